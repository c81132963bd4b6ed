#include "protocol/recording.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace racebeam {
namespace {

int frame_rate(Format format) { return format == Format::kPal || format == Format::kSecam ? 50 : 60; }

}  // namespace

Recording::Recording(MediaKind kind, const std::string& folder, const std::string& name,
                     std::size_t most_bytes, const Environment& machine)
    : name_(file_name(kind, name)), budget_(most_bytes) {
  const Footage footage{static_cast<std::size_t>(machine.height()), palette(machine.format()),
                        frame_rate(machine.format())};
  media_ = make_media(kind, folder, name, footage, budget_);
}

Recording::~Recording() {
  try {
    if (media_) media_->keep();
  } catch (const std::exception&) {
    // The client is not there to be told.
  }
}

void Recording::add(const Environment& machine) noexcept {
  if (!media_) return;
  try {
    sound_.registers = machine.sound().registers;
    std::array<std::uint8_t, kSamplesPerBlock> samples;
    sound_.generate(samples);
    media_->frame(machine.screen());
    media_->sound(samples);
    ++frames_;
  } catch (const std::exception& error) {
    failure_ = error.what();
    media_.reset();
  }
}

void Recording::stop() {
  const auto media = std::exchange(media_, nullptr);
  if (!media) throw std::runtime_error(failure_ + "; nothing was kept");
  media->keep();
}

}  // namespace racebeam

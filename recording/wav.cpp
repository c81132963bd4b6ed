// WAV: 8-bit mono, 512 samples a frame, as the reference records (docs/spec/environment.md, 12).
#include <vector>

#include "emulator/tia/sound.hpp"
#include "recording/media.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHeaderSize = 44;

void put_text(Bytes& out, std::string_view text) {
  for (const char c : text) out.push_back(static_cast<std::uint8_t>(c));
}

void put_number(Bytes& out, std::size_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(number >> 8 * i));
}

Bytes header(std::size_t rate, std::size_t samples) {
  Bytes out;
  put_text(out, "RIFF");
  put_number(out, kHeaderSize - 8 + samples, 4);
  put_text(out, "WAVEfmt ");
  put_number(out, 16, 4);    // size of this chunk
  put_number(out, 1, 2);     // PCM
  put_number(out, 1, 2);     // channels
  put_number(out, rate, 4);  // samples a second
  put_number(out, rate, 4);  // bytes a second
  put_number(out, 1, 2);     // bytes a sample
  put_number(out, 8, 2);     // bits a sample
  put_text(out, "data");
  put_number(out, samples, 4);
  return out;
}

class Wav final : public Media {
 public:
  Wav(const std::string& path, const Footage& footage, DiskBudget& budget)
      : file_(path, budget), rate_(static_cast<std::size_t>(footage.rate * kSamplesPerBlock)) {
    file_.write(header(rate_, 0));
  }

  void frame(std::span<const std::uint8_t>) override {}

  void sound(std::span<const std::uint8_t> samples) override {
    file_.write(samples);
    samples_ += samples.size();
  }

  void commit() override {
    file_.overwrite(0, header(rate_, samples_));
    file_.commit();
  }

 private:
  AtomicFile file_;
  std::size_t rate_, samples_ = 0;
};

}  // namespace

std::unique_ptr<Media> make_wav(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Wav>(path, footage, budget);
}

}  // namespace racebeam

#include "recording/recording.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "recording/film_encoder.hpp"

namespace racebeam {
namespace {

// The most frames in the queue: some milliseconds of the encoders' work. A frame of only sound has six bytes.
constexpr std::size_t kMaxPictures = 16, kMaxSounds = 1024;

// The most memory that encoders need: buffers of six bytes a pixel, their output, and zlib's own memory.
constexpr std::size_t kEncoderBytesAPixel = 12, kEncoderBytes = 1 << 19;
constexpr std::size_t kEncoderProcess = 80 << 20;  // the memory of ffmpeg, as measured

constexpr const char* kStopping = "the server stops";

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) (list += list.empty() ? "" : ",") += name;
  return list;
}

bool has_pictures(const std::vector<MediaKind>& kinds) {
  return std::ranges::any_of(kinds, [](MediaKind kind) { return kind != MediaKind::kWav; });
}

std::size_t queue_length(const std::vector<MediaKind>& kinds) {
  return has_pictures(kinds) ? kMaxPictures : kMaxSounds;
}

}  // namespace

std::string_view name_of(Recording::Cut cut) {
  switch (cut) {
    case Recording::Cut::kLimit: return "limit";
    case Recording::Cut::kDisk: return "disk";
    default: return "encoder";
  }
}

std::vector<std::string> Order::file_names() const {
  std::vector<std::string> names;
  for (const MediaKind kind : kinds) names.push_back(file_name(kind, name));
  return names;
}

std::size_t Order::memory() const {
  const std::size_t pixels = has_pictures(kinds) ? footage.height * kScreenWidth : 0;
  return queue_length(kinds) * (sizeof(RecordedFrame) + pixels) +
         kinds.size() * (kEncoderBytesAPixel * pixels + kEncoderBytes) +
         static_cast<std::size_t>(std::ranges::count_if(kinds, is_encoded)) * kEncoderProcess;
}

Recording::Recording(Order order, std::unique_ptr<Claim> claim, Post post,
                     std::shared_ptr<const std::atomic<bool>> given_up)
    : order_(std::move(order)),
      names_(listed(order_.file_names())),
      has_pictures_(has_pictures(order_.kinds)),
      post_(std::move(post)),
      given_up_(std::move(given_up)),
      queue_(queue_length(order_.kinds)),
      budget_(order_.most_bytes, given_up_),
      claim_(std::move(claim)) {}

void Recording::begin() { post(&Recording::open); }

bool Recording::is_behind() const {
  const std::lock_guard lock(mutex_);
  if (ended_) return false;
  return !has_begun_ || finishing_ || (!cut_ && waiting_ == queue_.size());
}

bool Recording::is_over() const {
  const std::lock_guard lock(mutex_);
  return cut_ || ended_;
}

bool Recording::finished() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

std::optional<Recording::Cut> Recording::cut() const {
  const std::lock_guard lock(mutex_);
  return cut_;
}

void Recording::add(const Environment& machine) {
  if (is_over()) return;
  RecordedFrame& frame = queue_[added_++ % queue_.size()];
  frame.sound = machine.sound().registers;
  if (has_pictures_) {
    const auto screen = machine.screen();
    frame.pixels.assign(screen.begin(), screen.end());
  }
  change([this] { ++waiting_; });
  post(&Recording::write_next);
}

void Recording::finish() {
  bool first = false;
  change([&] { first = !std::exchange(finishing_, true) && !ended_; });
  if (first) post(&Recording::close);
}

void Recording::post(void (Recording::*job)()) {
  post_([self = shared_from_this(), job] { (self.get()->*job)(); });
}

template <typename Change>
void Recording::change(Change change) {
  const std::lock_guard lock(mutex_);
  change();
}

void Recording::open() {
  try {
    if (*given_up_) throw std::runtime_error(kStopping);
    for (const MediaKind kind : order_.kinds)
      media_.push_back(make_media(kind, order_.folder, order_.name, order_.footage, budget_));
    change([this] { has_begun_ = true; });
  } catch (const std::exception& error) {
    result_.failure = error.what();
    end();
  }
}

void Recording::write_next() {
  const RecordedFrame& frame = queue_[written_++ % queue_.size()];
  if (!media_.empty() && !*given_up_) write(frame);
  change([this] { --waiting_; });
}

void Recording::write(const RecordedFrame& frame) {
  try {
    std::array<std::uint8_t, kSamplesPerBlock> samples;
    sound_.registers = frame.sound;
    sound_.generate(samples);
    for (const auto& medium : media_) medium->sound(samples);
    for (const auto& medium : media_) medium->frame(frame.pixels);
    ++result_.frames;
  } catch (const BudgetSpent&) {
    cut_off(Cut::kLimit);
  } catch (const EncoderFailed& error) {
    result_.failure = error.what();
    cut_off(Cut::kEncoder);
  } catch (const std::exception& error) {
    result_.failure = error.what();
    cut_off(Cut::kDisk);
  }
}

void Recording::cut_off(Cut why) {
  change([this, why] { cut_ = why; });
  close();
}

void Recording::close() {
  if (finished()) return;
  if (*given_up_) {
    result_.failure = kStopping;
  } else {
    commit();
  }
  end();
}

// Keeps the first failure, since later ones follow from it.
void Recording::fail(Cut why, const std::exception& error) {
  if (!result_.failure.empty()) return;
  result_.failure = error.what();
  change([this, why] { cut_ = why; });
}

void Recording::commit() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < media_.size(); ++i) {
    try {
      media_[i]->commit();
      names.push_back(order_.file_names()[i]);
    } catch (const EncoderFailed& error) {
      fail(Cut::kEncoder, error);
    } catch (const std::exception& error) {
      fail(Cut::kDisk, error);
    }
  }
  result_.names = listed(names);
  result_.bytes = budget_.taken();
}

void Recording::end() {
  media_.clear();  // files that were not committed are removed
  claim_.reset();
  change([this] { ended_ = true; });
}

}  // namespace racebeam

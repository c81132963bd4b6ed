// WebM and MP4: pictures and sound, encoded by ffmpeg while the game is played.
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

#include "recording/avi.hpp"
#include "recording/film_encoder.hpp"
#include "recording/media.hpp"

namespace racebeam {
namespace {

// How many bytes ffmpeg may still write when its input ends: for frames that it has not encoded, and for an
// index of all frames.
constexpr std::size_t kUnwritten = 200'000, kIndexBytesAFrame = 32;

// The encoders do not hold frames back, and flush what they have. So the size of the file shows how much
// space the frames take.
constexpr std::string_view kWebm =
    "-c:v libvpx-vp9 -deadline realtime -cpu-used 6 -lag-in-frames 0 -b:v 0 -crf 20 -c:a libopus "
    "-f webm -cluster_size_limit 50000 -flush_packets 1";
constexpr std::string_view kMp4 =
    "-c:v libx264 -preset veryfast -tune zerolatency -crf 20 -c:a aac -f mp4 -flush_packets 1";

// A pixel becomes four wide and two high. Chroma has half of the resolution, and then stays as sharp as luma.
constexpr std::string_view kCommand =
    "ffmpeg -hide_banner -nostdin -loglevel error -f avi -i pipe:0 "
    "-filter_threads 1 -vf scale=iw*4:ih*2:flags=neighbor -pix_fmt yuv420p -ar 48000 -threads 1";

std::vector<std::string> command(std::string_view codecs, const std::string& file) {
  std::vector<std::string> words;
  for (const std::string_view part : {kCommand, codecs}) {
    std::istringstream text{std::string(part)};
    words.insert(words.end(), std::istream_iterator<std::string>(text), {});
  }
  words.insert(words.end(), {"-y", "file:" + file});
  return words;
}

class EncodedFilm final : public Media {
 public:
  EncodedFilm(const std::string& path, std::string_view codecs, const Footage& footage, DiskBudget& budget)
      : height_(footage.height),
        budget_(budget),
        file_(path, budget),
        encoder_(command(codecs, file_.temporary()), [&budget] { return budget.is_given_up(); }) {
    reserve(kUnwritten);
    encoder_.write(avi_header(footage));
  }

  void sound(std::span<const std::uint8_t> samples) override {
    samples_.insert(samples_.end(), samples.begin(), samples.end());
  }

  void frame(std::span<const std::uint8_t> pixels) override {
    const std::vector<std::uint8_t> samples = std::move(samples_);
    samples_.clear();
    file_.count_growth();
    reserve(kIndexBytesAFrame);
    encoder_.write(avi_frame(pixels, height_, samples));
  }

  void commit() override {
    encoder_.finish();
    budget_.give_back(reserved_);
    reserved_ = 0;
    file_.count_growth();
    file_.commit();
  }

 private:
  void reserve(std::size_t bytes) {
    budget_.take(bytes);
    reserved_ += bytes;
  }

  std::size_t height_;
  DiskBudget& budget_;
  AtomicFile file_;
  FilmEncoder encoder_;  // ends before its file is removed
  std::size_t reserved_ = 0;
  std::vector<std::uint8_t> samples_;  // of the next frame
};

}  // namespace

std::unique_ptr<Media> make_webm(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<EncodedFilm>(path, kWebm, footage, budget);
}

std::unique_ptr<Media> make_mp4(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<EncodedFilm>(path, kMp4, footage, budget);
}

}  // namespace racebeam

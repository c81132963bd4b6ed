#include "tests/snapshots/check.hpp"

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "games/catalogue.hpp"
#include "tests/snapshots/run.hpp"

namespace racebeam::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
using Digests = std::vector<std::uint64_t>;

constexpr int kOtherActs = 30;

Environment machine(const Cartridge& cartridge, int number) {
  return {cartridge.image, cartridge.game, manner(number).settings};
}

// The number of acts before the saved frames; it differs for each seed and manner.
int warm_up(std::uint64_t seed, int number) {
  return static_cast<int>((seed * 131 + 57 * static_cast<unsigned>(number)) % 500);
}

// Digests of the present, and after each of `acts` acts from act `first` on.
Digests went_on(Environment& environment, std::uint64_t seed, int first, int acts) {
  Digests digests = {digest(environment, 0)};
  for (int i = 0; i < acts; ++i) digests.push_back(act(environment, seed, first + i));
  return digests;
}

void write_bytes(const fs::path& path, std::span<const std::uint8_t> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("can't write " + path.string());
}

Bytes read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

// A temporary folder.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "racebeam-snapshots-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("can't make the folder " + name);
    path = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

// A run and its digests.
class Run {
 public:
  Run(const Cartridge& cartridge, const Cartridge& other, int number, const Plan& plan)
      : cartridge_(cartridge),
        other_(other),
        number_(number),
        plan_(plan),
        first_(warm_up(plan.seed, number)),
        running_(machine(cartridge, number)) {}

  std::string check() {
    play();
    write_bytes(folder_.path / "image", *cartridge_.image->bytes);
    for (int frame = 0; frame < plan_.frames; ++frame) {
      const Environment::Saved& saved = *saved_[static_cast<std::size_t>(frame)];
      const Bytes bytes = to_bytes(saved, running_);
      std::string fault = compare(frame, "on the same machine", on_same_machine(saved, frame));
      if (fault.empty()) fault = compare(frame, "after another game", after_another_game(bytes, frame));
      if (fault.empty()) fault = compare(frame, "in a fresh process", in_fresh_process(bytes, frame));
      if (!fault.empty()) return fault;
    }
    return {};
  }

 private:
  void play() {
    for (int n = 0; n < first_; ++n) act(running_, plan_.seed, n);
    now_.push_back(digest(running_, 0));
    led_to_.push_back(0);  // the first has no act before it
    for (int i = 0; i < plan_.frames + plan_.ahead; ++i) {
      if (i < plan_.frames) saved_.push_back(running_.save(manner(number_).with_random));
      led_to_.push_back(act(running_, plan_.seed, first_ + i));
      now_.push_back(digest(running_, 0));
    }
  }

  Digests on_same_machine(const Environment::Saved& saved, int frame) {
    running_.restore(saved);
    return went_on(running_, plan_.seed, first_ + frame, plan_.ahead);
  }

  // Uses the same object, and probably the same memory.
  Digests after_another_game(const Bytes& bytes, int frame) {
    Environment second = machine(other_, number_);
    for (int n = 0; n < kOtherActs; ++n) act(second, plan_.seed, n);
    second = machine(cartridge_, number_);
    second.restore(*from_bytes(bytes, second));
    return went_on(second, plan_.seed, first_ + frame, plan_.ahead);
  }

  Digests in_fresh_process(const Bytes& bytes, int frame) {
    write_bytes(folder_.path / "state", bytes);
    const std::string command = "'" + plan_.executable + "' --resume '" + folder_.path.string() +
                                "' --games " + cartridge_.game->name + " --manner " +
                                std::to_string(number_) + " --first " + std::to_string(first_ + frame) +
                                " --ahead " + std::to_string(plan_.ahead) + " --seed " +
                                std::to_string(plan_.seed);
    FILE* output = popen(command.c_str(), "r");
    if (output == nullptr) throw std::runtime_error("can't start " + command);
    Digests seen;
    for (std::uint64_t one; std::fscanf(output, "%" SCNx64, &one) == 1;) seen.push_back(one);
    if (pclose(output) != 0) throw std::runtime_error("this failed: " + command);
    return seen;
  }

  std::string compare(int frame, const char* where, const Digests& digests) const {
    const auto fault = [&](int acts) {
      return "the state of act " + std::to_string(first_ + frame) + ", restored " + where + ", differs " +
             std::to_string(acts) + " acts later (" + manner(number_).name + ", seed " +
             std::to_string(plan_.seed) + ")";
    };
    const auto at = static_cast<std::size_t>(frame);
    if (digests.empty() || digests[0] != now_[at]) return fault(0);
    for (std::size_t i = 1; i <= static_cast<std::size_t>(plan_.ahead); ++i)
      if (i >= digests.size() || digests[i] != led_to_[at + i]) return fault(static_cast<int>(i));
    return {};
  }

  const Cartridge& cartridge_;
  const Cartridge& other_;
  int number_;
  const Plan& plan_;
  int first_;  // act whose state is saved first
  Environment running_;
  std::vector<std::shared_ptr<const Environment::Saved>> saved_;
  Digests now_, led_to_;  // by the number of acts since `first_`
  Folder folder_;
};

}  // namespace

std::string check_run(const Cartridge& cartridge, const Cartridge& other, int number, const Plan& plan) {
  return Run(cartridge, other, number, plan).check();
}

void resume(const Resumption& resumption) {
  const fs::path folder = resumption.folder;
  const auto image = load_image((folder / "image").string());
  const auto game = find_game(resumption.game);
  Environment environment(image, game, manner(resumption.manner).settings);
  environment.restore(*from_bytes(read_bytes(folder / "state"), environment));
  for (const std::uint64_t one : went_on(environment, resumption.seed, resumption.first, resumption.acts))
    std::printf("%016" PRIx64 "\n", one);
}

}  // namespace racebeam::test

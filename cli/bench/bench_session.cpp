#include "cli/bench/bench_session.hpp"

#include <zlib.h>

#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/bench/cpu_clock.hpp"
#include "cli/bench/snapshot_bench.hpp"

namespace racebeam {
namespace {

using Json = nlohmann::ordered_json;

// The machine's state is copied this many times for each copy of a client's state: a hundred copies take no
// time.
constexpr int kMachineTimes = 50;
constexpr int kMaxTimes = 1'000'000;

class BenchSession {
 public:
  BenchSession(const Cartridge& cartridge, const MachineOptions& options, bool look)
      : cartridge_(cartridge), options_(options), look_(look), environment_(power_on(cartridge, options)) {
    if (!look_) environment_.set_drawing(Drawing::kNone);
  }

  Json play(const std::vector<int>& actions) {
    begin();
    const double start = cpu_seconds();
    for (const int action : actions) {
      measured_act(action);
      if (environment_.game_over()) reset();
    }
    const double seconds = cpu_seconds() - start - reset_seconds_;
    Json answer = totals();
    answer["seconds"] = seconds;
    answer["reset_seconds"] = reset_seconds_;
    if (look_) answer["screen"] = crc32_of(0, environment_.screen());
    answer["ram"] = crc32_of(0, environment_.ram());
    return answer;
  }

  Json check(const std::vector<int>& actions) {
    begin();
    std::uint32_t digest = 0;
    for (const int action : actions) {
      const int reward = environment_.act(action);
      reward_ += reward;
      digest = digest_of_act(digest, reward);
      if (environment_.game_over()) reset();
    }
    Json answer = totals();
    answer["digest"] = digest;
    return answer;
  }

  Json time_resets(int times) {
    begin();
    for (int i = 0; i < times; ++i) reset();
    return {{"seconds", reset_seconds_ / times},
            {"screen", crc32_of(0, environment_.screen())},
            {"ram", crc32_of(0, environment_.ram())}};
  }

  Json time_snapshots(int times) {
    return {{"seconds", time_client_snapshots(environment_, times) * 1e-9},
            {"machine_seconds", time_machine_snapshots(cartridge_, options_, times * kMachineTimes) * 1e-9}};
  }

 private:
  // The only function of `play` whose instructions are counted: scripts/measure/callgrind.py names it, so it
  // must not be inlined.
  [[gnu::noinline]] void measured_act(int action) {
    reward_ += environment_.act(action);
    digest_ += look_ ? environment_.screen()[0] : environment_.ram()[0];
  }

  void begin() {
    frames_ = reward_ = resets_ = 0;
    reset_seconds_ = 0;
    first_frame_ = environment_.frame_number();
  }

  // The frames of a reset do not count.
  void reset() {
    const double start = cpu_seconds();
    frames_ += environment_.frame_number() - first_frame_;
    environment_.reset_game();
    first_frame_ = environment_.frame_number();
    if (environment_.game_over())
      throw std::runtime_error("the game is over right after its reset: nothing can be measured");
    ++resets_;
    reset_seconds_ += cpu_seconds() - start;
  }

  Json totals() const {
    const int frames = frames_ + environment_.frame_number() - first_frame_;
    return {{"frames", frames}, {"reward", reward_}, {"resets", resets_}};
  }

  static std::uint32_t crc32_of(std::uint32_t before, std::span<const std::uint8_t> bytes) {
    return static_cast<std::uint32_t>(crc32(before, bytes.data(), static_cast<uInt>(bytes.size())));
  }

  std::uint32_t digest_of_act(std::uint32_t digest, int reward) const {
    const auto word = static_cast<std::uint32_t>(reward);
    const auto byte = [word](int shift) { return static_cast<std::uint8_t>(word >> shift); };
    const std::array<std::uint8_t, 6> rest = {byte(0),
                                              byte(8),
                                              byte(16),
                                              byte(24),
                                              static_cast<std::uint8_t>(environment_.game_over()),
                                              static_cast<std::uint8_t>(environment_.lives())};
    if (look_) digest = crc32_of(digest, environment_.screen());
    return crc32_of(crc32_of(digest, environment_.ram()), rest);
  }

  const Cartridge& cartridge_;
  const MachineOptions& options_;
  bool look_;
  Environment environment_;
  int frames_ = 0, reward_ = 0, resets_ = 0, first_frame_ = 0;
  double reset_seconds_ = 0;
  unsigned digest_ = 0;
};

[[noreturn]] void refuse(const std::string& line) {
  throw std::invalid_argument("unknown command '" + line.substr(0, 60) +
                              "'; accepted: play A..., check A..., reset N and save N");
}

std::vector<int> read_numbers(std::istringstream& words, const std::string& line) {
  std::vector<int> numbers;
  for (int number; words >> number;) numbers.push_back(number);
  if (!words.eof() || numbers.empty()) refuse(line);
  return numbers;
}

Json answer(BenchSession& session, const std::string& line) {
  std::istringstream words{line};
  std::string command;
  words >> command;
  const auto numbers = read_numbers(words, line);
  if (command == "play") return session.play(numbers);
  if (command == "check") return session.check(numbers);
  if (numbers.size() != 1 || numbers[0] < 1 || numbers[0] > kMaxTimes) refuse(line);
  if (command == "reset") return session.time_resets(numbers[0]);
  if (command == "save") return session.time_snapshots(numbers[0]);
  refuse(line);
}

}  // namespace

void run_bench_session(const Cartridge& cartridge, const MachineOptions& options, bool look,
                       std::istream& commands, std::ostream& answers) {
  BenchSession session{cartridge, options, look};
  for (std::string line; std::getline(commands, line);) answers << answer(session, line).dump() << std::endl;
}

}  // namespace racebeam

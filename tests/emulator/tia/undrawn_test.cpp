// Frames that are run without their pixels. A picture that is read later shows what would have been drawn,
// and the machine is the same in any case. The programs are generated; their frames change, and are short,
// long or without an end.
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "emulator/console.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam::test {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  bool percent(int chance) { return below(100) < chance; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

// A frame as in games: VSYNC, then groups of lines that begin with some writes. Values are constants, or
// bytes of RAM that change from frame to frame. The values of collision registers are written, too.
class Program {
 public:
  explicit Program(unsigned seed) : random_(seed) {
    put({0xA9, 0x02, 0x85, VSYNC, 0x85, WSYNC, 0x85, WSYNC, 0x85, WSYNC, 0xA9, 0x00, 0x85, VSYNC});
    put({0xE6, 0x90, 0xA5, 0x90, 0x29, random_.percent(50) ? std::uint8_t{3} : std::uint8_t{31}, 0x85, 0x91});
    const int lines = random_.percent(70) ? 262 : random_.below(340);
    for (int line = 0; line < lines && code_.size() < 3900;) line += add_group();
    if (random_.percent(10)) put({0xE6, 0x92, 0xD0, 0xFE, 0xE6, 0x92});  // loops for ever, from one frame on
    put({0x4C, 0x00, 0xF0});
    code_.resize(4096, 0xEA);
    code_[0xFFC] = 0x00;
    code_[0xFFD] = 0xF0;
  }

  const std::vector<std::uint8_t>& code() const { return code_; }

 private:
  void put(std::initializer_list<std::uint8_t> bytes) { code_.insert(code_.end(), bytes); }

  int add_group() {
    if (random_.percent(cosmic_)) add_cosmic();
    for (int writes = random_.below(8); writes > 0; --writes) add_write();
    const int lines = 1 + random_.below(20);
    put({0xA2, static_cast<std::uint8_t>(lines), 0x85, WSYNC});
    const bool on_each = random_.percent(50);
    const auto start = code_.size() - 2;
    if (on_each) add_write();
    put({0xCA, 0xD0, static_cast<std::uint8_t>(start - (code_.size() + 3))});
    return lines;
  }

  // HMM0 changes from 7 to 6 exactly 21 cycles after an HMOVE: the ends of lines move missile 0.
  void add_cosmic() {
    put({0xA2, 0x60, 0xA9, 0x70, 0x85, HMM0, 0x85, HMOVE});
    put({0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0x86, HMM0});
  }

  void add_write() {
    if (random_.percent(10)) {  // a collision register, once in some frames
      put({0xA5, 0x91, 0xD0, 0x04, 0xA5, static_cast<std::uint8_t>(random_.below(8)), 0x85, 0x98});
    }
    if (random_.percent(clears_)) put({0x85, CXCLR});
    switch (random_.below(4)) {
      case 0: put({0xA5, static_cast<std::uint8_t>(random_.below(reads_))}); break;  // a collision register
      case 1: put({0xA5, 0x91}); break;
      default: put({0xA9, random_.byte()}); break;
    }
    put({0x85, static_cast<std::uint8_t>(VBLANK + (random_.percent(95) ? 3 + random_.below(CXCLR - 4) : 0))});
  }

  Random random_;
  const int reads_ = 1 + random_.below(8);  // how many collision registers are read in each frame
  // How many percent of the writes clear the collision registers before, and of the groups begin with
  // add_cosmic().
  const int clears_ = random_.percent(50) ? 0 : random_.below(10), cosmic_ = random_.percent(70) ? 0 : 30;
  std::vector<std::uint8_t> code_;
};

struct Machine {
  Machine(const std::shared_ptr<const std::vector<std::uint8_t>>& rom, const Properties& properties)
      : console(rom, properties, power_on) {}
  SystemGenerator power_on{1};
  Console console;
};

bool same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  return std::ranges::equal(a, b);
}

// States are read in this many of a hundred frames. The others need not be computed.
void compare(Console& drawn, Console& other, Random& random, int looks) {
  REQUIRE(same(drawn.ram(), other.ram()));
  if (!random.percent(looks)) return;
  REQUIRE(std::memcmp(&drawn.state(), &other.state(), sizeof(State)) == 0);
  REQUIRE(std::memcmp(&drawn.sound(), &other.sound(), sizeof(Sound)) == 0);
  if (random.percent(20)) REQUIRE(same(drawn.picture(), other.picture()));
  if (random.percent(20)) REQUIRE(same(drawn.previous_picture(), other.previous_picture()));
  REQUIRE(std::memcmp(&drawn.state(), &other.state(), sizeof(State)) == 0);
}

struct Snapshot {
  explicit Snapshot(const Console& console) : state(console.state()), pictures(console.pictures()) {}
  void restore_to(Console& console) const {
    console.restore(state);
    console.restore_pictures(pictures);
  }
  State state;
  FrameBuffers pictures;
};

void play(unsigned seed, int frames) {
  Random random(seed);
  const auto rom = std::make_shared<const std::vector<std::uint8_t>>(Program(seed).code());
  Properties properties;
  properties.format = random.percent(80) ? Format::kNtsc : Format::kPal;
  Machine drawn(rom, properties), other(rom, properties);
  std::vector<std::pair<Snapshot, Snapshot>> saved;
  const bool follows = random.percent(80);
  const int often = random.percent(30) ? 0 : random.below(101),
            looks = random.percent(30) ? 100 : random.below(40);
  for (int frame = 0; frame < frames; ++frame) {
    INFO("frame " << frame);
    drawn.console.step();
    other.console.step(random.percent(often), follows);
    compare(drawn.console, other.console, random, looks);
    if (random.percent(5)) other.console.release_caches();
    if (random.percent(looks / 8)) saved.emplace_back(drawn.console, other.console);
    if (!saved.empty() && random.percent(10)) {
      const auto& [of_drawn, of_other] =
          saved[static_cast<std::size_t>(random.below(static_cast<int>(saved.size())))];
      of_drawn.restore_to(drawn.console);
      of_other.restore_to(other.console);
      compare(drawn.console, other.console, random, looks);
      if (random.percent(30)) {
        const FrameBuffer& theirs = *drawn.console.pictures().current;
        REQUIRE(same(theirs.pixels(), other.console.with_pixels(of_other.pictures.current)->pixels()));
      }
    }
    if (saved.size() > 4) saved.erase(saved.begin());
  }
}

// Only in frame 10, the program reads whether player 0 and the playfield collided in the previous frame.
std::vector<std::uint8_t> late_reader() {
  std::vector<std::uint8_t> code = {0xA9, 0x02,  0x85,  VSYNC, 0x85,  WSYNC, 0x85, WSYNC, 0x85, WSYNC, 0xA9,
                                    0x00, 0x85,  VSYNC, 0xE6,  0x90,  0xA5,  0x90, 0xC9,  0x0A, 0xD0,  0x0A,
                                    0xA5, 0x02,  0x85,  0x98,                 // CXP0FB
                                    0x30, 0x04,  0xA9,  0x0F,  0x85,  AUDV0,  // a tone if they did not
                                    0x85, CXCLR, 0xA9,  0xFF,  0x85,  GRP0,  0x85, PF0,   0x85, PF1,   0x85,
                                    PF2,  0xA2,  0xFA,  0x85,  WSYNC, 0xCA,  0xD0, 0xFB,  0x4C, 0x00,  0xF0};
  code.resize(4096);
  code[0xFFD] = 0xF0;
  return code;
}

TEST_CASE("A collision that was not computed is known when it is first read") {
  const auto rom = std::make_shared<const std::vector<std::uint8_t>>(late_reader());
  const bool draws_that = GENERATE(false, true);
  Machine machine(rom, {});
  Console& console = machine.console;
  console.set_ram(0x10, 0);
  console.set_ram(0x18, 0);
  for (int frame = 0; frame <= 12; ++frame) {  // the program counts from the end of the first VSYNC on
    INFO("frame " << frame << ", the tenth drawn: " << draws_that);
    console.step(draws_that && frame == 10, true);
    REQUIRE(int{console.ram()[0x10]} == frame);
    REQUIRE((console.ram()[0x18] & 0x80) == (frame >= 10 ? 0x80 : 0));
    REQUIRE(int{console.sound().registers[4]} == 0);
  }
}

TEST_CASE("A frame that was not drawn is drawn when its picture is read") {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    INFO("seed " << seed);
    play(seed, 60);
  }
}

}  // namespace
}  // namespace racebeam::test

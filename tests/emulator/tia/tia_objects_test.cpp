// Positions, shapes and movement: each table of docs/spec/tia.md in full, and bugs that random accesses
// found.
#include <catch2/catch.hpp>

#include "tests/emulator/comparison.hpp"

namespace racebeam::test {
namespace {

Comparison fresh() {
  Properties properties = ntsc();
  properties.ystart = 3;
  properties.height = 4;
  return Comparison(properties, false);
}

constexpr Access write(int line, int x, unsigned reg, unsigned value) {
  return {Access::kWrite, line * kLineCycles + x, reg, value};
}

constexpr Access read(int line, int x, unsigned reg) {
  return {Access::kLatches, line * kLineCycles + x, reg, 0};
}

constexpr int kEnd = 8 * kLineCycles;

const Script kColors = {write(0, 1, COLUP0, 0x10), write(0, 2, COLUP1, 0x20), write(0, 3, COLUPF, 0x30),
                        write(0, 4, COLUBK, 0x40), write(0, 5, GRP0, 0xB1),   write(0, 6, GRP1, 0x8D)};

Script operator+(Script a, const Script& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST_CASE("HMOVE moves as the table says, for every cycle and every motion") {
  for (int x = 0; x < kLineCycles; ++x) {
    Comparison machines = fresh();
    for (unsigned motion = 0; motion < 256; motion += 16) {
      INFO("cycle " << x << ", motion " << motion);
      Script script;
      for (unsigned reg = HMP0; reg <= HMBL; ++reg)
        script.push_back(write(0, static_cast<int>(reg), reg, motion));
      machines.play(script + Script{write(1, x, HMOVE, 0)}, kEnd);
      machines.next_frame(kEnd);
    }
  }
}

TEST_CASE("Every strobe position, for all five objects, with every width and number of copies") {
  for (unsigned nusiz = 0; nusiz < 64; nusiz = nusiz == 7      ? 0x10
                                               : nusiz == 0x17 ? 0x20
                                               : nusiz == 0x27 ? 0x30
                                                               : nusiz + 1)
    for (int x = 0; x < kLineCycles; ++x) {
      INFO("NUSIZ " << nusiz << ", strobes from cycle " << x << " on");
      Comparison machines = fresh();
      Script script = kColors + Script{write(0, 30, ENAM0, 2),      write(0, 31, ENAM1, 2),
                                       write(0, 32, ENABL, 2),      write(0, 40, NUSIZ0, nusiz),
                                       write(0, 43, NUSIZ1, nusiz), write(0, 46, CTRLPF, nusiz)};
      for (unsigned i = 0; i < 5; ++i) script.push_back(write(1, x + 3 * static_cast<int>(i), RESP0 + i, 0));
      machines.play(script + Script{write(2, 20, NUSIZ0, nusiz), write(2, 23, NUSIZ1, nusiz)}, kEnd);
    }
}

TEST_CASE("A player placed anew while one of its copies is drawn") {
  for (unsigned nusiz = 0; nusiz < 8; ++nusiz)
    for (int first = 24; first < 70; first += 5)
      for (int gap = 2; first + gap < kLineCycles; ++gap) {
        INFO("NUSIZ0 " << nusiz << ", RESP0 at " << first << " and " << gap << " cycles later");
        Comparison machines = fresh();
        const int second = first + gap;
        machines.play(kColors + Script{write(0, 40, NUSIZ0, nusiz), write(1, first, RESP0, 0),
                                       write(2, 0, NUSIZ0, nusiz), write(4, second, RESP0, 0),
                                       write(4, second + 2, COLUP0, 0x66), write(4, second + 4, GRP0, 0xFF)},
                      kEnd);
      }
}

TEST_CASE("Every pair of motions of Cosmic Ark mode") {
  for (unsigned from = 0; from < 16; ++from)
    for (unsigned to = 0; to < 16; ++to)
      for (int wait = 20; wait <= 22; ++wait) {
        INFO("HMM0 " << from << " then " << to << " after " << wait << " cycles");
        Comparison machines = fresh();
        machines.play(
            kColors + Script{write(0, 30, ENAM0, 2), write(2, 5, HMM0, 16 * from), write(2, 60, RESM0, 0),
                             write(3, 3, HMOVE, 0), write(3, 3 + wait, HMM0, 16 * to)},
            kEnd);
      }
}

TEST_CASE("Missiles and ball strobed soon after an HMOVE, at every distance") {
  for (const unsigned reg : {RESM0, RESM1, RESBL})
    for (int x = 0; x < 30; ++x)
      for (int gap = 3; gap < 25; ++gap) {
        INFO("register " << reg << " at " << gap << " cycles after an HMOVE at cycle " << x);
        Comparison machines = fresh();
        machines.play({write(3, x, HMOVE, 0), write(3, x + gap, reg, 0)}, kEnd);
      }
}

// Frames that differ in what is invisible at the start of a line, but matters because of a write on it.

const Script kBeyondWindow = {write(7, 40, VSYNC, 0)};

void play_alternately(const Script& one, const Script& other) {
  Comparison machines = fresh();
  for (int frame = 0; frame < 12; ++frame) {
    INFO("frame " << frame);
    machines.play((frame / 2 % 3 == 1 ? other : one) + kBeyondWindow, kEnd);
    machines.next_frame(kEnd);
  }
}

TEST_CASE(
    "A colour that only score mode shows, switched on in the middle of the line, is not taken from an older "
    "frame") {
  const auto frame = [](unsigned color) {
    Script script = {write(0, 1, COLUP0, color), write(0, 4, COLUP1, color + 2), write(0, 7, COLUPF, 0x30),
                     write(0, 10, PF1, 0xFF)};
    for (int line = 3; line < 7; ++line)
      script = script + Script{write(line, 30, CTRLPF, 2), write(line, 68, CTRLPF, 0)};
    return script;
  };
  play_alternately(frame(0x50), frame(0x90));
}

TEST_CASE("Where an invisible player stands decides how far RESP0 draws ahead") {
  for (const unsigned reg : {RESP0, RESP1}) {
    const auto frame = [reg](int position) {
      Script script = {write(0, position, reg, 0)};
      for (int line = 3; line < 7; ++line)
        script = script + Script{write(line, 5, COLUBK, 0x40), write(line, 30, reg, 0),
                                 write(line, 33, COLUBK, 0x80), write(line, 60, reg, 0)};
      return script;
    };
    play_alternately(frame(28), frame(60));
    // The strobe of the previous line decides; above, only the first line differs.
    const auto single = [reg](int position) {
      return Script{write(0, position, reg, 0), write(4, 30, reg, 0), write(4, 33, COLUBK, 0x80),
                    write(5, 3, COLUBK, 0x40)};
    };
    play_alternately(single(28), single(60));
  }
}

TEST_CASE("A line that repeats the one above has its collisions, also when only it is drawn again") {
  Script meet = {write(0, 1, GRP0, 0xFF), write(0, 4, PF0, 0xF0), write(0, 7, CXCLR, 0)}, cleared = meet;
  for (int line = 3; line < 7; ++line) {
    meet.push_back(write(line, 10, VSYNC, 0));
    cleared.push_back(write(line, 10, VSYNC, 0));
    if (line == 4) cleared.push_back(write(line, 74, CXCLR, 0));
  }
  play_alternately(meet, cleared);
}

// Frames that stop within the pixels that an HMOVE blanks ahead of the beam. With a VSYNC before, they close.

TEST_CASE("Every access in horizontal blank is an end of a span, though it changes nothing") {
  const Access accesses[] = {write(3, 12, WSYNC, 0),   write(3, 12, VSYNC, 0),
                             write(3, 12, HMP0, 0x10), write(3, 12, AUDV0, 3),
                             write(3, 12, 0x3F, 0),    write(3, 12, COLUBK, 0x40),
                             read(3, 12, 2),           {Access::kInput, 3 * kLineCycles + 12, 0, 0}};
  for (const Access& access : accesses)
    for (int last = 23; last < 50; ++last)
      for (const Script& begin : {Script{}, Script{write(0, 3, VSYNC, 2)}}) {
        INFO("kind " << access.kind << ", register " << access.reg << ", the frame ends at cycle " << last
                     << (begin.empty() ? "" : ", closed"));
        Comparison machines = fresh();
        machines.play(kColors + kBeyondWindow, kEnd);  // both buffers get something to show
        machines.next_frame(kEnd);
        machines.play(kBeyondWindow, kEnd);
        machines.next_frame(kEnd);
        machines.play(begin + Script{write(2, 3, HMOVE, 0), access, write(3, last, VSYNC, 0)}, kEnd);
      }
}

}  // namespace
}  // namespace racebeam::test

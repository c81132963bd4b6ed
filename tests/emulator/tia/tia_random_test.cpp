// Random sequences of TIA accesses on the machine and on the model of reference_tia.hpp. Pictures, collisions
// and registers must be equal after every frame. Frames share two buffers, repeat the previous one with small
// changes, end inside the window or beyond it, and are sometimes reset or restored.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/emulator/comparison.hpp"

namespace racebeam::test {
namespace {

// The properties of a series of frames.
struct Style {
  std::vector<unsigned> registers;
  std::vector<unsigned> values;
  int longest_gap;    // cycles between two accesses
  int reads_percent;  // of accesses
  bool kernel;        // the same accesses on every line, as a game's kernel makes them
  int cuts;           // percent of frames that end inside the window
  int mutations;      // percent of accesses that change from line to line, or from frame to frame
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool percent(int chance) { return below(100) < chance; }
  std::mt19937& engine() { return engine_; }
  unsigned byte() { return static_cast<unsigned>(below(256)); }
  template <class T>
  T of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
  }

 private:
  std::mt19937 engine_;
};

// Groups of registers that affect each other; a style takes one or all.
const std::vector<std::vector<unsigned>> kFamilies = {
    {COLUP0, COLUP1, COLUPF, COLUBK, CTRLPF, PF0, PF1, PF2, VBLANK},
    {RESP0, GRP0, NUSIZ0, REFP0, HMP0, HMOVE},
    {RESP1, GRP1, GRP0, VDELP0, VDELP1, NUSIZ1, REFP1},
    {RESM0, ENAM0, NUSIZ0, RESMP0, RESP0, HMM0, HMOVE},
    {RESM1, ENAM1, NUSIZ1, RESMP1, RESP1, HMM1, HMOVE, HMCLR},
    {RESBL, ENABL, VDELBL, CTRLPF, GRP1, HMBL, HMOVE},
    {HMOVE, HMM0, HMP0, HMP1, HMM1, HMBL, HMCLR},
    {HMOVE, RESBL, RESM0, RESM1, COLUBK},
    {HMOVE, VBLANK, COLUBK, PF1},
    {CXCLR, PF1, GRP0, GRP1, ENABL, ENAM0, ENAM1, RESP0},
    {RESP0, RESP1, NUSIZ0, NUSIZ1},
    {CTRLPF, PF2, ENABL, GRP0, GRP1, COLUPF},
};

std::vector<unsigned> all_registers() {
  std::vector<unsigned> list;
  for (unsigned reg = 0; reg < 0x40; ++reg) list.push_back(reg);
  return list;
}

Style random_style(Random& random) {
  Style style;
  style.registers = random.percent(30) ? all_registers() : random.of(kFamilies);
  for (int i = random.below(3); i > 0; --i) {
    const std::vector<unsigned> more = random.of(kFamilies);
    style.registers.insert(style.registers.end(), more.begin(), more.end());
  }
  for (int i = random.between(1, 6); i > 0; --i) style.values.push_back(random.byte());
  if (random.percent(50)) style.values.insert(style.values.end(), {0x00, 0xFF, 0x70, 0x60, 0x02});
  style.longest_gap = random.of(std::vector<int>{4, 10, 20, 30, 60, 200});
  style.reads_percent = random.of(std::vector<int>{0, 0, 5, 30});
  style.kernel = random.percent(80);
  style.cuts = random.of(std::vector<int>{0, 5, 50});
  style.mutations = random.of(std::vector<int>{0, 0, 1, 3, 30});
  return style;
}

Access random_access(Random& random, const Style& style, int cycle) {
  const bool any_value = random.percent(30);
  if (random.percent(style.reads_percent))
    return {random.percent(70) ? Access::kLatches : Access::kInput, cycle,
            static_cast<unsigned>(random.below(8)), 0};
  return {Access::kWrite, cycle, random.of(style.registers),
          any_value ? random.byte() : random.of(style.values)};
}

// Three cycles or more lie between the accesses of two instructions; two in one cycle are pushes.
int random_gap(Random& random, const Style& style) {
  return random.percent(5) ? 0 : random.between(3, 3 + style.longest_gap);
}

void mutate(Random& random, const Style& style, Script& script) {
  for (Access& access : script)
    if (random.percent(style.mutations)) access = random_access(random, style, access.cycle);
}

Script random_script(Random& random, const Style& style, int cycles) {
  Script script;
  if (!style.kernel) {
    for (int cycle = random.below(20); cycle < cycles; cycle += random_gap(random, style))
      script.push_back(random_access(random, style, cycle));
    return script;
  }
  Script line;
  for (int x = random.below(20); x < kLineCycles; x += random_gap(random, style))
    line.push_back(random_access(random, style, x));
  for (int start = 0; start < cycles; start += kLineCycles) {
    mutate(random, style, line);
    for (Access access : line) {
      access.cycle += start;
      script.push_back(access);
    }
  }
  return script;
}

// A vertical blank as in games: it moves and recolours what the same kernel shows again.
Script with_blank(Random& random, const Style& style, const Script& script, int blank_cycles) {
  Script whole;
  const bool anything = random.percent(50);
  for (int cycle = 0; cycle < blank_cycles && random.percent(70); cycle += 4) {
    whole.push_back(random_access(random, style, cycle));
    if (anything && whole.back().kind == Access::kWrite)
      whole.back().reg = static_cast<unsigned>(random.below(CXCLR + 1));
  }
  const auto first =
      std::find_if(script.begin(), script.end(), [&](const Access& a) { return a.cycle > blank_cycles; });
  whole.insert(whole.end(), first, script.end());
  return whole;
}

// A little of everything: colours, graphics, some enabled objects.
Script random_scene(Random& random) {
  Script scene;
  const int density = random.of(std::vector<int>{5, 20, 60});
  for (unsigned reg = NUSIZ0; reg <= RESMP1; ++reg)
    if (random.percent(density)) scene.push_back({Access::kWrite, random.below(100), reg, random.byte()});
  std::stable_sort(scene.begin(), scene.end(),
                   [](const Access& a, const Access& b) { return a.cycle < b.cycle; });
  return scene;
}

// HMOVE and, 21 cycles later, the write that sets missile 0 in motion: too rare to occur by chance.
void add_cosmic(Random& random, Script& script, int cycles) {
  const int at = random.below(cycles);
  script.push_back({Access::kWrite, at, HMM0, 0x70});
  script.push_back({Access::kWrite, at + 3, HMOVE, 0});
  script.push_back({Access::kWrite, at + 24, HMM0, 0x60});
  script.push_back({Access::kWrite, at + 27, ENAM0, 0x02});
  std::stable_sort(script.begin(), script.end(),
                   [](const Access& a, const Access& b) { return a.cycle < b.cycle; });
}

Script with_pushes(Script script) {
  for (std::size_t i = 1; i < script.size(); ++i)
    if (script[i].cycle - script[i - 1].cycle < 3)
      for (Access* access : {&script[i - 1], &script[i]})
        if (access->kind == Access::kWrite) access->kind = Access::kPush;
  return script;
}

void play_series(unsigned seed, int frames) {
  Random random(seed);
  Properties properties = ntsc();
  properties.ystart = random.between(1, 4);
  properties.height = random.between(2, 20);
  properties.hmove_blanks = random.percent(80);
  const bool pal = random.percent(15);
  const int cycles = (properties.ystart + properties.height + 2) * kLineCycles;
  const int blank = properties.ystart * kLineCycles - 8;
  const Style style = random_style(random);
  Script script = random_script(random, style, cycles);
  if (random.percent(15)) add_cosmic(random, script, cycles);
  Comparison machines(properties, pal);
  machines.play(with_pushes(random_scene(random)), cycles);
  machines.next_frame(cycles + kLineCycles);
  bool saved = false;
  for (int frame = 0; frame < frames; ++frame) {
    INFO("frame " << frame);
    const int until = random.percent(style.cuts) ? random.below(cycles) : cycles;
    machines.play(with_pushes(random.percent(60) ? with_blank(random, style, script, blank) : script), until);
    if (random.percent(5))
      machines.reset_in_frame();
    else
      machines.next_frame(random.percent(90) ? cycles + kLineCycles : until + random.below(100));
    if (saved && random.percent(10)) machines.restore();
    if (random.percent(10)) machines.save(), saved = true;
    if (random.percent(10))
      script = random_script(random, style, cycles);
    else
      mutate(random, style, script);
  }
}

Script shifted(Script script, int cycles) {
  for (Access& access : script) access.cycle += cycles;
  return script;
}

// Plays the same frame repeatedly, each time with one or two other registers at the start of lines. The line
// cache must notice every visible change, and the rows below must be right in any case.
void play_repeats(unsigned seed, int frames) {
  Random random(seed);
  Properties properties = ntsc();
  properties.ystart = 4;
  properties.height = random.between(2, 8);
  const int blank = properties.ystart * kLineCycles;
  const int cycles = (properties.ystart + properties.height + 2) * kLineCycles;
  Style style = random_style(random);
  style.kernel = random.percent(90);
  // With few registers in the lines, the effect of the others is most visible.
  if (random.percent(60)) std::shuffle(style.registers.begin(), style.registers.end(), random.engine());
  const std::vector<unsigned> family = style.registers;
  if (random.percent(60))
    style.registers.resize(std::min<std::size_t>(style.registers.size(), 1 + random.byte() % 3));
  Script lines = random_script(random, style, cycles - blank);
  if (random.percent(15)) add_cosmic(random, lines, cycles - blank);
  lines = shifted(lines, blank);
  const Script scene = random_scene(random);
  Comparison machines(properties, random.percent(15));
  for (int frame = 0; frame < frames; ++frame) {
    INFO("frame " << frame);
    Script script = scene;
    for (int cycle = 110; cycle < 290 && random.percent(cycle == 110 ? 90 : 30); cycle += 6)
      script.push_back({Access::kWrite, cycle, random.percent(70) ? random.of(family) : random.byte() % 0x2D,
                        random.percent(50) ? random.of(style.values) : random.byte()});
    script.insert(script.end(), lines.begin(), lines.end());
    machines.play(with_pushes(script), cycles);
    machines.next_frame(cycles + kLineCycles * (1 + random.below(2)));  // PAL loses its colour on odd counts
  }
}

TEST_CASE("Frames that differ in one register at the start of a line are told apart") {
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    INFO("seed " << seed);
    play_repeats(seed, 30);
  }
}

TEST_CASE("Random accesses draw the same pictures and find the same collisions as the model") {
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    INFO("seed " << seed);
    play_series(seed, 24);
  }
}

}  // namespace
}  // namespace racebeam::test

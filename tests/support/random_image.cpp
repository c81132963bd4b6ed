#include "tests/support/random_image.hpp"

#include <algorithm>
#include <initializer_list>
#include <random>
#include <stdexcept>
#include <vector>

#include "emulator/base/opcodes.hpp"
#include "games/md5.hpp"
#include "tests/support/thumb_code.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kCartridge = 4096, kStarpathLoad = 8448, kStarpathPages = 24;
constexpr unsigned kDpcPlusDriver = 3072, kDpcPlusBanks = 6 * 4096, kDpcPlusOthers = 5120;
constexpr unsigned kCdfDriver = 2048, kCdfCode = 2048, kCdfBanks = 7 * 4096;

struct Range {
  unsigned first, size;
};

struct Recipe {
  std::string_view scheme;
  std::size_t size;  // of the image
  // Each block of this many bytes holds the program once; it runs in the last one that the CPU sees.
  unsigned unit;
  std::vector<Range> lively;  // addresses with an effect
  Bytes first{};              // instructions that the program begins with
};

// Fast fetch by a bit of RAM, and a call of the ARM.
const Bytes kStartOfCdf = {0xA5, 0x80, 0x29, 0x01, 0x8D, 0xF2, 0x1F, 0xA2, 0xFF, 0x8E, 0xF3, 0x1F};

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all = {
      {"2K", 2048, 2048, {{0x1000, 0x1000}}},
      {"4K", 4096, 4096, {{0x1000, 0x1000}}},
      {"4KSC", 4096, 4096, {{0x1000, 0x1000}, {0x1000, 0x100}}},
      {"F8", 8192, 4096, {{0x1FF8, 2}}},
      {"F8 swapped", 8192, 4096, {{0x1FF8, 2}}},
      {"F8SC", 8192, 4096, {{0x1FF8, 2}, {0x1000, 0x100}}},
      {"F6", 16384, 4096, {{0x1FF6, 4}}},
      {"F6SC", 16384, 4096, {{0x1FF6, 4}, {0x1000, 0x100}}},
      {"F4", 32768, 4096, {{0x1FF4, 8}}},
      {"F4SC", 32768, 4096, {{0x1FF4, 8}, {0x1000, 0x100}}},
      {"FASC", 12288, 4096, {{0x1FF8, 3}, {0x1000, 0x200}}},
      {"E0", 8192, 4096, {{0x1FE0, 24}}},
      {"E7", 16384, 2048, {{0x1FE0, 12}, {0x1FE7, 1}, {0x1000, 0x800}, {0x1800, 0x200}}},
      {"FE", 8192, 4096, {{0xD000, 0x3000}}},
      {"DPC", 10496, 4096, {{0x1FF8, 2}, {0x1000, 0x40}, {0x1040, 0x40}, {0x1058, 8}}},
      {"3F", 8192, 2048, {{0x0000, 0x40}, {0x1000, 0x40}}},
      {"3E", 16384, 2048, {{0x003E, 2}, {0x103E, 2}, {0x1000, 0x800}}},
      {"UA", 8192, 4096, {{0x0220, 1}, {0x0240, 1}}},
      {"CV", 2048, 2048, {{0x1000, 0x800}}},
      {"CV 4K", 4096, 2048, {{0x1000, 0x800}}},
      {"AR", kStarpathLoad, 2048, {{0x1000, 0x100}, {0x1FF8, 1}, {0x1850, 1}}},
      {"UA clone", 8192, 4096, {{0x0220, 1}, {0x02A0, 1}, {0x02C0, 1}}},
      {"UASW", 8192, 4096, {{0x0220, 1}, {0x0240, 1}, {0x0FC0, 1}}},
      {"0FA0", 8192, 4096, {{0x06A0, 1}, {0x06C0, 1}, {0x0FC0, 1}}},
      {"0840", 8192, 4096, {{0x0800, 1}, {0x0840, 1}}},
      {"03E0", 8192, 4096, {{0x03B0, 0x38}}},
      {"WF8", 8192, 4096, {{0x1FF8, 1}}},
      {"WDSW", 8195, 1024, {{0x0030, 16}, {0x1040, 0x40}}},
      {"WD", 8192, 1024, {{0x0030, 16}, {0x1040, 0x40}}},
      {"3EX", 16384, 2048, {{0x003E, 2}, {0x103E, 2}, {0x1000, 0x800}}},
      {"JANE", 16384, 4096, {{0x1FF0, 16}}},
      {"3E+", 16384, 1024, {{0x003E, 2}, {0x1000, 0xC00}}},
      {"FA2", 28672, 4096, {{0x1FF4, 8}, {0x1000, 0x200}}},
      {"FC", 32768, 4096, {{0x1FF8, 2}, {0x1FFC, 1}}},
      {"SB", 131072, 4096, {{0x0800, 0x40}}},
      {"EF", 65536, 4096, {{0x1FE0, 16}}},
      {"EFF", 65536, 4096, {{0x1FE0, 16}, {0x1FF0, 5}, {0x1FF0, 4}}},
      {"EFSC", 65536, 4096, {{0x1FE0, 16}, {0x1000, 0x100}}},
      {"DF", 131072, 4096, {{0x1FC0, 32}}},
      {"DFSC", 131072, 4096, {{0x1FC0, 32}, {0x1000, 0x100}}},
      {"BF", 262144, 4096, {{0x1F80, 64}}},
      {"BFSC", 262144, 4096, {{0x1F80, 64}, {0x1000, 0x100}}},
      {"MDM", 32768, 4096, {{0x0800, 0x80}, {0x0800, 8}, {0x0880, 1}}},
      {"X07", 65536, 4096, {{0x080D, 1}, {0x088D, 1}, {0x08ED, 1}, {0x08FD, 1}, {0x0000, 0x80}}},
      // The program goes on in a page that it selects first.
      {"4A50",
       65536,
       2048,
       {{0x6E00, 16}, {0x6E40, 16}, {0x6F10, 16}, {0x6400, 512}, {0x1000, 0x800}, {0x6C0E, 1}, {0x00F8, 4}},
       {0xAD, 0x06, 0x6C}},
      {"2IN1", 4096, 2048, {{0x1000, 0x1000}}},
      {"MB", 65536, 4096, {{0x1FF0, 1}}},
      // The program's window shows ROM.
      {"MC", 131072, 1024, {{0x003C, 3}, {0x1000, 0xC00}, {0x1FFC, 2}}, {0xA9, 0x90, 0x85, 0x3F}},
      // Fast fetch by a bit of RAM, and a call of the ARM.
      {"DPC+",
       32768,
       4096,
       {{0x1FF6, 6}, {0x1000, 0x28}, {0x1028, 0x58}, {0x1058, 3}},
       {0xA5, 0x80, 0x29, 0x01, 0x8D, 0x58, 0x10, 0xA9, 0xFF, 0x8D, 0x5A, 0x10}},
      {"CDF0", 32768, 4096, {{0x1FF5, 7}, {0x1FF0, 4}}, kStartOfCdf},
      {"CDF", 32768, 4096, {{0x1FF5, 7}, {0x1FF0, 4}}, kStartOfCdf},
      {"CDFJ", 32768, 4096, {{0x1FF5, 7}, {0x1FF0, 4}}, kStartOfCdf},
      {"CDFJ+", 32768, 4096, {{0x1FF4, 7}, {0x1FF0, 4}}, kStartOfCdf},
  };
  return all;
}

const Recipe& recipe_of(std::string_view scheme) {
  const auto recipe = std::ranges::find(recipes(), scheme, &Recipe::scheme);
  if (recipe == recipes().end())
    throw std::invalid_argument("no random image of scheme " + std::string(scheme));
  return *recipe;
}

bool jams(unsigned opcode) { return (opcode & 0x1F) == 0x12 || (opcode & 0x9F) == 0x02; }

bool jumps(unsigned opcode) {
  return opcode == 0x00 || opcode == 0x20 || opcode == 0x40 || opcode == 0x60 || opcode == 0x4C ||
         opcode == 0x6C;
}

bool branches(unsigned opcode) { return (opcode & 0x1F) == 0x10; }

// A frame of straight code, repeatedly: writes to the TIA, loops that wait, accesses of hot spots, and any
// instruction except jumps. All units have the same instructions, with different values, so that code that
// switches the bank continues in the other one. No instruction crosses a border of two windows.
class Writer {
 public:
  Writer(const Recipe& recipe, unsigned seed) : recipe_(recipe), random_(seed) {}

  Bytes write() {
    while (bytes_.size() < kBegin) bytes_.push_back(static_cast<std::uint8_t>(below(256)));
    for (const std::uint8_t byte : recipe_.first) bytes_.push_back(byte);
    while (bytes_.size() < recipe_.unit - kTail) instruction();
    put({0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x00, 0x85,
         0x00});  // VSYNC on, two lines, off
    put({0x4C, begin() & 0xFF, begin() >> 8});
    bytes_.resize(recipe_.unit);
    for (std::size_t vector = recipe_.unit - 4; vector < recipe_.unit; vector += 2) {
      bytes_[vector] = static_cast<std::uint8_t>(begin() & 0xFF);
      bytes_[vector + 1] = static_cast<std::uint8_t>(begin() >> 8);
    }
    if (recipe_.scheme == "AR") return starpath_load();
    if (recipe_.scheme == "CDF0") return cdf(0x768);
    if (recipe_.scheme == "CDF") return cdf(0x128);
    if (recipe_.scheme == "CDFJ") return cdf(0x124);
    if (recipe_.scheme == "CDFJ+") return cdf(0x124, true);
    return recipe_.scheme == "DPC+" ? dpcplus() : units(recipe_.size);
  }

 private:
  static constexpr unsigned kBegin = 0x200, kTail = 0x60, kWindow = 1024;

  unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }
  unsigned begin() const { return 0xF000 + kCartridge - recipe_.unit + kBegin; }

  void put(std::initializer_list<unsigned> instruction) {
    while (bytes_.size() / kWindow != (bytes_.size() + instruction.size() - 1) / kWindow)
      bytes_.push_back(0xEA);
    for (const unsigned byte : instruction) bytes_.push_back(static_cast<std::uint8_t>(byte));
  }

  void instruction() {
    const unsigned kind = below(32);
    if (kind < 12)
      write_tia();
    else if (kind < 18)
      put({0x85, 0x02});  // STA WSYNC
    else if (kind == 18)
      touch_hotspot();
    else if (kind == 19)
      put({0xA2, 1 + below(8), 0x85, 0x02, 0xCA, 0xD0, 0xFB});  // wait for lines
    else if (kind == 20)
      put({0xA9, 1 + below(4), 0x8D, 0x96, 0x02, 0xAD, 0x84, 0x02, 0xD0, 0xFB});  // for the timer
    else
      any();
  }

  void write_tia() {
    const unsigned reg = below(24) == 0 ? 1 : 3 + below(0x2A);
    put({0xA9, below(256)});
    values_.push_back(bytes_.size() - 1);
    put({0x85, reg});
  }

  void touch_hotspot() {
    const Range& range = recipe_.lively[below(static_cast<unsigned>(recipe_.lively.size()))];
    const unsigned address = range.first + below(range.size);
    put({below(2) == 0 ? 0xADU : 0x8DU, address & 0xFF, address >> 8});
  }

  void any() {
    unsigned opcode = below(256);
    while (jams(opcode) || jumps(opcode)) opcode = below(256);
    const unsigned operand = branches(opcode) ? 0 : below(256);
    if (kOpcodes[opcode].length == 1)
      put({opcode});
    else if (kOpcodes[opcode].length == 2)
      put({opcode, operand});
    else
      put({opcode, operand, below(256)});
  }

  Bytes units(std::size_t size) {
    Bytes all;
    while (all.size() < size) {
      all.insert(all.end(), bytes_.begin(), bytes_.end());
      for (const std::size_t at : values_) bytes_[at] = static_cast<std::uint8_t>(below(256));
    }
    all.resize(size);
    return all;
  }

  // Load 0 fills the three banks of RAM. It starts with the last of them in the upper half
  // (docs/spec/cartridges.md, 9).
  Bytes starpath_load() {
    constexpr unsigned kConfiguration = 0x0D, kPagesABank = 8;
    Bytes load = units(kStarpathPages * 256);
    load.resize(kStarpathLoad);
    const auto header = load.end() - 256;
    header[0] = static_cast<std::uint8_t>(begin() & 0xFF);
    header[1] = static_cast<std::uint8_t>(begin() >> 8);
    header[2] = kConfiguration;
    header[3] = kStarpathPages;
    for (unsigned page = 0; page < kStarpathPages; ++page)
      header[16 + page] = static_cast<std::uint8_t>(page / kPagesABank | page % kPagesABank << 2);
    return load;
  }

  Bytes random_bytes(std::size_t size) {
    Bytes all(size);
    for (std::uint8_t& byte : all) byte = static_cast<std::uint8_t>(below(256));
    return all;
  }

  // The banks begin behind the driver, or behind the ARM's program. That adds to bytes of the display data.
  // Streams read all of it, step by step.
  Bytes cdf(unsigned increments, bool is_plus = false) {
    using namespace thumb;
    Bytes driver = random_bytes(kCdfDriver), arm = random_bytes(kCdfCode);
    constexpr unsigned kStreams = 35;
    for (std::size_t i = 0; i < 4 * kStreams; ++i) driver[increments + i] = i % 4 == 1;
    thumb::put(arm, is_plus ? 0 : 8,
               {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 8), lsl(2, 2, 8), add(1, 1, 2), ldrb(3, 1, 0),
                add_number(3, 1), strb(3, 1, 0), add_number(1, 16), ldr(4, 1, 0), add(4, 4, 3), str(4, 1, 0),
                bx(kLr)});
    const Bytes banks = units(kCdfBanks);
    Bytes all = driver;
    for (const Bytes* part : {is_plus ? &banks : &arm, is_plus ? &arm : &banks})
      all.insert(all.end(), part->begin(), part->end());
    constexpr std::uint8_t kStackAndEntry[] = {0xDC, 0x1F, 0, 0x40, 0x01, 0x78, 0, 0};
    if (is_plus) std::copy(std::begin(kStackAndEntry), std::end(kStackAndEntry), all.begin() + 0x17F4);
    return all;
  }

  // The banks begin behind the driver. The ARM's program, in front of that of the 6507, reverses a byte of
  // the display data, and adds it to others.
  Bytes dpcplus() {
    using namespace thumb;
    thumb::put(bytes_, 8,
               {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 3), lsl(2, 2, 10), add(1, 1, 2), ldrb(3, 1, 0),
                alu(kMvn, 3, 3), strb(3, 1, 0), add_number(1, 16), ldr(4, 1, 0), add(4, 4, 3), str(4, 1, 0),
                bx(kLr)});
    Bytes all = random_bytes(kDpcPlusDriver), others = random_bytes(kDpcPlusOthers);
    for (const Bytes& part : {units(kDpcPlusBanks), others}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  const Recipe& recipe_;
  std::mt19937 random_;
  Bytes bytes_;
  std::vector<std::size_t> values_;  // offsets of the values that are written to the TIA
};

}  // namespace

std::span<const std::string_view> random_schemes() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Recipe& recipe : recipes()) all.push_back(recipe.scheme);
    return all;
  }();
  return names;
}

std::shared_ptr<const Image> random_image(std::string_view scheme, unsigned seed) {
  Bytes bytes = Writer(recipe_of(scheme), seed).write();
  auto image = std::make_shared<Image>();
  image->md5 = md5_of(bytes);
  image->bytes = std::make_shared<const Bytes>(std::move(bytes));
  image->stem = "random";
  return image;
}

std::shared_ptr<const Game> random_game(std::string_view scheme) {
  Game game = game_without_rule("random");
  GameImage any{};
  any.properties.scheme = recipe_of(scheme).scheme;
  game.images = {any};
  return std::make_shared<const Game>(std::move(game));
}

}  // namespace racebeam::test

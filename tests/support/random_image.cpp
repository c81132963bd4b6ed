#include "tests/support/random_image.hpp"

#include <algorithm>
#include <initializer_list>
#include <random>
#include <stdexcept>
#include <vector>

#include "emulator/opcodes.hpp"
#include "emulator/scheme.hpp"
#include "games/digest.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kBank = 4096;

struct Recipe {
  std::string_view scheme;
  std::size_t size;
  bool on_board_ram;       // the first 256 bytes of each bank are left alike
  Bytes signature;         // by which the scheme is recognised; twice
  unsigned hotspot, last;  // addresses that change banks
};

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all = {
      {"2K", 2048, false, {}, 0x1000, 0x1FFF},
      {"4K", 4096, false, {}, 0x1000, 0x1FFF},
      {"F8", 8192, false, {}, 0x1FF8, 0x1FF9},
      {"F8SC", 8192, true, {}, 0x1FF8, 0x1FF9},
      {"F6", 16384, false, {}, 0x1FF6, 0x1FF9},
      {"F6SC", 16384, true, {}, 0x1FF6, 0x1FF9},
      {"F4", 32768, false, {}, 0x1FF4, 0x1FFB},
      {"F4SC", 32768, true, {}, 0x1FF4, 0x1FFB},
      {"E0", 8192, false, {0x8D, 0xE0, 0x1F}, 0x1FE0, 0x1FF7},
      {"FE", 8192, false, {0x20, 0x00, 0xD0, 0xC6, 0xC5}, 0xD000, 0xFFFF},
      {"3F", 8192, false, {0x85, 0x3F}, 0x0000, 0x003F},
  };
  return all;
}

bool jams(unsigned opcode) { return (opcode & 0x1F) == 0x12 || (opcode & 0x9F) == 0x02; }

bool jumps(unsigned opcode) {
  return opcode == 0x00 || opcode == 0x20 || opcode == 0x40 || opcode == 0x60 || opcode == 0x4C ||
         opcode == 0x6C;
}

bool branches(unsigned opcode) { return (opcode & 0x1F) == 0x10; }

// A frame of straight code, again and again: writes to the TIA, loops that wait, touched hot spots, and any
// instruction that there is but jumps. All banks have the same instructions, with other values, so that code
// that changes the bank goes on in the other one; none lies across a border of two windows.
class Writer {
 public:
  Writer(const Recipe& recipe, unsigned seed)
      : recipe_(recipe), random_(seed), bank_(std::min(recipe.size, kBank)) {}

  Bytes write() {
    while (bytes_.size() < kBegin) bytes_.push_back(static_cast<std::uint8_t>(below(256)));
    while (bytes_.size() < bank_ - kTail) instruction();
    put({0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x00, 0x85,
         0x00});  // VSYNC on, two lines, off
    put({0x4C, kBegin & 0xFF, 0xF0 | kBegin >> 8});
    bytes_.resize(bank_);
    for (std::size_t i = 0; i < 2; ++i)
      std::ranges::copy(recipe_.signature, bytes_.end() - 0x60 + 16 * static_cast<int>(i));
    for (std::size_t vector = bank_ - 4; vector < bank_; vector += 2) {
      bytes_[vector] = kBegin & 0xFF;
      bytes_[vector + 1] = 0xF0 | kBegin >> 8;
    }
    return with_all_banks();
  }

 private:
  static constexpr unsigned kBegin = 0x100, kTail = 0xA0, kWindow = 1024;

  unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }

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
    const unsigned address = recipe_.hotspot + below(recipe_.last - recipe_.hotspot + 1);
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

  Bytes with_all_banks() {
    Bytes all;
    while (all.size() < recipe_.size) {
      if (recipe_.on_board_ram) std::fill_n(bytes_.begin(), 256, std::uint8_t{0xEA});
      all.insert(all.end(), bytes_.begin(), bytes_.end());
      for (const std::size_t at : values_) bytes_[at] = static_cast<std::uint8_t>(below(256));
    }
    return all;
  }

  const Recipe& recipe_;
  std::mt19937 random_;
  std::size_t bank_;
  Bytes bytes_;
  std::vector<std::size_t> values_;  // places of what is written to the TIA
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
  const auto recipe = std::ranges::find(recipes(), scheme, &Recipe::scheme);
  if (recipe == recipes().end())
    throw std::invalid_argument("no random image of scheme " + std::string(scheme));
  Bytes bytes = Writer(*recipe, seed).write();
  if (scheme_name(bytes) != scheme)
    throw std::logic_error("a random image is not of scheme " + std::string(scheme));
  auto image = std::make_shared<Image>();
  image->md5 = md5_of(bytes);
  image->bytes = std::make_shared<const Bytes>(std::move(bytes));
  image->stem = "random";
  return image;
}

}  // namespace racebeam::test

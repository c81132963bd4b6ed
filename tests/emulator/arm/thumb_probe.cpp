// For compare_with_unicorn.py. Reads 32768 bytes of flash memory, 8192 of RAM, and then cases: the registers
// R0 to R15, the flags (N Z C V from bit 31 on), and a number of instructions, 18 words. It runs each case
// from that RAM, and answers with registers and flags after every instruction, and the RAM at the end.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "emulator/cartridge/arm/thumb.hpp"

namespace {

using Words = std::array<std::uint32_t, 17>;
using namespace racebeam;

template <class Item>
bool get(Item* items, std::size_t count) {
  return std::fread(items, sizeof(Item), count, stdin) == count;
}

template <class Item>
void answer(const Item* items, std::size_t count) {
  std::fwrite(items, sizeof(Item), count, stdout);
}

arm::Registers registers_of(const Words& words) {
  arm::Registers registers;
  std::copy_n(words.begin(), registers.r.size(), registers.r.begin());
  const std::uint32_t flags = words.back();
  registers.n = flags >> 31 & 1, registers.z = flags >> 30 & 1;
  registers.c = flags >> 29 & 1, registers.v = flags >> 28 & 1;
  return registers;
}

Words words_of(const arm::Registers& registers) {
  Words words{};
  std::ranges::copy(registers.r, words.begin());
  words.back() = std::uint32_t{registers.n} << 31 | std::uint32_t{registers.z} << 30 |
                 std::uint32_t{registers.c} << 29 | std::uint32_t{registers.v} << 28;
  return words;
}

}  // namespace

int main() {
  std::vector<std::uint8_t> flash(arm::kFlashEnd), ram(8192);
  if (!get(flash.data(), flash.size()) || !get(ram.data(), ram.size())) return 1;
  Words words;
  std::uint32_t instructions = 0;
  while (get(words.data(), words.size()) && get(&instructions, 1)) {
    std::vector<std::uint8_t> own = ram;
    arm::Registers registers = registers_of(words);
    for (; instructions > 0; --instructions) {
      std::uint32_t left = 1;
      arm::run({flash, own}, registers, left);
      const Words after = words_of(registers);
      answer(after.data(), after.size());
    }
    answer(own.data(), own.size());
  }
}

// translator_listing IMAGE ADDRESS FILE: prints the 6507 instructions of the block at an address of a 2K or
// 4K image, and writes the code of this processor to FILE. scripts/check/translated shows both.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "emulator/board/board.hpp"
#include "emulator/translator/block_emitter.hpp"

namespace {

using namespace racebeam;

constexpr const char* kNames[] = {
#define OP(code, operation, mode, access, cycles) #operation " " #mode,
#include "emulator/base/opcodes.inc"
#undef OP
};

std::shared_ptr<const Rom> load(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return std::make_shared<const Rom>(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

void list(const translator::Block& block, const translator::Window& window) {
  for (const translator::Instruction& instruction : block.instructions) {
    std::printf("%04X ", instruction.pc);
    for (unsigned i = 0; i < instruction.length; ++i)
      std::printf(" %02X", window.byte_at(static_cast<std::uint16_t>(instruction.pc + i)));
    std::printf("%*s%s\n", 3 * (4 - static_cast<int>(instruction.length)), "",
                kNames[window.byte_at(instruction.pc)]);
  }
}

void show(const char* image, std::uint16_t pc, const char* path) {
  const auto rom = load(image);
  const auto board = std::make_unique<Board>(rom, Properties{});
  board->map_memory();
  const CodeWindow code = board->map.window_around(pc);
  const translator::Layout layout(*board);
  const std::vector<const void*> entries(code.span);
  const translator::Window window{
      {board->plain_registers(), board->slot.scheme.port_reader}, rom->data(), code, entries.data()};
  std::vector<std::uint8_t> memory(65536);
  const translator::Stubs stubs{memory.data(), memory.data(), memory.data(), 0};
  translator::Assembler as(memory.data(), memory.size(), layout, window, stubs);
  for (const translator::Block& block : translator::discover(code, pc, std::vector<bool>(code.span))) {
    if (block.pc != pc) continue;
    list(block, window);
    translator::BlockEmitter(as, block).emit();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(memory.data()), static_cast<std::streamsize>(as.size()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: translator_listing IMAGE ADDRESS FILE\n", stderr);
    return 2;
  }
  show(argv[1], static_cast<std::uint16_t>(std::strtoul(argv[2], nullptr, 16)), argv[3]);
}

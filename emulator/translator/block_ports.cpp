// Emits reads of the TIA's pins, and of ports of the cartridge.
#include <cstddef>

#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/bus_calls.hpp"

namespace racebeam::translator {
namespace {

constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;

}  // namespace

// Board::read_tia for INPT0-5, in line.
BlockEmitter::Value BlockEmitter::read_pin(const Instruction& instruction, unsigned latch) {
  const int pin = instruction.operand & 7;
  const unsigned undriven = latch & 0x3F;
  touch_tia(elapsed_ + instruction.cycles);
  as_.cmp(as_.edx, as_.dword_of(as_.layout.pins + 4 * pin));
  as_.sbb(as_.eax, as_.eax);  // all bits set where the pin is low
  as_.and_(as_.eax, 0x80);
  as_.xor_(as_.eax, 0x80 | undriven);
  clobbered_flags();
  return {Value::Kind::kEax};
}

BlockEmitter::Value BlockEmitter::read_port(const Instruction& instruction, PortReader reader) {
  if (as_.window.port_reader_at == dpc::port_reader && dpc::is_plain_fetch(instruction.operand)) {
    fetch(instruction.operand);
  } else {
    as_.lea(as_.edx, as_.ptr[as_.rbp + (elapsed_ + instruction.cycles)]);
    call_port(as_, reader, instruction.operand);
    if (rom_loaded_) load_rom_again();
  }
  clobbered_flags();
  return {Value::Kind::kEax};
}

// dpc::fetch in line, for a fetcher that makes no music.
void BlockEmitter::fetch(std::uint16_t address) {
  using dpc::Chip, dpc::Fetcher;
  const auto random = as_.byte_of(as_.layout.cartridge_ram + static_cast<int>(offsetof(Chip, random)));
  const auto in_fetcher = [this, address](std::size_t member) {
    const std::size_t offset = offsetof(Chip, fetcher) + (address & 7) * sizeof(Fetcher) + member;
    return as_.rbx + (as_.layout.cartridge_ram + static_cast<int>(offset));
  };
  const auto flag = as_.byte[in_fetcher(offsetof(Fetcher, flag))];
  const auto counter = as_.word[in_fetcher(offsetof(Fetcher, counter))];
  as_.movzx(as_.eax, random);
  as_.mov(as_.rcx, reinterpret_cast<std::uintptr_t>(dpc::kNextRandom.data()));
  as_.movzx(as_.eax, as_.byte[as_.rcx + as_.rax]);
  as_.mov(random, as_.al);
  Xbyak::Label enters, leaves, done;
  as_.movzx(as_.edx, counter);
  as_.cmp(as_.dl, as_.byte[in_fetcher(offsetof(Fetcher, top))]);
  as_.je(enters, kNear);
  as_.cmp(as_.dl, as_.byte[in_fetcher(offsetof(Fetcher, bottom))]);
  as_.je(leaves, kNear);
  as_.L(done);
  const unsigned function = dpc::function_at(address);
  if (function == dpc::kDisplayed || function == dpc::kMasked) {
    as_.mov(as_.rcx,
            reinterpret_cast<std::uintptr_t>(as_.window.image + dpc::kDisplay + dpc::kDisplaySize - 1));
    as_.sub(as_.rcx, as_.rdx);
    as_.movzx(as_.eax, as_.byte[as_.rcx]);
  }
  if (function == dpc::kMasked) as_.and_(as_.al, flag);
  if (function == dpc::kFlag) as_.movzx(as_.eax, flag);
  as_.dec(as_.edx);
  as_.and_(as_.edx, dpc::kDisplaySize - 1);
  as_.mov(counter, as_.dx);
  cold([this, flag, enters, leaves, done]() mutable {
    as_.L(enters);
    as_.mov(flag, 0xFF);
    as_.jmp(done, kNear);
    as_.L(leaves);
    as_.mov(flag, 0x00);
    as_.jmp(done, kNear);
  });
}

}  // namespace racebeam::translator

// Addresses and reads.
#include <cstddef>

#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

void Host::load_address(std::uint16_t address) { as_.mov(as_.eax, address); }
void Host::load_latch(std::uint8_t byte) { as_.mov(as_.ecx, byte); }

void Host::index_address(unsigned base, Reg index) {
  as_.lea(as_.eax, as_.ptr[reg_of(index).cvt64() + base]);
}

void Host::wrap_address() { as_.movzx(as_.eax, as_.ax); }
void Host::load_pointer(unsigned pointer) { as_.movzx(as_.eax, as_.word[ram(pointer & 0x7F)]); }

void Host::load_pointer_at_x(unsigned pointer, Label& outside) {
  as_.lea(as_.ecx, as_.ptr[as_.r13 + (static_cast<int>(pointer) - 0x80)]);
  as_.movzx(as_.ecx, as_.cl);
  as_.cmp(as_.ecx, 0x7F);
  as_.jae(outside, kNear);
  as_.movzx(as_.eax, as_.word[as_.rbx + as_.rcx + as_.layout.ram]);
  clobbered_flags();
}

void Host::add_y() { as_.add(as_.eax, as_.r14d); }

void Host::add_y_with_penalty() {
  as_.movzx(as_.ecx, as_.al);
  as_.add(as_.cl, as_.r14b);
  as_.adc(as_.ebp, 0);
  add_y();
  wrap_address();
}

void Host::offset_in_ram(unsigned zero_page, Reg index, Label& device) {
  as_.lea(as_.ecx, as_.ptr[reg_of(index).cvt64() + (static_cast<int>(zero_page) - 0x80)]);
  as_.movzx(as_.ecx, as_.cl);
  as_.test(as_.cl, as_.cl);
  as_.js(device, kNear);
  clobbered_flags();
}

void Host::offset_in_ram_at(std::uint16_t base, Reg index, Label& outside) {
  as_.lea(as_.ecx, as_.ptr[reg_of(index).cvt64() + base]);
  as_.mov(as_.eax, as_.ecx);
  as_.and_(as_.eax, 0x1280);
  as_.cmp(as_.eax, 0x80);
  as_.jne(outside, kNear);
  as_.and_(as_.ecx, 0x7F);
  clobbered_flags();
}

void Host::address_of_device() {
  as_.mov(as_.eax, as_.ecx);
  as_.xor_(as_.eax, 0x80);
}

void Host::add_cycle_if(Reg index, int least) {
  as_.cmp(reg_of(index).cvt8(), least);
  as_.sbb(as_.ebp, -1);
  clobbered_flags();
}

void Host::remove_cycle_if(Reg index, int least) {
  as_.cmp(reg_of(index).cvt8(), least);
  as_.adc(as_.ebp, -1);
}

void Host::remove_cycle_of_pointer(unsigned pointer) {
  as_.movzx(as_.ecx, as_.byte[ram(pointer & 0x7F)]);
  as_.add(as_.cl, as_.r14b);
  as_.sbb(as_.ebp, 0);
}

void Host::load_rom() { as_.mov(as_.r10, reinterpret_cast<std::uintptr_t>(as_.window.code.memory)); }

void Host::load_page(std::uint16_t address, Label& hidden) {
  as_.mov(as_.rdx, as_.ptr[as_.rbx + as_.layout.pages + 8 * (address >> 6 & 0xFF)]);
  as_.test(as_.rdx, as_.rdx);
  as_.jz(hidden, kNear);
  clobbered_flags();
}

void Host::read_ram() { as_.movzx(as_.eax, as_.byte[as_.rbx + as_.rcx + as_.layout.ram]); }

void Host::keep_bus(std::uint8_t byte) { as_.mov(as_.esi, byte); }

void Host::keep_bus_of_pointer() {
  as_.mov(as_.esi, as_.eax);
  as_.shr(as_.esi, 8);
}

void Host::read_window(Label& elsewhere) {
  as_.lea(as_.ecx, as_.ptr[as_.rax - as_.window.code.first]);
  as_.cmp(as_.ecx, as_.window.size());
  as_.jae(elsewhere, kNear);
  as_.movzx(as_.eax, as_.byte[as_.r10 + as_.rcx]);
  clobbered_flags();
}

void Host::read_page(Label& device) {
  as_.mov(as_.ecx, as_.eax);
  as_.shr(as_.ecx, 6);
  as_.movzx(as_.ecx, as_.cl);
  as_.mov(as_.rdx, as_.ptr[as_.rbx + as_.rcx * 8 + as_.layout.pages]);
  as_.test(as_.rdx, as_.rdx);
  as_.jz(device, kNear);
  as_.and_(as_.eax, 0x3F);
  as_.movzx(as_.eax, as_.byte[as_.rdx + as_.rax]);
}

void Host::jump_if_cartridge(Label& cartridge) {
  as_.test(as_.ah, 0x10);
  as_.jnz(cartridge, kNear);
}

void Host::latch_kept_bus() { as_.mov(as_.ecx, as_.esi); }

// Does what Board::read_tia does for INPT0-5.
void Host::read_pin(int pin, unsigned undriven, int cycles) {
  touch_tia(cycles);
  as_.cmp(as_.edx, as_.dword_of(as_.layout.pins + 4 * pin));
  as_.sbb(as_.eax, as_.eax);  // all bits set where the pin is low
  as_.and_(as_.eax, 0x80);
  as_.xor_(as_.eax, 0x80 | undriven);
  clobbered_flags();
}

// Does what dpc::fetch does, for a fetcher that is not in music mode.
void Host::fetch(std::uint16_t address, Label& enters, Label& leaves, Label& done) {
  using dpc::Chip, dpc::Fetcher;
  const auto random = as_.byte_of(as_.layout.in_chip(offsetof(Chip, random)));
  const auto in_fetcher = [this, address](std::size_t member) {
    return as_.rbx + as_.layout.in_fetcher(address, member);
  };
  const auto flag = as_.byte[in_fetcher(offsetof(Fetcher, flag))];
  const auto counter = as_.word[in_fetcher(offsetof(Fetcher, counter))];
  as_.movzx(as_.eax, random);
  as_.mov(as_.rcx, reinterpret_cast<std::uintptr_t>(dpc::kNextRandom.data()));
  as_.movzx(as_.eax, as_.byte[as_.rcx + as_.rax]);
  as_.mov(random, as_.al);
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
  clobbered_flags();
}

}  // namespace racebeam::translator

// Addresses and reads.
#include <cstddef>

#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

void Host::load_address(std::uint16_t address) { as_.mov(kAddress, unsigned{address}); }
void Host::load_latch(std::uint8_t byte) { as_.mov(kLatch, unsigned{byte}); }

void Host::index_address(unsigned base, Reg index) {
  add_constant(kAddress, reg_of(index), static_cast<int>(base));
}

void Host::wrap_address() { as_.ubfx(kAddress, kAddress, 0, 16); }

void Host::load_pointer(unsigned pointer) {
  as_.ldrh(kAddress, kBoard, as_.layout.ram + static_cast<int>(pointer & 0x7F));
}

void Host::load_pointer_at_x(unsigned pointer, Label& outside) {
  add_constant(kOffset, kX, static_cast<int>(pointer) - 0x80);
  keep_byte(kOffset);
  as_.cmp(kOffset, 0x7FU);
  as_.b(Condition::hs, outside);
  ram_at(kOffset);
  as_.ldrh(kAddress, kPlace, as_.layout.ram);
}

void Host::add_y() { as_.add(kAddress, kAddress, kY); }

void Host::add_y_with_penalty() {
  as_.and_(kScratch, kAddress, 0xFFU);
  as_.add(kScratch, kScratch, kY);
  as_.add_lsr(kCycle, kCycle, kScratch, 8);
  add_y();
  wrap_address();
}

void Host::offset_in_ram(unsigned zero_page, Reg index, Label& device) {
  add_constant(kOffset, reg_of(index), static_cast<int>(zero_page) - 0x80);
  keep_byte(kOffset);
  as_.tbnz(kOffset, 7, device);
}

// Compares the bits of an address that select RAM with the values that they must have.
void aarch64::Processor::compare_with_ram(Register address) {
  as_.mov(kScratch, 0x1280U);
  as_.and_(kScratch, address, kScratch);
  as_.cmp(kScratch, 0x80U);
}

void Host::offset_in_ram_at(std::uint16_t base, Reg index, Label& outside) {
  add_constant(kOffset, reg_of(index), base);
  compare_with_ram(kOffset);
  as_.b(Condition::ne, outside);
  as_.and_(kOffset, kOffset, 0x7FU);
}

void Host::address_of_device() { as_.eor(kAddress, kOffset, 0x80U); }

void Host::add_cycle_if(Reg index, int least) {
  as_.cmp(reg_of(index), static_cast<unsigned>(least));
  as_.cinc(kCycle, kCycle, Condition::hs);
}

void Host::remove_cycle_if(Reg index, int least) {
  as_.cmp(reg_of(index), static_cast<unsigned>(least));
  as_.cset(kScratch, Condition::hs);
  as_.sub(kCycle, kCycle, kScratch);
}

void Host::remove_cycle_of_pointer(unsigned pointer) {
  as_.ldrb(kScratch, kBoard, as_.layout.ram + static_cast<int>(pointer & 0x7F));
  as_.add(kScratch, kScratch, kY);
  as_.sub_lsr(kCycle, kCycle, kScratch, 8);
}

void Host::load_rom() {}  // the stub has loaded it, and calls preserve it

void Host::load_page(std::uint16_t address, Label& hidden) {
  as_.ldr(kPage, kBoard, as_.layout.pages + 8 * (address >> 6 & 0xFF));
  as_.cbz(kPage, hidden);
}

void Host::read_ram() {
  ram_at(kOffset);
  as_.ldrb(kByte, kPlace, as_.layout.ram);
}

void Host::keep_bus(std::uint8_t byte) { load_latch(byte); }
void Host::keep_bus_of_pointer() { as_.lsr(kLatch, kAddress, 8); }
void Host::latch_kept_bus() {}  // the kept bus is in the latch already

void Host::read_window(Label& elsewhere) {
  add_constant(kOffset, kAddress, -as_.window.code.first);
  compare_with(kOffset, as_.window.size());
  as_.b(Condition::hs, elsewhere);
  as_.ldrb(kByte, kRom, kOffset);
}

void Host::read_page(Label& device) {
  as_.ubfx(kOffset, kAddress, 6, 8);
  as_.add(kPlace, kBoard, x(kOffset.number), 3);
  as_.ldr(kPage, kPlace, as_.layout.pages);
  as_.cbz(kPage, device);
  as_.and_(kOffset, kAddress, 0x3FU);
  as_.ldrb(kByte, kPage, kOffset);
}

void Host::jump_if_cartridge(Label& cartridge) { as_.tbnz(kAddress, 12, cartridge); }

// Does what Board::read_tia does for INPT0-5. The board knows from which cycle on bit 7 is set.
void Host::read_pin(int pin, unsigned undriven, int cycles) {
  touch_tia(cycles);
  as_.ldr(kScratch, kBoard, as_.layout.pins + 4 * pin);
  as_.cmp(kTime, kScratch);
  as_.cset(kByte, Condition::hs);
  as_.lsl(kByte, kByte, 7);
  as_.add(kByte, kByte, undriven);
}

// Does what dpc::fetch does, for a fetcher that is not in music mode.
void Host::fetch(std::uint16_t address, Label& enters, Label& leaves, Label& done) {
  using dpc::Chip, dpc::Fetcher;
  const auto place = [&](std::size_t member) { return as_.layout.in_fetcher(address, member); };
  const std::int32_t random = as_.layout.in_chip(offsetof(Chip, random));
  const Register counter = kTarget;
  as_.ldrb(kByte, kBoard, random);
  as_.mov(kPointer, reinterpret_cast<std::uintptr_t>(dpc::kNextRandom.data()));
  as_.ldrb(kByte, kPointer, kByte);
  as_.strb(kByte, kBoard, random);
  as_.ldrh(counter, kBoard, place(offsetof(Fetcher, counter)));
  as_.and_(kOther, counter, 0xFFU);
  as_.ldrb(kScratch, kBoard, place(offsetof(Fetcher, top)));
  as_.cmp(kOther, kScratch);
  as_.b(Condition::eq, enters);
  as_.ldrb(kScratch, kBoard, place(offsetof(Fetcher, bottom)));
  as_.cmp(kOther, kScratch);
  as_.b(Condition::eq, leaves);
  as_.bind(done);
  const unsigned function = dpc::function_at(address);
  if (function == dpc::kDisplayed || function == dpc::kMasked) {
    as_.mov(kPointer,
            reinterpret_cast<std::uintptr_t>(as_.window.image + dpc::kDisplay + dpc::kDisplaySize - 1));
    as_.sub(kPlace, kPointer, x(counter.number));
    as_.ldrb(kByte, kPlace, 0);
  }
  if (function == dpc::kMasked) {
    as_.ldrb(kScratch, kBoard, place(offsetof(Fetcher, flag)));
    as_.and_(kByte, kByte, kScratch);
  }
  if (function == dpc::kFlag) as_.ldrb(kByte, kBoard, place(offsetof(Fetcher, flag)));
  as_.sub(counter, counter, 1U);
  as_.and_(counter, counter, dpc::kDisplaySize - 1);
  as_.strh(counter, kBoard, place(offsetof(Fetcher, counter)));
}

}  // namespace racebeam::translator

#include "emulator/cartridge/harmony/dpcplus.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <span>

#include "emulator/cartridge/arm/thumb.hpp"

namespace racebeam::dpcplus {
namespace {

constexpr unsigned kReadRegisters = 0x28, kPorts = 0x80, kHotPage = 0xFC0;
constexpr unsigned kMaxPointer = kDisplaySize - 1;
constexpr unsigned kWave = 32, kWaveBits = 5;  // bytes of a waveform
constexpr std::uint32_t kFirstRandom = 0x2B435044, kTaps = 0x10ADAB1E;
constexpr int kRandomStep = 11;
constexpr std::uint8_t kLoadNumber = 0xA9;  // the opcode of LDA #

Chip& chip_of(CartridgeSlot& slot) { return *std::launder(reinterpret_cast<Chip*>(slot.state.ram.data())); }

std::uint8_t& displayed(CartridgeSlot& slot, unsigned pointer) {
  return slot.ram[kDriver + (pointer & kMaxPointer)];
}

const std::uint8_t* banks(const CartridgeSlot& slot) {
  return slot.rom.data() + (slot.rom.size() - kMinImage);
}

const std::uint8_t* bank(const CartridgeSlot& slot) {
  return banks(slot) + kBankSize * slot.state.bank[kShown];
}

std::uint16_t with_low(std::uint16_t pointer, unsigned low) {
  return static_cast<std::uint16_t>((pointer & 0xF00) | low);
}

std::uint16_t with_high(std::uint16_t pointer, unsigned high) {
  return static_cast<std::uint16_t>((high & 0xF) << 8 | (pointer & 0xFF));
}

std::uint16_t moved(std::uint16_t pointer, unsigned distance) {
  return static_cast<std::uint16_t>((pointer + distance) & kMaxPointer);
}

std::uint8_t amplitude(CartridgeSlot& slot) {
  const Chip& chip = chip_of(slot);
  unsigned sum = 0;
  for (std::size_t i = 0; i < chip.clock.voice.size(); ++i)
    sum += displayed(slot, kWave * chip.waveform[i] + (chip.clock.voice[i].phase >> (32 - kWaveBits)));
  return static_cast<std::uint8_t>(sum);
}

// Random numbers. The taps do not contain the highest bit, so the prior number can be computed from the next.
std::uint32_t with_taps(std::uint32_t number) { return number >> 31 != 0 ? number ^ kTaps : number; }
std::uint32_t next_random(std::uint32_t number) { return with_taps(std::rotr(number, kRandomStep)); }
std::uint32_t prior_random(std::uint32_t number) { return std::rotl(with_taps(number), kRandomStep); }

std::uint8_t byte_of(std::uint32_t number, unsigned index) {
  return static_cast<std::uint8_t>(number >> (8 * index));
}

void set_byte(std::uint32_t& number, unsigned index, std::uint8_t value) {
  number = (number & ~(0xFFU << (8 * index))) | std::uint32_t{value} << (8 * index);
}

// Whether the low byte of the pointer is behind the top and before the bottom.
bool is_inside(const Fetcher& fetcher) {
  const auto behind = [&](unsigned place) { return static_cast<std::uint8_t>(place - fetcher.top - 1); };
  return behind(fetcher.pointer) < behind(fetcher.bottom);
}

std::uint8_t fetch(CartridgeSlot& slot, Fetcher& fetcher) {
  const std::uint8_t value = displayed(slot, fetcher.pointer);
  fetcher.pointer = moved(fetcher.pointer, 1);
  return value;
}

std::uint8_t fetch_inside(CartridgeSlot& slot, Fetcher& fetcher) {
  const bool inside = is_inside(fetcher);
  const std::uint8_t value = fetch(slot, fetcher);
  return inside ? value : 0;
}

std::uint8_t fetch_fractional(CartridgeSlot& slot, FractionalFetcher& fetcher) {
  const std::uint8_t value = displayed(slot, fetcher.pointer);
  const unsigned sum = unsigned{fetcher.fraction} + fetcher.step;
  fetcher.fraction = static_cast<std::uint8_t>(sum);
  fetcher.pointer = moved(fetcher.pointer, sum >> 8);
  return value;
}

std::uint8_t read_number(CartridgeSlot& slot, unsigned index, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  switch (index) {
    case 0: return byte_of(chip.random = next_random(chip.random), 0);
    case 1: return byte_of(chip.random = prior_random(chip.random), 0);
    case 2:
    case 3:
    case 4: return byte_of(chip.random, index - 1);
    case 5: chip.clock.pass(slot.machine, cycle); return amplitude(slot);
    default: return 0;
  }
}

std::uint8_t read_register(CartridgeSlot& slot, unsigned offset, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  const unsigned index = offset & 7;
  switch (offset >> 3) {
    case 0: return read_number(slot, index, cycle);
    case 1: return fetch(slot, chip.fetcher[index]);
    case 2: return fetch_inside(slot, chip.fetcher[index]);
    case 3: return fetch_fractional(slot, chip.fractional[index]);
    default: return index < 4 && is_inside(chip.fetcher[index]) ? 0xFF : 0;
  }
}

// Fast fetch: `value` was read at `address`. Returns what the CPU gets.
std::uint8_t follow(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value, std::int32_t cycle) {
  harmony::Follower& follower = chip_of(slot).follower;
  const bool exchanged = follower.continues(address, value, bank(slot)[(address - 2U) % kBankSize]) &&
                         follower.opcode == kLoadNumber;
  return exchanged && value < kReadRegisters ? read_register(slot, value, cycle) : value;
}

// The registers and the stack that the library's ARM code at $C00 leaves.
arm::Registers at_call() {
  arm::Registers registers;
  registers.r[0] = 0xC09;
  registers.r[arm::kSp] = 0x40001FDC;
  registers.r[arm::kLr] = 0x40000000;
  registers.r[arm::kPc] = 0xC08;
  return registers;
}

void finish_call(CartridgeSlot& slot) {
  slot.state.bank[kCalled] = 0;
  map(slot);
  Chip& chip = chip_of(slot);
  arm::Registers registers = at_call();
  const arm::Memory memory{slot.rom, slot.ram};
  chip.stopped = arm::run(memory, registers, chip.clock.instructions) != arm::Ending::kReturned;
}

// Copies bytes of the image to the display data, or fills them with the first parameter.
void copy(CartridgeSlot& slot, bool fills) {
  Chip& chip = chip_of(slot);
  const auto& given = chip.parameter;
  const unsigned from = given[0] + given[1] * 256U, to = chip.fetcher[given[2] & 7].pointer;
  for (unsigned i = 0; i < given[3]; ++i)
    displayed(slot, to + i) = fills ? given[0] : banks(slot)[(from + i) % kMinImage];
  chip.parameters = 0;
}

void call(CartridgeSlot& slot, std::uint8_t function) {
  Chip& chip = chip_of(slot);
  switch (function) {
    case 0: chip.parameters = 0; break;
    case 1:
    case 2: copy(slot, function == 2); break;
    case 254:
    case 255:
      if (chip.stopped) break;
      slot.state.bank[kCalled] = 1;
      map(slot);
      break;
    default: break;
  }
}

void set_fast_fetch(CartridgeSlot& slot, bool on) {
  slot.state.bank[kFastFetch] = on;
  chip_of(slot).follower = {};
  map(slot);
}

void put_parameter(Chip& chip, std::uint8_t value) {
  if (chip.parameters < chip.parameter.size()) chip.parameter[chip.parameters++] = value;
}

// Writes to $1058-$105F: fast fetch, parameters, functions and waveforms.
void control(CartridgeSlot& slot, unsigned index, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  switch (index) {
    case 0: set_fast_fetch(slot, value == 0); break;
    case 1: put_parameter(chip, value); break;
    case 2: call(slot, value); break;
    case 5:
    case 6:
    case 7: chip.waveform[index - 5] = value & 0x7F; break;
    default: break;
  }
}

// Writes to $1070-$1077: the random number and the frequencies.
void set_number(CartridgeSlot& slot, unsigned index, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  if (index == 0)
    chip.random = kFirstRandom;
  else if (index < 5)
    set_byte(chip.random, index - 1, value);
  else
    std::memcpy(&chip.clock.voice[index - 5].frequency, &slot.ram[kDriver + kDisplaySize + 4 * value], 4);
}

void write_register(CartridgeSlot& slot, unsigned offset, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  const unsigned index = offset & 7;
  Fetcher& fetcher = chip.fetcher[index];
  FractionalFetcher& fractional = chip.fractional[index];
  switch (offset & 0x78) {
    case 0x28: fractional = {with_low(fractional.pointer, value), 0, fractional.step}; break;
    case 0x30: fractional.pointer = with_high(fractional.pointer, value); break;
    case 0x38: fractional = {fractional.pointer, 0, value}; break;
    case 0x40: fetcher.top = value; break;
    case 0x48: fetcher.bottom = value; break;
    case 0x50: fetcher.pointer = with_low(fetcher.pointer, value); break;
    case 0x58: control(slot, index, value); break;
    case 0x60:
      fetcher.pointer = moved(fetcher.pointer, kMaxPointer);
      displayed(slot, fetcher.pointer) = value;
      break;
    case 0x68: fetcher.pointer = with_high(fetcher.pointer, value); break;
    case 0x70: set_number(slot, index, value); break;
    default:
      displayed(slot, fetcher.pointer) = value;
      fetcher.pointer = moved(fetcher.pointer, 1);
      break;
  }
}

void select(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.first_hot_spot;
  if (selected >= kBanks || selected == slot.state.bank[kShown]) return;
  slot.state.bank[kShown] = static_cast<std::uint8_t>(selected);
  map(slot);
}

bool is_valid(const Chip& chip) {
  const auto has_pointer = [](const auto& fetcher) { return fetcher.pointer <= kMaxPointer; };
  return std::ranges::all_of(chip.fetcher, has_pointer) &&
         std::ranges::all_of(chip.fractional, has_pointer) &&
         std::ranges::all_of(chip.waveform, [](std::uint8_t number) { return number <= 0x7F; }) &&
         std::ranges::all_of(chip.spare, [](std::uint8_t byte) { return byte == 0; }) &&
         chip.clock.is_valid() && chip.follower.is_valid() && chip.parameters <= chip.parameter.size() &&
         chip.stopped <= 1;
}

}  // namespace

// Loads the RAM with the parts of the image other than its banks: driver, display data and frequencies. The
// image may contain only a part of the driver.
void reset(CartridgeSlot& slot) {
  Chip& chip = chip_of(slot) = Chip{};
  chip.random = kFirstRandom;
  slot.state.bank = {slot.scheme.initial_bank};
  const std::span image = slot.rom;
  const auto driver = image.first(image.size() - kMinImage), others = image.last(kDisplaySize + kFrequencies);
  const auto end = std::ranges::copy(driver, slot.ram.begin()).out;
  std::fill(end, slot.ram.begin() + kDriver, std::uint8_t{0});
  std::ranges::copy(others, slot.ram.begin() + kDriver);
}

void map(CartridgeSlot& slot) {
  slot.map.hide(0, kBankSize);
  if (slot.state.bank[kFastFetch] || slot.state.bank[kCalled]) return;
  slot.map.show(kPorts, bank(slot) + kPorts, kHotPage - kPorts);
  slot.map.hide(kHotPage, MemoryMap::kPageSize, slot.scheme.first_hot_spot - kHotPage);
}

bool admits(const CartridgeSlot&, const CartridgeState& state) {
  Chip chip;
  std::memcpy(&chip, state.ram.data(), sizeof chip);
  return harmony::is_valid(state, kBanks) && is_valid(chip);
}

std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle) {
  if (slot.state.bank[kCalled]) {
    chip_of(slot).clock.pass(slot.machine, cycle);
    finish_call(slot);
  }
  select(slot, address);
  const unsigned offset = address & 0xFFF;
  const std::uint8_t value =
      offset < kReadRegisters ? read_register(slot, offset, cycle) : bank(slot)[offset];
  return slot.state.bank[kFastFetch] ? follow(slot, address, value, cycle) : value;
}

Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if (slot.state.bank[kCalled]) finish_call(slot);
  select(slot, address);
  const unsigned offset = address & 0xFFF;
  if (offset >= kReadRegisters && offset < kPorts) write_register(slot, offset, value);
  return Delivery::kTaken;
}

// Translated code never runs while fast fetch is on or a call waits: no page shows it then.
PortReader port_reader(std::uint16_t address) { return (address & 0xFFF) < kReadRegisters ? read : nullptr; }

}  // namespace racebeam::dpcplus

#include "emulator/cartridge/mappers/cdf.hpp"

#include <algorithm>
#include <cstring>
#include <new>

#include "emulator/cartridge/arm/thumb.hpp"

namespace racebeam::cdf {
namespace {

// Where CDFJ and CDFJ+ differ.
struct Variant {
  unsigned banks_at;  // in the image
  unsigned fraction;  // bits of a pointer behind the place in the display data
  unsigned sample;    // bits of a phase behind the byte of a sample
  bool is_plus;
};
constexpr Variant kPlain{0x1000, 20, 21, false}, kPlus{0x800, 16, 13, true};

const Variant& variant_of(const CartridgeSlot& slot) {
  return slot.scheme.hotspot == kFirstHotSpotPlus ? kPlus : kPlain;
}

// The image: places in the driver and behind it.
constexpr unsigned kDriver = 0x800, kEntry = 0x808;
constexpr unsigned kLoadsX = 0x34C, kLoadsY = 0x350, kFirstStream = 0x3E0;  // choices of the program, CDFJ+
constexpr unsigned kMostFirstStream = 220;
constexpr unsigned kStackPlus = 0x17F4, kEntryPlus = 0x17F8;
constexpr std::uint32_t kFunctions = 0x750, kFunctionsEnd = 0x760;  // of the driver, four bytes each

// The ARM's RAM.
constexpr unsigned kPointers = 0x98, kIncrements = 0x124, kWaveforms = 0x1B0;
constexpr std::uint32_t kDisplay = arm::kRamBegin + kDriver;
constexpr std::uint32_t kStack = 0x40001FDC;

constexpr unsigned kComm = 0x20, kFirstJump = 0x21, kAmplitude = 0x23;  // numbers of streams
constexpr unsigned kRegisters = 0xFF0, kHotPage = 0xFC0;
constexpr std::uint8_t kLoadA = 0xA9, kLoadX = 0xA2, kLoadY = 0xA0, kJump = 0x4C;  // opcodes
constexpr std::uint8_t kWaveOf32 = 27;
constexpr unsigned kNibble = 4;

Chip& chip_of(CartridgeSlot& slot) { return *std::launder(reinterpret_cast<Chip*>(slot.state.ram.data())); }

arm::Memory memory_of(const CartridgeSlot& slot) { return {slot.rom, slot.ram, kDriver}; }

const std::uint8_t* bank(const CartridgeSlot& slot) {
  return slot.rom.data() + variant_of(slot).banks_at + kBankSize * slot.state.bank[kShown];
}

std::uint32_t word(const CartridgeSlot& slot, unsigned at) {
  std::uint32_t number = 0;
  std::memcpy(&number, &slot.ram[at], sizeof number);
  return number;
}

void set_word(CartridgeSlot& slot, unsigned at, std::uint32_t number) {
  std::memcpy(&slot.ram[at], &number, sizeof number);
}

unsigned pointer_at(unsigned stream) { return kPointers + 4 * stream; }

std::uint8_t read_stream(CartridgeSlot& slot, unsigned stream) {
  const unsigned fraction = variant_of(slot).fraction;
  const std::uint32_t pointer = word(slot, pointer_at(stream));
  const std::uint32_t step = word(slot, kIncrements + 4 * stream) << (fraction - 8);
  set_word(slot, pointer_at(stream), pointer + step);
  return memory_of(slot).load<std::uint8_t>(kDisplay + (pointer >> fraction));
}

// Sound.

std::uint8_t wave_amplitude(const CartridgeSlot& slot, const Chip& chip) {
  unsigned sum = 0;
  for (unsigned i = 0; i < chip.wave.size(); ++i) {
    const std::uint32_t place = chip.clock.voice[i].phase >> chip.wave[i];
    sum += memory_of(slot).load<std::uint8_t>(word(slot, kWaveforms + 4 * i) + place);
  }
  return static_cast<std::uint8_t>(sum);
}

// A byte of a sample has two amplitudes, the upper four bits first.
std::uint8_t sample_amplitude(const CartridgeSlot& slot, const Chip& chip) {
  const std::uint32_t phase = chip.clock.voice[0].phase;
  const unsigned behind = variant_of(slot).sample;
  const auto pair = memory_of(slot).load<std::uint8_t>(word(slot, kWaveforms) + (phase >> behind));
  const bool second = (phase >> (behind - 1) & 1) != 0;
  return static_cast<std::uint8_t>(second ? pair & 0xF : pair >> kNibble);
}

std::uint8_t amplitude(CartridgeSlot& slot, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  chip.clock.pass(slot.machine, cycle);
  return chip.plays_waves ? wave_amplitude(slot, chip) : sample_amplitude(slot, chip);
}

// Fast fetch.

bool loads(const CartridgeSlot& slot, std::uint8_t opcode) {
  if (opcode == kLoadA || !variant_of(slot).is_plus) return opcode == kLoadA;
  return (opcode == kLoadX && slot.rom[kLoadsX] == kLoadX) ||
         (opcode == kLoadY && slot.rom[kLoadsY] == kLoadY);
}

unsigned first_stream(const CartridgeSlot& slot) {
  const bool has_one = variant_of(slot).is_plus && slot.rom[kFirstStream] <= kMostFirstStream;
  return has_one ? slot.rom[kFirstStream] : 0;
}

std::uint8_t loaded(CartridgeSlot& slot, std::uint8_t value, std::int32_t cycle) {
  const unsigned stream = value - first_stream(slot);
  if (stream == kAmplitude) return amplitude(slot, cycle);
  return stream < kAmplitude ? read_stream(slot, stream) : value;
}

// JMP $0000 and $0001 go where two bytes of a stream say.
std::uint8_t target(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  if (chip.follower.missing == 0) return chip.jump != 0 ? read_stream(slot, chip.jump) : value;
  const std::uint8_t upper = bank(slot)[(address + 1U) % kBankSize];
  if (value > 1 || upper != 0) return value;
  chip.jump = static_cast<std::uint8_t>(kFirstJump + value);
  return read_stream(slot, chip.jump);
}

// `value` was read at `address`. Returns what the CPU gets.
std::uint8_t follow(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  if (!chip.follower.continues(address, value, bank(slot)[(address - 2U) % kBankSize])) {
    chip.jump = 0;
    return value;
  }
  if (chip.follower.opcode == kJump) return target(slot, address, value);
  return loads(slot, chip.follower.opcode) ? loaded(slot, value, cycle) : value;
}

// Calls of the ARM.

arm::Registers at_call(const CartridgeSlot& slot) {
  arm::Registers registers;
  registers.r[arm::kLr] = arm::kRamBegin;
  registers.r[arm::kSp] = kStack;
  registers.r[arm::kPc] = kEntry;
  registers.r[0] = kEntry + 1;
  if (!variant_of(slot).is_plus) return registers;
  const arm::Memory memory = memory_of(slot);
  registers.r[arm::kSp] = memory.load<std::uint32_t>(kStackPlus);
  registers.r[arm::kPc] = memory.load<std::uint32_t>(kEntryPlus) & ~std::uint32_t{1};
  registers.r[0] = 0;
  return registers;
}

// The driver's functions are ARM code. Their arguments are in R2 and R3.
bool call_driver(Chip& chip, arm::Registers& registers) {
  const std::uint32_t place = registers.r[arm::kPc];
  if (place < kFunctions || place >= kFunctionsEnd || place % 4 != 0) return false;
  std::uint32_t &voice = registers.r[2], number = registers.r[3];
  registers.r[arm::kPc] = registers.r[arm::kLr] & ~std::uint32_t{1};
  if (voice >= chip.wave.size()) return true;
  auto& [frequency, phase] = chip.clock.voice[voice];
  switch ((place - kFunctions) / 4) {
    case 0: frequency = number; break;
    case 1: phase = 0; break;
    case 2: voice = phase; break;
    default:
      if (number >= kLeastWave && number <= kMostWave) chip.wave[voice] = static_cast<std::uint8_t>(number);
      break;
  }
  return true;
}

void finish_call(CartridgeSlot& slot) {
  slot.state.bank[kCalled] = 0;
  map(slot);
  Chip& chip = chip_of(slot);
  arm::Registers registers = at_call(slot);
  const arm::Memory memory = memory_of(slot);
  auto ending = arm::Ending::kFault;
  do {
    ending = arm::run(memory, registers, chip.clock.instructions);
  } while (ending == arm::Ending::kFault && call_driver(chip, registers));
  chip.stopped = ending != arm::Ending::kReturned;
}

void call(CartridgeSlot& slot, std::uint8_t function) {
  if (function < 254 || chip_of(slot).stopped) return;
  slot.state.bank[kCalled] = 1;
  map(slot);
}

// Registers.

void set_mode(CartridgeSlot& slot, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  chip.plays_waves = value >> kNibble != 0;
  chip.follower = {};
  chip.jump = 0;
  slot.state.bank[kFastFetch] = (value & 0xF) == 0;
  map(slot);
}

void write_register(CartridgeSlot& slot, unsigned number, std::uint8_t value) {
  const unsigned fraction = variant_of(slot).fraction;
  const std::uint32_t pointer = word(slot, pointer_at(kComm)), place = pointer >> fraction;
  switch (number) {
    case 0:
      memory_of(slot).store(kDisplay + place, value);
      set_word(slot, pointer_at(kComm), pointer + (1U << fraction));
      break;
    case 1: set_word(slot, pointer_at(kComm), (place << 8 | value) << fraction); break;
    case 2: set_mode(slot, value); break;
    default: call(slot, value); break;
  }
}

void select(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.hotspot;
  if (selected >= kBanks || selected == slot.state.bank[kShown]) return;
  slot.state.bank[kShown] = static_cast<std::uint8_t>(selected);
  map(slot);
}

bool can_be(const Chip& chip) {
  const auto is_size = [](std::uint8_t size) { return size >= kLeastWave && size <= kMostWave; };
  const bool can_jump = chip.jump == 0 || chip.jump == kFirstJump || chip.jump == kFirstJump + 1;
  return chip.clock.can_be() && chip.follower.can_be() && std::ranges::all_of(chip.wave, is_size) &&
         chip.plays_waves <= 1 && can_jump && chip.stopped <= 1 && chip.spare[0] == 0 && chip.spare[1] == 0;
}

}  // namespace

void reset(CartridgeSlot& slot) {
  Chip& chip = chip_of(slot) = Chip{};
  chip.wave.fill(kWaveOf32);
  slot.state.bank = {slot.scheme.initial};
  const auto end = std::copy_n(slot.rom.begin(), kDriver, slot.ram.begin());
  std::fill(end, slot.ram.end(), std::uint8_t{0});
}

void map(CartridgeSlot& slot) {
  slot.map.hide(0, kBankSize);
  if (slot.state.bank[kFastFetch] || slot.state.bank[kCalled]) return;
  slot.map.show(0, bank(slot), kHotPage);
  slot.map.hide(kHotPage, MemoryMap::kPageSize, kRegisters - kHotPage);
}

bool admits(const CartridgeSlot&, const CartridgeState& state) {
  Chip chip;
  std::memcpy(&chip, state.ram.data(), sizeof chip);
  return harmony::can_be(state, kBanks) && can_be(chip);
}

std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle) {
  if (slot.state.bank[kCalled]) {
    chip_of(slot).clock.pass(slot.machine, cycle);
    finish_call(slot);
  }
  select(slot, address);
  const std::uint8_t value = bank(slot)[address % kBankSize];
  return slot.state.bank[kFastFetch] ? follow(slot, address, value, cycle) : value;
}

Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if (slot.state.bank[kCalled]) finish_call(slot);
  select(slot, address);
  const unsigned number = (address & 0xFFFU) - kRegisters;
  if (number < 4) write_register(slot, number, value);
  return Delivery::kTaken;
}

}  // namespace racebeam::cdf

#include "emulator/cartridge/harmony/cdf.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <span>
#include <utility>

#include "emulator/cartridge/arm/thumb.hpp"

namespace racebeam::cdf {
namespace {

// Where the versions differ.
struct Variant {
  unsigned banks_at;                         // in the image
  unsigned fraction;                         // bits of a pointer behind the place in the display data
  unsigned sample;                           // bits of a phase behind the byte of a sample
  unsigned pointers, increments, waveforms;  // in the ARM's RAM
  std::uint32_t functions;                   // of the driver, four bytes each
  std::uint8_t amplitude;                    // its number, behind those of streams
  bool is_plus;
};
constexpr Variant kVariants[] = {
    {0x1000, 20, 21, 0x6E0, 0x768, 0x7F0, 0x6E0, 34, false},  // kCdf0
    {0x1000, 20, 21, 0x0A0, 0x128, 0x1B0, 0x750, 34, false},  // kCdf1
    {0x1000, 20, 21, 0x098, 0x124, 0x1B0, 0x750, 35, false},  // kCdfj
    {0x0800, 16, 13, 0x098, 0x124, 0x1B0, 0x750, 35, true},   // kCdfjPlus
};

const Variant& variant_of(const CartridgeSlot& slot) { return kVariants[slot.scheme.version]; }

// The image: places in the driver and behind it.
constexpr unsigned kDriver = 0x800, kEntry = 0x808, kFunctions = 4;
constexpr unsigned kStackPlus = 0x17F4, kEntryPlus = 0x17F8;

// The ARM's RAM.
constexpr std::uint32_t kDisplay = arm::kRamBegin + kDriver;
constexpr std::uint32_t kStack = 0x40001FDC, kStackOfDriver = 36;
constexpr std::uint32_t kReturn = 0x40000594, kReturnPlus = 0x4000058C;
constexpr unsigned kLastAmplitude = 0x1BC;  // CDFJ+ is one fetch late

constexpr unsigned kComm = 0x20, kFirstJump = 0x21;  // numbers of streams
constexpr unsigned kRegisters = 0xFF0, kFirstSpot = 0xFF4, kHotPage = 0xFC0;
constexpr std::uint8_t kLoadA = 0xA9, kLoadX = 0xA2, kLoadY = 0xA0, kJump = 0x4C;  // opcodes
constexpr std::uint8_t kWaveOf32 = 27;
constexpr unsigned kNibble = 4;

Chip& chip_of(CartridgeSlot& slot) { return *std::launder(reinterpret_cast<Chip*>(slot.state.ram.data())); }

// Boards with more flash memory have more RAM.
std::span<std::uint8_t> ram_of(const CartridgeSlot& slot) {
  constexpr std::size_t kMiddleImage = 131072, kMiddleRam = 16384;
  const std::size_t image = slot.rom.size();
  return slot.ram.first(image <= kImage ? kRam : image <= kMiddleImage ? kMiddleRam : kMaxRamPlus);
}

arm::Memory memory_of(const CartridgeSlot& slot) { return {slot.rom, ram_of(slot), kDriver}; }

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

unsigned pointer_at(const CartridgeSlot& slot, unsigned stream) {
  return variant_of(slot).pointers + 4 * stream;
}

// The byte that the stream points to. The pointer then moves on by `step` / 256.
std::uint8_t take(CartridgeSlot& slot, unsigned stream, std::uint32_t step) {
  const unsigned fraction = variant_of(slot).fraction;
  const std::uint32_t pointer = word(slot, pointer_at(slot, stream));
  set_word(slot, pointer_at(slot, stream), pointer + (step << (fraction - 8)));
  return memory_of(slot).load<std::uint8_t>(kDisplay + (pointer >> fraction));
}

std::uint8_t read_stream(CartridgeSlot& slot, unsigned stream) {
  return take(slot, stream, word(slot, variant_of(slot).increments + 4 * stream));
}

std::uint8_t read_jump(CartridgeSlot& slot, unsigned stream) { return take(slot, stream, 0x100); }

// Sound.

std::uint8_t wave_amplitude(const CartridgeSlot& slot, const Chip& chip) {
  unsigned sum = 0;
  for (unsigned i = 0; i < chip.wave.size(); ++i) {
    const std::uint32_t place = chip.clock.voice[i].phase >> chip.wave[i];
    sum += memory_of(slot).load<std::uint8_t>(word(slot, variant_of(slot).waveforms + 4 * i) + place);
  }
  return static_cast<std::uint8_t>(sum);
}

// A byte of a sample has two amplitudes, the upper four bits first. CDFJ+ leaves them to the TIA to mask.
std::uint8_t sample_amplitude(const CartridgeSlot& slot, const Chip& chip) {
  const Variant& variant = variant_of(slot);
  const std::uint32_t phase = chip.clock.voice[0].phase;
  const auto pair =
      memory_of(slot).load<std::uint8_t>(word(slot, variant.waveforms) + (phase >> variant.sample));
  const bool second = (phase >> (variant.sample - 1) & 1) != 0;
  return static_cast<std::uint8_t>(!second ? pair >> kNibble : variant.is_plus ? pair : pair & 0xF);
}

std::uint8_t amplitude(CartridgeSlot& slot, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  chip.clock.pass(slot.machine, cycle);
  const std::uint8_t now = chip.plays_waves ? wave_amplitude(slot, chip) : sample_amplitude(slot, chip);
  return variant_of(slot).is_plus ? std::exchange(slot.ram[kLastAmplitude], now) : now;
}

// Fast fetch.

bool loads(const Chip& chip, std::uint8_t opcode) {
  return opcode == kLoadA || (opcode == kLoadX && (chip.loads & kLoadsX) != 0) ||
         (opcode == kLoadY && (chip.loads & kLoadsY) != 0);
}

std::uint8_t loaded(CartridgeSlot& slot, std::uint8_t value, std::int32_t cycle) {
  const unsigned stream = value - unsigned{chip_of(slot).first_stream}, last = variant_of(slot).amplitude;
  if (stream == last) return amplitude(slot, cycle);
  return stream < last ? read_stream(slot, stream) : value;
}

// JMP $0000, and $0001 with a second stream for jumps, go where two bytes of a stream say.
std::uint8_t target(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  Chip& chip = chip_of(slot);
  if (chip.follower.missing == 0) return chip.jump != 0 ? read_jump(slot, chip.jump) : value;
  const std::uint8_t upper = bank(slot)[(address + 1U) % kBankSize];
  if (kFirstJump + value >= variant_of(slot).amplitude || upper != 0) return value;
  chip.jump = static_cast<std::uint8_t>(kFirstJump + value);
  return read_jump(slot, chip.jump);
}

// Fast fetch: `value` was read at `address`. Returns the byte that the CPU gets instead.
std::uint8_t follow(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  if (!chip.follower.continues(address, value, bank(slot)[(address - 2U) % kBankSize])) {
    chip.jump = 0;
    return value;
  }
  if (chip.follower.opcode == kJump) return target(slot, address, value);
  return loads(chip, chip.follower.opcode) ? loaded(slot, value, cycle) : value;
}

// Calls of the ARM.

// The registers at the start of a call: as the driver leaves them and, in CDF and CDFJ, as two instructions
// of ARM code at $800 then change them.
arm::Registers at_call(const CartridgeSlot& slot) {
  constexpr std::uint32_t kFlash = 0x3FFFC000, kNoThumb = ~std::uint32_t{1};
  arm::Registers registers;
  auto& r = registers.r;
  r[arm::kLr] = kReturn;
  r[arm::kSp] = kStack - kStackOfDriver;
  r[arm::kPc] = kEntry;
  r[0] = kEntry + 1;
  if (!variant_of(slot).is_plus) return registers;
  const arm::Memory memory = memory_of(slot);
  r[0] = kFlash;
  r[1] = arm::kRamBegin;
  r[2] = kEntryPlus;
  r[3] = memory.load<std::uint32_t>(kEntryPlus);
  r[arm::kLr] = kReturnPlus;
  r[arm::kSp] = memory.load<std::uint32_t>(kStackPlus) - kStackOfDriver;
  r[arm::kPc] = r[3] & kNoThumb;
  return registers;
}

// Does the work of the driver's functions, which are ARM code. Their arguments are in R2 and R3, and they
// return with LR in R4. Returns false if PC is not at such a function.
bool call_driver(CartridgeSlot& slot, arm::Registers& registers) {
  const std::uint32_t place = registers.r[arm::kPc] - variant_of(slot).functions;
  if (place >= 4 * kFunctions || place % 4 != 0) return false;
  Chip& chip = chip_of(slot);
  std::uint32_t& argument = registers.r[2];
  const std::uint32_t number = registers.r[3];
  const auto voice = static_cast<std::size_t>(std::clamp(static_cast<std::int32_t>(argument), 0, 2));
  auto& [frequency, phase] = chip.clock.voice[voice];
  switch (place / 4) {
    case 0: frequency = number; break;
    case 1: phase = 0; break;
    case 2: argument = phase; break;
    default:
      if (number >= kMinWave && number <= kMaxWave) chip.wave[voice] = static_cast<std::uint8_t>(number);
      break;
  }
  registers.r[4] = registers.r[arm::kLr] | 1;
  registers.r[arm::kPc] = registers.r[4] - 1;
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
  } while (ending == arm::Ending::kFault && call_driver(slot, registers));
  chip.stopped = ending != arm::Ending::kReturned;
}

void call(CartridgeSlot& slot) {
  if (chip_of(slot).stopped) return;
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
  const unsigned comm = pointer_at(slot, kComm);
  const std::uint32_t pointer = word(slot, comm), place = pointer >> fraction;
  switch (number) {
    case 0:
      memory_of(slot).store(kDisplay + place, value);
      set_word(slot, comm, pointer + (1U << fraction));
      break;
    case 1: set_word(slot, comm, (place << 8 | value) << fraction); break;
    case 2: set_mode(slot, value); break;
    default: call(slot); break;
  }
}

void select(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned spot = address & 0xFFFU;
  if (spot < kFirstSpot || spot > kFirstSpot + kBanks) return;
  const unsigned selected = (spot + kBanks - slot.scheme.first_hot_spot) % kBanks;
  if (selected == slot.state.bank[kShown]) return;
  slot.state.bank[kShown] = static_cast<std::uint8_t>(selected);
  map(slot);
}

// Reads the options that the driver was assembled with from two of its instructions: CMP R2 with an opcode of
// the 6507, and SUB R2 with the number of the first stream.
void find_options(const CartridgeSlot& slot, Chip& chip) {
  const auto begin = slot.rom.begin(), end = begin + kDriver;
  const auto has = [&](std::uint8_t opcode) {
    const std::uint8_t compares[] = {opcode, 0x00, 0x52, 0x13};
    return std::search(begin, end, std::begin(compares), std::end(compares)) != end;
  };
  constexpr std::uint8_t kSubtracts[] = {0x20, 0x42, 0xE2};
  const auto found = std::search(begin, end, std::begin(kSubtracts), std::end(kSubtracts));
  const std::uint8_t number = found != begin && found != end ? found[-1] : std::uint8_t{0};
  chip.first_stream = number <= kMaxFirstStream ? number : std::uint8_t{0};
  chip.loads = static_cast<std::uint8_t>((has(kLoadX) ? kLoadsX : 0) | (has(kLoadY) ? kLoadsY : 0));
}

bool is_valid(const Chip& chip) {
  const auto is_size = [](std::uint8_t size) { return size >= kMinWave && size <= kMaxWave; };
  const bool can_jump = chip.jump == 0 || chip.jump == kFirstJump || chip.jump == kFirstJump + 1;
  return chip.clock.is_valid() && chip.follower.is_valid() && std::ranges::all_of(chip.wave, is_size) &&
         chip.plays_waves <= 1 && can_jump && chip.stopped <= 1 && chip.loads <= (kLoadsX | kLoadsY) &&
         chip.first_stream <= kMaxFirstStream;
}

}  // namespace

void reset(CartridgeSlot& slot) {
  Chip& chip = chip_of(slot) = Chip{};
  chip.wave.fill(kWaveOf32);
  if (variant_of(slot).is_plus) find_options(slot, chip);
  slot.state.bank = {slot.scheme.initial_bank};
  const auto end = std::copy_n(slot.rom.begin(), kDriver, slot.ram.begin());
  std::fill(end, slot.ram.end(), std::uint8_t{0});
  slot.machine.riot.ram.fill(0);  // as the driver leaves it on a 2600
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
  return harmony::is_valid(state, kBanks) && is_valid(chip);
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

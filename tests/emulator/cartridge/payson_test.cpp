// 4A50: random instructions select and write what they do in a model that sees each access on the bus
// (docs/spec/cartridges.md, 16).
#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "emulator/cartridge/mappers/payson.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/emulator/reference/reference_4a50.hpp"

namespace racebeam::test {
namespace {

constexpr int kCode = 0x80;  // in RAM

Properties for_4a50() {
  Properties properties = ntsc();
  properties.scheme = "4A50";
  return properties;
}

Rom random_rom(std::mt19937& random) {
  Rom rom(payson::kImage);
  for (std::uint8_t& byte : rom) byte = static_cast<std::uint8_t>(random());
  return rom;
}

// The machine and the model execute the same instruction, with the same registers.
class Trial {
 public:
  explicit Trial(std::uint32_t seed)
      : random_(seed), rom_(random_rom(random_)), bench_(rom_, for_4a50()), model_(rom_) {
    for (std::size_t i = 0; i < 128; ++i) set_ram(i, below(256));
    for (std::size_t i = 0; i < payson::kRam; ++i)
      model_.cartridge_ram[i] = bench_.board.cartridge_ram[i] = static_cast<std::uint8_t>(random_());
  }

  void step() {
    put_instruction();
    const int a = below(256), y = below(256);
    const int x = has_pointer() || modifies() ? 0 : below(256);
    run_machine(a, x, y);
    run_model(a, x, y);
    compare();
  }

  const CartridgeState& banks() const { return bench_.state.cartridge; }

 private:
  int below(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }

  void set_ram(std::size_t place, int value) {
    bench_.state.riot.ram[place] = static_cast<std::uint8_t>(value);
    model_.ram[place] = value;
  }

  // Half of the pages are those of soft hot spots, and half of the bytes hot spots of page zero.
  int lively_page() {
    constexpr std::array kPages = {0x64, 0x65, 0x68, 0x69, 0x6B, 0x6C, 0x6D, 0x6E, 0x6F,
                                   0x7E, 0x7F, 0xF0, 0xF8, 0xFE, 0x0C, 0x01, 0x00};
    return kPages[static_cast<std::size_t>(below(static_cast<int>(kPages.size())))];
  }
  int lively_byte() {
    return below(2) == 0 ? 0xF0 + below(16) : below(2) == 0 ? 0x70 + below(16) : below(256);
  }

  void put_instruction() {
    // Without jumps, the stack, and instructions that halt.
    constexpr std::array kOpcodes = {0xAD, 0xBD, 0xB9, 0x8D, 0x9D, 0x99, 0x0C, 0x1C, 0x2C, 0xEE, 0xDE, 0xDD,
                                     0x04, 0xA5, 0x85, 0x86, 0xE6, 0xC6, 0xB5, 0x95, 0xB6, 0x96, 0xF6, 0xA1,
                                     0xB1, 0x91, 0x81, 0x8E, 0xBC, 0xEA, 0xA9, 0x07, 0x0F, 0xB3, 0xFB};
    const int opcode = kOpcodes[static_cast<std::size_t>(below(static_cast<int>(kOpcodes.size())))];
    set_ram(0, opcode);
    const bool is_absolute = (opcode & 0x0C) == 0x0C || (opcode & 0x1F) == 0x19 || (opcode & 0x1F) == 0x1B;
    set_ram(1, is_absolute && below(2) == 0 ? below(256) : lively_byte());
    set_ram(2, lively_page());
    // Not in the TIA, which reads as what it has drawn.
    if (has_pointer()) set_ram(1, 0xF0 + below(15));
    if (modifies()) set_ram(1, 0x80 + model_.ram[1] % 0x80);
    const std::size_t place = 0x70 + static_cast<std::size_t>(below(15));
    set_ram(place, below(256));
    set_ram(place + 1, lively_page());
  }

  bool has_pointer() const {
    const int column = model_.ram[0] & 0x1F;
    return column == 0x01 || column == 0x11 || column == 0x13;
  }

  // Reads the operand, and writes it.
  bool modifies() const {
    const int opcode = model_.ram[0];
    return (opcode & 0x03) == 0x03 || ((opcode & 0x07) == 0x06 && (opcode < 0x80 || opcode >= 0xC0));
  }

  void run_machine(int a, int x, int y) {
    CpuState& cpu = bench_.cpu;
    cpu = {};
    cpu.PC = kCode;
    cpu.A = static_cast<std::uint8_t>(a);
    cpu.X = static_cast<std::uint8_t>(x);
    cpu.Y = static_cast<std::uint8_t>(y);
    bench_.run_program(1);
  }

  void run_model(int a, int x, int y) {
    ReferenceCpu cpu(model_);
    cpu.PC = kCode;
    cpu.A = a;
    cpu.X = x;
    cpu.Y = y;
    cpu.step();
    model_.end_instruction();
  }

  void compare() {
    INFO(std::hex << model_.ram[0] << ' ' << model_.ram[1] << ' ' << model_.ram[2]);
    for (int a = 0x1000; a < 0x2000; a += 1 + below(64)) {
      INFO(a);
      REQUIRE(int{bench_.see(static_cast<unsigned>(a))} == model_.cartridge_byte(a));
    }
    for (std::size_t i = 3; i < 128; ++i) REQUIRE(int{bench_.state.riot.ram[i]} == model_.ram[i]);
  }

  std::mt19937 random_;
  Rom rom_;
  Bench bench_;
  Model4a50 model_;
};

TEST_CASE("4A50 shows and stores what its model does, instruction by instruction") {
  bool showed_ram = false, showed_rom = false;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    Trial trial(seed);
    for (int i = 0; i < 3000; ++i) {
      trial.step();
      (trial.banks().bank[payson::kUpperIsRam] ? showed_ram : showed_rom) = true;
    }
  }
  CHECK((showed_ram && showed_rom));
}

}  // namespace
}  // namespace racebeam::test

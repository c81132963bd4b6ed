// Translated code reads paddles, buttons and the ports of a DPC as the interpreter does.
#include <algorithm>
#include <catch2/catch.hpp>
#include <initializer_list>
#include <memory>
#include <random>
#include <vector>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/console.hpp"
#include "tests/support/skip.hpp"
#include "tests/translator/pair.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& code, const Bytes& more) { code.insert(code.end(), more.begin(), more.end()); }

Bytes word(std::size_t value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
}

constexpr std::size_t kOrigin = 0xF080;                          // below are the ports of a DPC
const Bytes kStart = {0x78, 0xD8, 0xA2, 0xFF, 0x9A};             // SEI, CLD, LDX #$FF, TXS
const Bytes kClose = {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85,  // VSYNC for three lines, INC $80
                      0x02, 0x85, 0x02, 0xA9, 0x00, 0x85, 0x00, 0xE6, 0x80};
const std::size_t kLoop = kOrigin + kStart.size(), kFrame = kLoop + kClose.size();

// An image of 4K, or of a DPC: each bank closes a frame, counts frames in $80, and executes `frame`.
std::shared_ptr<const Rom> make_image(const Bytes& frame, std::size_t size) {
  Bytes code = kStart;
  append(code, kClose);
  append(code, frame);
  append(code, {0x4C});  // JMP
  append(code, word(kLoop));
  Bytes rom(size);
  for (std::size_t i = 0; i < size; ++i) rom[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  for (std::size_t bank = 0; bank + 4096 <= size; bank += 4096) {
    std::ranges::copy(code, rom.begin() + static_cast<std::ptrdiff_t>(bank + (kOrigin & 0xFFF)));
    std::ranges::copy(word(kOrigin), rom.begin() + static_cast<std::ptrdiff_t>(bank + 0xFFC));
  }
  return std::make_shared<const Rom>(std::move(rom));
}

// A machine that is interpreted, and one that is translated.
class Pair {
 public:
  Pair(const std::shared_ptr<const Rom>& rom, const Properties& properties)
      : interpreted_(rom, properties, power_on_[0], CpuKind::kInterpreter),
        translated_(rom, properties, power_on_[1], CpuKind::kTranslator) {}

  void step(const Inputs& inputs) {
    for (Console* console : {&interpreted_, &translated_}) {
      console->inputs() = inputs;
      console->step();
    }
    REQUIRE(difference(interpreted_, translated_) == "");
    cycles_ += translated_.state().cycle;
  }

  unsigned ram(unsigned address) { return translated_.ram()[address & 0x7F]; }
  double interpreted_share() const {
    return static_cast<double>(translated_.interpreted_cycles()) / static_cast<double>(cycles_);
  }

 private:
  SystemGenerator power_on_[2] = {SystemGenerator(1), SystemGenerator(1)};
  Console interpreted_, translated_;
  std::int64_t cycles_ = 0;
};

bool is_left_out() {
  const bool left_out = Translator::obstacle()[0] != '\0';
  if (left_out) leave_out(Translator::obstacle());
  return left_out;
}

constexpr unsigned kPins = 6, kLowLines = 0x90, kValues = 0xA0;

// Discharges the paddles for ten lines, then counts at $90-$95 the lines, of 200, in which INPT0-5 are low.
// Reads them with each instruction and in each mode, and keeps at $A0 what it has read.
Bytes pin_reads() {
  Bytes code = {0xA9, 0x82, 0x85, 0x01, 0xA2, 0x0A, 0x85, 0x02, 0xCA, 0xD0, 0xFB};  // VBLANK; WSYNC, DEX, BNE
  append(code, {0xA5, 0x08, 0x85, kValues + 20, 0xA9, 0x00, 0x85, 0x01});
  for (unsigned pin = 0; pin < kPins; ++pin) append(code, {0x85, static_cast<std::uint8_t>(kLowLines + pin)});
  append(code, {0xA0, 0xC8});
  Bytes line = {0x85, 0x02};
  for (std::uint8_t pin = 0; pin < kPins; ++pin)  // LDA INPTx, BMI, INC
    append(line, {0xA5, static_cast<std::uint8_t>(0x08 + pin), 0x30, 0x02, 0xE6,
                  static_cast<std::uint8_t>(kLowLines + pin)});
  append(line, {0x88, 0xD0, static_cast<std::uint8_t>(253 - line.size())});
  append(code, line);
  const std::initializer_list<Bytes> reads = {
      {0xA5, 0x38},                    // LDA $38
      {0xAD, 0x39, 0x25},              // LDA $2539
      {0xA6, 0x0A, 0x8A},              // LDX, TXA
      {0xA4, 0x0B, 0x98},              // LDY, TYA
      {0xA9, 0xFF, 0x25, 0x0C},        // AND
      {0xA9, 0x00, 0x05, 0x0D},        // ORA
      {0xA9, 0x55, 0x45, 0x0C},        // EOR
      {0x18, 0x65, 0x0D},              // CLC, ADC
      {0x38, 0xED, 0x0C, 0x3F},        // SEC, SBC $3F0C
      {0x24, 0x0C, 0x08, 0x68},        // BIT, PHP, PLA
      {0xC5, 0x0D, 0x08, 0x68},        // CMP, PHP, PLA
      {0xA2, 0x04, 0xB5, 0x08},        // LDA $08,X
      {0xA0, 0x05, 0xB9, 0x08, 0x00},  // LDA $0008,Y
      {0xA0, 0x80, 0xB9, 0x88, 0x0E},  // LDA $0E88,Y: $0F08, on the next page
      {0xA2, 0x7B, 0xBD, 0x8F, 0x06},  // LDA $068F,X: $070A
      {0xA5, 0x0E},                    // no pin
      {0xA5, 0x0F},
  };
  std::uint8_t place = kValues;
  for (const Bytes& read : reads) {
    append(code, read);
    append(code, {0x85, place++});
  }
  return code;
}

constexpr std::int32_t kMaxOhms = 1'000'000;

TEST_CASE("Translated code reads paddles and buttons as the interpreter does") {
  if (is_left_out()) return;
  const auto image = make_image(pin_reads(), 4096);
  for (unsigned kind = 0; kind < 16; ++kind) {
    INFO("kind " << kind);
    Properties properties;
    properties.format = Format::kNtsc;
    if (kind & 1) properties.left = Controller::kPaddles;
    if (kind & 2) properties.right = Controller::kPaddles;
    properties.swap_ports = (kind & 4) != 0;
    properties.swap_paddles = (kind & 8) != 0;
    Pair pair(image, properties);
    std::mt19937 random(kind);
    for (int frame = 0; frame < 40; ++frame) {
      Inputs inputs;
      for (std::int32_t& ohms : inputs.paddle)
        ohms = static_cast<std::int32_t>(random() % (random() % 4 == 0 ? 1U : unsigned{kMaxOhms}));
      for (std::uint8_t& stick : inputs.joystick) stick = static_cast<std::uint8_t>(random() % 32);
      inputs.paddle_fire = static_cast<std::uint8_t>(random() % 16);
      pair.step(inputs);
    }
    CHECK(pair.interpreted_share() < 0.1);
  }
}

TEST_CASE("In translated code, a paddle's pin is low the longer, the larger its resistance is") {
  if (is_left_out()) return;
  Properties properties;
  properties.format = Format::kNtsc;
  properties.left = properties.right = Controller::kPaddles;
  Pair pair(make_image(pin_reads(), 4096), properties);
  unsigned last = 0;
  for (std::int32_t ohms = 0; ohms <= kMaxOhms; ohms += kMaxOhms / 20) {
    INFO(ohms << " ohms");
    Inputs inputs;
    inputs.paddle.fill(ohms);
    for (int frame = 0; frame < 2; ++frame) pair.step(inputs);
    const unsigned lines = pair.ram(kLowLines);
    for (unsigned pin = 1; pin < 4; ++pin) CHECK(lines - pair.ram(kLowLines + pin) <= 1);  // it is read later
    CHECK((ohms == 0 ? lines == 0 : lines > last || lines == 200));
    last = lines;
  }
}

// Sets the fetchers, each frame to something else, and adds up in $90 what each of the 64 ports reads.
Bytes dpc_reads() {
  Bytes code;
  for (std::uint8_t port = 0x40; port < 0x60; ++port)  // LDA $80, ADC #, STA
    append(code, {0xA5, 0x80, 0x69, static_cast<std::uint8_t>(port * 37), 0x8D, port, 0x10});
  append(code, {0xA0, 0x08});
  const std::size_t loop = kFrame + code.size();
  for (std::uint8_t port = 0; port < 0x40; ++port)  // LDA, ADC $90, STA $90
    append(code, {0xAD, port, 0x10, 0x65, 0x90, 0x85, 0x90});
  append(code, {0x88, 0xF0, 0x03, 0x4C});  // DEY, BEQ, JMP
  append(code, word(loop));
  append(code, {0x2C, 0x08, 0x10, 0x08, 0x68, 0x85, 0x91});  // BIT, PHP, PLA
  append(code,
         {0xAE, 0x11, 0x10, 0x86, 0x92, 0xAC, 0x3A, 0x10, 0x84, 0x93, 0xCD, 0x10, 0x10});  // LDX, LDY, CMP
  return code;
}

TEST_CASE("Translated code reads the ports of a DPC as the interpreter does") {
  if (is_left_out()) return;
  Properties properties;
  properties.format = Format::kNtsc;
  properties.scheme = "DPC";
  Pair pair(make_image(dpc_reads(), 10240), properties);
  for (int frame = 0; frame < 600; ++frame) {
    INFO("frame " << frame);
    pair.step({});
  }
  CHECK(pair.interpreted_share() < 0.1);
}

}  // namespace
}  // namespace racebeam::test

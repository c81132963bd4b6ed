// A 6507 that executes instructions as long as everything that they read is known. What it knows of memory is
// the user's. It shares opcodes.inc with the interpreter, but counts no cycles.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator/base/opcodes.hpp"

namespace racebeam {

struct Unknown {};  // thrown where a value is not known

class KnownBus {
 public:
  virtual ~KnownBus() = default;
  virtual std::uint8_t read(unsigned address) = 0;  // or throws Unknown
  virtual void write(unsigned address, std::uint8_t value) = 0;
};

// The CPU after its reset, but for PC.
class KnownCpu {
 public:
  KnownCpu(KnownBus& bus, std::uint16_t pc) : bus_(bus), pc_(pc) {}

  // Executes an instruction. Throws Unknown if it depends on a flag or a byte that is not known, follows a
  // pointer in memory, or is one of those that programs seldom start with.
  void step() { execute(kOpcodes[fetch()]); }

 private:
  std::uint8_t fetch() { return bus_.read(pc_++); }
  unsigned fetch_word() {
    const unsigned low = fetch();
    return low | static_cast<unsigned>(fetch()) << 8;
  }

  unsigned address(opcode::Mode mode);
  std::uint8_t operand(opcode::Mode mode);

  void set(std::uint8_t& to, std::uint8_t value) { result_ = to = value; }
  void change(unsigned address, int by) {
    result_ = static_cast<std::uint8_t>(bus_.read(address) + by);
    bus_.write(address, *result_);
  }
  void compare(std::uint8_t value, std::uint8_t with) {
    carry_ = value >= with;
    result_ = static_cast<std::uint8_t>(value - with);
  }

  template <typename T>
  static T known(const std::optional<T>& value) {
    if (!value) throw Unknown{};
    return *value;
  }
  void branch(bool taken) {
    const auto distance = static_cast<std::int8_t>(fetch());
    if (taken) pc_ = static_cast<std::uint16_t>(pc_ + distance);
  }
  bool zero() const { return known(result_) == 0; }
  bool negative() const { return (known(result_) & 0x80) != 0; }

  void push(std::uint8_t value) { bus_.write(0x100U + sp_--, value); }
  std::uint8_t pull() { return bus_.read(0x100U + ++sp_); }
  void call() {
    const unsigned target = fetch_word(), back = pc_ - 1U;
    push(static_cast<std::uint8_t>(back >> 8));
    push(static_cast<std::uint8_t>(back));
    pc_ = static_cast<std::uint16_t>(target);
  }
  void return_from_call() {
    const unsigned low = pull();
    pc_ = static_cast<std::uint16_t>((low | static_cast<unsigned>(pull()) << 8) + 1);
  }

  void execute(const Opcode& opcode);

  KnownBus& bus_;
  std::uint16_t pc_;
  std::uint8_t a_ = 0, x_ = 0, y_ = 0, sp_ = 0xFF;
  std::optional<std::uint8_t> result_;  // for Z and N
  std::optional<bool> carry_;
};

}  // namespace racebeam

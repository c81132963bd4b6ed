// A second 6507, written only from docs/spec/cpu.md: its own copy of the opcode grid, and one bus access
// after the other. Slow and simple, and independent of emulator/. The interpreter is compared with it.
#pragma once

#include <cstdint>

namespace racebeam::test {

// The model's bus. `T` is the cycle counter at the access. A write returns the counter, which WSYNC may have
// advanced.
struct Bus {
  virtual ~Bus() = default;
  virtual int read(int address, int T) = 0;
  virtual int write(int address, int value, int T, bool after_read) = 0;
};

// A mnemonic or a mode as a number, for switch statements; upper or lower case.
constexpr int op(const char* letters) {
  int name = 0;
  for (; *letters != 0; ++letters) name = name << 8 | (*letters >= 'a' ? *letters - 32 : *letters);
  return name;
}

bool is_documented(int opcode);

class ReferenceCpu {
 public:
  explicit ReferenceCpu(Bus& bus) : bus_(bus) {}

  int T = 0, PC = 0, A = 0, X = 0, Y = 0, SP = 0xFF;
  int N = 0, V = 0, D = 0, I = 0, Z = 0, C = 0;
  bool jammed = false;

  void step();  // one instruction
  int status() const { return N << 7 | V << 6 | 0x30 | D << 3 | I << 2 | Z << 1 | C; }
  void set_status(int p);

 private:
  int read(int address);
  void write(int address, int value);
  int fetch();
  int fetch_word();
  int word_at(int low, int high);
  void push(int value);
  int pull();

  int address_of(int mode, bool penalty);
  void run(int name, int mode, bool penalty);
  void branch(bool taken);
  bool run_control(int name, int mode);
  bool run_implied(int name);
  void store(int name, int address);
  int modify(int name, int m);
  void use(int name, int m);

  void nz(int value);
  void compare(int reg, int m);
  void adc(int m);
  void sbc(int m);
  void arr(int m);

  Bus& bus_;
  bool read_last_ = true;
};

}  // namespace racebeam::test

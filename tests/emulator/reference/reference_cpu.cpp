#include "tests/emulator/reference/reference_cpu.hpp"

#include <array>
#include <sstream>
#include <string>

namespace racebeam::test {
namespace {

// The grid of docs/spec/cpu.md, 5: mnemonic, mode, cycles. "+": one more cycle if a page is crossed; "*": a
// branch.
constexpr const char* kGrid = R"(
    BRK 7|ORA ix 6|jam 2|slo ix 8|nop zp 3|ORA zp 3|ASL zp 5|slo zp 5|
    PHP 3|ORA # 2|ASL A 2|anc # 2|nop ab 4|ORA ab 4|ASL ab 6|slo ab 6|
    BPL r 2*|ORA iy 5+|jam 2|slo iy 8|nop zx 4|ORA zx 4|ASL zx 6|slo zx 6|
    CLC 2|ORA ay 4+|nop 2|slo ay 7|nop ax 4+|ORA ax 4+|ASL ax 7|slo ax 7|
    JSR 6|AND ix 6|jam 2|rla ix 8|BIT zp 3|AND zp 3|ROL zp 5|rla zp 5|
    PLP 4|AND # 2|ROL A 2|anc # 2|BIT ab 4|AND ab 4|ROL ab 6|rla ab 6|
    BMI r 2*|AND iy 5+|jam 2|rla iy 8|nop zx 4|AND zx 4|ROL zx 6|rla zx 6|
    SEC 2|AND ay 4+|nop 2|rla ay 7|nop ax 4+|AND ax 4+|ROL ax 7|rla ax 7|
    RTI 6|EOR ix 6|jam 2|sre ix 8|nop zp 3|EOR zp 3|LSR zp 5|sre zp 5|
    PHA 3|EOR # 2|LSR A 2|asr # 2|JMP ab 3|EOR ab 4|LSR ab 6|sre ab 6|
    BVC r 2*|EOR iy 5+|jam 2|sre iy 8|nop zx 4|EOR zx 4|LSR zx 6|sre zx 6|
    CLI 2|EOR ay 4+|nop 2|sre ay 7|nop ax 4+|EOR ax 4+|LSR ax 7|sre ax 7|
    RTS 6|ADC ix 6|jam 2|rra ix 8|nop zp 3|ADC zp 3|ROR zp 5|rra zp 5|
    PLA 4|ADC # 2|ROR A 2|arr # 2|JMP in 5|ADC ab 4|ROR ab 6|rra ab 6|
    BVS r 2*|ADC iy 5+|jam 2|rra iy 8|nop zx 4|ADC zx 4|ROR zx 6|rra zx 6|
    SEI 2|ADC ay 4+|nop 2|rra ay 7|nop ax 4+|ADC ax 4+|ROR ax 7|rra ax 7|
    nop # 2|STA ix 6|nop # 2|sax ix 6|STY zp 3|STA zp 3|STX zp 3|sax zp 3|
    DEY 2|nop # 2|TXA 2|ane # 2|STY ab 4|STA ab 4|STX ab 4|sax ab 4|
    BCC r 2*|STA iy 6|jam 2|sha iy 6|STY zx 4|STA zx 4|STX zy 4|sax zy 4|
    TYA 2|STA ay 5|TXS 2|shs ay 5|shy ax 5|STA ax 5|shx ay 5|sha ay 5|
    LDY # 2|LDA ix 6|LDX # 2|lax ix 6|LDY zp 3|LDA zp 3|LDX zp 3|lax zp 4|
    TAY 2|LDA # 2|TAX 2|lxa # 2|LDY ab 4|LDA ab 4|LDX ab 4|lax ab 4|
    BCS r 2*|LDA iy 5+|jam 2|lax iy 5+|LDY zx 4|LDA zx 4|LDX zy 4|lax zy 4|
    CLV 2|LDA ay 4+|TSX 2|las ay 4+|LDY ax 4+|LDA ax 4+|LDX ay 4+|lax ay 4+|
    CPY # 2|CMP ix 6|nop # 2|dcp ix 8|CPY zp 3|CMP zp 3|DEC zp 5|dcp zp 5|
    INY 2|CMP # 2|DEX 2|sbx # 2|CPY ab 4|CMP ab 4|DEC ab 6|dcp ab 6|
    BNE r 2*|CMP iy 5+|jam 2|dcp iy 8|nop zx 4|CMP zx 4|DEC zx 6|dcp zx 6|
    CLD 2|CMP ay 4+|nop 2|dcp ay 7|nop ax 4+|CMP ax 4+|DEC ax 7|dcp ax 7|
    CPX # 2|SBC ix 6|nop # 2|isb ix 8|CPX zp 3|SBC zp 3|INC zp 5|isb zp 5|
    INX 2|SBC # 2|NOP 2|sbc # 2|CPX ab 4|SBC ab 4|INC ab 6|isb ab 6|
    BEQ r 2*|SBC iy 5+|jam 2|isb iy 8|nop zx 4|SBC zx 4|INC zx 6|isb zx 6|
    SED 2|SBC ay 4+|nop 2|isb ay 7|nop ax 4+|SBC ax 4+|INC ax 7|isb ax 7|
)";

struct Cell {
  int name = 0, mode = 0, cycles = 0;
  bool penalty = false, documented = false;
};

Cell parse(const std::string& text) {
  Cell cell;
  std::istringstream words(text);
  std::string word;
  words >> word;
  cell.name = op(word.c_str());
  cell.documented = word[0] <= 'Z';  // the others are in lower case
  while (words >> word) {
    const bool is_cycles = word[0] >= '0' && word[0] <= '9';
    if (is_cycles)
      cell.cycles = word[0] - '0';
    else
      cell.mode = op(word.c_str());
    cell.penalty = word.back() == '+';
  }
  return cell;
}

std::array<Cell, 256> parse_grid() {
  std::array<Cell, 256> cells;
  std::istringstream grid(kGrid);
  std::string text;
  for (Cell& cell : cells) {
    std::getline(grid, text, '|');
    cell = parse(text);
  }
  return cells;
}

const std::array<Cell, 256> kCells = parse_grid();

}  // namespace

bool is_documented(int opcode) { return kCells[static_cast<std::size_t>(opcode)].documented; }

void ReferenceCpu::set_status(int p) {
  N = p >> 7 & 1;
  V = p >> 6 & 1;
  D = p >> 3 & 1;
  I = p >> 2 & 1;
  Z = p >> 1 & 1;
  C = p & 1;
}

int ReferenceCpu::read(int address) {
  read_last_ = true;
  return bus_.read(address & 0xFFFF, T);
}

void ReferenceCpu::write(int address, int value) {
  T = bus_.write(address & 0xFFFF, value & 0xFF, T, read_last_);
  read_last_ = false;
}

int ReferenceCpu::fetch() {
  const int value = read(PC);
  PC = (PC + 1) & 0xFFFF;
  return value;
}

int ReferenceCpu::fetch_word() {
  const int low = fetch();
  return low | fetch() << 8;
}

int ReferenceCpu::word_at(int low, int high) {
  const int value = read(low);
  return value | read(high) << 8;
}

void ReferenceCpu::push(int value) {
  write(0x100 | SP, value);
  SP = (SP - 1) & 0xFF;
}

int ReferenceCpu::pull() {
  SP = (SP + 1) & 0xFF;
  return read(0x100 | SP);
}

void ReferenceCpu::nz(int value) {
  N = value >> 7 & 1;
  Z = (value & 0xFF) == 0;
}

void ReferenceCpu::step() {
  if (jammed) return;
  const Cell& cell = kCells[static_cast<std::size_t>(fetch())];
  T += cell.cycles;
  run(cell.name, cell.mode, cell.penalty);
}

// clang-format off
int ReferenceCpu::address_of(int mode, bool penalty) {
  const auto indexed = [&](int base, int index) {
    const int address = (base + index) & 0xFFFF;
    if (penalty && address >> 8 != base >> 8) ++T;
    return address;
  };
  switch (mode) {
    case op("#"): PC = (PC + 1) & 0xFFFF; return (PC - 1) & 0xFFFF;
    case op("zp"): return fetch();
    case op("zx"): return (fetch() + X) & 0xFF;
    case op("zy"): return (fetch() + Y) & 0xFF;
    case op("ab"): return fetch_word();
    case op("ax"): return indexed(fetch_word(), X);
    case op("ay"): return indexed(fetch_word(), Y);
    case op("ix"): {
      const int p = (fetch() + X) & 0xFF;
      return word_at(p, p + 1);
    }
    default: {  // iy
      const int p = fetch();
      return indexed(word_at(p, p + 1), Y);
    }
  }
}
// clang-format on

void ReferenceCpu::run(int name, int mode, bool penalty) {
  if (run_control(name, mode) || (mode == 0 && run_implied(name))) return;
  if (mode == op("A")) {
    A = modify(name, A);
    return;
  }
  const int address = address_of(mode, penalty);
  switch (name) {
    case op("sta"):
    case op("stx"):
    case op("sty"):
    case op("sax"):
    case op("sha"):
    case op("shx"):
    case op("shy"):
    case op("shs"): return store(name, address);
    case op("asl"):
    case op("lsr"):
    case op("rol"):
    case op("ror"):
    case op("inc"):
    case op("dec"):
    case op("slo"):
    case op("rla"):
    case op("sre"):
    case op("rra"):
    case op("dcp"):
    case op("isb"): return write(address, modify(name, read(address)));
    default: return use(name, read(address));
  }
}

void ReferenceCpu::branch(bool taken) {
  const int offset = fetch();
  if (!taken) return;
  const int target = (PC + (offset < 128 ? offset : offset - 256)) & 0xFFFF;
  T += target >> 8 == PC >> 8 ? 1 : 2;
  PC = target;
}

// clang-format off
// Jumps, branches and the stack: section 4. Returns false for other instructions.
bool ReferenceCpu::run_control(int name, int mode) {
  switch (name) {
    case op("bpl"): branch(N == 0); return true;
    case op("bmi"): branch(N == 1); return true;
    case op("bvc"): branch(V == 0); return true;
    case op("bvs"): branch(V == 1); return true;
    case op("bcc"): branch(C == 0); return true;
    case op("bcs"): branch(C == 1); return true;
    case op("bne"): branch(Z == 0); return true;
    case op("beq"): branch(Z == 1); return true;
    case op("jmp"): {
      const int q = fetch_word();
      PC = mode == op("in") ? word_at(q, (q & 0xFF) == 0xFF ? q & 0xFF00 : q + 1) : q;
      return true;
    }
    case op("jsr"): {
      const int low = fetch();
      read(0x100 | SP);
      push(PC >> 8);
      push(PC & 0xFF);
      PC = low | read(PC) << 8;
      return true;
    }
    case op("rts"): {
      read(0x100 | SP);
      const int low = pull();
      const int popped = low | pull() << 8;
      read(popped);
      PC = (popped + 1) & 0xFFFF;
      return true;
    }
    case op("rti"): {
      read(0x100 | SP);
      set_status(pull());
      const int low = pull();
      PC = low | pull() << 8;
      return true;
    }
    case op("brk"):
      fetch();
      push(PC >> 8);
      push(PC & 0xFF);
      push(status());
      I = 1;
      PC = word_at(0xFFFE, 0xFFFF);
      return true;
    case op("pha"): push(A); return true;
    case op("php"): push(status()); return true;
    case op("pla"): read(0x100 | SP); A = pull(); nz(A); return true;
    case op("plp"): read(0x100 | SP); set_status(pull()); return true;
    case op("jam"): jammed = true; return true;
    default: return false;
  }
}

bool ReferenceCpu::run_implied(int name) {
  switch (name) {
    case op("clc"): C = 0; return true;
    case op("sec"): C = 1; return true;
    case op("cli"): I = 0; return true;
    case op("sei"): I = 1; return true;
    case op("cld"): D = 0; return true;
    case op("sed"): D = 1; return true;
    case op("clv"): V = 0; return true;
    case op("tax"): nz(X = A); return true;
    case op("tay"): nz(Y = A); return true;
    case op("txa"): nz(A = X); return true;
    case op("tya"): nz(A = Y); return true;
    case op("tsx"): nz(X = SP); return true;
    case op("txs"): SP = X; return true;
    case op("inx"): nz(X = (X + 1) & 0xFF); return true;
    case op("iny"): nz(Y = (Y + 1) & 0xFF); return true;
    case op("dex"): nz(X = (X - 1) & 0xFF); return true;
    case op("dey"): nz(Y = (Y - 1) & 0xFF); return true;
    default: return true;  // nop
  }
}
// clang-format on

}  // namespace racebeam::test

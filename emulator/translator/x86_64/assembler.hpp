// The x86-64 assembler of one batch of blocks: Xbyak, with labels of our own. Xbyak's own labels allocate
// memory for each label and for each jump.
#pragma once

#include <xbyak/xbyak.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "emulator/translator/label.hpp"
#include "emulator/translator/layout.hpp"
#include "emulator/translator/stubs.hpp"
#include "emulator/translator/window.hpp"

namespace racebeam::translator::x86_64 {

using AssemblyError = Xbyak::Error;  // the memory is full

class Assembler : public Xbyak::CodeGenerator {
 public:
  // Writes to `memory`.
  Assembler(void* memory, std::size_t size, const Layout& places, const Window& seen, const Stubs& shared)
      : CodeGenerator(size, memory), layout(places), window(seen), stubs(shared) {}

  const Layout& layout;
  const Window& window;
  const Stubs& stubs;
  std::unordered_map<std::uint16_t, Label> blocks;  // labels of this batch's blocks, by address

  std::size_t size() const { return getSize(); }
  const void* address_of(std::uint16_t block) { return getCode() + targets_[blocks[block]].place; }

  using CodeGenerator::byte;
  using CodeGenerator::word;
  Xbyak::Address byte_of(std::int32_t place) { return byte[rbx + place]; }
  Xbyak::Address dword_of(std::int32_t place) { return dword[rbx + place]; }

  // Labels and jumps to them, with the names of Xbyak. A forward jump is short unless it is T_NEAR.
  void L(Label& label);
  using CodeGenerator::jmp;
  void jmp(Label& to, LabelType type = T_AUTO) { jump({0xEB, 0xE9, false}, to, type); }
  void jb(Label& to, LabelType type = T_AUTO) { jump_if(0x2, to, type); }
  void jc(Label& to, LabelType type = T_AUTO) { jump_if(0x2, to, type); }
  void jae(Label& to, LabelType type = T_AUTO) { jump_if(0x3, to, type); }
  void jnc(Label& to, LabelType type = T_AUTO) { jump_if(0x3, to, type); }
  void je(Label& to, LabelType type = T_AUTO) { jump_if(0x4, to, type); }
  void jz(Label& to, LabelType type = T_AUTO) { jump_if(0x4, to, type); }
  void jne(Label& to, LabelType type = T_AUTO) { jump_if(0x5, to, type); }
  void jnz(Label& to, LabelType type = T_AUTO) { jump_if(0x5, to, type); }
  void ja(Label& to, LabelType type = T_AUTO) { jump_if(0x7, to, type); }
  void js(Label& to, LabelType type = T_AUTO) { jump_if(0x8, to, type); }
  void jns(Label& to, LabelType type = T_AUTO) { jump_if(0x9, to, type); }
  void jge(Label& to, LabelType type = T_AUTO) { jump_if(0xD, to, type); }

 private:
  struct Opcodes {
    std::uint8_t with_byte, with_dword;
    bool has_prefix;  // with_dword follows 0F
  };

  // A jump to a label that has no place yet. Its displacement ends at `end`.
  struct Jump {
    std::size_t end;
    std::int32_t next;  // the next jump to the same label; -1 if this is the last
    bool is_short;
  };

  struct Target {
    std::int64_t place = -1;  // -1: not known yet
    std::int32_t jumps = -1;  // the last jump to the label, an index in jumps_
  };

  void jump_if(unsigned condition, Label& to, LabelType type) {
    jump({static_cast<std::uint8_t>(0x70 | condition), static_cast<std::uint8_t>(0x80 | condition), true}, to,
         type);
  }
  void jump(const Opcodes& opcodes, Label& to, LabelType type);
  void write_jump(const Opcodes& opcodes, bool is_short);
  void resolve(std::size_t end, bool is_short, std::int64_t place);

  LabelTable<Target> targets_;
  std::vector<Jump> jumps_;
};

}  // namespace racebeam::translator::x86_64

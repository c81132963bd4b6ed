// The places of operands, as x86-64 addresses them.
#pragma once

#include "emulator/translator/host.hpp"

namespace racebeam::translator {

inline Xbyak::RegExp x86_64::Processor::place_of(const Value& value) const {
  const int number = static_cast<int>(value.number);
  switch (value.kind) {
    case Value::Kind::kRam: return ram(value.number);
    case Value::Kind::kPage: return as_.rdx + number;
    default: return as_.r10 + reg_of(value.index).cvt64() + number;
  }
}

// Calls `apply` with the operand: a constant, a place in memory, or al.
template <class Apply>
void x86_64::Processor::with_operand(const Value& value, Apply apply) {
  switch (value.kind) {
    case Value::Kind::kConstant: apply(std::uint32_t{value.number}); break;
    case Value::Kind::kByte: apply(as_.al); break;
    default: apply(as_.byte[place_of(value)]); break;
  }
}

}  // namespace racebeam::translator

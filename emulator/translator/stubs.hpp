// Code that all blocks of an image share.
#pragma once

#include <cstddef>

#include "emulator/translator/layout.hpp"

namespace racebeam::translator {

struct Stubs {
  const void* enter;     // saves the host's registers, loads the 6507's, and jumps to a block
  const void* leave;     // does the reverse; eax or w0 holds the PC, and kInterpretNext if that applies
  const void* read_bus;  // reads a pin itself, and has bus::read read any other address
  std::size_t size;
};

Stubs emit_stubs(void* memory, std::size_t size, const Layout& layout);

}  // namespace racebeam::translator

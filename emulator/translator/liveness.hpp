// Which flags somebody may look at after an instruction of a block. A flag that is overwritten first need not be made.
#pragma once

#include <vector>

#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/window.hpp"

namespace racebeam::translator {

struct Flags {
  bool nz = true, c = true, v = true;
};

// One for each instruction of the block: the flags that are live after it. All are at the block's end, where a branch
// may leave it, after a write that may end the frame, where the state is seen from outside, and after a read that the
// interpreter may have to do, since it may bring other code before the processor.
std::vector<Flags> live_flags(const Block& block, const Window& window);

// Does the instruction write somewhere else than RAM, or may it?
bool may_write_device(const Instruction& instruction);

}  // namespace racebeam::translator

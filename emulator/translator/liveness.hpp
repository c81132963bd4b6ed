// Which flags can be read after an instruction of a block. A flag that is overwritten before it can be read
// is not computed.
#pragma once

#include <vector>

#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/window.hpp"

namespace racebeam::translator {

struct Flags {
  bool nz = true, c = true, v = true;
};

// For each instruction of the block, the flags that are live after it. All flags are live at these places:
// - before PHP, and where a branch, a jump or the end of the block leaves it;
// - after a write that may end the frame, because the state can then be read from outside;
// - after a read that the interpreter may have to execute, because it may switch to other code.
std::vector<Flags> live_flags(const Block& block, const Window& window);

// Whether the instruction writes to a device, or may do so.
bool may_write_device(const Instruction& instruction);

}  // namespace racebeam::translator

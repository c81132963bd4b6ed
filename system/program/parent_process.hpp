// The process that has made this one. Windows does not ask for this.
#pragma once

namespace racebeam {

// From now on, this process gets SIGTERM when its parent ends, also after it has executed another program.
// False if the parent, whose number is `parent`, has ended already, or the system refuses that.
bool end_with_parent(int parent);

}  // namespace racebeam

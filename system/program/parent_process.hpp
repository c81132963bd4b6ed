// The process that has made this one. Not available on Windows.
#pragma once

namespace racebeam {

// From now on, this process gets SIGTERM when its parent ends, also after it has executed another program.
// Returns false if the parent, whose number is `parent`, has ended already, or if the system refuses.
bool end_with_parent(int parent);

}  // namespace racebeam

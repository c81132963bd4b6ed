#include "racebeam/version.hpp"

namespace racebeam::v0 {

const char* version() noexcept { return RACEBEAM_VERSION_STRING; }

}  // namespace racebeam::v0

#include "racebeam/error.hpp"

namespace racebeam::v0 {

Error::Error(Cause cause, const std::string& sentence) : std::runtime_error(sentence), cause_(cause) {}
Error::~Error() = default;

}  // namespace racebeam::v0

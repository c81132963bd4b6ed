#include "protocol/running/pacer.hpp"

#include <string>

#include "protocol/request_error.hpp"

namespace racebeam {

void Pacer::allow_frames(std::int64_t more) {
  allowed_ = more;
  most_frames_ = more < kNoLimit - frames_ ? frames_ + more : kNoLimit;
}

void Pacer::refuse() const {
  throw RequestError(ErrorCode::kLimit, "the request would run more than " + std::to_string(allowed_) +
                                            " frames; powering on, reaching a mode and no-ops count, too");
}

}  // namespace racebeam

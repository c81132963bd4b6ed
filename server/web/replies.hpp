// Cuts the output of a session of the line protocol into replies.
#pragma once

#include <string_view>

namespace racebeam {

struct CutReply {
  std::string_view line;  // without its LF
  std::string_view raw;   // the bytes that follow the line, of fields with the encoding raw
};

// Removes the first reply from `output`, which has whole replies, at least one.
CutReply cut_reply(std::string_view& output);

}  // namespace racebeam

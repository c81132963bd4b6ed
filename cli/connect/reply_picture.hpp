// The picture in replies of the line protocol, for `racebeam png`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

struct ReplyPicture {
  enum class Pixels { kIndices, kRgb, kGrey, kFile };
  Pixels pixels = Pixels::kIndices;
  std::vector<std::uint8_t> bytes;    // row by row; kFile: a PNG, whose size is not told
  std::size_t width = 0, height = 0;  // the screens of a stack are one below the other
  bool resized = false;               // else a row has the 160 wide pixels of the console
  std::vector<std::uint8_t> palette;  // red, green and blue of 256 values, if a reply has it
  std::string format;                 // the television standard that the reply of `load` says, or ""
};

struct PictureRequest {
  std::string field;     // empty: the first that is a picture
  std::string encoding;  // empty: the one that fits
  int machine = -1;      // of `open`; below 0: the first group with the field
};

bool is_reply(std::string_view line);  // of the line protocol: ok or error

// The picture in the last reply that has one. `line` is the first, and the others follow in `input`. Throws
// std::invalid_argument with a sentence.
ReplyPicture last_picture(std::string line, std::istream& input, const PictureRequest& request);

}  // namespace racebeam

// The files of the page (viewer/dist), which are part of the program.
#pragma once

#include <string>
#include <string_view>

namespace racebeam {

struct PageFile {
  std::string_view path;  // of the request, such as /viewer.js
  std::string_view type;  // for the field Content-Type
  std::string tag;        // for the field ETag; files with different bytes have different tags
  std::string_view bytes;
  std::string compressed;  // the bytes, compressed with gzip
};

// Null for an unknown path. `/` stands for /index.html. Thread-safe.
const PageFile* find_page_file(std::string_view path);

}  // namespace racebeam

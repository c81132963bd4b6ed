// The files of viewer/dist, as embed_page.cmake writes them into a source file.
#pragma once

#include <span>
#include <string_view>

namespace racebeam {

struct EmbeddedFile {
  std::string_view path, digest, bytes;  // the digest is the SHA-256 in hexadecimal
};

std::span<const EmbeddedFile> embedded_page();

}  // namespace racebeam

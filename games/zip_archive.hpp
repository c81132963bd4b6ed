// Reads zip archives: their list of files, and files that are stored or deflated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

struct ZipEntry {
  std::string name;
  std::uint16_t flags, method;
  std::uint32_t crc, packed, size, offset;  // the offset is that of the local header
};

bool is_zip(std::string_view bytes);

// All entries, folders included. Throws InvalidInput if the archive is damaged, or has parts elsewhere.
std::vector<ZipEntry> zip_entries(std::string_view archive);

// The contents of one file. Throws InvalidInput if it has more than `most` bytes, even if its entry claims
// fewer, is damaged or encrypted, or is packed in another way.
std::vector<std::uint8_t> unzip(std::string_view archive, const ZipEntry& entry, std::size_t most);

}  // namespace racebeam

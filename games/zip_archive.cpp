#include "games/zip_archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// Signatures and sizes of APPNOTE.TXT, 4.3; lengths of names and comments are not part of the sizes.
constexpr std::string_view kLocal("PK\3\4", 4), kCentral("PK\1\2", 4), kEnd("PK\5\6", 4);
constexpr std::size_t kLocalSize = 30, kCentralSize = 46, kEndSize = 22, kLongestComment = 65535;
constexpr std::uint16_t kStored = 0, kDeflated = 8, kEncrypted = 1;

[[noreturn]] void refuse_damaged() { throw InvalidInput("the zip archive is damaged"); }

std::string_view part(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || size > bytes.size() - at) refuse_damaged();
  return bytes.substr(at, size);
}

std::uint32_t number(std::string_view record, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes; i-- > 0;)
    value = value << 8 | static_cast<std::uint8_t>(record[at + static_cast<std::size_t>(i)]);
  return value;
}

std::uint16_t word(std::string_view record, std::size_t at) {
  return static_cast<std::uint16_t>(number(record, at, 2));
}

std::string_view end_record(std::string_view archive) {
  const std::size_t tail = archive.size() - std::min(archive.size(), kEndSize + kLongestComment);
  const std::size_t at = archive.rfind(kEnd);
  if (at == archive.npos || at < tail) refuse_damaged();
  return part(archive, at, kEndSize);
}

std::string_view packed_bytes(std::string_view archive, const ZipEntry& entry) {
  const std::string_view local = part(archive, entry.offset, kLocalSize);
  if (!local.starts_with(kLocal)) refuse_damaged();
  const std::size_t at = entry.offset + kLocalSize + word(local, 26) + word(local, 28);
  return part(archive, at, entry.packed);
}

// Writes `most` bytes at most.
std::vector<std::uint8_t> inflated(std::string_view packed, std::size_t most) {
  std::vector<std::uint8_t> bytes(most);
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = bytes.data();
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int result = inflate(&stream, Z_FINISH);
  bytes.resize(bytes.size() - stream.avail_out);
  inflateEnd(&stream);
  const bool is_full = result == Z_BUF_ERROR && bytes.size() == most;
  if (result != Z_STREAM_END && !is_full) refuse_damaged();
  return bytes;
}

}  // namespace

bool is_zip(std::string_view bytes) { return bytes.starts_with(kLocal) || bytes.starts_with(kEnd); }

std::vector<ZipEntry> zip_entries(std::string_view archive) {
  const std::string_view end = end_record(archive);
  if (word(end, 8) != word(end, 10)) throw InvalidInput("the zip archive has several parts");
  std::vector<ZipEntry> entries;
  std::size_t at = number(end, 16, 4);
  for (unsigned remaining = word(end, 10); remaining > 0; --remaining) {
    const std::string_view head = part(archive, at, kCentralSize);
    if (!head.starts_with(kCentral)) refuse_damaged();
    const std::string_view name = part(archive, at + kCentralSize, word(head, 28));
    entries.push_back({std::string(name), word(head, 8), word(head, 10), number(head, 16, 4),
                       number(head, 20, 4), number(head, 24, 4), number(head, 42, 4)});
    at += kCentralSize + name.size() + word(head, 30) + word(head, 32);
  }
  return entries;
}

std::vector<std::uint8_t> unzip(std::string_view archive, const ZipEntry& entry, std::size_t most) {
  const auto refuse = [&](const std::string& why) { throw InvalidInput(entry.name + " in it " + why); };
  if ((entry.flags & kEncrypted) != 0) refuse("is encrypted");
  const std::string_view packed = packed_bytes(archive, entry);
  std::vector<std::uint8_t> bytes;
  if (entry.method == kStored) {
    bytes.assign(packed.begin(), packed.begin() + static_cast<long>(std::min(packed.size(), most + 1)));
  } else if (entry.method == kDeflated) {
    bytes = inflated(packed, most + 1);
  } else {
    refuse("is packed by method " + std::to_string(entry.method) + "; 0 and 8 are read");
  }
  if (bytes.size() > most) refuse("has more than " + std::to_string(most) + " bytes");
  if (bytes.size() != entry.size || crc32(0, bytes.data(), static_cast<uInt>(bytes.size())) != entry.crc)
    refuse_damaged();
  return bytes;
}

}  // namespace racebeam

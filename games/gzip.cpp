#include "games/gzip.hpp"

#include <zlib.h>

#include <new>

#include "system/invalid_input.hpp"

namespace racebeam {

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1F\x8B"); }

std::vector<std::uint8_t> gunzip(std::string_view file, std::size_t most) {
  constexpr int kWithHeader = 16;
  std::vector<std::uint8_t> bytes(most + 1);
  z_stream stream{};
  if (inflateInit2(&stream, MAX_WBITS + kWithHeader) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(file.data()));
  stream.avail_in = static_cast<uInt>(file.size());
  stream.next_out = bytes.data();
  stream.avail_out = static_cast<uInt>(bytes.size());
  int result = inflate(&stream, Z_FINISH);
  while (result == Z_STREAM_END && is_gzip(file.substr(file.size() - stream.avail_in)) &&
         inflateReset(&stream) == Z_OK)
    result = inflate(&stream, Z_FINISH);
  bytes.resize(bytes.size() - stream.avail_out);
  inflateEnd(&stream);
  const bool is_full = result == Z_BUF_ERROR && bytes.size() > most;
  if (result == Z_BUF_ERROR && !is_full) throw InvalidInput("the gzip file is truncated");
  if (result != Z_STREAM_END && !is_full) throw InvalidInput("the gzip file is damaged");
  return bytes;
}

}  // namespace racebeam

#include "recording/sealed_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>

#include "system/input_file.hpp"

namespace racebeam {
namespace {

// A sealed file has magic, version, size of the contents and checksum, then the deflated contents.
constexpr std::size_t kVersionAt = 8, kSizeAt = 12, kChecksumAt = 20, kHeadSize = 24;

template <typename T>
void put(std::string& out, T value) {  // the lowest byte first
  for (std::size_t byte = 0; byte < sizeof value; ++byte)
    out += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * byte)));
}

template <typename T>
T get(std::string_view bytes, std::size_t at) {
  T value = 0;
  for (std::size_t byte = 0; byte < sizeof value; ++byte)
    value = static_cast<T>(value | static_cast<T>(static_cast<std::uint8_t>(bytes[at + byte])) << (8 * byte));
  return value;
}

const Bytef* bytes_of(std::string_view text) { return reinterpret_cast<const Bytef*>(text.data()); }

// The checksum covers all bytes except its own four.
std::uint32_t checksum(std::string_view head, std::string_view deflated) {
  const uLong sum = crc32_z(0, bytes_of(head), kChecksumAt);
  return static_cast<std::uint32_t>(crc32_z(sum, bytes_of(deflated), deflated.size()));
}

[[noreturn]] void refuse(const SealedKind& kind, const std::string& name, const std::string& reason) {
  throw InvalidInput(std::string(kind.what).append(" ").append(name).append(": ").append(reason));
}

std::string inflated(const SealedKind& kind, const std::string& name, std::string_view deflated,
                     std::size_t size) {
  std::string contents(size, '\0');
  auto size_found = static_cast<uLongf>(size);
  auto used = static_cast<uLong>(deflated.size());
  const int status =
      uncompress2(reinterpret_cast<Bytef*>(contents.data()), &size_found, bytes_of(deflated), &used);
  if (status != Z_OK || size_found != size || used != deflated.size())
    refuse(kind, name, "its contents are damaged");
  return contents;
}

// A compressing stream of zlib.
class Deflater {
 public:
  explicit Deflater(int level) {
    if (deflateInit(&stream_, level) != Z_OK) throw std::runtime_error("zlib cannot compress");
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  std::size_t bound(std::size_t bytes) { return deflateBound(&stream_, static_cast<uLong>(bytes)); }

  // Appends the compressed piece to `out`, which has room for all.
  void add(std::string_view piece, std::string& out, std::size_t& size, bool is_last) {
    stream_.next_in = const_cast<Bytef*>(bytes_of(piece));  // zlib does not write there
    stream_.avail_in = static_cast<uInt>(piece.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data()) + size;
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(out.size() - size, kMaxOut));
    if (deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH) != (is_last ? Z_STREAM_END : Z_OK))
      throw std::runtime_error("zlib cannot compress");
    size = static_cast<std::size_t>(reinterpret_cast<char*>(stream_.next_out) - out.data());
  }

 private:
  static constexpr std::size_t kMaxOut = std::size_t{1} << 30;  // bytes for a piece, which has far fewer

  z_stream stream_{};
};

std::string deflated(std::string_view contents, int level, const std::function<void()>& pause) {
  constexpr std::size_t kPiece = std::size_t{1} << 14;
  Deflater deflater(level);
  std::string out(deflater.bound(contents.size()), '\0');
  std::size_t size = 0;
  while (contents.size() > kPiece) {
    deflater.add(contents.substr(0, kPiece), out, size, false);
    contents.remove_prefix(kPiece);
    if (pause) pause();
  }
  deflater.add(contents, out, size, true);
  out.resize(size);
  return out;
}

}  // namespace

std::string seal(const SealedKind& kind, std::string_view contents, const std::function<void()>& pause) {
  if (contents.size() > kind.most)
    throw std::runtime_error(std::string("a ").append(kind.what).append(" has at most ") +
                             std::to_string(kind.most) + " bytes");
  const std::string body = deflated(contents, kind.level, pause);
  std::string sealed(kind.magic);
  put(sealed, kind.version);
  put(sealed, std::uint64_t{contents.size()});
  put(sealed, checksum(sealed, body));
  return sealed + body;
}

std::string unseal(const SealedKind& kind, const std::string& name, std::string_view bytes) {
  if (bytes.size() < kHeadSize || !bytes.starts_with(kind.magic))
    refuse(kind, name,
           std::string("it does not begin with ").append(kind.magic) +
               "; it was cut, or is another kind of file");
  const auto version = get<std::uint32_t>(bytes, kVersionAt);
  const std::string_view deflated = bytes.substr(kHeadSize);
  if (version != kind.version)
    refuse(kind, name,
           "it is of version " + std::to_string(version) + "; this program reads version " +
               std::to_string(kind.version));
  const auto size = get<std::uint64_t>(bytes, kSizeAt);
  if (size > kind.most)
    refuse(kind, name,
           "it says that it holds " + std::to_string(size) + " bytes; accepted: at most " +
               std::to_string(kind.most));
  if (checksum(bytes.substr(0, kHeadSize), deflated) != get<std::uint32_t>(bytes, kChecksumAt))
    refuse(kind, name, "its checksum is wrong; it was cut or altered");
  return inflated(kind, name, deflated, static_cast<std::size_t>(size));
}

std::string read_sealed(const SealedKind& kind, const std::string& path) {
  const std::size_t added_by_zlib = kind.most / 1024 + 64;  // to contents that do not deflate, at most
  const std::string bytes =
      read_input_file(std::string(kind.what), path, kHeadSize + kind.most + added_by_zlib);
  return unseal(kind, path, bytes);
}

}  // namespace racebeam

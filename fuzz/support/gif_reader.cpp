#include "fuzz/support/gif_reader.hpp"

namespace racebeam::fuzz {
namespace {

using Buffer = std::vector<std::uint8_t>;

Buffer read_blocks(Reader& reader) {
  Buffer all;
  while (const std::size_t size = reader.byte()) {
    const Bytes block = reader.take(size);
    require(block.size() == size, "a block of a GIF is whole");
    all.insert(all.end(), block.begin(), block.end());
  }
  return all;
}

class Codes {
 public:
  explicit Codes(Bytes packed) : reader_(packed) {}

  unsigned next(int width) {
    for (; count_ < width; count_ += 8) {
      require(!reader_.empty(), "LZW ends with its end code");
      bits_ |= static_cast<std::uint32_t>(reader_.byte()) << count_;
    }
    const unsigned code = bits_ & ((1U << width) - 1);
    bits_ >>= width;
    count_ -= width;
    return code;
  }

 private:
  Reader reader_;
  std::uint32_t bits_ = 0;
  int count_ = 0;
};

}  // namespace

// See the specification GIF89a, appendix F.
Buffer unpack_lzw(Reader& reader) {
  constexpr std::size_t kLargest = 4096;
  const int root = reader.byte();
  require(root >= 2 && root <= 8, "the size of LZW codes is 2 to 8");
  const unsigned clear = 1U << root, end = clear + 1;
  const Buffer packed = read_blocks(reader);
  Codes codes(packed);
  std::vector<Buffer> table;
  const auto start_again = [&] {
    table.assign(clear + 2, {});
    for (unsigned code = 0; code < clear; ++code) table[code] = {static_cast<std::uint8_t>(code)};
  };
  start_again();
  Buffer pixels, before;
  int width = root + 1;
  for (;;) {
    const unsigned code = codes.next(width);
    if (code == end) return pixels;
    if (code == clear) {
      start_again();
      before.clear();
      width = root + 1;
      continue;
    }
    const bool is_new = code == table.size() && !before.empty();
    require(code < table.size() || is_new, "an LZW code exists");
    Buffer sequence = is_new ? before : table[code];
    if (is_new) sequence.push_back(before.front());
    pixels.insert(pixels.end(), sequence.begin(), sequence.end());
    if (!before.empty() && table.size() < kLargest) {
      before.push_back(sequence.front());
      table.push_back(std::move(before));
      if (table.size() == 1U << width && width < 12) ++width;
    }
    before = std::move(sequence);
  }
}

Gif read_gif(Bytes file) {
  Reader reader(file);
  require(text_of(reader.take(6)) == "GIF89a", "a GIF begins with its version");
  Gif gif{};
  gif.width = reader.word();
  gif.height = reader.word();
  const unsigned flags = reader.byte();
  reader.take(2);
  require((flags & 0x80) != 0, "a GIF has colours");
  reader.take(3U << ((flags & 7) + 1));
  for (;;) {
    const unsigned kind = reader.byte();
    if (kind == 0x21) {
      reader.take(1);
      read_blocks(reader);
    } else if (kind == 0x2C) {
      require(reader.word() == 0 && reader.word() == 0, "a frame of a GIF begins at its corner");
      require(reader.word() == gif.width && reader.word() == gif.height,
              "a frame of a GIF is as large as the GIF");
      require(reader.byte() == 0, "a frame of a GIF must not have its own colours");
      gif.frames.push_back(unpack_lzw(reader));
    } else {
      require(kind == 0x3B && reader.empty(), "a GIF ends with its last byte");
      return gif;
    }
  }
}

}  // namespace racebeam::fuzz

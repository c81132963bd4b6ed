// Bytes as text and back, in every encoding of the protocols; numbers, actions and lines from text.
#include "protocol/encoding/encoding.hpp"

#include <zlib.h>

#include <cerrno>
#include <cstdlib>
#include <limits>
#include <vector>

#include "fuzz/support/target.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/text.hpp"
#include "protocol/line/action.hpp"
#include "protocol/line/line_reader.hpp"
#include "protocol/request_error.hpp"
#include "system/words.hpp"

namespace racebeam::fuzz {
namespace {

using Buffer = std::vector<std::uint8_t>;

template <class Append>
std::string written(Append append, Bytes bytes) {
  std::string text;
  append(text, bytes);
  return text;
}

bool same(Bytes a, Bytes b) { return std::ranges::equal(a, b); }

Buffer runs_of(Bytes pairs) {
  Buffer bytes;
  for (std::size_t at = 0; at + 1 < pairs.size(); at += 2) {
    require(pairs[at + 1] > 0, "a run is at least one byte long");
    bytes.insert(bytes.end(), pairs[at + 1], pairs[at]);
  }
  return bytes;
}

// Applies records as protocol/PROTOCOL.md describes.
void apply_delta(Bytes records, Buffer& array) {
  Reader reader(records);
  std::size_t place = 0;
  while (!reader.empty()) {
    const std::size_t high = reader.byte();
    place += high << 8 | reader.byte();
    for (unsigned runs = reader.byte(); runs > 0; --runs) {
      const std::uint8_t value = reader.byte();
      const std::size_t length = reader.byte();
      require(place + length <= array.size(), "a delta stays within its field");
      std::fill_n(array.begin() + static_cast<std::ptrdiff_t>(place), length, value);
      place += length;
    }
  }
}

void check_hex_and_runs(Bytes bytes) {
  const auto hex = [](Simd form) {
    return [form](std::string& out, Bytes all) { append_hex(out, all, form); };
  };
  const auto runs = [](Simd form) {
    return [form](std::string& out, Bytes all) { append_run_length(out, all, form); };
  };
  const std::string digits = written(hex(Simd::kPlain), bytes), lengths = written(runs(Simd::kPlain), bytes);
  require(same(bytes_of_hex(digits), bytes), "hex gives back what it was made of");
  require(same(runs_of(bytes_of_hex(lengths)), bytes), "runs give back what they were made of");
  for (const Simd form : supported_simd()) {
    require(written(hex(form), bytes) == digits, "all forms of append_hex are the same");
    require(written(runs(form), bytes) == lengths, "all forms of append_run_length are the same");
  }
}

void check_delta(Bytes bytes) {
  const std::size_t size = bytes.size() / 2;
  Buffer array(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)), before = array;
  const Bytes after = bytes.subspan(size, size);
  std::string text;
  append_delta(text, after, before);
  require(same(before, after), "a delta leaves what it leads to");
  apply_delta(bytes_of_hex(text), array);
  require(same(array, after), "a delta leads to what it was made for");
}

void check_base64(Bytes bytes) {
  const std::string text = written(append_base64, bytes);
  const auto read = bytes_of_base64(text);
  require(read && same(*read, bytes), "base64 gives back what it was made of");
  require(text.size() == text_size(Encoding::kBase64, bytes.size()),
          "the size of base64 is known beforehand");
}

void check_zlib(Bytes bytes) {
  Encoder encoder(Encoding::kZlib);
  for (int reply = 0; reply < 2; ++reply) {
    std::string text, raw;
    encoder.append(text, bytes, raw);
    const auto packed = bytes_of_base64(text);
    require(packed.has_value(), "zlib is written as base64");
    Buffer unpacked(bytes.size() + 1);
    uLongf size = unpacked.size();
    const int status = uncompress(unpacked.data(), &size, packed->data(), packed->size());
    require(status == Z_OK && same(Bytes(unpacked).first(size), bytes),
            "zlib gives back what it was made of");
  }
}

// A reader of client input either accepts it, or refuses it with a sentence.
template <class Read>
void may_refuse(Read read) {
  try {
    read();
  } catch (const RequestError& error) {
    require(*error.what() != '\0', "an error has a message");
  } catch (const InvalidInput& error) {
    require(*error.what() != '\0', "an error has a message");
  }
}

void check_numbers(const std::string& text) {
  errno = 0;
  const long number = std::strtol(text.c_str(), nullptr, 10);
  constexpr long kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max();
  require(parse_integer(text.c_str()) == std::clamp(number, kMin, kMax), "parse_integer reads as atoi does",
          text);
  std::array<int, 4> values{};
  require(parse_integers(text, values) <= values.size(), "no more numbers are read than there is room for");
}

void check_words(std::string_view text) {
  std::vector<std::string_view> words;
  split(text, words);
  for (const std::string_view word : words) {
    require(!word.empty() && word.find(' ') == std::string_view::npos, "a word has no blanks");
    may_refuse([&] {
      const Action action = parse_action(word, {"a game", 0x3FFFF, 0x3FFFF});
      const Act& act = action.act;
      require(act.a >= 0 && act.a < 18 && act.b >= 18 && act.b < 36, "actions are those of the players");
      require(std::isfinite(act.strength_a) && std::isfinite(act.strength_b), "strengths are finite");
      require(action.times >= 1, "an action is played at least once");
    });
    may_refuse([&] {
      const auto digits =
          written([](std::string& out, Bytes all) { append_hex(out, all); }, bytes_of_hex(word));
      require(digits.size() == word.size(), "two digits make a byte");
    });
    if (const auto bytes = bytes_of_base64(word))
      require(bytes->size() <= word.size() / 4 * 3, "base64 makes at most three bytes of four letters");
  }
}

std::vector<std::string> lines_of(std::string_view text, std::size_t piece) {
  LineReader reader(100);
  std::vector<std::string> lines;
  const auto listen = [&] {
    while (const auto line = reader.next())
      lines.push_back(std::to_string(int(line->kind)) + std::string(line->text));
    if (reader.growth() > 0) reader.grow();
  };
  while (!text.empty()) {
    const auto space = reader.space();
    const std::size_t count = std::min({space.size(), text.size(), piece});
    require(count > 0, "a reader that has given its lines has space");
    std::copy_n(text.begin(), count, space.begin());
    reader.added(count);
    text.remove_prefix(count);
    listen();
  }
  reader.end();
  listen();
  return lines;
}

}  // namespace

void run(Bytes input) {
  const std::string_view text = text_of(input);
  check_hex_and_runs(input);
  check_delta(input);
  check_base64(input);
  check_zlib(input);
  check_numbers(std::string(text));
  check_words(text);
  const std::size_t piece = 1 + (input.empty() ? 0 : input[0]) % 16U;
  require(lines_of(text, piece) == lines_of(text, text.size()),
          "lines do not depend on the pieces that they come in");
}

}  // namespace racebeam::fuzz

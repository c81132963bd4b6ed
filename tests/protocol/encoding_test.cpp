#include "protocol/encoding/encoding.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <random>

#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/text.hpp"
#include "system/words.hpp"

using namespace racebeam;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes text_bytes(std::string_view text) { return {text.begin(), text.end()}; }

std::string base64(std::string_view text) {
  std::string out;
  append_base64(out, text_bytes(text));
  return out;
}

// See protocol/PROTOCOL.md.
void apply_delta(Bytes& array, const std::string& text) {
  const Bytes data = bytes_of_hex(text);
  std::size_t place = 0;
  for (std::size_t at = 0; at < data.size();) {
    place += data[at] << 8 | data[at + 1];
    int runs = data[at + 2];
    at += 3;
    for (; runs > 0; --runs, at += 2) {
      for (int length = data[at + 1]; length > 0; --length) array.at(place++) = data[at];
    }
  }
}

std::string delta(const Bytes& bytes, Bytes before) {
  std::string text;
  append_delta(text, bytes, before);
  CHECK(before == bytes);
  return text;
}

}  // namespace

TEST_CASE("Base64 is that of RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  for (const std::string text : {"", "f", "fo", "foo", "foob", "fooba", "foobar"})
    CHECK(bytes_of_base64(base64(text)) == text_bytes(text));
  std::string all;  // groups of every length, with every byte at every place
  for (int i = 0; i < 800; ++i) {
    REQUIRE(bytes_of_base64(base64(all)) == text_bytes(all));
    all += static_cast<char>(i * 5);
  }
}

TEST_CASE("Invalid base64 is refused") {
  for (const std::string text :
       {"Z", "Zg", "Zg=", "Zg===", "=Zg=", "Z=g=", "Zm9v Zg==", "Zm9\n", "Zh==", "Zm9=", "===="}) {
    INFO(text);
    CHECK_FALSE(bytes_of_base64(text));
  }
}

TEST_CASE("A delta without a change is empty") { CHECK(delta(Bytes(1000, 7), Bytes(1000, 7)).empty()); }

TEST_CASE("A change is written as its position and its runs") {
  Bytes bytes(100);
  bytes[50] = bytes[51] = 0xAB;
  CHECK(delta(bytes, Bytes(100)) == "003201AB02");
  bytes[99] = 1;
  CHECK(delta(bytes, Bytes(100)) == "003201AB02002F010101");
}

TEST_CASE("Changes that are near each other share a record") {
  Bytes bytes(100);
  bytes[10] = 1;
  bytes[14] = 2;
  CHECK(delta(bytes, Bytes(100)) == "000A03010100030201");
}

TEST_CASE("Long gaps, long runs and many runs are cut") {
  Bytes far(100'000);
  far[99'999] = 9;
  CHECK(delta(far, Bytes(100'000)) == "FFFF0086A0010901");
  CHECK(delta(Bytes(300, 5), Bytes(300)) == "00000205FF052D");
  Bytes noise(1000);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<std::uint8_t>(1 + i % 2);
  Bytes copy(1000);
  apply_delta(copy, delta(noise, Bytes(1000)));
  CHECK(copy == noise);
}

TEST_CASE("A client that applies each delta has what the server has") {
  std::mt19937 random(2);
  Bytes now(5000), copy(5000);
  Encoder encoder(Encoding::kDelta);
  for (int reply = 0; reply < 300; ++reply) {
    for (auto changes = random() % 20; changes > 0; --changes) {
      const std::size_t begin = random() % now.size(), end = std::min(now.size(), begin + random() % 600);
      std::fill(now.begin() + static_cast<long>(begin), now.begin() + static_cast<long>(end),
                static_cast<std::uint8_t>(random() % 3));
    }
    std::string text, raw;
    encoder.append(text, now, raw);
    apply_delta(copy, text);
    REQUIRE(copy == now);
  }
}

TEST_CASE("raw writes a length, and the bytes elsewhere") {
  Encoder encoder(Encoding::kRaw);
  std::string text = "a=", raw = "x";
  encoder.append(text, Bytes{0, 10, 255}, raw);
  CHECK(text == "a=3");
  CHECK(raw == std::string("x\0\n\xFF", 4));
  CHECK(text_size(Encoding::kRaw, 3) == 3);
}

TEST_CASE("A value in pieces is the same text") {
  std::mt19937 random(3);
  Bytes value(300'000);
  for (std::size_t at = 0; at < value.size();) {  // noise, short runs, and runs longer than a piece
    const std::size_t length =
        std::min<std::size_t>(value.size() - at, random() % 50 == 0 ? 70'000 : 1 + random() % 300);
    const bool noise = random() % 2 == 0;
    for (const std::size_t end = at + length; at < end; ++at)
      value[at] = static_cast<std::uint8_t>(noise ? random() : length);
  }
  for (const EncodingRow& row : encodings()) {
    INFO(row.name);
    int pauses = 0;
    std::string whole, pieces, whole_raw, pieces_raw;
    Encoder(row.encoding).append(whole, value, whole_raw);
    Encoder(row.encoding).append(pieces, value, pieces_raw, [&pauses] { ++pauses; });
    CHECK(pauses >= 3);  // runs are longer than a piece here
    CHECK(whole == pieces);
    CHECK(whole_raw == pieces_raw);
  }
  std::string runs, raw, at_once;
  append_run_length(at_once, value);
  Encoder(Encoding::kRunLength).append(runs, value, raw);
  CHECK(runs == at_once);
}

TEST_CASE("No text is longer than its greatest length, which can be reached") {
  std::mt19937 random(4);
  Bytes noise(50'000), ramp(50'000), flat(50'000, 7);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = static_cast<std::uint8_t>(random());
    ramp[i] = static_cast<std::uint8_t>(i + 1);
  }
  for (const EncodingRow& row : encodings()) {
    std::size_t longest = 0;
    for (const Bytes& value : {noise, ramp, flat}) {
      std::string text, raw;
      Encoder(row.encoding).append(text, value, raw);
      const std::size_t size = row.encoding == Encoding::kRaw ? raw.size() : text.size();
      longest = std::max(longest, size);
      CHECK(size <= text_size(row.encoding, value.size()));
    }
    INFO(row.name);
    CHECK(100 * longest > 99 * text_size(row.encoding, noise.size()));
  }
}

TEST_CASE("zlib gives back what went in, reply after reply") {
  Encoder encoder(Encoding::kZlib);
  for (int reply = 0; reply < 3; ++reply) {
    Bytes bytes(10'000, static_cast<std::uint8_t>(reply)), unpacked(bytes.size());
    bytes[77] = 200;
    std::string text = "x", raw;
    encoder.append(text, bytes, raw);
    const auto packed = bytes_of_base64(text.substr(1));
    REQUIRE(packed);
    uLongf size = unpacked.size();
    REQUIRE(uncompress(unpacked.data(), &size, packed->data(), packed->size()) == Z_OK);
    CHECK(unpacked == bytes);
    CHECK(size == bytes.size());
  }
}

// Measures the cost of decoding a field for a client in C++. Not a test; scripts/bench encodings runs it.
//   decode_bench ENCODING SIZE < texts      one text a line; prints microseconds of processor time per text
#include <time.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/encoding/base64.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Decode = void (*)(const std::string& text, Bytes& array);

constexpr int kRounds = 7;

double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

constexpr unsigned digit(char c) { return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'A' + 10); }

std::uint8_t byte_at(const std::string& text, std::size_t at) {
  return static_cast<std::uint8_t>(digit(text[at]) << 4 | digit(text[at + 1]));
}

void decode_hex(const std::string& text, Bytes& array) {
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = byte_at(text, 2 * i);
}

// Reads `count` runs of `text` from `at` on, or those up to its end. Advances `place` and `at`.
void decode_runs(const std::string& text, std::size_t& at, std::size_t count, Bytes& array,
                 std::size_t& place) {
  for (; count > 0 && at < text.size(); --count, at += 4) {
    const std::size_t length = byte_at(text, at + 2);
    std::fill_n(&array.at(place), length, byte_at(text, at));
    place += length;
  }
}

void decode_run_length(const std::string& text, Bytes& array) {
  std::size_t at = 0, place = 0;
  decode_runs(text, at, text.size(), array, place);
}

void decode_delta(const std::string& text, Bytes& array) {
  for (std::size_t at = 0, place = 0; at < text.size();) {
    place += static_cast<std::size_t>(byte_at(text, at)) << 8 | byte_at(text, at + 2);
    const std::size_t runs = byte_at(text, at + 4);
    at += 6;
    decode_runs(text, at, runs, array, place);
  }
}

void decode_base64(const std::string& text, Bytes& array) { array = racebeam::bytes_of_base64(text).value(); }

void decode_zlib(const std::string& text, Bytes& array) {
  const Bytes packed = racebeam::bytes_of_base64(text).value();
  uLongf size = array.size();
  if (uncompress(array.data(), &size, packed.data(), packed.size()) != Z_OK || size != array.size())
    throw std::runtime_error("a text is not of that size");
}

const std::map<std::string, Decode> kDecoders = {{"hex", decode_hex},
                                                 {"rle", decode_run_length},
                                                 {"delta", decode_delta},
                                                 {"base64", decode_base64},
                                                 {"zlib", decode_zlib}};

}  // namespace

int main(int count, char** words) {
  if (count != 3 || !kDecoders.contains(words[1])) {
    std::cerr << "decode_bench takes an encoding and the size of the field in bytes\n";
    return 2;
  }
  const Decode decode = kDecoders.at(words[1]);
  const auto size = static_cast<std::size_t>(std::atoi(words[2]));
  std::vector<std::string> texts;
  for (std::string line; std::getline(std::cin, line);) texts.push_back(line);
  std::array<double, kRounds> rounds{};
  unsigned long sum = 0;
  for (double& round : rounds) {
    Bytes array(size);
    const double start = seconds();
    for (const std::string& text : texts) decode(text, array);
    round = (seconds() - start) / static_cast<double>(texts.size()) * 1e6;
    sum = adler32(1, array.data(), static_cast<uInt>(array.size()));
  }
  std::printf("%.3f %lu\n", *std::ranges::min_element(rounds), sum);
}

#include "server/access/tokens.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "server/operation/log.hpp"
#include "system/input_file.hpp"
#include "system/output_file.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kShortest = 16, kLongest = 1024, kLargestFile = 1 << 24;

bool is_comment(std::string_view line) { return line.empty() || line.starts_with('#'); }

std::string_view trimmed(std::string_view line) {
  while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
  return line;
}

bool is_token(std::string_view text) {
  return text.size() >= kShortest && text.size() <= kLongest &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}

void warn_if_open(const std::string& path) {
  if (!all_may_read(path)) return;
  log_warning("every user of this machine can read the tokens in " + path + "; chmod 600 keeps them");
}

}  // namespace

Tokens::Tokens(std::string path, const std::string& own) : path_(std::move(path)) {
  if (!own.empty()) own_.push_back(digest_of(own));
  digests_ = all();
}

std::vector<Tokens::Digest> Tokens::all() const {
  std::vector<Digest> digests = path_.empty() ? std::vector<Digest>() : read(path_);
  digests.insert(digests.end(), own_.begin(), own_.end());
  return digests;
}

void Tokens::read_again() {
  auto digests = all();
  const std::lock_guard lock(mutex_);
  digests_.swap(digests);
}

std::size_t Tokens::count() const {
  const std::lock_guard lock(mutex_);
  return digests_.size();
}

bool Tokens::admits(std::string_view token) const {
  const Digest candidate = digest_of(token);
  const std::lock_guard lock(mutex_);
  bool is_known = false;
  for (const Digest& digest : digests_)
    is_known |= CRYPTO_memcmp(digest.data(), candidate.data(), digest.size()) == 0;
  return is_known;
}

Tokens::Digest Tokens::digest_of(std::string_view token) {
  Digest digest{};
  if (EVP_Digest(token.data(), token.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("libcrypto does not provide SHA-256");
  return digest;
}

std::vector<Tokens::Digest> Tokens::read(const std::string& path) {
  std::istringstream file(read_input_file("cannot read the token file", path, kLargestFile));
  std::vector<Digest> digests;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string_view text = trimmed(line);
    if (is_comment(text)) continue;
    if (!is_token(text)) {
      throw std::runtime_error(path + ", line " + std::to_string(number) +
                               ": a token must have 16 to 1024 printable characters and no blanks");
    }
    digests.push_back(digest_of(text));
  }
  if (digests.empty()) throw std::runtime_error(path + " has no token");
  warn_if_open(path);
  return digests;
}

std::string random_token() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<unsigned char, 32> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("libcrypto gives no random bytes for a token");
  std::string text;
  for (const unsigned char byte : bytes) (text += kDigits[byte >> 4]) += kDigits[byte & 15];
  return text;
}

}  // namespace racebeam

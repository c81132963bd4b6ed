// The tokens that clients may use: those of a file, which can be read again while the server runs, and one
// that the server has generated.
#pragma once

#include <array>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

class Tokens {
 public:
  // Reads a file with one token a line: 16 to 1024 printable characters without blanks. Empty lines, and
  // lines that begin with #, are ignored. Throws std::runtime_error with a sentence that names the line. An
  // empty path stands for no file. own: another token to admit; empty for none.
  explicit Tokens(std::string path, const std::string& own = {});

  void read_again();  // throws like the constructor, and then does not change anything
  std::size_t count() const;

  // Thread-safe. The time that it takes does not depend on how much of the token is right.
  bool admits(std::string_view token) const;

 private:
  using Digest = std::array<unsigned char, 32>;
  static Digest digest_of(std::string_view token);
  static std::vector<Digest> read(const std::string& path);
  std::vector<Digest> all() const;

  std::string path_;
  std::vector<Digest> own_;  // at most one
  mutable std::mutex mutex_;
  std::vector<Digest> digests_;  // SHA-256: all have the same length, so that comparisons take constant time
};

std::string random_token();  // 64 hexadecimal digits

}  // namespace racebeam

// Who may play: the tokens of a file. They can be read again while the server runs.
#pragma once

#include <array>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

class Tokens {
 public:
  // A file with a token a line: 16 to 1024 printable characters without blanks. Empty lines and those that
  // begin with # are comments. Throws std::runtime_error with a sentence that names the line.
  explicit Tokens(std::string path);

  void read_again();  // throws like the constructor; the tokens of before stay then
  std::size_t count() const;

  // From any thread. How long it takes does not tell how much of the token was right.
  bool admits(std::string_view token) const;

 private:
  using Digest = std::array<unsigned char, 32>;
  static Digest digest_of(std::string_view token);
  static std::vector<Digest> read(const std::string& path);

  std::string path_;
  mutable std::mutex mutex_;
  std::vector<Digest> digests_;  // SHA-256: all of one length, so that comparing them takes one time
};

}  // namespace racebeam

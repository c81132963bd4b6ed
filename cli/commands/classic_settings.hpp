// The command line and the configuration files of ALE 0.4-0.6 (docs/spec/classic-protocol.md, 7).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace racebeam {

class ClassicSettings {
 public:
  // Reads ale.cfg, then the words, then the file of the key `config`; later values override earlier ones.
  // Throws std::invalid_argument if none of them names an image.
  explicit ClassicSettings(const std::vector<std::string>& words);

  // Whether `word`, -help or --help, is among the keys.
  static bool asks_for(const std::string& word, const std::vector<std::string>& words);

  const std::string& image() const { return image_; }

  std::string text(const std::string& key) const;  // empty if it is not set
  // Throw std::invalid_argument, with the key and what it accepts.
  int number(const std::string& key, int otherwise) const;
  std::uint32_t seed(const std::string& key) const;  // 0 if it is not set, or is the word time
  float real(const std::string& key, float otherwise) const;
  bool truth(const std::string& key, bool otherwise) const;

 private:
  void read_words(const std::vector<std::string>& words);
  void read_file(const std::string& path);

  std::map<std::string, std::string> values_;
  std::string image_;
};

}  // namespace racebeam

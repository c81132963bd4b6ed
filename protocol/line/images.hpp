// The cartridge images that clients may load: by name or MD5, never by path. Looked at once, when the server
// starts; const after that, and shared by all sessions.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "games/catalogue.hpp"

namespace racebeam {

class Images {
 public:
  Images();  // those that are part of the program

  // Both throw InvalidInput for what can't be read. A file in a folder that can't is left out.
  // `game`, `game_file`: how to score it, as recognise() has it.
  void add_file(const std::string& path, const std::optional<std::string>& game = std::nullopt,
                const std::optional<std::string>& game_file = std::nullopt);
  void add_folder(const std::string& folder);

  // `name`: a game of the catalogue, the stem of an unknown image's file, or an MD5. Null if there is none.
  const Cartridge* find(std::string_view name) const;
  std::vector<std::string_view> names() const;  // without the MD5s

 private:
  void add(Cartridge cartridge, bool certain);

  struct Entry {
    Cartridge cartridge;
    bool certain;  // recognised by its MD5, or told so; wins over one that is only called like it
  };
  std::map<std::string, Entry, std::less<>> by_name_, by_md5_;
};

}  // namespace racebeam

// The shared sessions that a session watches, and the fields of each that it was last sent.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "protocol/line/field.hpp"
#include "protocol/line/share.hpp"

namespace racebeam {

// The shared session of one name, as a watcher asks for it. Another session may share its game under the name
// later.
class Watched {
 public:
  bool ended() const { return !place_ || place_->share().ended(); }
  std::shared_ptr<const Snapshot> newest() { return place_->share().newest(); }

  void enter(std::unique_ptr<Share::Place> place) { place_ = std::move(place); }
  void leave() { place_.reset(); }

  // Appends " name=value" for each field. The encoding delta has the changes since the last reply with the
  // same fields and a screen of the same height.
  void append(std::string& out, std::string& raw, const std::vector<Field>& fields, const Snapshot& snapshot);

  std::size_t footprint() const { return footprint_; }  // estimated bytes of memory

 private:
  void choose(const std::vector<Field>& fields, int height);

  std::unique_ptr<Share::Place> place_;
  std::vector<Field> fields_;
  int height_ = 0;
  std::vector<Encoder> encoders_;  // one for each field
  std::size_t footprint_ = 1024;
};

// Fields that a watcher may ask for: screen, ram and palette. Throws RequestError.
std::vector<Field> parse_watched_fields(Words words);

// What a session watches, by the name of the shared session.
using Watching = std::map<std::string, Watched, std::less<>>;

}  // namespace racebeam

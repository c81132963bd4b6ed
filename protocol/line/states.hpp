// The states that a session keeps, by name.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "protocol/line/loaded_machine.hpp"

namespace racebeam {

class States {
 public:
  using Map = std::map<std::string, Slot::Saved, std::less<>>;

  const Slot::Saved* find(std::string_view name) const;  // null: unknown
  bool contains(std::string_view name) const { return by_name_.contains(name); }
  void put(std::string_view name, Slot::Saved place);  // replaces a state of the same name
  void drop(std::string_view name);                    // if it is there

  std::size_t size() const { return by_name_.size(); }
  bool empty() const { return by_name_.empty(); }
  Map::const_iterator begin() const { return by_name_.begin(); }
  Map::const_iterator end() const { return by_name_.end(); }

  std::size_t footprint() const { return footprint_; }  // bytes of memory, about

 private:
  Map by_name_;
  std::size_t footprint_ = 0;
};

}  // namespace racebeam

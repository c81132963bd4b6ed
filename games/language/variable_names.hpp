// The variables of one game's rule. A variable gets its place in the tally when something first asks for the
// value that it had before the step; names that nobody asks for in this way are temporaries of the step and
// take no place.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "games/game/rule.hpp"

namespace racebeam {

class VariableNames {
 public:
  VariableNames();  // with reward and terminal, in their slots

  // Throws InvalidInput for a word that the language needs itself, or that is no name.
  void declare(std::string_view name);
  void reset_to(std::string_view name, std::int32_t initial);
  void keep(std::string_view name);

  bool knows(std::string_view name) const { return all_.find(name) != all_.end(); }
  int slot(std::string_view
               name);  // of a name that is known; throws InvalidInput when there are too many
  std::optional<int> slot_if_used(std::string_view name) const;
  std::vector<Variable> variables() const;  // in order of slots

 private:
  struct Entry {
    Variable variable;
    int slot = -1;
  };
  Entry& entry(std::string_view name);

  std::map<std::string, Entry, std::less<>> all_;
  int slots_ = 0;
};

}  // namespace racebeam

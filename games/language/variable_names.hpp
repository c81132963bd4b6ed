// The variables of one game's rule. A variable gets a slot in the rule's state when its value from before the
// step is first read. Other names are temporaries of the step, without a slot.
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

  // Throws InvalidInput if it is a word of the language, or no valid name.
  void declare(std::string_view name);
  void reset_to(std::string_view name, std::int32_t initial);
  void keep(std::string_view name);

  bool knows(std::string_view name) const { return all_.find(name) != all_.end(); }
  int slot(std::string_view name);  // of a known name; throws InvalidInput if there are too many
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

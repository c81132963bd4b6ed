#include "games/language/variable_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "games/language/lexer.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::string_view, 19> kReserved = {
    "ram", "mem", "bcd",  "wrap",  "prev", "if",     "min", "max",        "s8",  "u8",
    "sum", "rng", "mode", "while", "else", "select", "act", "soft_reset", "fail"};

bool is_name(std::string_view text) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), fits);
}

}  // namespace

VariableNames::VariableNames() {
  declare("reward");
  declare("terminal");
  slot("reward");
  slot("terminal");
}

void VariableNames::declare(std::string_view name) {
  if (!is_name(name)) throw InvalidInput(quoted(name) + " is not a name; a name has letters, digits and _");
  if (std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end())
    throw InvalidInput(quoted(name) + " is a word of the rule language and cannot name a variable");
  if (!knows(name)) all_[std::string(name)].variable.name = name;
}

void VariableNames::reset_to(std::string_view name, std::int32_t initial) {
  declare(name);
  entry(name).variable.initial = initial;
}

void VariableNames::keep(std::string_view name) {
  declare(name);
  entry(name).variable.kept = true;
}

VariableNames::Entry& VariableNames::entry(std::string_view name) { return all_.find(name)->second; }

int VariableNames::slot(std::string_view name) {
  int& place = entry(name).slot;
  if (place < 0 && slots_ == kMaxVariables)
    throw InvalidInput("more than " + std::to_string(kMaxVariables) +
                       " variables persist from frame to frame");
  if (place < 0) place = slots_++;
  return place;
}

std::optional<int> VariableNames::slot_if_used(std::string_view name) const {
  const auto found = all_.find(name);
  return found == all_.end() || found->second.slot < 0 ? std::nullopt : std::optional(found->second.slot);
}

std::vector<Variable> VariableNames::variables() const {
  std::vector<Variable> list(static_cast<std::size_t>(slots_));
  for (const auto& [name, entry] : all_)
    if (entry.slot >= 0) list[static_cast<std::size_t>(entry.slot)] = entry.variable;
  return list;
}

}  // namespace racebeam

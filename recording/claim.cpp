#include "recording/claim.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace racebeam {
namespace {

// Whether `folder` is `name`, or a folder that contains it.
bool is_above(const std::string& folder, const std::string& name) {
  return name.starts_with(folder) && (name.size() == folder.size() || name[folder.size()] == '/');
}

}  // namespace

bool Claims::empty() const {
  const std::lock_guard lock(mutex_);
  return names_.empty();
}

void Claims::add(const std::vector<std::string>& names) {
  const std::lock_guard lock(mutex_);
  if (names_.size() + names.size() > most_)
    throw std::runtime_error("the server would record into " + std::to_string(names_.size() + names.size()) +
                             " files at the same time; the limit is " + std::to_string(most_) +
                             "; try again later");
  for (const std::string& name : names) {
    const auto is_same_place = [&](const std::string& taken) {
      return is_above(taken, name) || is_above(name, taken);
    };
    if (std::ranges::any_of(names_, is_same_place))
      throw std::runtime_error(name + " is being recorded already; choose another name");
  }
  names_.insert(names.begin(), names.end());
}

void Claims::drop(const std::vector<std::string>& names) {
  const std::lock_guard lock(mutex_);
  for (const std::string& name : names) names_.erase(name);
}

Claim::Claim(std::shared_ptr<Claims> claims, std::vector<std::string> names)
    : claims_(std::move(claims)), names_(std::move(names)) {
  claims_->add(names_);
}

}  // namespace racebeam

#include "recording/claim.hpp"

#include <stdexcept>
#include <utility>

namespace racebeam {

bool Claims::empty() const {
  const std::lock_guard lock(mutex_);
  return names_.empty();
}

void Claims::add(const std::vector<std::string>& names) {
  const std::lock_guard lock(mutex_);
  for (const std::string& name : names) {
    if (names_.contains(name))
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

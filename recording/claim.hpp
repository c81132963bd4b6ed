// Names under which something is being recorded. Two recordings of one name would both go on until the end,
// when the second could not be kept.
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace racebeam {

// From any thread.
class Claims {
 public:
  bool empty() const;
  void add(
      const std::vector<std::string>& names);  // all or none; throws std::runtime_error when one is taken
  void drop(const std::vector<std::string>& names);

 private:
  mutable std::mutex mutex_;
  std::set<std::string> names_;
};

// Holds its names as long as it lives.
class Claim {
 public:
  Claim(std::shared_ptr<Claims> claims, std::vector<std::string> names);
  ~Claim() { claims_->drop(names_); }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  std::shared_ptr<Claims> claims_;
  std::vector<std::string> names_;
};

}  // namespace racebeam

// Names that recordings and logs use. If two had the same name, or one were a folder that contains the other,
// the second could not be committed at its end. So it is refused at its start.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace racebeam {

// Thread-safe.
class Claims {
 public:
  static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

  explicit Claims(std::size_t most = kNoLimit) : most_(most) {}
  bool empty() const;
  // Adds all or none. Throws std::runtime_error if one is taken, or if there would be too many.
  void add(const std::vector<std::string>& names);
  void drop(const std::vector<std::string>& names);

 private:
  const std::size_t most_;
  mutable std::mutex mutex_;
  std::set<std::string> names_;
};

// Holds its names during its lifetime.
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

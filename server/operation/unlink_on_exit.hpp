// A file that this server has created. It is removed at the end, unless it has been replaced under the same
// name.
#pragma once

#include <string>
#include <utility>

#include "system/output_file.hpp"

namespace racebeam {

class UnlinkOnExit {
 public:
  UnlinkOnExit() = default;  // no file
  explicit UnlinkOnExit(std::string path) : path_(std::move(path)), mark_(mark_of(path_)) {}
  ~UnlinkOnExit() { remove(); }
  UnlinkOnExit(UnlinkOnExit&& other) noexcept
      : path_(std::move(other.path_)), mark_(std::exchange(other.mark_, {})) {}
  UnlinkOnExit& operator=(UnlinkOnExit&& other) noexcept {
    remove();
    path_ = std::move(other.path_);
    mark_ = std::exchange(other.mark_, {});
    return *this;
  }

  // Removes the file, unless it is gone or replaced. A second call does nothing.
  void remove() {
    const FileMark mark = std::exchange(mark_, {});
    if (mark.number != 0 && mark_of(path_) == mark) remove_file(path_);
  }

 private:
  std::string path_;
  FileMark mark_;
};

}  // namespace racebeam

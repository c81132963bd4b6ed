// Who is charged for the memory of translated code. All machines that run an image share its code, and the
// total is limited. But an image that a client has sent belongs to that client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace racebeam {

// Declares that an image has an owner, during the lifetime of the object. Code that is made meanwhile counts
// in bytes(), and not in shared_code(). The object must be made before a machine runs the image.
class CodeOwner {
 public:
  explicit CodeOwner(std::shared_ptr<const std::vector<std::uint8_t>> image);
  ~CodeOwner();
  CodeOwner(const CodeOwner&) = delete;
  CodeOwner& operator=(const CodeOwner&) = delete;

  std::size_t bytes() const;  // of code, and of the data that belong to it

 private:
  const std::shared_ptr<const std::vector<std::uint8_t>> image_;
  [[maybe_unused]] const std::size_t hash_;  // translator_stub.cpp does without it
};

// Limits the code of all images without an owner, with the data that belong to it. Beyond the limit,
// instructions are interpreted. Until the first call, the size is unlimited.
void limit_shared_code(std::size_t bytes);
std::size_t shared_code();  // bytes of such code now

}  // namespace racebeam

// Whose the memory of translated code is. The code of most images is shared by all who run them, and bounded
// in all. An image that one client has sent is that client's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace racebeam {

// Declares that an image has an owner, as long as the object lives. Code that is made meanwhile counts in
// bytes(), and not in shared_code(). Make it before a machine runs the image.
class CodeOwner {
 public:
  explicit CodeOwner(std::shared_ptr<const std::vector<std::uint8_t>> image);
  ~CodeOwner();
  CodeOwner(const CodeOwner&) = delete;
  CodeOwner& operator=(const CodeOwner&) = delete;

  std::size_t bytes() const;  // of code, and of what belongs to it

 private:
  const std::shared_ptr<const std::vector<std::uint8_t>> image_;
  const std::size_t hash_;
};

// Bounds the code of all images without an owner, with what belongs to it. Beyond that, instructions are
// interpreted. Until the first call, it is unlimited.
void limit_shared_code(std::size_t bytes);
std::size_t shared_code();  // bytes of it now

}  // namespace racebeam

#include "system/pages.hpp"

#include <utility>

namespace racebeam {

Pages::Pages(Pages&& other) noexcept : all_(std::exchange(other.all_, {})) {}

Pages& Pages::operator=(Pages&& other) noexcept {
  std::swap(all_, other.all_);
  return *this;
}

std::size_t whole_pages(std::size_t size) {
  const std::size_t page = page_size();
  return (size + page - 1) / page * page;
}

}  // namespace racebeam

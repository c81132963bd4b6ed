#include "system/pages.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <utility>

#include "tests/system/access.hpp"

using namespace racebeam;
using racebeam::test::readable;
using racebeam::test::writable;

TEST_CASE("a size is rounded up to whole pages") {
  CHECK(whole_pages(0) == 0);
  CHECK(whole_pages(1) == page_size());
  CHECK(whole_pages(page_size()) == page_size());
  CHECK(whole_pages(page_size() + 1) == 2 * page_size());
  CHECK(Pages(page_size() + 1).size() == 2 * page_size());
}

TEST_CASE("the access to pages changes for those that are named") {
  const std::size_t page = page_size();
  Pages pages(4 * page);
  pages.forbid(0, page);
  pages.make_executable(2 * page, page);
  std::byte* const first = pages.data();
  CHECK_FALSE(readable(first));
  CHECK_FALSE(readable(first + page - 1));
  CHECK(writable(first + page));
  CHECK(writable(first + 2 * page - 1));
  CHECK(readable(first + 2 * page));
  CHECK_FALSE(writable(first + 2 * page));
  CHECK_FALSE(writable(first + 3 * page - 1));
  CHECK(writable(first + 3 * page));
}

TEST_CASE("code in executable pages runs") {
#if defined(__x86_64__)
  constexpr std::array<unsigned char, 6> kCode = {0xB8, 42, 0, 0, 0, 0xC3};  // mov eax, 42; ret
  Pages pages(1);
  std::memcpy(pages.data(), kCode.data(), kCode.size());
  pages.make_executable(0, pages.size());
  CHECK(reinterpret_cast<int (*)()>(pages.data())() == 42);
#endif
}

TEST_CASE("pages that are moved are released once") {
  Pages one(1);
  std::byte* const first = one.data();
  Pages two = std::move(one);
  CHECK(two.data() == first);
  {
    Pages three(1);
    two = std::move(three);
    CHECK(readable(first));
  }
  CHECK_FALSE(readable(first));
  CHECK(writable(two.data()));
}

#if !defined(_WIN32)  // it may take the memory later
TEST_CASE("discarded pages lose their contents") {
  Pages pages(2 * page_size());
  std::memset(pages.data(), 1, pages.size());
  discard_pages(pages.data(), page_size());
  CHECK(pages.data()[page_size() - 1] == std::byte{0});
  CHECK(pages.data()[page_size()] == std::byte{1});
}
#endif

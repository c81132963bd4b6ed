#include "system/pages.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
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
  pages.forbid(page, page);
  std::byte* const first = pages.data();
  CHECK(writable(first + page - 1));
  CHECK_FALSE(readable(first + page));
  CHECK_FALSE(readable(first + 2 * page - 1));
  CHECK(writable(first + 2 * page));
}

TEST_CASE("executable pages cannot be written") {
  const std::size_t page = page_size();
  Pages pages(3 * page, Pages::Use::kCode);
  std::byte* const first = pages.data();
  {
    const CodeWriting writing;
    pages.make_executable(page, page);
    CHECK(writable(first));
    CHECK(writable(first + 2 * page));
  }
  CHECK(readable(first + page));
  CHECK_FALSE(writable(first + page));
  CHECK_FALSE(writable(first + 2 * page - 1));
}

TEST_CASE("code in executable pages runs") {
#if defined(__x86_64__)
  constexpr std::array<unsigned char, 6> kCode = {0xB8, 42, 0, 0, 0, 0xC3};  // mov eax, 42; ret
#elif defined(__aarch64__)
  constexpr std::array<std::uint32_t, 2> kCode = {0x52800540, 0xD65F03C0};  // mov w0, 42; ret
#endif
#if defined(__x86_64__) || defined(__aarch64__)
  Pages pages(1, Pages::Use::kCode);
  {
    const CodeWriting writing;
    std::memcpy(pages.data(), kCode.data(), sizeof kCode);
    pages.make_executable(0, pages.size());
  }
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

#if !defined(_WIN32) && !defined(__APPLE__)  // they may take the memory later
TEST_CASE("discarded pages lose their contents") {
  Pages pages(2 * page_size());
  std::memset(pages.data(), 1, pages.size());
  discard_pages(pages.data(), page_size());
  CHECK(pages.data()[page_size() - 1] == std::byte{0});
  CHECK(pages.data()[page_size()] == std::byte{1});
}
#endif

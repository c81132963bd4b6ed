#include "agents/base/huge_pages.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>

#include "agents/base/state_bytes.hpp"

using namespace racebeam;

TEST_CASE("A table in huge pages begins with zeros, keeps what is written, and is copied and stored") {
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{1000}, std::size_t{524288}, std::size_t{600001}}) {
    HugeTable<float> table(size);
    CHECK(std::ranges::count(table, 0.0F) == static_cast<std::ptrdiff_t>(size));
    if (size >= 524288) CHECK(reinterpret_cast<std::uintptr_t>(table.data()) % (std::size_t{2} << 20) == 0);
    table.front() = 2;
    table.back() = 3;
    StateWriter out;
    out.put(table);
    HugeTable<float> other;
    StateReader in(out.bytes());
    in.get(other);
    CHECK(other == table);
    table.resize(size + 600000);
    CHECK(table[size - 1] == 3);
    CHECK(table.back() == 0);
  }
}

#include "tests/library/counter.hpp"

#include "tests/support/counter_image.hpp"

std::vector<std::uint8_t> counter::bytes() { return *racebeam::test::counter_image()->bytes; }

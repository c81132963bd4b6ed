// The schemes that schemes_random_test.cpp compares with models.
#pragma once

#include <set>
#include <string>

namespace racebeam::test {

std::set<std::string> modelled_schemes();

}  // namespace racebeam::test

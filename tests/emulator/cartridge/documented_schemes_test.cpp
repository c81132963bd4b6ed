// The table of all schemes in docs/spec/cartridges.md, 11, is that of the program.
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/mappers/unsupported.hpp"

namespace racebeam::test {
namespace {

// The scheme and the second column of each row behind the heading "Every scheme".
std::map<std::string, std::string> documented() {
  std::ifstream file(RACEBEAM_CARTRIDGE_SPECIFICATION);
  std::string line;
  while (std::getline(file, line) && line != "### Every scheme") continue;
  std::map<std::string, std::string> rows;
  while (std::getline(file, line) && !line.starts_with("## ")) {
    std::istringstream cells(line);
    std::string empty, scheme, runs;
    if (std::getline(cells, empty, '|') && std::getline(cells, scheme, '|') && std::getline(cells, runs, '|'))
      rows[scheme.substr(1, scheme.size() - 2)] = runs.substr(1, runs.find_first_of(" ,", 1) - 1);
  }
  rows.erase("Scheme");
  rows.erase("--");
  rows.erase("-");
  return rows;
}

TEST_CASE("The table of all schemes says which ones run and which are refused") {
  std::map<std::string, std::string> expected;
  for (const std::string_view name : scheme_names()) expected[std::string(name)] = "yes";
  for (const std::string_view name : unsupported_schemes()) expected[std::string(name)] = "no";
  CHECK(documented() == expected);
}

TEST_CASE("A scheme is either implemented or refused by its name") {
  for (const std::string_view name : scheme_names()) {
    INFO(name);
    CHECK_FALSE(is_unsupported(name));
    CHECK(scheme_of(Rom(scheme_named(name).image), name).name == name);
  }
  const Rom rom(524288);
  for (const std::string_view name : unsupported_schemes()) {
    INFO(name);
    CHECK_THROWS_WITH(scheme_of(rom, name),
                      Catch::Contains("unsupported cartridge scheme '" + std::string(name) + "'"));
  }
}

}  // namespace
}  // namespace racebeam::test

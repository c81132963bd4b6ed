// The table of all schemes in docs/spec/cartridges.md, 11, is that of the program: which schemes run, what
// tests them, and what refuses the others.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "emulator/cartridge/cartridge.hpp"
#include "tests/emulator/cartridge/modelled_schemes.hpp"

namespace racebeam::test {
namespace {

struct Row {
  std::string runs, how;
};

std::string trimmed(const std::string& cell) { return cell.substr(1, cell.size() - 2); }

// The second and the third column of each row behind the heading "Every scheme".
std::map<std::string, Row> documented() {
  std::ifstream file(RACEBEAM_CARTRIDGE_SPECIFICATION);
  std::string line;
  while (std::getline(file, line) && line != "### Every scheme") continue;
  std::map<std::string, Row> rows;
  while (std::getline(file, line) && !line.starts_with("## ")) {
    std::istringstream cells(line);
    std::string empty, scheme, runs, how;
    const bool is_row = std::getline(cells, empty, '|') && std::getline(cells, scheme, '|') &&
                        std::getline(cells, runs, '|') && std::getline(cells, how, '|');
    if (is_row) rows[trimmed(scheme)] = {runs.substr(1, runs.find_first_of(" ,", 1) - 1), trimmed(how)};
  }
  rows.erase("Scheme");
  rows.erase("--");
  rows.erase("-");
  return rows;
}

// The schemes that tests/conformance/schemes/ compares: the keys of its table of images.
std::set<std::string> compared_with_reference() {
  std::ifstream file(RACEBEAM_COMPARED_SCHEMES);
  std::set<std::string> names;
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t end = line.find("\": ");
    if (line.starts_with("    \"") && end != std::string::npos) names.insert(line.substr(5, end - 5));
  }
  return names;
}

bool says(const Row& row, const std::string& word) { return row.how.find(word) != std::string::npos; }

Rom filled(std::size_t size) {
  Rom rom(size);
  for (std::size_t i = 0; i < size; ++i)
    rom[i] = static_cast<std::uint8_t>(i * 7 + (i >> 8) * 3 + (i >> 12) * 17);
  return rom;
}

// An image with `bytes` at `places`.
Rom with(std::size_t size, const std::string& bytes, std::initializer_list<std::size_t> places) {
  Rom rom = filled(size);
  for (const std::size_t place : places)
    std::copy(bytes.begin(), bytes.end(), rom.begin() + static_cast<std::ptrdiff_t>(place));
  return rom;
}

// What images of schemes that are refused look like.
struct Sign {
  const char* how;
  Rom image;
};

std::map<std::string, Sign> signs() {
  return {{"BUS", {"text", with(32768, "BUS", {700, 900})}},
          {"CTY", {"text", with(32768, "LENIN", {700})}},
          {"ELF",
           {"first bytes", with(32768,
                                "\x7F"
                                "ELF",
                                {0})}}};
}

TEST_CASE("The table of all schemes says which ones run and which are refused") {
  std::map<std::string, std::string> expected, found;
  for (const std::string_view name : scheme_names()) expected[std::string(name)] = "yes";
  for (const std::string_view name : unsupported_schemes()) expected[std::string(name)] = "no";
  for (const auto& [name, row] : documented()) found[name] = row.runs;
  CHECK(found == expected);
}

TEST_CASE("A scheme that runs is tested by what the table says: the reference, a model, or its own tests") {
  const std::set<std::string> compared = compared_with_reference(), modelled = modelled_schemes();
  REQUIRE(compared.contains("E7"));
  for (const auto& [name, row] : documented()) {
    if (row.runs != "yes") continue;
    INFO(name);
    CHECK(modelled.contains(name) == says(row, "model"));
    CHECK(compared.contains(name) == says(row, "reference"));
    CHECK((says(row, "model") || says(row, "reference") || row.how == "tests of its banks"));
  }
}

TEST_CASE("A scheme that is not implemented is refused by what the table says") {
  const auto known = signs();
  for (const auto& [name, row] : documented()) {
    if (row.runs == "yes") continue;
    INFO(name);
    const auto sign = known.find(name);
    REQUIRE((sign == known.end()) == (row.how == "name"));
    if (sign == known.end()) continue;
    CHECK(row.how == sign->second.how);
    CHECK_THROWS_WITH(
        scheme_of(sign->second.image),
        Catch::StartsWith("the image is for the cartridge scheme " + name + ", which is not implemented"));
  }
}

TEST_CASE("A scheme is either implemented or refused by its name") {
  for (const std::string_view name : scheme_names()) {
    INFO(name);
    CHECK_FALSE(is_unsupported(name));
    CHECK(scheme_of(Rom(scheme_named(name).least_image), name).name == name);
  }
  const Rom rom(524288);
  for (const std::string_view name : unsupported_schemes()) {
    INFO(name);
    CHECK_THROWS_WITH(scheme_of(rom, name),
                      Catch::Contains("unsupported cartridge scheme '" + std::string(name) + "'"));
  }
}

// BX of a register, `count` times, from the offset `first` on.
Rom with_returns(std::size_t size, std::size_t count, std::size_t first, std::uint8_t of_register = 0x70) {
  Rom rom = filled(size);
  for (std::size_t i = 0; i < count; ++i) {
    rom[first + 100 * i] = of_register;
    rom[first + 100 * i + 1] = 0x47;
  }
  return rom;
}

TEST_CASE("An image with code for an ARM, and without a text, is refused until its scheme is named") {
  for (const std::size_t size : {29696U, 32768U, 65536U, 131072U}) {
    INFO(size);
    CHECK_THROWS_WITH(
        scheme_of(with_returns(size, 20, 4096)),
        Catch::StartsWith("the image of " + std::to_string(size) + " bytes has code for an ARM"));
    CHECK_NOTHROW(scheme_of(with_returns(size, 2, 4096)));
    CHECK_NOTHROW(scheme_of(with_returns(size, 20, 4097)));
  }
  for (const std::uint8_t of_register : std::to_array<std::uint8_t>({0x00, 0x08, 0x18, 0x70})) {
    CHECK_THROWS(scheme_of(with_returns(24576, 8, 4096, of_register)));
    CHECK_NOTHROW(scheme_of(with_returns(24576, 7, 4096, of_register)));
  }
  CHECK_NOTHROW(scheme_of(with_returns(24576, 20, 4096, 0x10)));
  CHECK_THROWS(scheme_of(with_returns(65536, 8, 32768)));
  CHECK_NOTHROW(scheme_of(with_returns(65536, 14, 32768 - 700)));  // seven on either side
  CHECK(scheme_of(with_returns(32768, 20, 4096), "CDFJ").name == "CDFJ");
  CHECK(scheme_of(with_returns(16384, 20, 4096)).name == "F6");
  Rom marked = with_returns(32768, 20, 4096);
  std::copy_n("CDFJCDFJ", 8, marked.begin() + 700);
  CHECK(scheme_of(marked).name == "CDFJ");
}

TEST_CASE("Without an instruction that accesses a hot spot, an image is hardly one of its scheme") {
  const auto doubtful = [](const char* scheme, std::size_t size, std::initializer_list<std::uint8_t> code) {
    Rom rom(size);
    std::copy(code.begin(), code.end(), rom.begin() + 5000);
    return accesses_no_hot_spot(rom, scheme_named(scheme));
  };
  CHECK(doubtful("F8", 8192, {}));
  CHECK(doubtful("F8", 8192, {0xAD, 0xF7, 0x1F}));
  CHECK(doubtful("F8", 8192, {0xA9, 0xF8, 0x1F}));
  CHECK(doubtful("F8", 8192, {0xAD, 0xF8, 0x0F}));
  for (const int opcode : {0xAD, 0x8D, 0x2C, 0x0C, 0x4C, 0x20, 0xCD, 0xEE, 0xBD, 0xB9, 0x9D})
    CHECK_FALSE(doubtful("F8", 8192, {static_cast<std::uint8_t>(opcode), 0xF9, 0xFF}));
  CHECK_FALSE(doubtful("F8", 8192, {0xBD, 0xF7, 0xFF}));
  CHECK(doubtful("F8", 8192, {0xBD, 0xF6, 0xFF}));
  CHECK(doubtful("F8", 8192, {0xAD, 0xFA, 0xFF}));
  CHECK(doubtful("F8", 8192, {0xBD, 0xFA, 0xFF}));
  CHECK(doubtful("F6", 16384, {0xAD, 0xF5, 0xFF}));
  CHECK_FALSE(doubtful("F6", 16384, {0xAD, 0xF6, 0xFF}));
  CHECK(doubtful("MB", 65536, {0xAD, 0xEF, 0xFF}));
  CHECK_FALSE(doubtful("MB", 65536, {0xAD, 0xF0, 0xFF}));
  for (const char* scheme : {"2K", "4K", "E0", "FE", "3F", "UA", "AR"})
    CHECK_FALSE(doubtful(scheme, 16384, {}));
}

}  // namespace
}  // namespace racebeam::test

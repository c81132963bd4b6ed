#include "tests/emulator/cpu/vectors.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace racebeam::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Finds a field by its name, which some copies of the files write with capitals.
const Json& field(const Json& object, const char* name) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::equal(key, std::string_view(name), {}, [](unsigned char c) { return std::tolower(c); }))
      return value;
  throw std::runtime_error(std::string("a vector has no ") + name);
}

VectorState state_of(const Json& json) {
  const auto byte = [&](const char* name) { return field(json, name).get<std::uint8_t>(); };
  VectorState state{
      field(json, "pc").get<std::uint16_t>(), byte("s"), byte("a"), byte("x"), byte("y"), byte("p"), {}};
  for (const Json& cell : field(json, "ram")) state.ram.emplace_back(cell.at(0), cell.at(1));
  return state;
}

std::vector<Vector> read_json(const fs::path& path) {
  std::ifstream file(path);
  std::vector<Vector> vectors;
  for (const Json& json : Json::parse(file)) {
    Vector vector{field(json, "name"), state_of(field(json, "initial")), state_of(field(json, "final")), {}};
    for (const Json& access : field(json, "cycles"))
      vector.cycles.push_back({access.at(0), access.at(1), access.at(2) == "write"});
    vectors.push_back(std::move(vector));
  }
  return vectors;
}

// The packed form: a name of 10 bytes, both states, the accesses; words have the high byte first.
class Packed {
 public:
  explicit Packed(const fs::path& path) : path_(path.string()) {
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
  }

  bool at_end() const { return at_ == bytes_.size(); }

  Vector vector() {
    Vector vector;
    for (int i = 0; i < 10; ++i)
      if (const char c = static_cast<char>(byte())) vector.name += c;
    vector.before = state();
    vector.after = state();
    for (int n = byte(); n > 0; --n) {
      const std::uint16_t address = word();
      const std::uint8_t value = byte();
      vector.cycles.push_back({address, value, byte() == 'w'});
    }
    return vector;
  }

 private:
  std::uint8_t byte() {
    if (at_end()) throw std::runtime_error(path_ + " ends in the middle of a vector");
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }

  std::uint16_t word() {
    const std::uint8_t high = byte();
    return static_cast<std::uint16_t>(high << 8 | byte());
  }

  VectorState state() {
    VectorState state;
    state.pc = word();
    for (std::uint8_t* reg : {&state.s, &state.a, &state.x, &state.y, &state.p}) *reg = byte();
    for (int n = byte(); n > 0; --n) {
      const std::uint16_t address = word();
      state.ram.emplace_back(address, byte());
    }
    return state;
  }

  std::string path_;
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

std::vector<Vector> read_packed(const fs::path& path) {
  Packed packed(path);
  std::vector<Vector> vectors;
  while (!packed.at_end()) vectors.push_back(packed.vector());
  return vectors;
}

std::optional<fs::path> find_file(const std::string& folder, std::string name) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string found = entry.path().filename().string();
    if (std::ranges::equal(found, name, {}, [](unsigned char c) { return std::tolower(c); }))
      return entry.path();
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<Vector>> read_vectors(const std::string& folder, unsigned opcode) {
  char stem[3];
  std::snprintf(stem, sizeof stem, "%02x", opcode & 0xFF);
  if (const auto path = find_file(folder, std::string(stem) + ".json")) return read_json(*path);
  if (const auto path = find_file(folder, std::string(stem) + ".bin")) return read_packed(*path);
  return std::nullopt;
}

}  // namespace racebeam::test

#include "tests/support/roms.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>

namespace racebeam::test {
namespace {

namespace fs = std::filesystem;

using Roms = std::map<std::string, std::string, std::less<>>;  // MD5 -> path

std::string folder_of_ale_py() {
  std::error_code ignored;
  for (const auto& python : fs::directory_iterator(RACEBEAM_SOURCE_DIR "/.venv/lib", ignored)) {
    const fs::path roms = python.path() / "site-packages/ale_py/roms";
    if (fs::is_directory(roms)) return roms.string();
  }
  return {};
}

bool looks_like_rom(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".bin" || ending == ".a26" || ending == ".rom" || ending == ".gz";
}

Roms index_of(const std::string& folder) {
  Roms roms;
  std::error_code ignored;
  for (const auto& file : fs::recursive_directory_iterator(folder, ignored)) {
    if (!file.is_regular_file() || !looks_like_rom(file.path())) continue;
    try {
      roms.emplace(load_image(file.path().string())->md5, file.path().string());
    } catch (const std::invalid_argument&) {
      continue;  // not an image
    }
  }
  return roms;
}

const Roms& roms() {
  static const Roms all = index_of(rom_folder());
  return all;
}

}  // namespace

std::string rom_folder() {
  const char* folder = std::getenv("RACEBEAM_ROMS");
  return folder != nullptr && *folder != '\0' ? folder : folder_of_ale_py();
}

std::shared_ptr<const Image> find_rom(std::string_view md5) {
  const auto found = roms().lower_bound(md5);
  if (found == roms().end() || !found->first.starts_with(md5)) return nullptr;
  return load_image(found->second);
}

std::shared_ptr<const Image> find_rom_of(const Game& game) {
  for (const GameImage& image : game.images) {
    if (!image.accepted || image.md5.empty()) continue;
    if (auto found = find_rom(image.md5)) return found;
  }
  return nullptr;
}

}  // namespace racebeam::test

#include "games/rom_image.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <system_error>

#include "games/gzip.hpp"
#include "games/md5.hpp"
#include "games/zip_archive.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBuiltIn = "builtin:";

[[noreturn]] void refuse(const std::string& where, const std::string& why) {
  throw InvalidInput("image " + where + ": " + why);
}

// The stem of pong.bin, PONG.a26 and Pong.BIN.GZ is "pong".
std::string stem_of(std::filesystem::path path) {
  if (lower_case(path.extension().string()) == ".gz") path = path.stem();
  return lower_case(path.stem().string());
}

// Repeats the bytes of a cartridge of less than 2K until they fill 2K. The last copy ends at the end of the
// 2K, since the vectors are there. Returns the size before, or 0 if it does nothing.
std::size_t mirror(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kMin = 32, kFull = 2048;
  if (bytes.size() < kMin || bytes.size() >= kFull) return 0;
  std::vector<std::uint8_t> full(kFull);
  for (std::size_t i = 1; i <= kFull; ++i) full[kFull - i] = bytes[bytes.size() - 1 - (i - 1) % bytes.size()];
  std::swap(bytes, full);
  return full.size();
}

std::shared_ptr<const Image> image_of(std::vector<std::uint8_t> bytes, std::string stem) {
  std::string md5 = md5_of(bytes);
  const std::size_t file_size = mirror(bytes);
  bytes.shrink_to_fit();  // it was unpacked into space for the largest image
  return std::make_shared<const Image>(
      Image{std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes)), std::move(md5),
            std::move(stem), file_size});
}

std::shared_ptr<const Image> built_in(std::string_view name) {
  std::string names;
  for (const BuiltInImage& image : builtin_images()) {
    if (image.name == name) return image_of({image.bytes.begin(), image.bytes.end()}, std::string(name));
    names += (names.empty() ? "" : ", ") + std::string(kBuiltIn) + std::string(image.name);
  }
  refuse(std::string(kBuiltIn) + std::string(name),
         "unknown built-in image; accepted: " + (names.empty() ? "none" : names));
}

bool looks_like_image(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".gz") return looks_like_image(path.stem());
  return ending == ".bin" || ending == ".a26" || ending == ".rom";
}

bool looks_like_archive(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return ending == ".zip" || ending == ".7z";
}

// Archives

constexpr std::size_t kLargestFile = 16 << 20;
constexpr std::string_view kSevenZip = "7z\xBC\xAF\x27\x1C";

// What the archiver of macOS adds to each file.
bool is_fork(const std::filesystem::path& path) { return path.filename().string().starts_with("._"); }

std::string names_of(const std::vector<ZipEntry>& entries) {
  constexpr std::size_t kMax = 8;
  std::string names;
  for (std::size_t i = 0; i < entries.size() && i < kMax; ++i) names += (i > 0 ? ", " : "") + entries[i].name;
  return entries.size() > kMax ? names + " and others" : names;
}

// The one image of a zip archive. Its own name counts, not that of the archive.
std::shared_ptr<const Image> image_in_zip(std::string_view archive) {
  std::vector<ZipEntry> images = zip_entries(archive);
  std::erase_if(images,
                [](const ZipEntry& entry) { return !looks_like_image(entry.name) || is_fork(entry.name); });
  if (images.empty()) throw InvalidInput("the zip archive has no file that ends in .bin, .a26 or .rom");
  if (images.size() > 1)
    throw InvalidInput("the zip archive has " + std::to_string(images.size()) +
                       " images, and one is accepted: " + names_of(images));
  return make_image(unzip(archive, images.front(), kMaxImageSize), stem_of(images.front().name));
}

std::shared_ptr<const Image> unpacked(std::string_view file, const std::string& where) {
  if (is_zip(file)) return image_in_zip(file);
  if (file.starts_with(kSevenZip))
    throw InvalidInput("7z archives are not read; unpack it, or make it a zip archive with one image");
  if (!file.empty() && looks_like_archive(where))
    throw InvalidInput("the file is named as an archive, but it is not a zip archive");
  std::vector<std::uint8_t> bytes =
      is_gzip(file) ? gunzip(file, kMaxImageSize) : std::vector<std::uint8_t>(file.begin(), file.end());
  if (bytes.empty()) throw InvalidInput("the file is empty");
  if (bytes.size() > kMaxImageSize)
    throw InvalidInput("larger than the largest image, " + std::to_string(kMaxImageSize) + " bytes");
  return image_of(std::move(bytes), stem_of(where));
}

std::string reason_for(const fs::path& folder, const std::error_code& error) {
  std::error_code none;
  if (error != std::errc::no_such_file_or_directory || !fs::is_symlink(folder, none)) return error.message();
  return "it is a link to '" + fs::read_symlink(folder, none).string() + "', which is not there";
}

// The entries of a folder that are named like images, sorted.
std::vector<std::string> entries_like_images(const std::string& folder,
                                             const std::function<bool(const fs::directory_entry&)>& is_one) {
  std::error_code error;
  std::vector<std::string> files;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end; entry.increment(error)) {
    const fs::path path = entry->path();
    if (is_one(*entry) && (looks_like_image(path) || looks_like_archive(path)))
      files.push_back(path.string());
  }
  if (error) throw InvalidInput("cannot list the folder '" + folder + "': " + reason_for(folder, error));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::shared_ptr<const Image> make_image(std::vector<std::uint8_t> bytes, const std::string& stem) {
  if (bytes.empty()) refuse(stem, "it is empty");
  if (bytes.size() > kMaxImageSize)
    refuse(stem, "larger than the largest image, " + std::to_string(kMaxImageSize) + " bytes");
  return image_of(std::move(bytes), stem);
}

std::vector<std::string> image_files(const std::string& folder) {
  return entries_like_images(folder, [](const fs::directory_entry& entry) {
    std::error_code unknown;  // a link to itself, or into a folder without permission
    return entry.is_regular_file(unknown);
  });
}

std::vector<std::string> broken_image_links(const std::string& folder) {
  return entries_like_images(folder, [](const fs::directory_entry& entry) {
    std::error_code unknown;
    return entry.is_symlink(unknown) && entry.status(unknown).type() == fs::file_type::not_found;
  });
}

std::shared_ptr<const Image> image_in_file(std::string_view file, const std::string& name) {
  try {
    return unpacked(file, name);
  } catch (const InvalidInput& error) {
    refuse(name, error.what());
  }
}

std::shared_ptr<const Image> load_image(const std::string& where) {
  if (where.starts_with(kBuiltIn)) return built_in(std::string_view(where).substr(kBuiltIn.size()));
  return image_in_file(read_input_file("image", where, kLargestFile), where);
}

}  // namespace racebeam

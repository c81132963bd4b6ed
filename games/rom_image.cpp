#include "games/rom_image.hpp"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "games/md5.hpp"
#include "games/zip_archive.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kBuiltIn = "builtin:";

[[noreturn]] void refuse(const std::string& where, const std::string& why) {
  throw InvalidInput("image " + where + ": " + why);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The stem of pong.bin, PONG.a26 and pong.bin.gz is "pong".
std::string stem_of(std::filesystem::path path) {
  if (path.extension() == ".gz") path = path.stem();
  return lower(path.stem().string());
}

// A cartridge of less than 2K shows its bytes several times in 2K. The last time ends where the 2K end, since
// the vectors are there.
// Returns the size before, or 0 if nothing was done.
std::size_t mirror(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kLeast = 32, kFull = 2048;
  if (bytes.size() < kLeast || bytes.size() >= kFull) return 0;
  std::vector<std::uint8_t> full(kFull);
  for (std::size_t i = 1; i <= kFull; ++i) full[kFull - i] = bytes[bytes.size() - 1 - (i - 1) % bytes.size()];
  std::swap(bytes, full);
  return full.size();
}

std::shared_ptr<const Image> image_of(std::vector<std::uint8_t> bytes, std::string stem) {
  std::string md5 = md5_of(bytes);
  const std::size_t file_size = mirror(bytes);
  bytes.shrink_to_fit();  // it was read into space for the largest image
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
  const std::string ending = lower(path.extension().string());
  if (ending == ".gz") return looks_like_image(path.stem());
  return ending == ".bin" || ending == ".a26" || ending == ".rom";
}

bool looks_like_archive(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  return ending == ".zip" || ending == ".7z";
}

struct Closer {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzipFile = std::unique_ptr<gzFile_s, Closer>;

// Reads one byte more than an image may have, at most. zlib passes files through that are not gzip.
std::vector<std::uint8_t> read_file(const std::string& path) {
  const GzipFile file(gzdopen(open_input_file("image", path), "rb"));
  std::vector<std::uint8_t> bytes(kMaxImageSize + 1);
  const int count = gzread(file.get(), bytes.data(), static_cast<unsigned>(bytes.size()));
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (error == Z_BUF_ERROR) refuse(path, "the gzip file is truncated");
  if (count < 0) refuse(path, error == Z_ERRNO ? "the file cannot be read" : "the gzip file is damaged");
  bytes.resize(static_cast<std::size_t>(count));
  return bytes;
}

// Archives

constexpr std::string_view kSevenZip = "7z\xBC\xAF\x27\x1C";

// What the archiver of macOS adds to each file.
bool is_fork(const std::filesystem::path& path) { return path.filename().string().starts_with("._"); }

std::string names_of(const std::vector<ZipEntry>& entries) {
  constexpr std::size_t kMost = 8;
  std::string names;
  for (std::size_t i = 0; i < entries.size() && i < kMost; ++i)
    names += (i > 0 ? ", " : "") + entries[i].name;
  return entries.size() > kMost ? names + " and others" : names;
}

// The one image of a zip archive. Its own name counts, not that of the archive.
std::shared_ptr<const Image> image_in_zip(const std::string& path) {
  constexpr std::size_t kLargestArchive = 16 << 20;
  const std::string archive = read_input_file("image", path, kLargestArchive);
  try {
    std::vector<ZipEntry> images = zip_entries(archive);
    std::erase_if(images,
                  [](const ZipEntry& entry) { return !looks_like_image(entry.name) || is_fork(entry.name); });
    if (images.empty()) throw InvalidInput("the zip archive has no file that ends in .bin, .a26 or .rom");
    if (images.size() > 1)
      throw InvalidInput("the zip archive has " + std::to_string(images.size()) +
                         " images, and one is accepted: " + names_of(images));
    return make_image(unzip(archive, images.front(), kMaxImageSize), stem_of(images.front().name));
  } catch (const InvalidInput& error) {
    refuse(path, error.what());
  }
}

}  // namespace

std::shared_ptr<const Image> make_image(std::vector<std::uint8_t> bytes, const std::string& stem) {
  if (bytes.empty()) refuse(stem, "it is empty");
  if (bytes.size() > kMaxImageSize)
    refuse(stem, "larger than the largest image, " + std::to_string(kMaxImageSize) + " bytes");
  return image_of(std::move(bytes), stem);
}

std::vector<std::string> image_files(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<std::string> files;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;  // a link to itself, or into a folder without permission
    const fs::path path = entry->path();
    if (entry->is_regular_file(unknown) && (looks_like_image(path) || looks_like_archive(path)))
      files.push_back(entry->path().string());
  }
  if (error) throw InvalidInput("cannot list the folder '" + folder + "': " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

std::shared_ptr<const Image> load_image(const std::string& where) {
  if (where.starts_with(kBuiltIn)) return built_in(std::string_view(where).substr(kBuiltIn.size()));
  std::vector<std::uint8_t> bytes = read_file(where);
  if (bytes.empty()) refuse(where, "the file is empty");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (is_zip(text)) return image_in_zip(where);
  if (text.starts_with(kSevenZip))
    refuse(where, "7z archives are not read; unpack it, or make it a zip archive with one image");
  if (bytes.size() > kMaxImageSize)
    refuse(where, "larger than the largest image, " + std::to_string(kMaxImageSize) + " bytes");
  return image_of(std::move(bytes), stem_of(where));
}

}  // namespace racebeam

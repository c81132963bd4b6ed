#include "recording/atomic_file.hpp"

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "system/output_file.hpp"
#include "system/regular_file.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

// How an error names a file. A client of a server may read it, and does not learn the server's folders.
enum class Naming { kName, kPath };

[[noreturn]] void fail(const std::string& what, const std::string& path, Naming naming = Naming::kName) {
  const std::string reason = std::generic_category().message(errno);
  const std::string name = naming == Naming::kPath ? path : fs::path(path).filename().string();
  throw std::runtime_error("cannot " + what + " " + name + ": " + reason);
}

// The temporary name is hidden, and in the same folder, so that the file can be renamed.
std::string temporary_name(const std::string& path) {
  const fs::path whole(path);
  std::string name = ".";
  (name += whole.filename().string()) += ".XXXXXX";
  return (whole.parent_path() / name).string();
}

void write_all(int descriptor, std::size_t place, std::string_view bytes, const std::string& path,
               Naming naming = Naming::kName) {
  if (!write_at(descriptor, place, bytes)) fail("write", path, naming);
}

void create(const std::string& temporary, const std::string& path) {
  if (!rename_anew(temporary, path)) fail("create", path);
}

void refuse_existing(const std::string& path) {
  if (fs::symlink_status(path).type() == fs::file_type::not_found) return;  // a broken link exists, too
  throw std::runtime_error(fs::path(path).filename().string() + " exists; choose another name");
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A new file beside `path`: .NAME.part, or .NAME.part1 and so on if another program has a file of that name.
// Replaces a file that a killed process left behind. The destructor removes the file unless it was renamed.
class Aside {
 public:
  explicit Aside(const std::string& path) {
    const fs::path whole(path);
    const std::string hidden = std::string(".").append(whole.filename().string()).append(".part");
    const std::string first = (whole.parent_path() / hidden).string();
    for (int number = 0; descriptor_ < 0 && number < kMaxNames; ++number) {
      name_ = number == 0 ? first : first + std::to_string(number);
      descriptor_ = make_marked_file(name_);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail("make", path, Naming::kPath);
  }
  ~Aside() {
    close_file(descriptor_);
    if (!name_.empty()) remove_file(name_);
  }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;

  int descriptor() const { return descriptor_; }

  void rename_to(const std::string& path) {
    if (!rename_over(name_, path)) fail("replace", path, Naming::kPath);
    name_.clear();
    unmark(descriptor_);
  }

 private:
  static constexpr int kMaxNames = 100;

  std::string name_;  // empty once it is renamed
  int descriptor_ = -1;
};

// The file that a symbolic link names, whether it exists or not.
std::string target_of(std::string path) {
  constexpr int kMaxLinks = 40;
  std::error_code none;
  for (int links = 0; links < kMaxLinks && fs::is_symlink(path, none); ++links)
    path = (fs::path(path).parent_path() / fs::read_symlink(path)).string();
  return path;
}

}  // namespace

void DiskBudget::take(std::size_t bytes) {
  if (bytes > most_ - taken_)
    throw BudgetSpent("the recording has reached its limit of " + std::to_string(most_) + " bytes");
  taken_ += bytes;
}

AtomicFile::AtomicFile(std::string path, DiskBudget& budget, std::string tail)
    : path_(std::move(path)), temporary_(temporary_name(path_)), budget_(budget), tail_(std::move(tail)) {
  refuse_existing(path_);
  budget_.take(tail_.size());
  descriptor_ = make_temporary_file(temporary_);
  if (descriptor_ < 0) fail("make", path_);
  set_readers(descriptor_, Readers::kEveryone);
  number_ = mark_of(temporary_).number;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  close_file(descriptor_);
  remove_file(temporary_);
}

void AtomicFile::write(std::span<const std::uint8_t> bytes) { write(text_of(bytes)); }

void AtomicFile::write(std::string_view text) {
  budget_.take(text.size());
  try {
    write_all(descriptor_, size_ + text.size(), tail_, path_);
    write_all(descriptor_, size_, text, path_);
  } catch (...) {
    budget_.give_back(text.size());
    throw;
  }
  size_ += text.size();
}

void AtomicFile::overwrite(std::size_t place, std::span<const std::uint8_t> bytes) {
  write_all(descriptor_, place, text_of(bytes), path_);
}

void AtomicFile::count_growth() {
  const std::int64_t found = size_of_file(descriptor_);
  if (found < 0) fail("read", path_);
  const auto size = static_cast<std::size_t>(found);
  if (size <= size_) return;
  budget_.take(size - size_);
  size_ = size;
}

// A file that is gone has the number 0; to create the new one then fails with the system's reason.
void AtomicFile::check_place() const {
  const std::uint64_t found = mark_of(temporary_).number;
  if (found == 0 || found == number_) return;
  throw std::runtime_error("cannot create " + fs::path(path_).filename().string() +
                           ": another program has replaced its temporary file");
}

// Cuts off data of which only a part was written. The tail already has its space on the disk, so it always
// fits.
void AtomicFile::commit() {
  write_all(descriptor_, size_, tail_, path_);
  if (!cut_file(descriptor_, size_ + tail_.size())) fail("write", path_);
  if (!sync_file(descriptor_)) fail("sync", path_);
  check_place();
  create(temporary_, path_);
  close_file(descriptor_);
  descriptor_ = -1;
}

void replace_file(const std::string& path, std::string_view bytes, Durable durable) {
  const std::string target = target_of(path);
  Aside aside(target);
  write_all(aside.descriptor(), 0, bytes, path, Naming::kPath);
  if (durable == Durable::kNow && !sync_disk_of(aside.descriptor())) fail("sync", path, Naming::kPath);
  aside.rename_to(target);
}

AtomicFolder::AtomicFolder(std::string path, DiskBudget& budget)
    : path_(std::move(path)), temporary_(temporary_name(path_)), budget_(budget) {
  refuse_existing(path_);
  if (!make_temporary_folder(temporary_)) fail("make", path_);
}

AtomicFolder::~AtomicFolder() {
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void AtomicFolder::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  budget_.take(bytes.size());
  const std::string file = temporary_ + "/" + name;
  const int descriptor = make_file(file);
  try {
    if (descriptor < 0) fail("make", file);
    write_all(descriptor, 0, text_of(bytes), file);
  } catch (...) {
    budget_.give_back(bytes.size());
    if (descriptor < 0) throw;  // a file of that name may exist, and is not removed
    close_file(descriptor);
    remove_file(file);
    throw;
  }
  close_file(descriptor);
}

// Syncs all files at once: one sync for each file would stall the session.
void AtomicFolder::commit() {
  if (!sync_disk_of(temporary_)) fail("sync", path_);
  open_folder_to_all(temporary_);
  create(temporary_, path_);
  temporary_.clear();
}

}  // namespace racebeam

#include "recording/submission_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "environment/settings/setting_tables.hpp"
#include "recording/result_row.hpp"
#include "recording/sha256.hpp"
#include "system/file_lock.hpp"
#include "system/input_file.hpp"
#include "system/output_file.hpp"
#include "system/regular_file.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::size_t kMaxAgentBytes = std::size_t{1} << 16, kMaxLineBytes = std::size_t{1} << 16;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string reason = std::generic_category().message(errno);
  throw std::runtime_error("cannot " + what + " " + fs::path(path).filename().string() + ": " + reason);
}

bool is_there(const std::string& path) { return fs::symlink_status(path).type() != fs::file_type::not_found; }

// Returns false if something of this name is there.
bool makes_folder(const std::string& path) {
  if (make_folder(path)) return true;
  if (errno != EEXIST) fail("make", path);
  return false;
}

constexpr auto kLockTimeout = 2s;  // for the lock; other recordings wait, too

// A table that several programs append to.
class SharedTable {
 public:
  SharedTable(std::string path, const DiskBudget& budget) : path_(std::move(path)) {
    descriptor_ = open_to_append(path_);
    if (descriptor_ < 0) fail("open", path_);
    try {
      lock(budget);
    } catch (...) {
      close_file(descriptor_);
      throw;
    }
  }
  ~SharedTable() { close_file(descriptor_); }
  SharedTable(const SharedTable&) = delete;
  SharedTable& operator=(const SharedTable&) = delete;

  std::size_t size() const {
    const std::int64_t size = size_of_file(descriptor_);
    if (size < 0) fail("read", path_);
    return static_cast<std::size_t>(size);
  }

  // Appends all of the text, or nothing.
  void append(std::string_view text) const {
    const std::size_t before = size();
    if (racebeam::append(descriptor_, text)) return;
    const int reason = errno;
    if (cut_file(descriptor_, before)) errno = reason;
    fail("write", path_);
  }

 private:
  void lock(const DiskBudget& budget) const {
    const auto end = std::chrono::steady_clock::now() + kLockTimeout;
    while (!lock_file(descriptor_, Waiting::kNo)) {
      if (!is_locked_elsewhere(errno) || budget.is_given_up() || std::chrono::steady_clock::now() > end)
        fail("lock", path_);
      std::this_thread::sleep_for(10ms);
    }
  }

  const std::string path_;
  int descriptor_ = -1;
};

void append_text(std::string& out, std::string_view key, std::string_view text) {
  if (!text.empty()) out.append(key).append(" = \"").append(text).append("\"\n");
}

// The settings that a log of any evaluation preset also has (docs/experiments.md).
constexpr std::string_view kOfAllPresets = "rules=ale-0.12 life_loss_ends=0";

std::string text_of(const AboutAgent& about, std::string_view preset) {
  std::string text;
  append_text(text, "agent", about.agent);
  append_text(text, "version", about.version);
  append_text(text, "preset", preset);
  text += "training_frames = " + std::to_string(about.training_frames) + "\n";
  append_text(text, "phrase", about.phrase);
  append_text(text, "role", about.role);
  append_text(text, "link", about.link);
  return text;
}

// Makes the folder with its description and the columns of its table. It appears as a whole, so that several
// programs can begin it at the same time. Returns false if something of this name exists.
bool make_submission(const std::string& path, std::string_view about, DiskBudget& budget) {
  const auto bytes = [](std::string_view text) {
    return std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  if (is_there(path)) return false;
  try {
    AtomicFolder folder(path, budget);
    folder.add("agent.toml", bytes(about));
    folder.add("results.csv", bytes(line_of(kResultColumns)));
    folder.commit();
  } catch (const std::runtime_error&) {
    if (is_there(path)) return false;  // another program has begun it meanwhile
    throw;
  }
  return true;
}

void write_file(const std::string& path, std::string_view text, DiskBudget& budget) {
  AtomicFile file(path, budget);
  file.write(text);
  file.commit();
}

std::string first_log(const std::string& folder) {
  std::string path;
  std::size_t number = 0;
  each_line("results", folder + "/results.csv", kMaxLineBytes, [&](std::string_view line, bool) {
    if (++number != 2) return;
    const ResultRow row = row_of_line(line);
    path = folder + "/logs/" + row[0] + '/' + field(row, "episode") + ".episode";
  });
  return path;
}

}  // namespace

bool is_plain_name(std::string_view name, std::size_t most_letters) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !name.empty() && name.size() <= most_letters && is_letter(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return is_letter(c) || c == '_' || c == '.' || c == '-'; });
}

std::string plain_name_rule(std::size_t most_letters) {
  return "1 to " + std::to_string(most_letters) +
         " letters, digits, '-', '_' and '.', a letter or a digit first";
}

std::string_view preset_of(std::string_view settings) {
  std::vector<std::string_view> words, expected;
  split(settings, words);
  for (const description::EvaluationPreset& preset : description::kEvaluationPresets) {
    const std::string all = std::string(preset.words).append(" ").append(kOfAllPresets);
    split(all, expected);
    const auto has = [&](std::string_view word) { return std::ranges::find(words, word) != words.end(); };
    if (std::ranges::all_of(expected, has)) return preset.name;
  }
  return "other";
}

SubmissionFolder::SubmissionFolder(SubmissionOrder order, DiskBudget& budget)
    : order_(std::move(order)), budget_(budget) {
  const std::string text = text_of(order_.about, preset_of(order_.settings));
  if (!make_submission(order_.path, text, budget_)) check_earlier(text);
  makes_folder(order_.path + "/logs");
  if (!makes_folder(unit_path()))
    throw std::runtime_error(fs::path(order_.path).filename().string() + " has the unit " + order_.unit +
                             " already; another trial= makes another");
}

SubmissionFolder::~SubmissionFolder() { remove_folder(unit_path()); }

void SubmissionFolder::check_earlier(std::string_view text) const {
  const std::string name = fs::path(order_.path).filename().string(), about = order_.path + "/agent.toml";
  if (fs::is_symlink(order_.path) || !fs::exists(about))
    throw std::runtime_error(name + " exists, and has no agent.toml; choose another name");
  if (read_input_file("description of the agent", about, kMaxAgentBytes) != text)
    throw std::runtime_error(name + " has another agent.toml; choose another name, or the same words");
  const SharedTable table(table_path(), budget_);  // nobody appends a row while one is read
  if (table.size() == 0) table.append(line_of(kResultColumns));
  check_settings();
}

void SubmissionFolder::check_settings() const {
  const std::string path = first_log(order_.path);
  if (path.empty()) return;
  const std::string bytes = read_input_file("episode log", path, kMaxLogBytes);
  const std::string settings =
      settings_without_seed(log_of(fs::path(path).filename().string(), bytes).settings);
  if (settings != order_.settings)
    throw std::runtime_error("the logs of " + fs::path(order_.path).filename().string() +
                             " have the settings '" + settings + "', not '" + order_.settings +
                             "'; choose another name");
}

void SubmissionFolder::add(const EpisodeLog& log) {
  const std::string bytes = bytes_of(log);
  const std::string path = unit_path() + '/' + std::to_string(log.origin.episode) + ".episode";
  budget_.take(kBytesBesideFile);
  write_file(path, bytes, budget_);
  try {
    SharedTable(table_path(), budget_).append(line_of(row_of(log, sha256_of(bytes))));
  } catch (...) {
    remove_file(path);
    throw;
  }
}

}  // namespace racebeam

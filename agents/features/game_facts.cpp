#include "agents/features/game_facts.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "recording/atomic_file.hpp"
#include "recording/sealed_file.hpp"
#include "recording/sha256.hpp"
#include "system/file_lock.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr SealedKind kBackground = {
    .what = "background", .magic = "RBBACKGR", .version = 1, .most = std::size_t{1} << 20, .level = 9};
constexpr SealedKind kClasses = {
    .what = "class file", .magic = "RBCLASSE", .version = 3, .most = std::size_t{1} << 28, .level = 9};

std::string source_of(const Cartridge& cartridge) {
  return "game=" + cartridge.game->name + " image=" + cartridge.image->md5;
}

// The first line of a file: all that what was discovered depends on.
std::string source_of(const Cartridge& cartridge, const SampleSettings& settings, int screens) {
  const PlaySettings& play = settings.play;
  std::string line = source_of(cartridge);
  append_pair(line, "seed", std::int64_t{settings.seed});
  append_pair(line, "screens", screens);
  append_pair(line, "frame_skip", play.machine.frame_skip);
  append_pair(line, "color_averaging", int{play.machine.color_averaging});
  if (play.mode) append_pair(line, "mode", *play.mode);
  if (play.difficulty) append_pair(line, "difficulty", *play.difficulty);
  append_pair(line, "version", settings.version);
  return line;
}

std::string source_of_background(const Cartridge& cartridge, const SampleSettings& settings) {
  if (settings.background_csv.empty()) return source_of(cartridge, settings, settings.background_screens);
  return source_of(cartridge) + " csv=" + settings.background_csv;
}

// Classes depend on the background, too.
std::string source_of(const Cartridge& cartridge, const SampleSettings& settings,
                      const Background& background) {
  const std::string_view colours(reinterpret_cast<const char*>(background.data()), background.size());
  return source_of(cartridge, settings, settings.class_screens)
      .append(" background=")
      .append(sha256_of(colours), 0, 16);
}

// The value of a word KEY=VALUE; empty if no word has the key.
std::string_view value_in(const std::vector<std::string_view>& words, std::string_view key) {
  for (const std::string_view word : words)
    if (word.starts_with(key) && word.substr(key.size()).starts_with('=')) return word.substr(key.size() + 1);
  return {};
}

// What the first line of a file has instead of `source`: the first word that differs, a background's source
// before all others.
std::string first_difference(std::string_view found, std::string_view source) {
  std::vector<std::string_view> words, expected;
  split(found, words);
  split(source, expected);
  std::vector<std::string_view> keys = {"csv"};
  for (const auto* const list : {&expected, &words})
    for (const std::string_view word : *list) keys.push_back(word.substr(0, word.find('=')));
  for (const std::string_view key : keys) {
    const std::string_view value = value_in(words, key), accepted = value_in(expected, key);
    if (value != accepted)
      return std::string(key) + " is " + (value.empty() ? "missing" : quote(value)) + "; expected " +
             (accepted.empty() ? "none" : quote(accepted));
  }
  return "its first line is " + quote(found) + "; expected " + quote(source);
}

// The contents behind the first line, which must be `source`.
std::string_view behind(std::string_view contents, const std::string& source, const std::string& path) {
  const std::string_view found = contents.substr(0, contents.find('\n'));
  if (found != source || found.size() == contents.size())
    throw InvalidInput(path + ": " + first_difference(found, source));
  return contents.substr(found.size() + 1);
}

}  // namespace

std::string bytes_of(const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings) {
  return seal(
      kBackground,
      (source_of_background(cartridge, settings) += '\n').append(background.begin(), background.end()));
}

Background background_of(const std::string& path, const Cartridge& cartridge,
                         const SampleSettings& settings) {
  const std::string contents = read_sealed(kBackground, path);
  const std::string_view pixels = behind(contents, source_of_background(cartridge, settings), path);
  Background background;
  const auto is_colour = [](unsigned char byte) { return byte < kColours; };
  if (pixels.size() != background.size() || !std::ranges::all_of(pixels, is_colour))
    throw InvalidInput(path + " does not hold 160 x 210 colours from 0 to 127");
  std::ranges::copy(pixels, background.begin());
  return background;
}

std::string bytes_of(const ObjectClasses& classes, const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings) {
  return seal(kClasses, source_of(cartridge, settings, background) + '\n' + text_of(classes));
}

ObjectClasses classes_of(const std::string& path, const Background& background, const Cartridge& cartridge,
                         const SampleSettings& settings) {
  const std::string contents = read_sealed(kClasses, path);
  return classes_of_text(path, behind(contents, source_of(cartridge, settings, background), path));
}

// Reads the fact's file. If the file is missing, discovers the fact and writes the file.
template <typename Fact>
const Fact& GameFacts::kept(std::optional<Fact>& fact, const std::string& ending, const auto& discover,
                            const auto& read, const auto& bytes) const {
  if (fact) return *fact;
  if (folder_.empty()) return fact.emplace(discover());
  const std::string file = path(ending);
  std::optional<FileLock> lock;
  if (!std::filesystem::exists(file)) lock.emplace(path(".lock"));
  if (std::filesystem::exists(file)) return fact.emplace(read(file));  // another process may have made it
  fact = discover();
  replace_file(file, bytes(*fact), Durable::kNow);
  return *fact;
}

std::string GameFacts::path(const std::string& ending) const {
  return folder_ + '/' + cartridge_.game->name + ending;
}

Background GameFacts::discovered_background() const {
  if (settings_.background_csv.empty()) return discover_background(cartridge_, settings_);
  const std::string& game = cartridge_.game->name;
  throw InvalidInput(path(".background") + ": no such file; racebeam background " + game +
                     " --csv FILE --into " + folder_ + " makes it from the file with SHA-256 " +
                     settings_.background_csv);
}

void GameFacts::check() {
  std::error_code none;  // a folder that cannot be searched holds no files
  if (std::filesystem::exists(path(".background"), none)) {
    background();
    if (std::filesystem::exists(path(".classes"), none)) classes();
  } else if (!settings_.background_csv.empty()) {
    discovered_background();
  }
}

const Background& GameFacts::background() {
  return kept(
      background_, ".background", [&] { return discovered_background(); },
      [&](const std::string& file) { return background_of(file, cartridge_, settings_); },
      [&](const Background& background) { return bytes_of(background, cartridge_, settings_); });
}

const ObjectClasses& GameFacts::classes() {
  const Background& still = background();
  return kept(
      classes_, ".classes", [&] { return discover_classes(cartridge_, settings_, still); },
      [&](const std::string& file) { return classes_of(file, still, cartridge_, settings_); },
      [&](const ObjectClasses& classes) { return bytes_of(classes, still, cartridge_, settings_); });
}

}  // namespace racebeam

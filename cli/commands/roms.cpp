#include "cli/commands/roms.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "emulator/cartridge/cartridge.hpp"
#include "games/catalogue.hpp"
#include "games/rom_image.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr auto kRomsFooter =
    R"(Examines the files in the folder (not in its subfolders) that end in .bin, .a26 or .rom, also with .gz after it,
and zip archives, which must have one image each.
Each file is one of:
  known     its MD5 is in the catalogue: it plays as this game
  by-name   another image, but the file is named like a game: it plays as that game, with a warning
  unknown   it plays without a score; --game NAME or --game-file FILE selects a rule
  unusable  it cannot be read, it is a link to what is not there, or no cartridge scheme fits it
The last line counts the images, and the games of the catalogue that the folder has no image of.

Example:
  racebeam roms ~/atari)";

struct RomFinding {
  std::string file;
  std::string verdict;  // known, by-name, unknown, unusable
  std::string game;     // known, by-name
  std::string md5;      // "" if unusable
  std::string scheme;   // of the cartridge
  std::string note;
};

// The game that lists this MD5 as another dump, which it is not recognised by; "" if no game does.
std::string other_dump_of(const std::string& md5) {
  for (const CatalogueImage& image : catalogue_images()) {
    if (image.md5 == md5) return std::string{catalogue()[image.entry].name};
  }
  return "";
}

RomFinding judge(const Image& image) {
  const Recognition recognition = recognise(image);
  const std::string& name = recognition.game->name;
  const std::string_view game_scheme = recognition.game->properties_for(image.md5).scheme;
  const std::string scheme(scheme_of(*image.bytes, game_scheme).name);
  if (recognition.how == RecognisedBy::kMd5) return {"", "known", name, image.md5, scheme, ""};
  if (recognition.how == RecognisedBy::kFileName)
    return {"", "by-name", name, image.md5, scheme, "not the image that its rule was written for"};
  const std::string dump = other_dump_of(image.md5);
  return {"",
          "unknown",
          "",
          image.md5,
          scheme,
          dump.empty() ? "--game NAME or --game-file FILE selects a rule"
                       : "another dump of " + dump + ": try --game " + dump};
}

// The text of an error. It leaves out the file's name, since another column shows that.
std::string reason_of(const std::exception& error, const fs::path& path) {
  const std::string sentence = error.what();
  const std::string name = "image " + path.string() + ": ";
  return sentence.starts_with(name) ? sentence.substr(name.size()) : sentence;
}

RomFinding examine(const fs::path& path) {
  RomFinding finding;
  try {
    finding = judge(*load_image(path.string()));
  } catch (const std::exception& error) {
    finding = {"", "unusable", "", "", "", reason_of(error, path)};
  }
  finding.file = path.filename().string();
  return finding;
}

RomFinding broken_link(const fs::path& path) {
  std::error_code none;
  const std::string target = fs::read_symlink(path, none).string();
  return {path.filename().string(), "unusable", "", "", "", "a link to '" + target + "', which is not there"};
}

std::vector<RomFinding> findings_in(const std::string& folder) {
  std::vector<RomFinding> findings;
  for (const fs::path path : image_files(folder)) findings.push_back(examine(path));
  for (const fs::path path : broken_image_links(folder)) findings.push_back(broken_link(path));
  std::ranges::sort(findings, {}, &RomFinding::file);
  return findings;
}

std::vector<std::string> games_without(const std::vector<RomFinding>& findings) {
  std::set<std::string> found;
  for (const RomFinding& finding : findings) found.insert(finding.game);
  std::vector<std::string> missing;
  for (const CatalogueEntry& entry : catalogue()) {
    const std::string name{entry.name};
    if (!entry.built_in && !found.contains(name)) missing.push_back(name);
  }
  return missing;
}

void print_text(const std::vector<RomFinding>& findings, const std::vector<std::string>& missing,
                bool names_missing) {
  for (const RomFinding& finding : findings) {
    const std::string game = finding.game.empty() ? "-" : finding.game;
    std::printf("%-8s  %-20s %-32s  %-5s %s%s%s\n", finding.verdict.c_str(), game.c_str(),
                finding.md5.empty() ? "-" : finding.md5.c_str(),
                finding.scheme.empty() ? "-" : finding.scheme.c_str(), printable(finding.file).c_str(),
                finding.note.empty() ? "" : ": ", printable(finding.note).c_str());
  }
  if (names_missing) {
    for (const std::string& name : missing) std::printf("missing   %s\n", name.c_str());
  }
  std::printf("%zu image%s; %zu games without one%s\n", findings.size(), findings.size() == 1 ? "" : "s",
              missing.size(), names_missing || missing.empty() ? "" : " (--missing lists them)");
}

void print_json(const std::vector<RomFinding>& findings, const std::vector<std::string>& missing) {
  auto rows = nlohmann::ordered_json::array();
  for (const RomFinding& finding : findings) {
    rows.push_back({{"file", finding.file},
                    {"verdict", finding.verdict},
                    {"game", finding.game},
                    {"md5", finding.md5},
                    {"scheme", finding.scheme},
                    {"note", finding.note}});
  }
  // A file's name may be invalid UTF-8. Everything beyond ASCII is escaped, because it includes control
  // characters.
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::cout << nlohmann::ordered_json{{"images", rows}, {"missing", missing}}.dump(1, ' ', true, kReplace)
            << '\n';
}

struct Options {
  std::string folder;
  bool json = false;
  bool names_missing = false;
};

void run(const Options& options) {
  const std::vector<RomFinding> findings = findings_in(options.folder);
  const auto missing = games_without(findings);
  options.json ? print_json(findings, missing) : print_text(findings, missing, options.names_missing);
}

}  // namespace

void add_roms(Subcommand& program) {
  const auto options = std::make_shared<Options>();
  Subcommand command = program.add_subcommand(
      "roms", "List which images in a folder are known, and which games lack one", kRomsFooter);
  command.option("DIR", options->folder, "The folder with the images").required();
  command.flag("--json", options->json, "Print a JSON object instead of text");
  command.flag("--missing", options->names_missing, "Also list the games that the folder has no image of");
  command.runs([options] { run(*options); });
}

}  // namespace racebeam

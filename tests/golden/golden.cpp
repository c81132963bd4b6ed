// The digests that our own games must show, kept beside this file, and the signature of the machine.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <sstream>

#include "games/digest.hpp"
#include "tests/golden/works.hpp"

namespace racebeam::test {
namespace {

std::string report(const std::vector<Work>& works) {
  std::string text;
  for (const Work& work : works) text += "\n[" + work.name + "]\n" + kColumns + played(work);
  return text;
}

std::string golden_text(const std::string& game) {
  return "# What builtin:" + game +
         " shows, folded line by line. scripts/golden compares, scripts/golden --rebaseline writes.\n" +
         report(works_of(game));
}

std::string file_of(const std::string& game) { return RACEBEAM_SOURCE_DIR "/tests/golden/" + game + ".txt"; }

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("can't read " + path + "; scripts/golden --rebaseline makes it");
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (!(file << text).flush()) throw std::runtime_error("can't write " + path);
}

// Prints the lines that differ, under the setting that they belong to. Are there none?
bool same_lines(const std::string& game, const std::string& kept, const std::string& shown) {
  std::istringstream kept_lines(kept), shown_lines(shown);
  std::string kept_line, shown_line, setting;
  bool same = true;
  while (true) {
    const bool more_kept = static_cast<bool>(std::getline(kept_lines, kept_line));
    const bool more_shown = static_cast<bool>(std::getline(shown_lines, shown_line));
    if (!more_kept && !more_shown) return same;
    if (more_shown && shown_line.starts_with('[')) setting = shown_line;
    if (more_kept == more_shown && kept_line == shown_line) continue;
    same = false;
    std::printf("%s %s\n  kept:  %s\n  shown: %s\n", game.c_str(), setting.c_str(),
                more_kept ? kept_line.c_str() : "nothing", more_shown ? shown_line.c_str() : "nothing");
  }
}

bool compare(const std::string& game, bool rebaseline) {
  const std::string shown = golden_text(game);
  if (rebaseline) {
    write_file(file_of(game), shown);
    return true;
  }
  return same_lines(game, read_file(file_of(game)), shown);
}

// One digest of all that is played; the lines themselves say where two compilers part.
void print_signature(const std::vector<std::string>& games, bool lines) {
  std::string text = report(works_of_programs());
  for (const std::string& game : games) text += golden_text(game);
  if (lines) std::fputs(text.c_str(), stdout);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  std::printf("%s\n", md5_of(bytes).c_str());
}

int run(int argc, char** argv) {
  CLI::App app("Compares what our own games show with tests/golden/GAME.txt");
  std::vector<std::string> games = {"beamfall", "updraft"};
  bool rebaseline = false, signature = false, lines = false;
  app.add_option("GAME", games, "Games that are built in")->check(CLI::IsMember(games));
  app.add_flag("--rebaseline", rebaseline, "Write the files instead");
  app.add_flag("--signature", signature,
               "Print one digest of all games and of programs in every cartridge scheme");
  app.add_flag("--lines", lines, "With --signature: print what it is the digest of, too")
      ->needs("--signature");
  CLI11_PARSE(app, argc, argv);
  if (signature) {
    print_signature(games, lines);
    return 0;
  }
  bool same = true;
  for (const std::string& game : games) same = compare(game, rebaseline) && same;
  return same ? 0 : 1;
}

}  // namespace
}  // namespace racebeam::test

int main(int argc, char** argv) {
  try {
    return racebeam::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "golden: %s\n", error.what());
    return 1;
  }
}

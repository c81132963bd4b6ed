// Compares our own games with their digests in this folder, and prints the signature of the machine.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <map>
#include <sstream>

#include "games/catalogue.hpp"
#include "games/md5.hpp"
#include "tests/golden/works.hpp"

namespace racebeam::test {
namespace {

std::string report(const std::vector<Work>& works, bool states = false) {
  std::string text;
  for (const Work& work : works) text += "\n[" + work.name + "]\n" + kColumns + played(work, states);
  return text;
}

std::string golden_text(const std::string& game) {
  return "# What builtin:" + game +
         " shows, folded line by line. scripts/check/golden compares, scripts/check/golden --rebaseline "
         "writes.\n" +
         report(works_of(game));
}

std::vector<std::string> own_games() {
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : catalogue())
    if (entry.built_in) names.emplace_back(entry.name);
  return names;
}

std::string file_of(const std::string& game) { return RACEBEAM_SOURCE_DIR "/tests/golden/" + game + ".txt"; }

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (!(file << text).flush()) throw std::runtime_error("can't write " + path);
}

// Prints the lines that differ, with their setting. Returns whether all are equal.
bool same_lines(const std::string& game, const std::string& expected, const std::string& found) {
  std::istringstream kept_lines(expected), shown_lines(found);
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
  const std::string text = golden_text(game);
  if (rebaseline) {
    write_file(file_of(game), text);
    return true;
  }
  return same_lines(game, read_file(file_of(game)), text);
}

struct SignatureOptions {
  std::string save_states, play_states;  // folders
  bool signature = false, lines = false, images = false, states = false;
  CpuKind cpu = CpuKind::kAuto;
  int at_once = 1;
  int frames = 0;                // of each game with an image, and nothing else; 0: the usual works
  std::vector<int> slice{0, 1};  // K, N: of these, each whose number leaves K when it is divided by N
};

// A part of all games with an image.
std::vector<Work> slice_of_images(const SignatureOptions& options) {
  if (options.slice[0] >= options.slice[1]) throw std::runtime_error("--slice K N: K must be less than N");
  std::vector<Work> works;
  int number = 0;
  for (const Work& work : works_of_images(options.frames))
    if (number++ % options.slice[1] == options.slice[0]) works.push_back(work);
  if (works.empty()) throw std::runtime_error("no images; RACEBEAM_ROMS names their folder");
  return works;
}

std::vector<Work> works_of_signature(const std::vector<std::string>& games, const SignatureOptions& options) {
  std::vector<Work> all;
  const auto add = [&all](std::vector<Work> works) { all.insert(all.end(), works.begin(), works.end()); };
  if (options.frames > 0) {
    add(slice_of_images(options));
  } else {
    add(works_of_programs());
    for (const std::string& game : games) add(works_of(game));
    if (options.images) add(works_of_images());
  }
  for (Work& work : all) work.settings.cpu = options.cpu;
  return all;
}

// Runs the same work in several threads at once, each with its own machines. Returns their output.
std::string reported_at_once(const std::vector<Work>& works, int threads, bool states) {
  if (threads == 1) return report(works, states);
  std::vector<std::future<std::string>> reports;
  for (int i = 0; i < threads; ++i)
    reports.push_back(std::async(std::launch::async, [&works, states] { return report(works, states); }));
  const std::string first = reports.front().get();
  bool same = true;
  for (std::size_t i = 1; i < reports.size(); ++i)
    same = same_lines("thread " + std::to_string(i), first, reports[i].get()) && same;
  if (!same) throw std::runtime_error("threads that did the same showed different things");
  return first;
}

std::string state_file(const std::string& folder, std::size_t number) {
  return folder + "/" + std::to_string(number) + ".state";
}

// Exports a state of each work after half of its acts. Returns the output of the second half.
std::string save_states(const std::vector<Work>& works, const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::string text;
  for (std::size_t i = 0; i < works.size(); ++i) {
    const Halves halves = played_in_halves(works[i]);
    write_file(state_file(folder, i), {halves.state.begin(), halves.state.end()});
    text += "\n[" + works[i].name + "]\n" + kColumns + halves.rest;
  }
  return text;
}

// Continues the states that save_states() has exported, here or on another platform, and returns the same.
std::string play_states(const std::vector<Work>& works, const std::string& folder) {
  std::string text;
  for (std::size_t i = 0; i < works.size(); ++i) {
    const std::string path = state_file(folder, i), state = read_file(path);
    text += "\n[" + works[i].name + "]\n" + kColumns;
    try {
      text += continued(works[i], {reinterpret_cast<const std::uint8_t*>(state.data()), state.size()});
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(path + ": " + error.what());
    }
  }
  return text;
}

std::string output_of(const std::vector<Work>& works, const SignatureOptions& options) {
  if (!options.save_states.empty()) return save_states(works, options.save_states);
  if (!options.play_states.empty()) return play_states(works, options.play_states);
  return reported_at_once(works, options.at_once, options.states);
}

// Prints one digest of all output, or its lines, which show where two builds differ.
void print_signature(const std::vector<std::string>& games, const SignatureOptions& options) {
  const std::string text = output_of(works_of_signature(games, options), options);
  if (options.lines) std::fputs(text.c_str(), stdout);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  std::printf("%s\n", md5_of(bytes).c_str());
}

int run(int argc, char** argv) {
  CLI::App app("Compares the output of our own games with tests/golden/GAME.txt");
  std::vector<std::string> games = own_games();
  bool rebaseline = false;
  SignatureOptions options;
  const std::map<std::string, CpuKind> cpus = {
      {"auto", CpuKind::kAuto}, {"interpreter", CpuKind::kInterpreter}, {"translator", CpuKind::kTranslator}};
  app.add_option("GAME", games, "Built-in games")->check(CLI::IsMember(games));
  app.add_flag("--rebaseline", rebaseline, "Write the files instead of comparing");
  app.add_flag("--signature", options.signature,
               "Print one digest of all games and of programs in every cartridge scheme");
  const auto with_signature = [](CLI::Option* option) { option->needs("--signature"); };
  CLI::Option* const save =
      app.add_option("--save-states", options.save_states,
                     "Export states to this folder, play on, and print the digest of that");
  app.add_option("--play-states", options.play_states,
                 "Print the digest of playing on from the states in this folder")
      ->excludes(save);
  with_signature(app.add_flag("--lines", options.lines, "Also print the lines that the digest is made from"));
  with_signature(app.add_flag("--images", options.images, "Include all games with a cartridge image"));
  CLI::Option* const frames =
      app.add_option("--frames", options.frames,
                     "Play only games with a cartridge image, and this many frames of each")
          ->check(CLI::Range(1, 1000000));
  with_signature(frames);
  app.add_option("--slice", options.slice, "K N: of these, each N-th from number K on")
      ->expected(2)
      ->check(CLI::NonNegativeNumber)
      ->needs(frames);
  with_signature(app.add_flag("--states", options.states, "Include the bytes of each final state"));
  with_signature(app.add_option("--cpu", options.cpu, "How instructions are executed")
                     ->transform(CLI::CheckedTransformer(cpus)));
  with_signature(app.add_option("--at-once", options.at_once,
                                "Number of threads that do the work at once, and must agree")
                     ->check(CLI::Range(1, 64)));
  CLI11_PARSE(app, argc, argv);
  if (options.signature || !options.save_states.empty() || !options.play_states.empty()) {
    print_signature(games, options);
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

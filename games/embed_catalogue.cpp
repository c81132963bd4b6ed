// A tool of the build. It checks all game files, and writes them, with the built-in images, as one C++
// source.
//   embed_catalogue OUTPUT CATALOGUE-FOLDER HOMEBREW-FOLDER
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <vector>

#include "games/files/game_file.hpp"
#include "games/md5.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;  // by file stem

Contents read_folder(const fs::path& folder, const std::string& ending) {
  Contents contents;
  if (!fs::is_directory(folder)) return contents;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ending) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    contents[entry.path().stem().string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return contents;
}

// Raw string literals, several in a row, because compilers limit the length of one.
std::string literal(std::string_view text) {
  constexpr std::size_t kPiece = 8000;
  std::string literal;
  for (; !text.empty(); text.remove_prefix(std::min(text.size(), kPiece)))
    literal += "R\"toml(" + std::string(text.substr(0, kPiece)) + ")toml\"";
  return literal;
}

std::string raw(std::string_view text) { return "R\"(" + std::string(text) + ")\""; }

struct Md5Entry {
  std::string md5;
  std::size_t game;
  bool accepted;
};

class Catalogue {
 public:
  Catalogue(const fs::path& folder, Contents images) : images_(std::move(images)) {
    for (const auto& [name, text] : read_folder(folder, ".toml")) add(name, text, folder / (name + ".toml"));
    for (const auto& [name, bytes] : images_)
      if (std::ranges::find(names_, name) == names_.end())
        throw InvalidInput("the built-in image " + name + " has no game file");
    std::ranges::sort(md5s_, {}, &Md5Entry::md5);
    for (std::size_t i = 1; i < md5s_.size(); ++i)
      if (md5s_[i].md5 == md5s_[i - 1].md5) throw InvalidInput("two games list the MD5 " + md5s_[i].md5);
  }

  void write(std::ostream& out) const {
    out << "// Made by embed_catalogue from games/catalogue and games/homebrew.\n"
           "#include \"games/catalogue.hpp\"\n\nnamespace racebeam {\nnamespace {\n\n";
    write_bytes(out);
    table(out, "CatalogueEntry", "kEntries", entries_);
    std::string md5s, images;
    for (const Md5Entry& entry : md5s_)
      md5s += "  {\"" + entry.md5 + "\", " + std::to_string(entry.game) + ", " +
              (entry.accepted ? "true" : "false") + "},\n";
    for (const auto& [name, bytes] : images_) images += "  {\"" + name + "\", kBytes_" + name + "},\n";
    table(out, "CatalogueImage", "kMd5s", md5s);
    table(out, "BuiltInImage", "kBuiltIn", images);
    out << "}  // namespace\n\n"
           "std::span<const CatalogueEntry> catalogue() { return kEntries; }\n"
           "std::span<const CatalogueImage> catalogue_images() { return kMd5s; }\n"
           "std::span<const BuiltInImage> builtin_images() { return kBuiltIn; }\n\n"
           "}  // namespace racebeam\n";
  }

 private:
  void add(const std::string& name, const std::string& text, const fs::path& path) {
    const Game game = parse_game(text, name, path.string());
    const auto built_in = images_.find(name);
    for (const GameImage& image : game.images) add_md5(image, built_in != images_.end(), path);
    if (built_in != images_.end()) md5s_.push_back({md5_of_text(built_in->second), names_.size(), true});
    const std::string flags = std::string(game.has_rule() ? "true" : "false") + ", " +
                              (built_in != images_.end() ? "true" : "false");
    entries_ += "  {\"" + name + "\", " + raw(game.title) + ", " + flags + ",\n" + literal(text) + "},\n";
    names_.push_back(name);
  }

  void add_md5(const GameImage& image, bool is_built_in, const fs::path& path) {
    if (!image.md5.empty())
      md5s_.push_back({image.md5, names_.size(), image.accepted});
    else if (!is_built_in)
      throw InvalidInput(path.string() + ":1: image.md5: an image that is not built in must have this key");
  }

  static std::string md5_of_text(const std::string& bytes) {
    return md5_of({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }

  void write_bytes(std::ostream& out) const {
    for (const auto& [name, bytes] : images_) {
      out << "constexpr std::uint8_t kBytes_" << name << "[] = {";
      for (std::size_t i = 0; i < bytes.size(); ++i)
        out << (i % 32 == 0 ? "\n  " : "") << int{static_cast<std::uint8_t>(bytes[i])} << ",";
      out << "\n};\n\n";
    }
  }

  // std::array, because a table may be empty.
  static void table(std::ostream& out, const std::string& type, const std::string& name,
                    const std::string& rows) {
    const std::string list = rows.empty() ? "std::span<const " + type + "> " + name + "{};\n\n"
                                          : type + " " + name + "[] = {\n" + rows + "};\n\n";
    out << "constexpr " << list;
  }

  Contents images_;
  std::vector<std::string> names_;
  std::vector<Md5Entry> md5s_;
  std::string entries_;
};

}  // namespace
}  // namespace racebeam

int main(int argc, char** argv) try {
  if (argc != 4)
    throw racebeam::InvalidInput("usage: embed_catalogue OUTPUT CATALOGUE-FOLDER HOMEBREW-FOLDER");
  const racebeam::Catalogue catalogue(argv[2], racebeam::read_folder(argv[3], ".bin"));
  std::ofstream out(argv[1]);
  catalogue.write(out);
  if (!out.flush()) throw std::runtime_error(std::string("cannot write ") + argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}

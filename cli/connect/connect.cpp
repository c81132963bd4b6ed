#include "cli/connect/connect.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <racebeam/client.hpp>
#include <sstream>
#include <string>

#include "cli/arguments/subcommand.hpp"
#include "cli/connect/completion.hpp"
#include "cli/connect/help_lines.hpp"
#include "cli/connect/line_editor.hpp"
#include "cli/connect/server_address.hpp"
#include "cli/terminal/display.hpp"
#include "system/input_file.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

constexpr auto kConnectFooter =
    R"(Sends each line to a server of the line protocol, and prints its reply. On a terminal, lines can be edited, and
earlier lines are recalled with the arrow keys; Tab completes commands, games, keys, fields and actions; a value of
more than 200 characters is shown by its length. Replies of help are folded. Lines that begin with a colon are for
this program:
  :screen     show the screen in colours, as --graphics says
  :help       list these lines; help is the server's
  :quit       end, as the end of the input does

Address: tcp://HOST:PORT, or HOST:PORT for short, tls://HOST:PORT, unix:PATH, pipes:PREFIX, or file:PATH, a server's
--ready-file or --announce file. Without one, the variable RACEBEAM_ADDRESS is used.

Exit status: 0; 1 if the server is not there or goes, and with --strict also at the first error; 2 usage error.

Examples:
  racebeam connect localhost:7800
  printf 'load beamfall\nact FIRE*30\n:screen\n' | racebeam connect unix:/run/racebeam/socket)";

constexpr auto kLocalHelp =
    ":screen shows the screen, :quit ends, and other lines go to the server; help explains its commands";

constexpr std::size_t kLongestShown = 200;  // characters of a value on a terminal
constexpr std::size_t kMaxTokenFile = 1 << 16;

struct ConnectOptions {
  std::string address, token_file;
  client::Options client;
  double timeout = 0;  // seconds; 0: none
  bool strict = false;
  Graphics graphics = Graphics::kAuto;
};

// The first token of a file of the form that serve --token-file reads.
std::string token_in(const std::string& path) {
  std::istringstream lines(read_input_file("token file", path, kMaxTokenFile));
  for (std::string line; std::getline(lines, line);) {
    while (line.ends_with('\r') || line.ends_with(' ')) line.pop_back();
    if (!line.empty() && !line.starts_with('#')) return line;
  }
  throw std::invalid_argument("the token file " + path + " has no token");
}

// A reply in which long values are replaced by their lengths.
std::string shortened(std::string_view line) {
  std::string text;
  for (const std::string_view word : client::detail::split(line, ' ')) {
    if (!text.empty()) text += ' ';
    const std::size_t begin = word.find('=') + 1;  // 0 without a value
    if (word.size() - begin > kLongestShown && begin > 0) {
      text.append(word.substr(0, begin + 20))
          .append("...(")
          .append(std::to_string(word.size() - begin))
          .append(")");
    } else {
      text.append(word);
    }
  }
  return text;
}

class Conversation {
 public:
  Conversation(client::Session session, const ConnectOptions& options)
      : session_(std::move(session)),
        strict_(options.strict),
        graphics_(options.graphics),
        editor_("racebeam> ", [this](auto before, auto word) { return completion_.words(before, word); }) {}

  // Returns the exit status.
  int hold() {
    while (const auto line = editor_.next()) {
      const std::size_t begin = line->find_first_not_of(" \t\r");
      if (begin == std::string::npos || (*line)[begin] == '#') continue;
      if (line->substr(begin) == ":quit") break;
      if (!answer(line->substr(begin, line->find_last_not_of(" \t\r") + 1 - begin)) && strict_) return 1;
    }
    return 0;
  }

 private:
  // Asks the server what completion needs to know.
  std::string text_of(const std::string& request) {
    try {
      constexpr std::string_view kOk = "ok ";
      const std::string line = session_.request(request).line();
      return line.substr(std::min(kOk.size(), line.size()));
    } catch (const client::Refused&) {
      return {};
    }
  }

  // Prints what a line leads to. False if it was refused.
  bool answer(const std::string& line) {
    try {
      if (line == ":screen") {
        show_screen();
      } else if (line.starts_with(':')) {
        std::cout << kLocalHelp << std::endl;
      } else {
        show(line, printable(session_.request(line).line()));
      }
      return true;
    } catch (const client::Refused& refused) {
      std::cout << "error " << printable(refused.code()) << ' ' << printable(refused.sentence()) << std::endl;
      return false;
    }
  }

  void show(const std::string& line, const std::string& reply) const {
    const std::string command = line.substr(0, line.find(' '));
    if (command == "help" || command == "?") {
      std::cout << help_lines(reply, columns_of_output()) << std::endl;
    } else {
      std::cout << (editor_.interactive() ? shortened(reply) : reply) << std::endl;
    }
  }

  void show_screen() {
    const auto look = session_.look("screen:zlib", "palette");
    const TerminalPicture picture{look.bytes("screen"), look.bytes("palette")};
    Room room;
    if (editor_.interactive()) ask_terminal(room);
    room.rows = kScrollingRows;
    std::cout << inline_picture(graphics_, picture, room) << std::flush;
  }

  // Its size, and once, what it can show.
  void ask_terminal(Room& room) {
    Tty tty;
    if (graphics_ == Graphics::kAuto) graphics_ = choose_graphics(graphics_, ask_abilities(tty));
    room = tty.size();
  }

  client::Session session_;
  bool strict_;
  Graphics graphics_;
  Completion completion_{[this](const std::string& request) { return text_of(request); },
                         {":screen", ":help", ":quit"}};
  LineEditor editor_;
};

int connect(ConnectOptions options) {
  if (!options.token_file.empty()) options.client.token = token_in(options.token_file);
  if (options.timeout > 0)
    options.client.timeout = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * options.timeout));
  return Conversation(client::connect(server_address(options.address), options.client), options).hold();
}

}  // namespace

void add_connect(Subcommand& program) {
  auto options = std::make_shared<ConnectOptions>();
  Subcommand command =
      program.add_subcommand("connect", "Talk to a server, by hand or from a script", kConnectFooter);
  command.option("ADDRESS", options->address, "The address of the server").variable("RACEBEAM_ADDRESS");
  command.option("--token-file", options->token_file, "Send the first token of this file").value_name("FILE");
  command
      .option("--authorities", options->client.authorities, "With tls://: trust these certificates, in PEM")
      .value_name("FILE");
  command.option("--timeout", options->timeout, "Seconds to wait for a connection or a reply; 0: no limit")
      .check(number(0, 1e6))
      .shows_default();
  add_graphics_option(command, options->graphics);
  command.flag("--strict", options->strict, "End with status 1 at the first error");
  command.exits_with([options] { return connect(*options); });
}

}  // namespace racebeam

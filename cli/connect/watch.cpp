#include "cli/connect/watch.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <racebeam/client.hpp>
#include <string>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "cli/connect/browser.hpp"
#include "cli/connect/half_blocks.hpp"
#include "cli/connect/page_address.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

constexpr auto kWatchFooter =
    R"(Shows the sessions whose clients have said `share`, or all with serve --watch all.

With --terminal, draws one of them in the terminal, as half blocks in 24-bit colours, as fast as the terminal and the
connection take them. Keys: n the next session, p the one before, q the end. ADDRESS is then that of
racebeam connect: tcp://HOST:PORT, tls://HOST:PORT, unix:PATH or file:PATH. If standard output is no terminal, one
picture is written.

Without --terminal, opens the server's page in a browser, and prints its address; ADDRESS is then ws://HOST:PORT,
wss://HOST:PORT, http://HOST:PORT or https://HOST:PORT.

A server on another machine is reached over SSH. Forward its port, and give the address of this end:
  ssh -N -L 7800:127.0.0.1:7800 HOST
  racebeam watch http://127.0.0.1:7800

Examples:
  racebeam watch --terminal tcp://127.0.0.1:7801
  racebeam watch --terminal --session room file:announce)";

constexpr int kBetweenLooks = 33;    // milliseconds
constexpr int kBetweenLists = 1000;  // while nothing is shared
constexpr auto kHome = "\x1b[H", kClear = "\x1b[2J", kHideCursor = "\x1b[?25l", kShowCursor = "\x1b[?25h",
               kToEndOfLine = "\x1b[K\n";

struct WatchOptions {
  std::string address, session;
  bool terminal = false;
};

// While it lives, each key is read at once, and is not shown.
class Keys {
 public:
  Keys() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    is_set_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0;
  }
  ~Keys() {
    if (is_set_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  // Waits up to this time. Returns a key, 'q' at the end of the input, or 0.
  char wait(int milliseconds) const {
    pollfd state{STDIN_FILENO, POLLIN, 0};
    if (::poll(&state, 1, milliseconds) <= 0) return 0;
    char key = 'q';
    return ::read(STDIN_FILENO, &key, 1) == 1 ? key : 'q';
  }

 private:
  termios before_{};
  bool is_set_ = false;
};

std::size_t picture_columns() {
  constexpr std::size_t kUsual = 80, kMost = 160;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  const std::size_t rows = size.ws_row > 2 ? size.ws_row - 2U : 1;
  return std::clamp<std::size_t>(rows * 4 * 160 / 210, 1, std::min<std::size_t>(size.ws_col, kMost));
}

class Watcher {
 public:
  Watcher(client::Session session, std::string name) : session_(std::move(session)), name_(std::move(name)) {}

  // Draws until the user ends it.
  void watch() {
    const Keys keys;
    std::cout << kHideCursor << kClear;
    for (char key = 0; key != 'q'; key = keys.wait(name_.empty() ? kBetweenLists : kBetweenLooks)) {
      if (key == 'n' || key == 'p') choose(key == 'n' ? 1 : -1);
      if (name_.empty()) choose(0);
      std::cout << kHome << look() << std::flush;
    }
    std::cout << kShowCursor << std::flush;
  }

  // Writes one picture.
  void show() {
    if (name_.empty()) choose(0);
    std::cout << look();
  }

 private:
  // Goes this many sessions on in the list.
  void choose(std::ptrdiff_t steps) {
    std::vector<std::string> names;
    const client::Reply shared = session_.request("shared");
    for (const client::Group& group : shared.rest()) names.push_back(group.text("name"));
    picture_.clear();
    frame_.reset();
    if (names.empty()) return name_.clear();
    const auto count = std::ssize(names), here = std::ranges::find(names, name_) - names.begin();
    name_ = names[static_cast<std::size_t>(((here == count ? 0 : here) + steps + count) % count)];
  }

  // What the terminal is to show.
  std::string look() {
    if (name_.empty()) return std::string("no session is shared").append(kToEndOfLine);
    try {
      std::string request = "watch " + name_;
      if (frame_) request.append(" since=").append(*frame_);
      const client::Reply reply = session_.request(request.append(" screen:zlib palette"));
      const client::Group& seen = reply.first();
      frame_ = seen.text("frame");
      if (seen.has("screen")) picture_ = draw(seen);
      return picture_ + describe(seen);
    } catch (const client::Refused& refused) {
      const std::string sentence = refused.sentence();
      choose(0);
      if (name_.empty()) return std::string(kClear).append(kHome).append(sentence).append(kToEndOfLine);
      return {};
    }
  }

  static std::string draw(const client::Group& seen) {
    const auto screen = client::decode(client::Encoding::kZlib, seen.text("screen"));
    const auto colours = client::decode(client::Encoding::kHex, seen.text("palette"));
    return half_blocks(screen, colours, picture_columns());
  }

  std::string describe(const client::Group& seen) const {
    std::string line = printable(name_);
    for (const std::string key : {"game", "score", "lives", "episode", "action"})
      line.append("  ").append(key).append(" ").append(printable(seen.text(key)));
    return line.append(kToEndOfLine);
  }

  client::Session session_;
  std::string name_;  // of the shared session; empty: none
  std::optional<std::string> frame_;
  std::string picture_;
};

void open_page(const WatchOptions& options) {
  std::string page = page_address(options.address);
  if (page.empty())
    throw UsageError("ADDRESS: '" + options.address +
                     "' has no page; accepted are ws://, wss://, http:// and https://HOST:PORT, and other "
                     "addresses with --terminal");
  page += "/#watch";
  std::cout << page << std::endl;
  const auto command = browser_command(page);
  if (!command) return;
  std::vector<char*> words;
  for (const std::string& word : *command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execvp(words[0], words.data());
  throw std::runtime_error("cannot run " + command->front() + "; open the page by hand");
}

void watch(const WatchOptions& options) {
  if (!options.terminal) return open_page(options);
  Watcher watcher(client::connect(options.address), options.session);
  ::isatty(STDOUT_FILENO) != 0 ? watcher.watch() : watcher.show();
}

}  // namespace

void add_watch(Subcommand& program) {
  const auto options = std::make_shared<WatchOptions>();
  Subcommand command =
      program.add_subcommand("watch", "Look at the shared sessions of a server", kWatchFooter);
  command.option("ADDRESS", options->address, "Where the server is").variable("RACEBEAM_ADDRESS").required();
  command.flag("--terminal", options->terminal, "Draw in the terminal");
  command.option("--session", options->session, "Begin with the session of this name").value_name("NAME");
  command.runs([options] { watch(*options); });
}

}  // namespace racebeam

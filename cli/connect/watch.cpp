#include "cli/connect/watch.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <racebeam/client.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/arguments/subcommand.hpp"
#include "cli/connect/browser.hpp"
#include "cli/connect/page_address.hpp"
#include "cli/connect/server_address.hpp"
#include "cli/terminal/display.hpp"
#include "system/printable.hpp"
#include "system/program/execute.hpp"
#include "system/program/standard_streams.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kWatchFooter =
    R"(Shows the sessions whose clients have said `share`, or all with serve --watch all.

With --terminal, draws one of them in the terminal, as --graphics says. Pictures that the line does not carry in time
are left out. Keys: n the next session, p the one before, q the end. ADDRESS is then that of racebeam connect:
tcp://HOST:PORT, tls://HOST:PORT, unix:PATH or file:PATH. If standard output is not a terminal, one picture is written;
the exit status is 1 if none exists.

Without --terminal, opens the server's page in a browser, and prints its address; ADDRESS is then ws://HOST:PORT,
wss://HOST:PORT, http://HOST:PORT or https://HOST:PORT.

A server on another machine is reached over SSH. Forward its port, and give the address of this end:
  ssh -N -L 7800:127.0.0.1:7800 HOST
  racebeam watch http://127.0.0.1:7800

Examples:
  racebeam watch --terminal tcp://127.0.0.1:7801
  racebeam watch --terminal --session room file:announce)";

constexpr auto kBetweenLooks = 16ms;
constexpr auto kBetweenLists = 1s;  // while nothing is shared

struct WatchOptions {
  std::string address, session;
  bool terminal = false;
  Graphics graphics = Graphics::kAuto;
};

class Watcher {
 public:
  Watcher(client::Session session, std::string name) : session_(std::move(session)), name_(std::move(name)) {}

  // Draws until the user ends it.
  void watch(Graphics graphics) {
    Display display(graphics);
    bool ended = false;
    while (!ended) {
      if (display.is_ready()) {
        const bool is_new = look() || (display.is_resized() && !picture_.pixels.empty());
        display.show(is_new ? &picture_ : nullptr, line_);
      }
      const auto next = Clock::now() + (name_.empty() ? kBetweenLists : kBetweenLooks);
      do {
        for (const TerminalEvent& event : display.wait(next)) ended = ended || handle(event);
      } while (!ended && Clock::now() < next);
    }
  }

  // Writes one picture.
  void show(Graphics graphics) {
    if (!look()) throw std::runtime_error(line_);
    std::cout << inline_picture(graphics, picture_, {.rows = kScrollingRows}) << line_ << std::endl;
  }

 private:
  // Returns whether the key ends the program.
  bool handle(const TerminalEvent& event) {
    if (event.kind != TerminalEvent::Kind::kPress) return false;
    if (event.key == 'n' || event.key == 'p') choose(event.key == 'n' ? 1 : -1);
    return event.key == 'q';
  }

  // Goes this many sessions on in the list. If the session is not there any more, 1 leads to the first, and
  // -1 to the last.
  void choose(std::ptrdiff_t steps) {
    std::vector<std::string> names;
    const client::Reply shared = session_.request("shared");
    for (const client::Group& group : shared.rest()) names.push_back(group.text("name"));
    frame_.reset();
    if (names.empty()) return name_.clear();
    const auto count = std::ssize(names), place = std::ranges::find(names, name_) - names.begin();
    const auto here = place < count ? place : steps > 0 ? -1 : 0;
    name_ = names[static_cast<std::size_t>((here + steps + count) % count)];
  }

  // Asks for the newest picture. Returns whether there is another one.
  bool look() {
    if (name_.empty()) choose(0);
    if (name_.empty()) return say("no session is shared");
    try {
      return take(
          session_.request("watch " + name_ + (frame_ ? " since=" + *frame_ : "") + " screen:zlib palette"));
    } catch (const client::Refused& refused) {
      choose(0);
      return say(printable(refused.sentence()));
    }
  }

  bool say(std::string line) {
    line_ = std::move(line);
    return false;
  }

  bool take(const client::Reply& reply) {
    const client::Group& group = reply.first();
    frame_ = group.text("frame");
    line_ = printable(name_);
    for (const std::string key : {"game", "score", "lives", "episode", "action"})
      line_.append("  ").append(key).append(" ").append(printable(group.text(key)));
    if (!group.has("screen")) return false;
    picture_.pixels = client::decode(client::Encoding::kZlib, group.text("screen"));
    picture_.colours = client::decode(client::Encoding::kHex, group.text("palette"));
    return true;
  }

  client::Session session_;
  std::string name_;  // of the shared session; empty: none
  std::optional<std::string> frame_;
  std::string line_;  // what is said of it
  TerminalPicture picture_;
};

void open_page(const WatchOptions& options) {
  std::string page = page_address(options.address);
  if (page.empty())
    throw UsageError("ADDRESS: '" + options.address +
                     "' has no page; accepted: ws://, wss://, http:// and https://HOST:PORT, and other "
                     "addresses with --terminal");
  page += "/#watch";
  std::cout << page << std::endl;
  const auto command = browser_command(page);
  if (!command) return;
  execute(*command);
  throw std::runtime_error("cannot run " + command->front() + "; open the page by hand");
}

void watch(const WatchOptions& options) {
  if (!options.terminal) return open_page(options);
  Watcher watcher(client::connect(server_address(options.address)), options.session);
  is_terminal(kStandardOutput) ? watcher.watch(options.graphics) : watcher.show(options.graphics);
}

}  // namespace

void add_watch(Subcommand& program) {
  const auto options = std::make_shared<WatchOptions>();
  Subcommand command =
      program.add_subcommand("watch", "Look at the shared sessions of a server", kWatchFooter);
  command.option("ADDRESS", options->address, "The address of the server")
      .variable("RACEBEAM_ADDRESS")
      .required();
  command.flag("--terminal", options->terminal, "Draw in the terminal");
  add_graphics_option(command, options->graphics);
  command.option("--session", options->session, "Begin with the session of this name").value_name("NAME");
  command.runs([options] { watch(*options); });
}

}  // namespace racebeam

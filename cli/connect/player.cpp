#include "cli/connect/player.hpp"

#include <chrono>
#include <racebeam/client.hpp>

#include "cli/terminal/display.hpp"
#include "cli/terminal/joysticks.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kMaxLag = 100ms;  // a game that is later is slowed
constexpr auto kKeysLine = "  arrows+space, wasd+g  p pause  n new game  q quit";

class TerminalPlayer {
 public:
  TerminalPlayer(client::Session session, std::string game, Graphics graphics)
      : session_(std::move(session)),
        game_(std::move(game)),
        display_(graphics),
        joysticks_(display_.tells_releases()) {}

  void play() {
    begin_game();
    while (!ended_) {
      for (const TerminalEvent& event : display_.wait(next_act_)) handle(event);
      if (Clock::now() >= next_act_) tick();
      if ((is_stale_ || display_.is_resized()) && display_.is_ready()) draw();
    }
  }

 private:
  void begin_game() {
    const client::Group settings = session_.load(game_, "sticky=0");
    const std::string format = settings.text("format");
    period_ = std::chrono::nanoseconds(1s) / (format == "pal" || format == "secam" ? 50 : 60);
    picture_.colours = session_.look("palette").bytes("palette");
    score_ = 0;
    lives_ = session_.look("lives").lives();
    is_over_ = is_paused_ = false;
    is_stale_ = true;
    next_act_ = Clock::now();
  }

  void handle(const TerminalEvent& event) {
    joysticks_.handle(event, Clock::now());
    if (event.kind != TerminalEvent::Kind::kPress) return;
    switch (event.key) {
      case 'p': is_paused_ = !is_paused_; break;
      case 'n': return begin_game();
      case 'q': ended_ = true; break;
      default: return;
    }
    is_stale_ = true;
  }

  void tick() {
    const auto now = Clock::now();
    next_act_ = now > next_act_ + kMaxLag ? now + period_ : next_act_ + period_;
    if (is_paused_ || is_over_) return;
    const client::Group result = session_.act(joysticks_.action(now));
    score_ += result.reward();
    lives_ = result.lives();
    is_over_ = result.over();
    is_stale_ = true;
  }

  void draw() {
    picture_.pixels = session_.look("screen:raw").bytes("screen");
    std::string line =
        printable(game_) + "  score " + std::to_string(score_) + "  lives " + std::to_string(lives_);
    if (is_paused_) line.append("  paused");
    if (is_over_) line.append("  game over");
    display_.show(&picture_, line.append(kKeysLine));
    is_stale_ = false;
  }

  client::Session session_;
  std::string game_;
  Display display_;
  Joysticks joysticks_;
  TerminalPicture picture_;
  std::chrono::nanoseconds period_{};  // of a frame
  Clock::time_point next_act_;
  std::int64_t score_ = 0;
  int lives_ = 0;
  bool is_paused_ = false, is_over_ = false, ended_ = false;
  bool is_stale_ = false;  // what is shown is not the newest
};

}  // namespace

void play_in_terminal(const std::string& address, const std::string& game, Graphics graphics) {
  client::Session session = client::connect(address);
  session.load(game);  // refused before the terminal is taken
  TerminalPlayer(std::move(session), game, graphics).play();
}

}  // namespace racebeam

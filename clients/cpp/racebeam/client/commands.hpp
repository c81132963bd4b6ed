#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/reply.hpp"
#include "racebeam/client/screens.hpp"
#include "racebeam/client/words.hpp"

namespace racebeam::client {

/// A method for each command of protocol/PROTOCOL.md. `Derived` is Session, whose methods return what is said
/// here, or AsyncSession, whose methods return an `awaitable` of it.
///
/// Arguments `words` and `settings` are texts such as `"seed=7"`, numbers, Settings, or ranges of these. A
/// method throws Refused if the server refuses the request, and the session continues. It throws Lost or
/// TimedOut if the server fails; the session has then ended. It throws std::invalid_argument if the request
/// is a comment or has several lines.
template <class Derived>
class Commands {
 public:
  /// Name and limits of the server: Group.
  auto hello() { return ask(first, "hello"); }
  /// The same, with the token that the server requires.
  auto hello(std::string_view token) { return ask(first, "hello", Setting("token", token)); }

  /// Explains a command, setting, field, preset, encoding or error code to people: std::string.
  template <class... Words>
  auto help(const Words&... topic) {
    return ask([](const Reply& reply) { return reply.line().substr(std::string_view("ok ").size()); }, "help",
               topic...);
  }

  /// The games whose images the server has, or with `all` those it knows: a list of names.
  template <class... Words>
  auto games(const Words&... which) {
    return ask(list("games"), "games", which...);
  }
  /// What the server knows about a game: Group.
  auto game(std::string_view name) { return ask(first, "games", name); }

  /// Powers on and begins an episode: the settings in effect, Group.
  /// @param game its name, or the MD5 of its image
  /// @param settings such as `Setting("seed", 7), "preset=dqn2015"`
  template <class... Settings>
  auto load(std::string_view game, const Settings&... settings) {
    return ask(first, "load", game, settings...);
  }
  /// The same with an image of the client's. The setting `as` names the game whose rules apply.
  template <class... Settings>
  auto load_image(std::span<const std::uint8_t> image, const Settings&... settings) {
    return ask(first, "load inline", Setting("image", to_base64(image)), settings...);
  }

  /// The settings in effect: Group.
  auto settings() { return ask(first, "settings"); }
  /// Changes mode or difficulty: both, Group.
  template <class... Settings>
  auto set(const Settings&... settings) {
    return ask(first, "set", settings...);
  }
  /// The game's modes for one player: a list of numbers.
  auto modes() { return ask(numbers("modes"), "modes"); }
  /// The game's difficulties: a list of numbers.
  auto difficulties() { return ask(numbers("difficulties"), "difficulties"); }
  /// Names for bytes of the fields `ram` and `tia`: ram_names, pairs of index and name, and tia_names, in
  /// order. Group.
  auto names() { return ask(first, "names"); }
  /// The actions that `act` accepts: names by number.
  auto actions() {
    return ask(
        [](const Reply& reply) {
          std::map<int, std::string> actions;
          for (const std::string& pair : reply.first().list("actions")) {
            const std::size_t colon = pair.find(':');
            if (colon == std::string::npos) continue;
            actions.emplace(detail::to_number<int>(std::string_view(pair).substr(0, colon)),
                            pair.substr(colon + 1));
          }
          return actions;
        },
        "actions");
  }

  /// Selects what replies carry, such as `"reward", "screen:delta"`; without fields, asks for the selection:
  /// a list.
  template <class... Words>
  auto observe(const Words&... fields) {
    return ask(list("fields"), "observe", fields...);
  }
  /// Shows fields once; without fields, those of `observe`: Group.
  template <class... Words>
  auto look(const Words&... fields) {
    return ask(first, "look", fields...);
  }
  /// The colours of the field `screen`: Palette.
  auto palette() {
    return ask([](const Reply& reply) { return Palette(reply.first().bytes("palette")); }, "look palette");
  }

  /// Plays actions until the episode ends, such as `"FIRE", "UP*3", 5`: Group.
  template <class... Words>
  auto act(const Words&... words) {
    return ask(first, "act", words...);
  }
  /// Begins an episode; the random generator continues: Group.
  auto reset() { return ask(first, "reset"); }
  /// Powers on anew with a seed: Group.
  auto reset(std::uint32_t seed) { return ask(first, "reset", Setting("seed", seed)); }

  /// Reads bytes of RAM: Bytes.
  auto peek(int index, int count = 1) {
    return ask([](const Reply& reply) { return from_hex(reply.first().text("bytes")); }, "peek", index,
               count);
  }
  /// Writes bytes of RAM.
  auto poke(int index, std::span<const std::uint8_t> bytes) {
    return ask(first, "poke", index, to_hex(bytes));
  }

  /// Saves the state. With `"random=1"`, with the generator of what is random.
  template <class... Settings>
  auto save(std::string_view name, const Settings&... settings) {
    return ask(first, "save", name, settings...);
  }
  /// Restores a state: Group.
  auto restore(std::string_view name) { return ask(first, "restore", name); }
  /// Deletes states, or `"all"`.
  template <class... Words>
  auto drop(const Words&... names) {
    return ask(first, "drop", names...);
  }
  /// The names of the states: a list.
  auto states() { return ask(list("states"), "states"); }
  /// A state for later, or for another process: Bytes.
  auto export_state(std::string_view name) {
    return ask([](const Reply& reply) { return from_base64(reply.first().text("data")); }, "export", name);
  }
  /// Saves a state that was exported.
  auto import_state(std::string_view name, std::span<const std::uint8_t> state) {
    return ask(first, "import", name, to_base64(state));
  }

  /// Plays lists of actions from a state; the session itself does not change: a Branch for each list.
  /// @param state its name
  /// @param lists actions, such as `"FIRE*3", "UP"`
  /// @param keep the beginning of the names of the states in which the lists ended, which are then kept
  auto branch(std::string_view state, const std::vector<std::vector<std::string>>& lists,
              std::string_view keep = {}) {
    std::vector<std::string> words;
    if (!keep.empty()) words.push_back(std::string("keep=").append(keep));
    for (const std::vector<std::string>& list : lists) {
      std::string& word = words.emplace_back();
      for (const std::string& action : list) word.append(word.empty() ? "" : ",").append(action);
    }
    return ask(branches, "branch", state, words);
  }

  /// Creates machines with the loaded game and settings: the Group of each.
  /// @param count machines
  /// @param settings such as `"autoreset=same-step"`
  template <class... Settings>
  auto open(int count, const Settings&... settings) {
    return ask(rest, "open", count, settings...);
  }
  /// An action for each machine, or one for all: the Group of each.
  template <class... Words>
  auto step(const Words&... words) {
    return ask(rest, "step", words...);
  }
  /// Resets machines: the Group of each. `words` are a mask such as `"0110"`, and `seed=N`; both are
  /// optional.
  template <class... Words>
  auto restart(const Words&... words) {
    return ask(rest, "restart", words...);
  }
  /// Closes the machines: the command `close`.
  auto close_machines() { return ask(first, "close"); }

  /// Begins a recording in the server's folder: Group.
  /// @param kinds such as `y4m,wav`
  /// @param name of the files
  /// @param settings `Setting("machine", N)` records a machine of `open`
  template <class... Settings>
  auto record(std::string_view kinds, std::string_view name, const Settings&... settings) {
    return ask(first, "record", kinds, name, settings...);
  }
  /// Ends the recording: what was kept, Group.
  auto stop_recording() { return ask(first, "record stop"); }
  /// Counters of this session: Group.
  auto stats() { return ask(first, "stats"); }
  /// Ends the session, as the server sees it.
  auto quit() { return ask(first, "quit"); }

 protected:
  Commands() = default;

 private:
  template <class Read, class... Words>
  auto ask(Read read, std::string_view command, const Words&... words) {
    return static_cast<Derived&>(*this).ask_for(detail::request_line(command, words...), std::move(read));
  }

  static Group first(const Reply& reply) { return reply.first(); }
  static std::vector<Group> rest(const Reply& reply) { return reply.rest(); }
  static std::vector<Branch> branches(const Reply& reply) {
    std::vector<Branch> found;
    for (Group& group : reply.rest()) {
      const std::string second = group.has("rewards_b") ? group.text("rewards_b") : "";
      found.push_back({unfold_rewards(group.text("rewards")), unfold_rewards(second), group});
    }
    return found;
  }
  static auto list(const char* key) {
    return [key](const Reply& reply) { return reply.first().list(key); };
  }
  static auto numbers(const char* key) {
    return [key](const Reply& reply) {
      std::vector<int> found;
      for (const std::string& number : reply.first().list(key))
        found.push_back(detail::to_number<int>(number));
      return found;
    };
  }
};

}  // namespace racebeam::client

/// @file
/// A method for each command, for Session and AsyncSession. Each of these says which threads may call them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ios>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/command_methods.hpp"
#include "racebeam/client/config.hpp"
#include "racebeam/client/reply.hpp"
#include "racebeam/client/screens.hpp"
#include "racebeam/client/words.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// A method for each command of protocol/PROTOCOL.md. `Derived` is Session, whose methods return what is said
/// here, or AsyncSession, whose methods return an `awaitable` of it.
///
/// Arguments `words` and `settings` are texts such as `"seed=7"`, numbers, Settings, or ranges of these. A
/// method throws Refused if the server refuses the request, and the session continues. It throws Lost or
/// TimedOut if the server fails; the session has then ended. It throws std::invalid_argument if the request
/// is a comment or has several lines.
template <class Derived>
class Commands : public CommandMethods<Derived> {
  using Base = CommandMethods<Derived>;
  using Base::ask;
  using Base::first;

 public:
  /// Explains a command, setting, field, preset, encoding or error code. Returns a text for people,
  /// std::string.
  template <class... Words>
  auto help(const Words&... topic) {
    return ask([](const Reply& reply) { return reply.line().substr(std::string_view("ok ").size()); }, "help",
               topic...);
  }

  /// Describes a game. Returns Group.
  auto game(std::string_view name) { return ask(first, "games", name); }

  /// Powers on and begins an episode. Returns the settings in effect, Group.
  /// @param game its name, or the MD5 of its image
  /// @param settings such as `Setting("seed", 7), "preset=dqn2015"`
  template <class... Settings>
  auto load(std::string_view game, const Settings&... settings) {
    return ask(first, "load", game, settings...);
  }
  /// Loads an image that the client sends. Returns the settings in effect, Group. The setting `as` names the
  /// game whose rules apply.
  template <class... Settings>
  auto load_image(std::span<const std::uint8_t> image, const Settings&... settings) {
    return ask(first, "load inline", Setting("image", to_base64(image)), settings...);
  }

  /// Names bytes of the fields `ram` and `tia`. Returns Group: `ram_names` has pairs of index and name, and
  /// `tia_names` the names in order.
  auto names() { return ask(first, "names"); }
  /// Lists the actions that `act` accepts. Returns their names by number.
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

  /// Reads the colours of the field `screen`. Returns Palette.
  auto palette() {
    return ask([](const Reply& reply) { return Palette(reply.first().bytes("palette")); }, "look palette");
  }

  /// Reads bytes of RAM. Returns Bytes.
  auto peek(int index, int count = 1) {
    return ask([](const Reply& reply) { return from_hex(reply.first().text("bytes")); }, "peek", index,
               count);
  }
  /// Writes bytes of RAM.
  auto poke(int index, std::span<const std::uint8_t> bytes) {
    return ask(first, "poke", index, to_hex(bytes));
  }

  /// Exports a state, for later or for another process. Returns Bytes.
  /// @param name the name of the state
  /// @param settings `"episode=1"`: also the score, the progress of the episode and the stack of screens
  template <class... Settings>
  auto export_state(std::string_view name, const Settings&... settings) {
    return ask([](const Reply& reply) { return from_base64(reply.first().text("data")); }, "export", name,
               settings...);
  }
  /// Saves a state that was exported.
  auto import_state(std::string_view name, std::span<const std::uint8_t> state) {
    return ask(first, "import", name, to_base64(state));
  }

  /// Plays lists of actions from a state; the session itself does not change. Returns a Branch for each list.
  /// @param state the name of the state
  /// @param lists actions, such as `"FIRE*3", "UP"`
  /// @param keep the prefix of names under which the states at the ends of the lists are saved
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

  /// Saves a picture of the screen as a PNG file. Throws std::runtime_error if it cannot be written.
  /// @param path the path of the file, on this computer
  /// @param settings `Setting("machine", N)`: the index of a machine of `open`, from 0
  template <class... Settings>
  auto save_png(const std::filesystem::path& path, const Settings&... settings) {
    return ask([path](const Reply& reply) { write_file(path, from_base64(reply.first().text("data"))); },
               "shot", settings...);
  }

  /// Ends the recording. Returns what was kept, Group.
  auto stop_recording() { return ask(first, "record stop"); }

 protected:
  Commands() = default;

 private:
  static void write_file(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
  }

  static std::vector<Branch> branches(const Reply& reply) {
    std::vector<Branch> found;
    for (Group& group : reply.rest()) {
      const std::string second = group.has("rewards_b") ? group.text("rewards_b") : "";
      found.push_back({unfold_rewards(group.text("rewards")), unfold_rewards(second), group});
    }
    return found;
  }
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE

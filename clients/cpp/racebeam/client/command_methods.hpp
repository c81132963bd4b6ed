// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/reply.hpp"
#include "racebeam/client/words.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// The commands whose methods only send their words. `Derived` sends them.
template <class Derived>
class CommandMethods {
 public:
  /// Greet the server; the reply has its name, version and limits. Returns Group.
  auto hello() { return ask(first, "hello"); }
  /// The same with token: a token that the server accepts.
  auto hello(std::string_view token) {
    return ask(first, "hello", Setting("token", token));
  }

  /// List the games whose image is here, or all known games; or describe one. Returns a list.
  /// @param words all for all known games, or the name of a game to describe
  template <class... Words>
  auto games(const Words&... words) {
    return ask(list("games"), "games", words...);
  }

  /// Show the settings in effect. Returns Group.
  auto settings() { return ask(first, "settings"); }

  /// Change the mode, from the next reset on, or the difficulty, at once. Returns Group.
  /// @param settings `Setting("mode", N)`: a number that modes lists; `Setting("difficulty", N)`: a number
  ///     that difficulties lists
  template <class... Words>
  auto set(const Words&... settings) {
    return ask(first, "set", settings...);
  }

  /// List the game's modes. Returns a list of numbers.
  auto modes() { return ask(numbers("modes"), "modes"); }

  /// List the game's difficulties. Returns a list of numbers.
  auto difficulties() { return ask(numbers("difficulties"), "difficulties"); }

  /// Select the fields of replies. Returns a list.
  /// @param fields the fields, such as lives or screen:rle, or none; without them, the selection does not
  ///     change
  template <class... Words>
  auto observe(const Words&... fields) {
    return ask(list("fields"), "observe", fields...);
  }

  /// Show these fields once; without fields, the selected ones. Returns Group.
  /// @param fields the fields, such as lives or screen:rle
  template <class... Words>
  auto look(const Words&... fields) {
    return ask(first, "look", fields...);
  }

  /// Play actions until the episode ends. Returns Group.
  /// @param actions names or numbers of actions, also with marks, such as RIGHT*10
  template <class... Words>
  auto act(const Words&... actions) {
    return ask(first, "act", actions...);
  }

  /// Begin an episode; with a seed, power on anew with it. Returns Group.
  auto reset() { return ask(first, "reset"); }
  /// The same with seed: the seed with which the console is powered on anew.
  auto reset(std::int64_t seed) {
    return ask(first, "reset", Setting("seed", seed));
  }

  /// Save the state; generator=1: with the random generator.
  /// @param name a name for the state
  /// @param settings `Setting("generator", 1)`: 1: the state includes the random generator;
  ///     `Setting("machine", N)`: the index of a machine of open, from 0
  template <class... Words>
  auto save(std::string_view name, const Words&... settings) {
    return ask(first, "save", name, settings...);
  }

  /// Restore a saved state. Returns Group.
  /// @param name the name of the state
  /// @param settings `Setting("machine", N)`: the index of a machine of open, from 0
  template <class... Words>
  auto restore(std::string_view name, const Words&... settings) {
    return ask(first, "restore", name, settings...);
  }

  /// Delete states.
  /// @param names the names of the states, or all
  template <class... Words>
  auto drop(const Words&... names) {
    return ask(first, "drop", names...);
  }

  /// List the names of the states. Returns a list.
  auto states() { return ask(list("states"), "states"); }

  /// Create N machines with the loaded game and settings; their seeds count up. Returns the Group of each.
  /// @param count the number of machines
  /// @param settings `Setting("autoreset", VALUE)`: what happens at the end of an episode; `Setting("steps",
  ///     VALUE)`: what a step is; `Setting("start", VALUE)`: how an episode begins; requires steps=frames;
  ///     `Setting("life_loss", VALUE)`: what a lost life does; `Setting("stack", VALUE)`: what a stack of
  ///     screens begins with; requires steps=frames; `Setting("pool", VALUE)`: which frames a stack shows;
  ///     requires steps=frames
  template <class... Words>
  auto open(std::int64_t count, const Words&... settings) {
    return ask(rest, "open", count, settings...);
  }

  /// Play one act on each machine: an action each, or one for all. Returns the Group of each.
  /// @param actions an action for each machine, or one for all
  template <class... Words>
  auto step(const Words&... actions) {
    return ask(rest, "step", actions...);
  }

  /// Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up. Returns the Group of
  /// each.
  /// @param settings a 0 or a 1 for each machine, such as 0110; `Setting("seed", N|random)`: the seed with
  ///     which machine 0 is powered on anew; machine 1 gets the next one, and so on
  template <class... Words>
  auto restart(const Words&... settings) {
    return ask(rest, "restart", settings...);
  }

  /// Close the machines.
  auto close_machines() { return ask(first, "close"); }

  /// Record frames, sound or both into the server's folder. Returns Group.
  /// @param kinds the kinds of files, separated by commas, such as gif,wav
  /// @param name a name for the files, without an extension
  /// @param settings `Setting("machine", N)`: the index of a machine of open, from 0
  template <class... Words>
  auto record(std::string_view kinds, std::string_view name, const Words&... settings) {
    return ask(first, "record", kinds, name, settings...);
  }

  /// Log the episodes from the next reset on, so that anybody can verify them. Returns Group.
  /// @param name a name for the submission, or inline; last answers with the last log, and stop ends logging
  /// @param settings `Setting("agent", AGENT)`: the agent's name (default: agent); `Setting("version",
  ///     VERSION)`: the agent's version (default: 1); `Setting("agent_seed", N)`: the agent's seed (default:
  ///     0); `Setting("trial", N)`: the number of the trial (default: 1); `Setting("training_frames", N)`:
  ///     frames that the agent was trained on (default: 0); `Setting("phrase", PHRASE)`: the phrase that the
  ///     episodes' seeds follow from, with _ for a blank; `Setting("role", VALUE)`: what the agent is;
  ///     `Setting("link", URL)`: a page about the agent; `Setting("machine", N)`: the index of a machine of
  ///     open, from 0
  template <class... Words>
  auto log(std::string_view name, const Words&... settings) {
    return ask(first, "log", name, settings...);
  }

  /// Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
  /// Returns Group.
  /// @param settings a name for the file, without .png; `Setting("machine", N)`: the index of a machine of
  ///     open, from 0
  template <class... Words>
  auto shot(const Words&... settings) {
    return ask(first, "shot", settings...);
  }

  /// Let other sessions watch the game under this name. Returns Group.
  /// @param name a name for the shared session
  /// @param settings `Setting("watchers", N)`: the most sessions that may watch at the same time
  template <class... Words>
  auto share(std::string_view name, const Words&... settings) {
    return ask(first, "share", name, settings...);
  }

  /// Stop sharing the game.
  auto unshare() { return ask(first, "unshare"); }

  /// List the shared sessions. Returns the Group of each.
  auto shared() { return ask(rest, "shared"); }

  /// Show the latest copy of a shared session. Returns Group.
  /// @param name the name of the shared session
  /// @param fields `Setting("since", FRAME)`: the frame of the last reply; the fields come only if there is a
  ///     newer one; fields among screen, ram and palette, such as screen:delta
  template <class... Words>
  auto watch(std::string_view name, const Words&... fields) {
    return ask(first, "watch", name, fields...);
  }

  /// Show counters of this session. Returns Group.
  auto stats() { return ask(first, "stats"); }

  /// End the session.
  auto quit() { return ask(first, "quit"); }

 protected:
  CommandMethods() = default;

  template <class Read, class... Words>
  auto ask(Read read, std::string_view command, const Words&... words) {
    return static_cast<Derived&>(*this).ask_for(detail::request_line(command, words...), std::move(read));
  }

  static Group first(const Reply& reply) { return reply.first(); }
  static std::vector<Group> rest(const Reply& reply) { return reply.rest(); }
  static auto list(const char* key) {
    return [key](const Reply& reply) { return reply.first().list(key); };
  }
  static auto numbers(const char* key) {
    return [key](const Reply& reply) {
      std::vector<int> found;
      for (const std::string& number : reply.first().list(key)) found.push_back(detail::to_number<int>(number));
      return found;
    };
  }
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE

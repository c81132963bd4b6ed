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
  /// The server's name, version and limits. Returns Group.
  auto hello() { return ask(first, "hello"); }
  /// The same with token: that the server requires.
  auto hello(std::string_view token) {
    return ask(first, "hello", Setting("token", token));
  }

  /// List the games whose image is here, or all known games; or describe one. Returns a list.
  /// @param words `[all|GAME]`
  template <class... Words>
  auto games(const Words&... words) {
    return ask(list("games"), "games", words...);
  }

  /// The settings in effect. Returns Group.
  auto settings() { return ask(first, "settings"); }

  /// Change the mode, from the next reset on, or the difficulty, at once. Returns Group.
  /// @param settings `Setting("mode", N)`: see modes; `Setting("difficulty", N)`: see difficulties
  template <class... Words>
  auto set(const Words&... settings) {
    return ask(first, "set", settings...);
  }

  /// The game's modes. Returns a list of numbers.
  auto modes() { return ask(numbers("modes"), "modes"); }

  /// The game's difficulties. Returns a list of numbers.
  auto difficulties() { return ask(numbers("difficulties"), "difficulties"); }

  /// Select the fields of replies. Returns a list.
  /// @param fields without them, asks for the selection
  template <class... Words>
  auto observe(const Words&... fields) {
    return ask(list("fields"), "observe", fields...);
  }

  /// Show these fields once; without fields, the selected ones. Returns Group.
  /// @param fields `[FIELD[:ENCODING]...]`
  template <class... Words>
  auto look(const Words&... fields) {
    return ask(first, "look", fields...);
  }

  /// Play actions until the episode ends. Returns Group.
  /// @param actions `A[@STRENGTH][/B[@STRENGTH]][*TIMES]...`
  template <class... Words>
  auto act(const Words&... actions) {
    return ask(first, "act", actions...);
  }

  /// Begin an episode; with a seed, power on anew with it. Returns Group.
  auto reset() { return ask(first, "reset"); }
  /// The same with seed: powers on anew with it.
  auto reset(std::int64_t seed) {
    return ask(first, "reset", Setting("seed", seed));
  }

  /// Save the state; generator=1: with the random generator.
  /// @param name NAME
  /// @param settings `Setting("generator", 1)`: 1: with the random generator; `Setting("machine", N)`: one of those of open, 0 the first
  template <class... Words>
  auto save(std::string_view name, const Words&... settings) {
    return ask(first, "save", name, settings...);
  }

  /// Restore a saved state. Returns Group.
  /// @param name NAME
  /// @param settings `Setting("machine", N)`: one of those of open, 0 the first
  template <class... Words>
  auto restore(std::string_view name, const Words&... settings) {
    return ask(first, "restore", name, settings...);
  }

  /// Delete states.
  /// @param names `NAME...|all`
  template <class... Words>
  auto drop(const Words&... names) {
    return ask(first, "drop", names...);
  }

  /// The names of the states. Returns a list.
  auto states() { return ask(list("states"), "states"); }

  /// Create N machines with the loaded game and settings; their seeds count up. Returns the Group of each.
  /// @param count N
  /// @param settings `Setting("autoreset", VALUE)`: what happens at the end of an episode; `Setting("steps", VALUE)`: what a step is; `Setting("start", VALUE)`: how an episode begins; with steps=frames; `Setting("life_loss", VALUE)`: what a lost life does; `Setting("stack", VALUE)`: what a stack of screens begins with; with steps=frames; `Setting("pool", VALUE)`: which frames a stack shows; with steps=frames
  template <class... Words>
  auto open(std::int64_t count, const Words&... settings) {
    return ask(rest, "open", count, settings...);
  }

  /// Play one act on each machine: an action each, or one for all. Returns the Group of each.
  /// @param actions `ACTION...`
  template <class... Words>
  auto step(const Words&... actions) {
    return ask(rest, "step", actions...);
  }

  /// Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up. Returns the Group of each.
  /// @param settings `Setting("seed", N|random)`: powers on anew: machine 0 with N, machine 1 with N + 1, and so on
  template <class... Words>
  auto restart(const Words&... settings) {
    return ask(rest, "restart", settings...);
  }

  /// Close the machines.
  auto close_machines() { return ask(first, "close"); }

  /// Record frames, sound or both into the server's folder. Returns Group.
  /// @param kinds png|gif|y4m|wav|webm|mp4[,...]
  /// @param name NAME
  /// @param settings `Setting("machine", N)`: one of those of open, 0 the first
  template <class... Words>
  auto record(std::string_view kinds, std::string_view name, const Words&... settings) {
    return ask(first, "record", kinds, name, settings...);
  }

  /// Log the episodes from the next reset on, so that anybody can verify them. Returns Group.
  /// @param name a name for the submission, or inline; last answers with the last log, and stop ends logging
  /// @param settings `Setting("agent", AGENT)`: the agent's name (default: agent); `Setting("version", VERSION)`: the agent's version (default: 1); `Setting("agent_seed", N)`: the agent's seed (default: 0); `Setting("trial", N)`: the number of the trial (default: 1); `Setting("training_frames", N)`: frames that the agent was trained on (default: 0); `Setting("phrase", PHRASE)`: the phrase that the episodes' seeds follow from, with _ for a blank; `Setting("role", VALUE)`: what the agent is; `Setting("link", URL)`: a page about the agent; `Setting("machine", N)`: one of those of open, 0 the first
  template <class... Words>
  auto log(std::string_view name, const Words&... settings) {
    return ask(first, "log", name, settings...);
  }

  /// Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64. Returns Group.
  /// @param settings a name for the file, without .png; `Setting("machine", N)`: one of those of open, 0 the first
  template <class... Words>
  auto shot(const Words&... settings) {
    return ask(first, "shot", settings...);
  }

  /// Let other sessions watch the game under this name. Returns Group.
  /// @param name NAME
  /// @param settings `Setting("watchers", N)`: how many may watch at the same time
  template <class... Words>
  auto share(std::string_view name, const Words&... settings) {
    return ask(first, "share", name, settings...);
  }

  /// End what share has begun.
  auto unshare() { return ask(first, "unshare"); }

  /// List the shared sessions. Returns the Group of each.
  auto shared() { return ask(rest, "shared"); }

  /// Show a shared session as it was lately. Returns Group.
  /// @param name NAME
  /// @param fields `Setting("since", FRAME)`: the frame of the last reply; the fields come only if there is a newer one
  template <class... Words>
  auto watch(std::string_view name, const Words&... fields) {
    return ask(first, "watch", name, fields...);
  }

  /// Counters of this session. Returns Group.
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

// The environment of an RL-Glue 3.0 experiment, as ALE 0.5 and 0.6 were (docs/spec/classic-protocol.md, 11).
// It does not use sockets: a message goes in, a message comes out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

struct RlGlueOptions {
  bool rgb = false;              // observations have three numbers for each pixel
  bool minimal_actions = false;  // actions are indices into the game's minimal set
  int max_num_frames = 0;        // frames since the start after which the session ends; 0: no limit
};

// The header of a message: two 32-bit numbers, big-endian.
struct RlGlueHeader {
  std::uint32_t type, size;
};
constexpr std::size_t kRlGlueHeaderBytes = 8;
RlGlueHeader rl_glue_header(std::string_view bytes);  // of exactly 8 bytes

std::string rl_glue_greeting();  // the first message to the core: an environment has connected

class RlGlueEnvironment {
 public:
  // Throws std::invalid_argument if the game's screen does not fit the protocol.
  RlGlueEnvironment(Environment& environment, const RlGlueOptions& options);

  // Returns the reply, with its header; nothing if the session is over. Throws std::invalid_argument if the
  // core sends what the protocol does not have.
  std::optional<std::string> answer(std::uint32_t type, std::string_view payload);

 private:
  std::string task() const;
  std::string start();
  std::string step(std::string_view payload);
  std::string observation() const;

  Environment& environment_;
  RlGlueOptions options_;
  std::vector<int> actions_;  // by index
};

}  // namespace racebeam

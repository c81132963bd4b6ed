#include "agents/experiment/log_judge.hpp"

#include <algorithm>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// Decisions, counted from 1, in which the state first differs.
std::string first_stretch(const EpisodeLog& log, const Replay& played) {
  const auto [ours, theirs] = std::ranges::mismatch(log.hashes, played.hashes);
  if (ours == log.hashes.end()) return "; every state is the same";
  const std::int64_t from = (ours - log.hashes.begin()) * kDecisionsPerStretch;
  return "; the first stretch that differs: decisions " + std::to_string(from + 1) + " to " +
         std::to_string(std::min(from + kDecisionsPerStretch, log.end.decisions));
}

std::shared_ptr<const Game> game_of(const EpisodeLog& log, const Cartridge& cartridge) {
  if (cartridge.game->name == log.game) return cartridge.game;
  auto game = find_game(log.game);
  if (!game) throw InvalidInput("its log is of the game '" + log.game + "', which is not in the catalogue");
  return game;
}

}  // namespace

std::string first_difference(const ResultRow& row, const ResultRow& truth, const std::string& source) {
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] != truth[i])
      return std::string(kResultColumns[i]) + " is '" + row[i] + "'; " + source + " '" + truth[i] + "'";
  return "";
}

RowVerdict LogJudge::judge(const ResultRow& row, const EpisodeLog& log) {
  const Cartridge* const cartridge = images_.find(log.image_md5);
  if (!cartridge) return {Judgement::kUnchecked, "no image with MD5 " + log.image_md5 + " is here"};
  const Replay played = replayer_.play(log, {cartridge->image, game_of(log, *cartridge)});
  EpisodeLog truth = log;
  truth.end = played.end;
  truth.hashes = played.hashes;
  std::string reason = first_difference(row, row_of(truth, field(row, "log_digest")), "the replay gives");
  if (reason.empty() && log.hashes != played.hashes)
    reason = "the end is the same, but earlier states differ from the log";
  if (!reason.empty()) return {Judgement::kWrong, reason + first_stretch(log, played), played.end.frames};
  if (!played.over)
    return {Judgement::kWrong, "the episode is not over after its last action; the log was cut short",
            played.end.frames};
  return {Judgement::kConfirmed, "", played.end.frames};
}

}  // namespace racebeam

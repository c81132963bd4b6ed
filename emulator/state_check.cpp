#include "emulator/state_check.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "emulator/base/range_check.hpp"
#include "emulator/board/riot.hpp"
#include "emulator/tia/line/objects.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kLastPosition = kLinePixels - 1, kLastMotion = 15;
constexpr unsigned kUnusedOfNusiz = 0xC8, kUnusedOfCtrlpf = 0xC8, kUnusedCollision = 1U << 12;

// The most draws from the system's generator. Repeating them takes a fraction of a second.
constexpr std::uint32_t kMaxDrawn = 1U << 27;

void check_cpu(const CpuState& cpu) {
  check_clear("the processor's status", cpu.P, 0x30);
  check_flag("the processor's jam flag", cpu.jammed);
  check_zeros("a spare byte of the processor", cpu.spare);
}

void check_riot(const RiotState& riot) {
  if (std::ranges::find(kTimerShift, riot.shift) == std::end(kTimerShift))
    refuse_field("the timer's shift", riot.shift, "0, 3, 6 or 10");
  check_flag("the timer's late flag", riot.late);
}

void check_player(const PlayerState& player) {
  check_flag("a player's REFP", player.refp);
  check_flag("a player's VDELP", player.vdel);
  check_clear("a player's NUSIZ", player.nusiz, kUnusedOfNusiz);
  check_range("a player's position", player.position, 0, kLastPosition);
  check_range("a player's motion", player.motion, 0, kLastMotion);
  check_flag("a player's skip flag", player.skip);
}

void check_missile(const MissileState& missile) {
  check_flag("a missile's ENAM", missile.enabled);
  check_flag("a missile's RESMP", missile.locked);
  check_range("a missile's position", missile.position, 0, kLastPosition);
  check_range("a missile's motion", missile.motion, 0, kLastMotion);
}

void check_ball(const BallState& ball) {
  check_flag("the ball's ENABL", ball.enabled);
  check_flag("the ball's old ENABL", ball.old_enabled);
  check_flag("the ball's VDELBL", ball.vdel);
  check_range("the ball's position", ball.position, 0, kLastPosition);
  check_range("the ball's motion", ball.motion, 0, kLastMotion);
}

void check_registers(const TiaRegisters& tia) {
  check_clear("CTRLPF", tia.ctrlpf, kUnusedOfCtrlpf);
  check_flag("the playfield's reflection", tia.reflect);
  for (const PlayerState& player : tia.player) check_player(player);
  for (const MissileState& missile : tia.missile) check_missile(missile);
  check_ball(tia.ball);
  check_flag("the blank flag", tia.vblank);
  check_flag("the comb flag", tia.comb_armed);
  check_flag("the Cosmic Ark flag", tia.cosmic);
  check_range("the Cosmic Ark count", tia.cosmic_count, 0, 3);
  check_range("the Cosmic Ark shape", static_cast<int>(tia.cosmic_shape), 0,
              static_cast<int>(CosmicShape::kHidden));
  check_range("the set of enabled objects", tia.enabled, enabled_objects(tia), enabled_objects(tia));
  check_zeros("a spare byte of the TIA", tia.spare);
}

// The beam's clock, the clocks left on its line and the next pixel must agree. A picture is drawn from the
// window's start, or from clock 0 if a reset interrupted one (docs/spec/tia.md, 2).
void check_beam(const TiaState& tia, const Video& video) {
  check_range("the frame's origin", tia.origin, 1 - kLineClocks, 0);
  check_range("the frame's origin modulo 3", tia.origin % 3, 0, 0);
  check_range("the clocks left on the line", tia.left, 0, kLineClocks);
  const std::int32_t start = tia.origin + kLineClocks * video.ystart,
                     end = start + kLineClocks * video.height;
  check_range("the beam's clock", tia.cursor, std::min(start, 0), end);
  const std::int32_t into = kLineClocks - tia.left;  // clocks since the line began
  const auto follows_from = [&](std::int32_t first) {
    const std::int32_t clocks = tia.cursor - into - first;
    return clocks >= 0 && clocks % kLineClocks == 0 &&
           tia.pixel == kLinePixels * (clocks / kLineClocks) + std::max(into - kBlankClocks, 0);
  };
  if (follows_from(start) || (tia.origin == 0 && follows_from(0))) return;
  refuse_field("the next pixel", tia.pixel, "the pixel of the beam's clock, " + std::to_string(tia.cursor));
}

void check_frame(const FrameState& frame) {
  check_range("the number of lines", frame.lines, 0, 3 * (kEndlessCycle / kLineClocks) + kLineClocks);
  check_flag("the flag of a paddle's capacitor", frame.dumping);
  check_flag("the flag of an open frame", frame.open);
  check_range("the flag of a greyed frame", frame.greyed, 0, frame.open);
}

void check_inputs(const Inputs& inputs) {
  for (const std::int32_t ohms : inputs.paddle) check_range("a paddle's resistance", ohms, 0, INT32_MAX);
  for (const std::uint8_t stick : inputs.joystick) check_range("a joystick", stick, 0, kStickBits);
  check_range("the paddles' buttons", inputs.paddle_fire, 0, 0x0F);
}

void check_cartridge(const CartridgeState& state, const CartridgeSlot& slot) {
  if (!slot.scheme.admits(slot, state))
    throw InvalidInput("invalid state: a cartridge of scheme " + std::string(slot.scheme.name) +
                       " has no such banks or registers");
  const std::size_t used =
      slot.scheme.ram_bytes > kRamInState ? slot.scheme.register_bytes : slot.scheme.ram_bytes;
  check_zeros("a byte behind the cartridge's RAM", std::span(state.ram).subspan(used));
}

}  // namespace

void check_state(const State& state, const Video& video, const CartridgeSlot& slot) {
  check_range("the cycle", state.cycle, 0, kEndlessCycle - 1);
  check_range("the number of draws at power-on", state.drawn, 0, kMaxDrawn);
  check_cpu(state.cpu);
  check_riot(state.riot);
  check_registers(state.tia);
  check_beam(state.tia, video);
  check_clear("the collisions", state.tia.collisions, kUnusedCollision);
  check_zeros("a spare byte of the picture", state.tia.spare_bytes);
  check_frame(state.frame);
  check_cartridge(state.cartridge, slot);
  check_inputs(state.inputs);
}

}  // namespace racebeam

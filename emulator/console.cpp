#include "emulator/console.hpp"

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

#include "emulator/console_impl.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/state_check.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kDetectionSteps = 60;
constexpr int kDefaultHeight = 210, kTallHeight = 250;  // the latter for PAL and SECAM

bool is_pal(Format format) { return format == Format::kPal || format == Format::kPal60; }

}  // namespace

// docs/spec/console.md, 1.
void Console::Impl::power_up() {
  for (std::uint8_t& byte : state().riot.ram) byte = static_cast<std::uint8_t>(power_on.draw(state().drawn));
  set_timer();
  if (properties.left_difficulty_a) state().inputs.switches |= kSwitchLeftA;
  if (properties.right_difficulty_a) state().inputs.switches |= kSwitchRightA;
  if (format == Format::kAuto) format = detect_format();
  board.video.pal = is_pal(format);
  const bool taller = format == Format::kPal || format == Format::kSecam;
  if (taller && board.video.height == kDefaultHeight) board.video.height = kTallHeight;
  reset();
}

// docs/spec/riot.md, 2: 25 to 99 intervals of 64 cycles.
void Console::Impl::set_timer() {
  RiotState& riot = state().riot;
  riot.timer = static_cast<std::uint8_t>(25 + power_on.draw(state().drawn) % 75);
  riot.shift = 6;
  riot.timer_set = 0;
  riot.late_read = 0;
  riot.late = 0;
  riot.swacnt = 0;
}

// docs/spec/console.md, 2. RIOT RAM, sound and an unfinished frame live through it.
void Console::Impl::reset() {
  const std::uint8_t open = state().frame.open, greyed = state().frame.greyed;
  state().cycle = 0;
  set_timer();
  latches.unknown = 0;
  state().tia = TiaState{};
  state().frame = FrameState{};
  state().frame.open = open;
  state().frame.greyed = greyed;
  blank(pictures.current);
  blank(pictures.previous);
  const Scheme& scheme = board.slot.scheme;
  if (scheme.random_ram) power_on.fill_cartridge(board.slot.ram, state().drawn);
  scheme.reset(board.slot);
  board.map_memory();
  reset_cpu(board);
}

// A black picture. A buffer that a saved state holds too is replaced, not changed.
void Console::Impl::blank(std::shared_ptr<FrameBuffer>& picture) {
  if (is_own(picture))
    picture->blank();
  else
    picture = std::make_shared<FrameBuffer>();
}

// Takes over the pictures of a saved state. The console keeps its own buffers for later frames, unless they
// are shared.
void Console::Impl::take(const FrameBuffers& others) {
  const auto displace = [](std::shared_ptr<FrameBuffer>& own, const std::shared_ptr<FrameBuffer>& other,
                           std::shared_ptr<FrameBuffer>& spare_buffer) {
    if (own != other && own.use_count() == 1) spare_buffer = std::move(own);
    own = other;
  };
  displace(pictures.current, others.current, spare.current);
  displace(pictures.previous, others.previous, spare.previous);
}

void Console::Impl::release_undrawn() {
  for (const FrameBuffers* const both : {&pictures, &spare}) {
    for (const std::shared_ptr<FrameBuffer>* const picture : {&both->current, &both->previous})
      if (is_own(*picture)) (*picture)->release_rows();
  }
}

// Spreads the probes of successive machines.
unsigned Console::Impl::delay_of_probes() {
  constexpr unsigned kStep = 197;  // frames; any odd number passes through all delays
  static std::atomic<unsigned> delay = 0;
  return delay.fetch_add(kStep, std::memory_order_relaxed);
}

Format Console::Impl::detect_format() {
  reset();
  int long_frames = 0;
  for (int i = 0; i < kDetectionSteps; ++i) {
    step(false, false);
    if (i >= 30 && (3 * state().cycle - state().tia.origin) / kLineClocks > 285) ++long_frames;
  }
  return long_frames >= 15 ? Format::kPal : Format::kNtsc;
}

void Console::Impl::check_ram_size(std::span<const std::uint8_t> cartridge_ram) const {
  if (cartridge_ram.size() == board.cartridge_ram.size()) return;
  throw InvalidInput("the state has " + std::to_string(cartridge_ram.size()) +
                     " bytes of cartridge RAM; the cartridge that runs has " +
                     std::to_string(board.cartridge_ram.size()));
}

Console::Console(std::shared_ptr<const std::vector<std::uint8_t>> rom, const Properties& properties,
                 PowerOn& power_on, CpuKind cpu, Pace* pace)
    : impl_(std::make_unique<Impl>(std::move(rom), properties, power_on, cpu, pace)) {
  impl_->power_up();
}

Console::~Console() = default;

void Console::reset() { impl_->reset(); }

Inputs& Console::inputs() { return impl_->state().inputs; }
Sound& Console::sound() { return impl_->board.sound; }
const Sound& Console::sound() const { return impl_->board.sound; }
const State& Console::state() const {
  impl_->settle_latches(*impl_->pictures.current);
  return impl_->board.state;
}

std::span<const std::uint8_t> Console::cartridge_ram() const { return impl_->board.cartridge_ram; }

void Console::check(const State& state, std::span<const std::uint8_t> cartridge_ram) const {
  impl_->check_ram_size(cartridge_ram);
  check_state(state, impl_->board.video, impl_->board.slot);
}

void Console::restore(const State& state, std::span<const std::uint8_t> cartridge_ram) {
  impl_->check_ram_size(cartridge_ram);
  Board& board = impl_->board;
  impl_->latches.unknown = 0;
  board.restore(state);
  std::ranges::copy(cartridge_ram, board.cartridge_ram.begin());
}

Format Console::format() const { return impl_->format; }
int Console::height() const { return impl_->height(); }

bool Console::has_paddles() const {
  return impl_->properties.left == Controller::kPaddles || impl_->properties.right == Controller::kPaddles;
}

std::span<const std::uint8_t> Console::picture() const {
  impl_->draw_now(impl_->pictures.current);
  return impl_->pictures.current->pixels().first(impl_->picture_size());
}

bool Console::frame_is_open() const {
  return impl_->board.state.frame.open != 0 && !impl_->pictures.current->is_undrawn;
}

std::span<const std::uint8_t> Console::previous_picture() const {
  impl_->draw_now(impl_->pictures.previous);
  return impl_->pictures.previous->pixels().first(impl_->picture_size());
}

std::span<const LineNumber> Console::picture_lines() const {
  impl_->draw_now(impl_->pictures.current);
  return impl_->pictures.current->lines();
}

std::span<const LineNumber> Console::previous_picture_lines() const {
  impl_->draw_now(impl_->pictures.previous);
  return impl_->pictures.previous->lines();
}

const FrameBuffers& Console::pictures() const { return impl_->pictures; }
void Console::restore_pictures(const FrameBuffers& pictures) {
  impl_->settle_latches(*impl_->pictures.current);  // they follow from the picture
  impl_->take(pictures);
}

std::shared_ptr<const FrameBuffer> Console::with_pixels(std::shared_ptr<FrameBuffer> picture) const {
  impl_->draw_now(picture);
  return picture;
}

void Console::release_caches() {
  impl_->spare = {};
  impl_->board.tia.forget_lines();
}

std::size_t Console::footprint() const {
  const Board& board = impl_->board;
  std::size_t bytes = board.cartridge_ram.capacity() + board.tia.footprint_of_lines();
  for (const FrameBuffers* const both : {&impl_->pictures, &impl_->spare}) {
    for (const auto& picture : {both->current.get(), both->previous.get()})
      bytes += picture != nullptr ? sizeof *picture + picture->footprint() : 0;
  }
  return bytes;
}

std::span<const std::uint8_t, 128> Console::ram() const { return impl_->board.state.riot.ram; }

std::int64_t Console::interpreted_cycles() const {
  return impl_->translator != nullptr ? impl_->translator->interpreted_cycles() : 0;
}

std::uint8_t Console::read_ram(int index) {
  return impl_->board.state.cpu.latch = ram()[static_cast<std::size_t>(index)];
}

void Console::set_ram(int index, std::uint8_t value) {
  impl_->board.state.riot.ram[static_cast<std::size_t>(index)] = value;
  impl_->board.state.cpu.latch = value;
}

std::uint8_t Console::peek(std::uint16_t address) const {
  const std::uint8_t* page = impl_->board.map.page_of(address);
  return page != nullptr ? page[address & 0x3F] : 0;
}

}  // namespace racebeam

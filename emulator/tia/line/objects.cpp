#include "emulator/tia/line/objects.hpp"

namespace racebeam {

namespace {

constexpr std::uint64_t bits_below(int bit) {
  if (bit <= 0) return 0;
  return bit >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bit) - 1;
}

std::array<PixelMask, kLinePixels + 1> make_below() {
  std::array<PixelMask, kLinePixels + 1> table;
  for (int n = 0; n <= kLinePixels; ++n)
    table[static_cast<std::size_t>(n)].word = {bits_below(n), bits_below(n - 64), bits_below(n - 128)};
  return table;
}

}  // namespace

const std::array<PixelMask, kLinePixels + 1> PixelMask::kBelow = make_below();

const std::array<Copies, 8> kCopies = {{
    {1, {0, 0, 0}, 1},
    {2, {0, 16, 0}, 1},
    {2, {0, 32, 0}, 1},
    {3, {0, 16, 32}, 1},
    {2, {0, 64, 0}, 1},
    {1, {0, 0, 0}, 2},
    {3, {0, 32, 64}, 1},
    {1, {0, 0, 0}, 4},
}};

namespace {

constexpr std::uint8_t reversed(std::uint8_t byte) {
  std::uint8_t result = 0;
  for (int bit = 0; bit < 8; ++bit)
    if (byte >> bit & 1) result |= static_cast<std::uint8_t>(0x80 >> bit);
  return result;
}

// Each bit of a byte, bit 0 first, repeated `scale` times.
constexpr std::uint32_t stretched(std::uint8_t byte, unsigned scale) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < 8; ++bit)
    for (unsigned copy = 0; copy < scale; ++copy)
      if (byte >> bit & 1) result |= 1U << (bit * scale + copy);
  return result;
}

struct ByteTables {
  std::array<std::uint8_t, 256> reverse{};
  std::array<std::uint32_t, 256> twice{}, four_times{};
  constexpr ByteTables() {
    for (unsigned i = 0; i < 256; ++i) {
      reverse[i] = reversed(static_cast<std::uint8_t>(i));
      twice[i] = stretched(static_cast<std::uint8_t>(i), 2);
      four_times[i] = stretched(static_cast<std::uint8_t>(i), 4);
    }
  }
};
constexpr ByteTables kTables;

constexpr unsigned wrapped(int position) {
  return static_cast<unsigned>(position >= kLinePixels ? position - kLinePixels : position);
}

// Adds a player's pixels. graphics: its leftmost pixel is bit 0. Wide players start a pixel late.
void place_player(PixelMask& mask, const PlayerState& player, std::uint8_t graphics) {
  const Copies& copies = kCopies[player.nusiz & 7];
  if (copies.scale > 1) {
    const std::uint64_t wide = copies.scale == 2 ? kTables.twice[graphics] : kTables.four_times[graphics];
    if (!player.skip) mask.add(wide << 1, player.position);
    return;
  }
  for (unsigned i = player.skip ? 1 : 0; i < copies.count; ++i)
    mask.add(graphics, wrapped(player.position + copies.offset[i]));
}

}  // namespace

std::uint8_t enabled_objects(const TiaRegisters& tia) { return enabled_among(tia, kAllObjects); }

std::uint32_t playfield_bits(const TiaState& tia) {
  return static_cast<std::uint32_t>(tia.pf[0] >> 4 | kTables.reverse[tia.pf[1]] << 4 | tia.pf[2] << 12);
}

void draw_playfield(PixelMask& mask, const TiaState& tia) {
  const std::uint32_t bits = playfield_bits(tia);
  // 20 bits, of four pixels each, are 80 pixels: a word and a quarter.
  const auto spread = [](std::uint32_t part) { return std::uint64_t{kTables.four_times[part & 0xFF]}; };
  const std::uint64_t low = spread(bits) | spread(bits >> 8) << 32;
  const std::uint64_t high = spread(bits >> 16) & 0xFFFF;
  mask.word[0] = low;
  if (!tia.reflect) {
    mask.word[1] = high | low << 16;
    mask.word[2] = low >> 48 | high << 16;
    return;
  }
  const auto mirror = [](std::uint32_t part) {
    return std::uint64_t{kTables.four_times[kTables.reverse[part & 0xFF]]};
  };
  // Right half: bits 19 to 0. As bytes of eight bits from the left: 19-12, 11-4, 3-0.
  const std::uint64_t right = mirror(bits >> 12) | mirror(bits >> 4) << 32;
  const std::uint64_t last = mirror(bits << 4) & 0xFFFF;
  mask.word[1] = high | right << 16;
  mask.word[2] = right >> 48 | last << 16;
}

void draw_player(PixelMask& mask, const PlayerState& player) {
  const std::uint8_t graphics = shown_graphics(player);
  mask.clear();
  if (graphics != 0) place_player(mask, player, player.refp ? graphics : kTables.reverse[graphics]);
}

PixelMask player_shape(const PlayerState& player) {
  PixelMask mask;
  place_player(mask, player, 0xFF);
  return mask;
}

void draw_missile(PixelMask& mask, const TiaState& tia, unsigned which) {
  const MissileState& missile = tia.missile[which];
  const bool cosmic = which == 0;
  mask.clear();
  if (!missile_enabled(missile) || (cosmic && tia.cosmic_shape == CosmicShape::kHidden)) return;
  const std::uint8_t nusiz = tia.player[which].nusiz;
  unsigned size = nusiz >> 4 & 3;
  if (cosmic && tia.cosmic_shape == CosmicShape::kStretched) size |= 1;
  const Copies& copies = kCopies[nusiz & 7];
  for (unsigned i = 0; i < copies.count; ++i)
    mask.add((1U << (1U << size)) - 1, wrapped(missile.position + copies.offset[i]));
}

void draw_ball(PixelMask& mask, const TiaState& tia) {
  mask.clear();
  if (ball_enabled(tia.ball)) mask.add((1U << (1U << (tia.ctrlpf >> 4 & 3))) - 1, tia.ball.position);
}

}  // namespace racebeam

// Models of the cartridge schemes, written only from docs/spec/cartridges.md, 5 to 11. Each decodes every
// address anew. They use no memory map, and nothing of emulator/.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace racebeam::test {

using Image = std::vector<std::uint8_t>;

constexpr unsigned kNotOurs = 0x100;  // above all bytes: what the cartridge does not say

// `a` has 13 bits. Time is in cycles.
struct CartridgeModel {
  explicit CartridgeModel(Image bytes) : image(std::move(bytes)) {}
  virtual ~CartridgeModel() = default;
  virtual unsigned read(unsigned a, int cycle) = 0;
  virtual void write(unsigned a, unsigned v) = 0;
  virtual std::unique_ptr<CartridgeModel> copy() const = 0;
  Image image;
};

template <class Model>
struct Copyable : CartridgeModel {
  using CartridgeModel::CartridgeModel;
  std::unique_ptr<CartridgeModel> copy() const override {
    return std::make_unique<Model>(static_cast<const Model&>(*this));
  }
};

struct Model4ksc : Copyable<Model4ksc> {
  using Copyable::Copyable;
  std::array<unsigned, 128> ram{};
  unsigned read(unsigned a, int) override {
    return a >= 0x1080 && a <= 0x10FF ? ram[a - 0x1080] : image[a & 0xFFF];
  }
  void write(unsigned a, unsigned v) override {
    if (a <= 0x107F) ram[a - 0x1000] = v;
  }
};

struct ModelFasc : Copyable<ModelFasc> {
  using Copyable::Copyable;
  unsigned bank = 2;
  std::array<unsigned, 256> ram{};
  void access(unsigned a) {
    if (a >= 0x1FF8 && a <= 0x1FFA) bank = a - 0x1FF8;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a >= 0x1100 && a <= 0x11FF ? ram[a - 0x1100] : image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned v) override {
    access(a);
    if (a <= 0x10FF) ram[a - 0x1000] = v;
  }
};

struct ModelE7 : Copyable<ModelE7> {
  using Copyable::Copyable;
  unsigned s = 0, b = 0;
  std::array<unsigned, 2048> ram{};
  unsigned byte(unsigned slice, unsigned a) const {
    const unsigned slices = static_cast<unsigned>(image.size() / 2048), missing = 8 - slices;
    return image[(slice < missing ? slice : slice - missing) * 2048 + (a & 0x7FF)];
  }
  void access(unsigned a) {
    if (a >= 0x1FE0 && a <= 0x1FE7) s = a - 0x1FE0;
    if (a >= 0x1FE8 && a <= 0x1FEB) b = a - 0x1FE8;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    if (a <= 0x17FF && s < 7) return byte(s, a);
    if (a >= 0x1400 && a <= 0x17FF) return ram[a - 0x1400];
    if (a >= 0x1900 && a <= 0x19FF) return ram[1024 + 256 * b + (a - 0x1900)];
    return byte(7, a);
  }
  void write(unsigned a, unsigned v) override {
    access(a);
    if (a <= 0x13FF && s == 7) ram[a - 0x1000] = v;
    if (a >= 0x1800 && a <= 0x18FF) ram[1024 + 256 * b + (a - 0x1800)] = v;
  }
};

template <unsigned kRamBanks>
struct Model3eLike : Copyable<Model3eLike<kRamBanks>> {
  using Copyable<Model3eLike>::Copyable;
  using CartridgeModel::image;
  unsigned rom_bank = 0, ram_bank = 0;
  bool ram_shows = false;
  std::vector<unsigned> ram = std::vector<unsigned>(kRamBanks * 1024);
  unsigned read(unsigned a, int) override {
    const bool fixed = a >= 0x1800;
    if (fixed) return image[image.size() - 2048 + (a & 0x7FF)];
    return ram_shows ? ram[ram_bank * 1024 + (a & 0x3FF)] : image[rom_bank * 2048 + (a & 0x7FF)];
  }
  void write(unsigned a, unsigned v) override {
    if ((a & 0xFFF) == 0x3F) {
      rom_bank = v % static_cast<unsigned>(image.size() / 2048);
      ram_shows = false;
    } else if ((a & 0xFFF) == 0x3E) {
      ram_bank = v % kRamBanks;
      ram_shows = true;
    } else if (ram_shows && a >= 0x1400 && a <= 0x17FF) {
      ram[ram_bank * 1024 + (a & 0x3FF)] = v;
    }
  }
};

using Model3e = Model3eLike<32>;

struct ModelJane : Copyable<ModelJane> {
  using Copyable::Copyable;
  unsigned bank = 0;
  void access(unsigned a) {
    if (a == 0x1FF0) bank = 0;
    if (a == 0x1FF1) bank = 1;
    if (a == 0x1FF8) bank = 2;
    if (a == 0x1FF9) bank = 3;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelWf8 : Copyable<ModelWf8> {
  using Copyable::Copyable;
  unsigned bank = 0;
  unsigned read(unsigned a, int) override { return image[bank * 4096 + (a & 0xFFF)]; }
  void write(unsigned a, unsigned v) override {
    if (a == 0x1FF8) bank = v / 4 % 2;
  }
};

struct ModelCv : Copyable<ModelCv> {
  explicit ModelCv(Image bytes) : Copyable(std::move(bytes)) {
    if (image.size() == 4096)
      for (unsigned i = 0; i < 1024; ++i) ram[i] = image[i];
  }
  std::array<unsigned, 1024> ram{};
  unsigned read(unsigned a, int) override {
    return a <= 0x13FF ? ram[a - 0x1000] : image[image.size() - 2048 + (a & 0x7FF)];
  }
  void write(unsigned a, unsigned v) override {
    if (a >= 0x1400 && a <= 0x17FF) ram[a - 0x1400] = v;
  }
};

// EF, DF and BF: `kBanks` banks, selected from `kFirst` on, and `kRam` bytes of RAM.
template <unsigned kFirst, unsigned kBanks, unsigned kInitial, unsigned kRam>
struct ModelLarge : Copyable<ModelLarge<kFirst, kBanks, kInitial, kRam>> {
  using Copyable<ModelLarge>::Copyable;
  unsigned bank = kInitial;
  std::array<unsigned, kRam + 1> ram{};
  void access(unsigned a) {
    if (a >= kFirst && a < kFirst + kBanks) bank = a - kFirst;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    const bool is_port = a >= 0x1000 + kRam && a < 0x1000 + 2 * kRam;
    return is_port ? ram[a - 0x1000 - kRam] : this->image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned v) override {
    access(a);
    if (a < 0x1000 + kRam) ram[a - 0x1000] = v;
  }
};

// EF with an EEPROM behind two lines.
struct ModelEff : Copyable<ModelEff> {
  using Copyable::Copyable;
  unsigned bank = 1;
  bool clock = true, data = true, low = false;  // low: the EEPROM's doing
  char waits_for = '-';                         // control byte, address, byte to write, byte to read
  unsigned count = 0, byte = 0, place = 0;
  std::vector<unsigned> cells = std::vector<unsigned>(2048, 0xFF);

  void set_data(bool level) {
    if (clock && level != data) waits_for = level ? '-' : 'c', count = byte = 0, low = false;
    data = level;
  }
  void rise() {
    const bool bit = data && !low;
    if (waits_for == '-') return;
    if (count == 8 && waits_for == 'r' && bit) waits_for = '-';
    if (count < 8) byte = (2 * byte + (bit ? 1 : 0)) % 256;
    ++count;
  }
  void fall() {
    low = false;
    if (waits_for == '-') return;
    const char awaited = waits_for;
    if (count == 8 && awaited == 'c') {
      low = byte / 16 == 0xA;
      waits_for = !low ? '-' : byte % 2 == 1 ? 'r' : 'a';
      if (low) place = byte / 2 % 8 * 256 + place % 256;
    } else if (count == 8 && awaited == 'a') {
      low = true;
      waits_for = 'w';
      place = place / 256 * 256 + byte;
    } else if (count == 8) {
      if (awaited == 'w') low = true, cells[place] = byte;
      place = (place + 1) % 2048;
    }
    if (count == 9) count = 0;
    if (waits_for == 'r' && count < 8) low = (cells[place] >> (7 - count)) % 2 == 0;
  }
  void access(unsigned a) {
    if (a >= 0x1FE0 && a <= 0x1FEF) bank = a - 0x1FE0;
    if (a == 0x1FF2 || a == 0x1FF3) set_data(a == 0x1FF3);
    if (a != 0x1FF0 && a != 0x1FF1) return;
    const bool level = a == 0x1FF1;
    if (level != clock) {
      clock = level;
      level ? rise() : fall();
    }
  }
  unsigned read(unsigned a, int) override {
    access(a);
    const unsigned value = image[bank * 4096 + (a & 0xFFF)];
    return a == 0x1FF4 ? value / 2 * 2 + (data && !low ? 1 : 0) : value;
  }
  void write(unsigned a, unsigned) override { access(a); }
};

// UA, its clones, 0FA0 and 0840.
template <unsigned kMask, unsigned kBank0, unsigned kBank1>
struct ModelTwo : Copyable<ModelTwo<kMask, kBank0, kBank1>> {
  using Copyable<ModelTwo>::Copyable;
  unsigned bank = 0;
  void access(unsigned a) {
    if ((a & kMask) == kBank0) bank = 0;
    if ((a & kMask) == kBank1) bank = 1;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a < 0x1000 ? kNotOurs : this->image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct Model03e0 : Copyable<Model03e0> {
  using Copyable::Copyable;
  std::array<unsigned, 4> slice = {4, 5, 6, 7};
  void access(unsigned a) {
    if (a < 0x380 || a > 0x3FF) return;
    if ((a & 0x10) == 0) slice[0] = a & 7;
    if ((a & 0x20) == 0) slice[1] = a & 7;
    if ((a & 0x40) == 0) slice[2] = a & 7;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a < 0x1000 ? kNotOurs : image[slice[a >> 10 & 3] * 1024 + (a & 0x3FF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

// kSwapped: WDSW.
template <bool kSwapped>
struct ModelWd : Copyable<ModelWd<kSwapped>> {
  using Copyable<ModelWd>::Copyable;
  unsigned arrangement = 0, next = 0, left = 0;
  std::array<unsigned, 64> ram{};
  void access(unsigned a) {
    if (a < 0x30 || a > 0x3F) return;
    next = a % 8;
    left = 3;
  }
  void pass() {
    if (left != 0 && --left == 0) arrangement = next;
  }
  unsigned read(unsigned a, int) override {
    static constexpr unsigned kSlices[8] = {0x0013, 0x0123, 0x4567, 0x7423, 0x0067, 0x0176, 0x2345, 0x6051};
    access(a);
    if (a < 0x1000) return kNotOurs;
    unsigned slice = kSlices[arrangement] >> (12 - 4 * (a >> 10 & 3)) & 0xF;
    if (kSwapped && slice / 2 == 1) slice = 5 - slice;
    const unsigned value = a <= 0x103F ? ram[a - 0x1000] : this->image[slice * 1024 + (a & 0x3FF)];
    pass();
    return value;
  }
  void write(unsigned a, unsigned v) override {
    access(a);
    if (a < 0x1000) return;
    if (a >= 0x1040 && a <= 0x107F) ram[a - 0x1040] = v;
    pass();
  }
};

struct ModelSb : Copyable<ModelSb> {
  using Copyable::Copyable;
  unsigned bank = static_cast<unsigned>(image.size() / 4096 - 1);
  void access(unsigned a) {
    if (a >= 0x800 && a <= 0x83F) bank = (a & 0x3F) % static_cast<unsigned>(image.size() / 4096);
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a < 0x1000 ? kNotOurs : image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelMdm : Copyable<ModelMdm> {
  using Copyable::Copyable;
  unsigned bank = 0;
  bool stays = false;
  void access(unsigned a) {
    if (stays || a < 0x800 || a > 0xFFF) return;
    bank = a % 128 % static_cast<unsigned>(image.size() / 4096);
    stays = a / 128 % 2 == 1;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a < 0x1000 ? kNotOurs : image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelX07 : Copyable<ModelX07> {
  using Copyable::Copyable;
  unsigned bank = 0;
  void access(unsigned a) {
    const bool below = a < 0x1000, upper = (a & 0x800) != 0, tia = (a & 0x880) == 0;
    if (below && upper && a % 16 == 13)
      bank = a / 16 % 16;
    else if (below && tia && bank >= 14)
      bank = (a & 0x40) != 0 ? 15 : 14;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return a < 0x1000 ? kNotOurs : image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelFa2 : Copyable<ModelFa2> {
  using Copyable::Copyable;
  unsigned bank = 0;
  std::array<unsigned, 256> ram{};
  void access(unsigned a) {
    const bool exists = a >= 0x1FF5 && a <= 0x1FFB && (a - 0x1FF5 + 1) * 4096 <= image.size();
    if (exists) bank = a - 0x1FF5;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    if (a >= 0x1100 && a <= 0x11FF) return ram[a - 0x1100];
    const unsigned byte = image[image.size() % 4096 + bank * 4096 + (a & 0xFFF)];
    return a == 0x1FF4 ? byte & 0xBF : byte;
  }
  void write(unsigned a, unsigned v) override {
    access(a);
    if (a <= 0x10FF) ram[a - 0x1000] = v;
  }
};

struct Model3ePlus : Copyable<Model3ePlus> {
  using Copyable::Copyable;
  struct Window {
    bool ram = false;
    unsigned bank = 0;
  };
  std::array<Window, 4> windows{};
  std::vector<unsigned> ram = std::vector<unsigned>(32768);
  unsigned read(unsigned a, int) override {
    if (a < 0x1000) return kNotOurs;
    const Window& window = windows[a >> 10 & 3];
    return window.ram ? ram[window.bank * 512 + (a & 0x1FF)] : image[window.bank * 1024 + (a & 0x3FF)];
  }
  void write(unsigned a, unsigned v) override {
    if (a == 0x3F) windows[v >> 6] = {false, v % 64 % static_cast<unsigned>(image.size() / 1024)};
    if (a == 0x3E) windows[v >> 6] = {true, v % 64};
    if (a < 0x1000) return;
    const Window& window = windows[a >> 10 & 3];
    if (window.ram && (a & 0x200) != 0) ram[window.bank * 512 + (a & 0x1FF)] = v;
  }
};

struct ModelFc : Copyable<ModelFc> {
  using Copyable::Copyable;
  unsigned bank = 0, next = 0;
  unsigned read(unsigned a, int) override {
    if (a == 0x1FFC) bank = next;
    return image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned v) override {
    const auto banks = static_cast<unsigned>(image.size() / 4096);
    if (a == 0x1FF8) next = v % 4 % banks;
    if (a == 0x1FF9) next = (4 * v < banks ? 4 * v + next % 4 : v) % banks;
    if (a == 0x1FFC) bank = next;
  }
};

// A cartridge with `kGames` games, of which the console shows one, counted from 0.
template <unsigned kGames, unsigned kGame>
struct ModelMany : Copyable<ModelMany<kGames, kGame>> {
  using Copyable<ModelMany>::Copyable;
  unsigned read(unsigned a, int) override {
    const unsigned size = this->image.size() / 4096 >= kGames ? 4096 : 2048;
    return this->image[kGame * size + a % size];
  }
  void write(unsigned, unsigned) override {}
};

struct ModelMb : Copyable<ModelMb> {
  using Copyable::Copyable;
  unsigned bank = 1;
  void access(unsigned a) {
    if (a == 0x1FF0) bank = (bank + 1) % 16;
  }
  unsigned read(unsigned a, int) override {
    access(a);
    return image[bank * 4096 + (a & 0xFFF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelMc : Copyable<ModelMc> {
  using Copyable::Copyable;
  std::array<unsigned, 4> block{};
  bool locked = false;
  std::vector<unsigned> ram = std::vector<unsigned>(32768);
  unsigned number(unsigned a) {
    if (a == 0x1FFC || a == 0x1FFD) locked = true;
    if (a >= 0x1000 && a <= 0x1BFF) locked = false;
    const unsigned window = (a & 0xC00) >> 10;
    return window == 3 && locked ? 0xFF : block[window];
  }
  unsigned read(unsigned a, int) override {
    if (a < 0x40) return 0;
    const unsigned n = number(a);
    if (n & 0x80) return image[(n & 0x7F) * 1024 + (a & 0x3FF)];
    unsigned& byte = ram[(n & 0x3F) * 512 + (a & 0x1FF)];
    if ((a & 0x200) == 0) byte = 0;
    return byte;
  }
  void write(unsigned a, unsigned v) override {
    if (a >= 0x3C && a <= 0x3F) {
      block[a - 0x3C] = v;
      return;
    }
    const unsigned n = number(a);
    if ((n & 0x80) == 0 && (a & 0x200) == 0) ram[(n & 0x3F) * 512 + (a & 0x1FF)] = v;
  }
};

// Without loads, because the RIOT is missing here.
struct ModelAr : Copyable<ModelAr> {
  using Copyable::Copyable;
  unsigned configuration = 0, hold = 0;
  bool pending = false;
  std::vector<unsigned> ram = std::vector<unsigned>(6144);
  void access(unsigned a) {
    const bool write_enabled = (configuration & 2) != 0;
    if ((a & 0x0F00) == 0 && (!write_enabled || !pending)) {
      hold = a & 0xFF;
      pending = true;
    } else if (a == 0x1FF8) {
      pending = false;
      configuration = hold;
    }
  }
  unsigned read(unsigned a, int) override {
    static constexpr unsigned kBanks[8][2] = {{2, 3}, {0, 3}, {2, 0}, {0, 2}, {2, 3}, {1, 3}, {2, 1}, {1, 2}};
    access(a);
    const unsigned bank = kBanks[configuration >> 2 & 7][a >> 11 & 1];
    return bank == 3 ? kNotOurs : ram[bank * 2048 + (a & 0x7FF)];
  }
  void write(unsigned a, unsigned) override { access(a); }
};

struct ModelDpc : Copyable<ModelDpc> {
  using Copyable::Copyable;
  unsigned bank = 1, rn = 1;
  std::array<unsigned, 8> top{}, bottom{}, counter{}, flag{};
  std::array<bool, 8> music{};
  int base = 0;
  double fraction = 0;

  void access(unsigned a, bool writes) {
    if (a == 0x1FF8) bank = 0;
    if (a == 0x1FF9) bank = 1;
    if (a <= 0x107F || a >= 0x1FC0 || writes) {
      const auto b = [&](unsigned bit) { return rn >> bit & 1; };
      rn = ((rn << 1) & 0xFF) + (1 - (b(7) ^ b(5) ^ b(4) ^ b(3)));
    }
  }
  void set_low(unsigned i, unsigned low) { counter[i] = (counter[i] & 0x700) + low; }

  void update(int cycle) {
    const double clocks = 15750.0 * (cycle - base) / 1193191.66666667 + fraction;
    base = cycle;
    const int w = static_cast<int>(clocks);
    fraction = clocks - w;
    for (unsigned i = 5; w >= 1 && i < 8; ++i) {
      if (!music[i]) continue;
      int low = 0;
      if (top[i] != 0) {
        low = static_cast<int>(counter[i] & 0xFF) - w % static_cast<int>(top[i] + 1);
        if (low < 0) low += static_cast<int>(top[i]) + 1;
      }
      set_low(i, static_cast<unsigned>(low));
      if (low <= static_cast<int>(bottom[i]))
        flag[i] = 0;
      else if (low <= static_cast<int>(top[i]))
        flag[i] = 0xFF;
    }
  }

  unsigned result(unsigned i, unsigned f, int cycle) {
    static constexpr unsigned kLevels[] = {0, 4, 5, 9, 6, 10, 11, 15};
    const unsigned display = image[8192 + 2047 - counter[i]];
    if (f == 0 && i < 4) return rn;
    if (f == 0) {
      update(cycle);
      const auto loud = [&](unsigned m) { return music[m] && flag[m] != 0 ? 1U : 0U; };
      return kLevels[loud(5) + 2 * loud(6) + 4 * loud(7)];
    }
    if (f == 1) return display;
    if (f == 2) return display & flag[i];
    return f == 7 ? flag[i] : 0;
  }

  unsigned read(unsigned a, int cycle) override {
    access(a, false);
    if (a >= 0x1040) return image[bank * 4096 + (a & 0xFFF)];
    const unsigned i = a & 7, f = a >> 3 & 7;
    if ((counter[i] & 0xFF) == top[i])
      flag[i] = 0xFF;
    else if ((counter[i] & 0xFF) == bottom[i])
      flag[i] = 0;
    const unsigned value = result(i, f, cycle);
    if (!(i >= 5 && music[i])) counter[i] = (counter[i] + 2047) % 2048;
    return value;
  }

  void write(unsigned a, unsigned v) override {
    access(a, true);
    if (a < 0x1040 || a > 0x107F) return;
    const unsigned i = a & 7, f = a >> 3 & 7;
    if (f == 0) {
      top[i] = v;
      flag[i] = 0;
    } else if (f == 1) {
      bottom[i] = v;
    } else if (f == 2) {
      set_low(i, music[i] ? top[i] : v);
    } else if (f == 3) {
      counter[i] = (v & 7) * 256 + (counter[i] & 0xFF);
      if (i >= 5) music[i] = (v & 0x10) != 0;
    } else if (f == 6) {
      rn = 1;
    }
  }
};

}  // namespace racebeam::test

// Compares schemes with their models (reference_cartridges.hpp): random reads and writes, with saved and
// restored states.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <random>

#include "tests/emulator/bench.hpp"
#include "tests/emulator/cartridge/modelled_schemes.hpp"
#include "tests/emulator/reference/reference_cartridges.hpp"
#include "tests/emulator/reference/reference_cdf.hpp"
#include "tests/emulator/reference/reference_dpcplus.hpp"

namespace racebeam::test {
namespace {

struct Range {
  unsigned first, size;
};

struct Case {
  const char* name;
  std::size_t size;
  std::function<std::unique_ptr<CartridgeModel>(const Rom&)> model;
  std::vector<Range> lively;  // addresses with an effect
  std::function<void(Rom&)> prepare = [](Rom&) {};
};

template <class Model>
std::unique_ptr<CartridgeModel> make(const Rom& rom) {
  return std::make_unique<Model>(rom);
}

// Many LDA #, whose operands fast fetch exchanges, and a program for the ARM.
void prepare_dpcplus(Rom& rom) {
  for (std::size_t i = 0; i + 1 < rom.size(); i += 3 + rom[i] % 4U) {
    rom[i] = 0xA9;
    rom[i + 1] %= 0x50;
  }
  put_counting_program(rom);
}

const std::vector<Range> kDpcPlusPorts = {{0x1000, 0x28}, {0x1005, 1}, {0x1028, 0x58}, {0x1058, 3},
                                          {0x105A, 1},    {0x1059, 1}, {0x1068, 8},    {0x1FF6, 6},
                                          {0x1010, 8},    {0x1020, 4}, {0x1040, 16}};

void keep_below(std::uint8_t& byte, unsigned limit) { byte = static_cast<std::uint8_t>(byte % limit); }

// Many LDA #, LDX #, LDY # and JMP that fast fetch exchanges, pointers within the display data, waveforms in
// it and in the image, and a program for the ARM.
template <unsigned kVersion>
void prepare_cdf(Rom& rom) {
  constexpr std::array<std::uint8_t, 4> kOpcodes = {0xA9, 0xA2, 0xA0, 0x4C};
  constexpr CdfPlaces kPlaces = kCdfPlaces[kVersion];
  for (std::size_t i = 0x800; i + 2 < 32768; i += 4 + rom[i] % 4U) {
    rom[i] = kOpcodes[rom[i] % 4U];
    const bool jumps = rom[i] == 0x4C;
    keep_below(rom[i + 1], jumps ? 3 : 0x40);
    if (jumps) keep_below(rom[i + 2], 2);
  }
  for (unsigned i = 0; i < kPlaces.amplitude; ++i) {
    keep_below(rom[kPlaces.pointers + 4 * i + 3], kVersion == 3 ? 0x18 : 0xFF);
    const unsigned increment = kPlaces.increments + 4 * i;
    keep_below(rom[increment + 1], 3);
    rom[increment + 2] = rom[increment + 3] = 0;
  }
  for (unsigned v = 0; v < 3; ++v) {
    const unsigned waveform = kPlaces.waveforms + 4 * v;
    rom[waveform + 1] = 0x09;
    rom[waveform + 2] = 0;
    rom[waveform + 3] = rom[waveform] % 4U == 0 ? 0 : 0x40;
  }
  const std::uint8_t dice = rom[0x1B0];
  put_choices(rom, dice % 2U == 0, dice % 4U < 2, dice % 2U == 0 ? 8 : 0xE0);
  put_counting_cdf_program(rom, kVersion);
}

const std::vector<Range> kCdfPorts = {{0x1FF0, 4}, {0x1FF0, 1}, {0x1FF2, 1}, {0x1FF3, 1}, {0x1FF4, 8}};

const std::vector<Case> kCases = {
    {"4KSC", 4096, make<Model4ksc>, {{0x1000, 0x100}}},
    {"FASC", 12288, make<ModelFasc>, {{0x1FF8, 3}, {0x1000, 0x200}}},
    {"E7", 16384, make<ModelE7>, {{0x1FE0, 12}, {0x1FE7, 1}, {0x1000, 0x800}, {0x1800, 0x200}}},
    {"E7", 12288, make<ModelE7>, {{0x1FE0, 12}, {0x1FE7, 1}, {0x1000, 0x800}, {0x1800, 0x200}}},
    {"E7", 8192, make<ModelE7>, {{0x1FE0, 12}, {0x1FE7, 1}, {0x1000, 0x800}, {0x1800, 0x200}}},
    {"3E", 16384, make<Model3e>, {{0x003E, 2}, {0x103E, 2}, {0x1000, 0x800}, {0x0000, 0x40}}},
    {"3E", 6144, make<Model3e>, {{0x003E, 2}, {0x103E, 2}, {0x1000, 0x800}, {0x0000, 0x40}}},
    {"3E+", 16384, make<Model3ePlus>, {{0x003E, 2}, {0x003E, 2}, {0x1000, 0x1000}}},
    {"3E+", 65536, make<Model3ePlus>, {{0x003E, 2}, {0x003E, 2}, {0x1000, 0x1000}}},
    {"UA", 8192, make<ModelTwo<0x1FFF, 0x220, 0x240>>, {{0x0220, 1}, {0x0240, 1}, {0x0200, 0x80}}},
    {"UA clone", 8192, make<ModelTwo<0x1260, 0x220, 0x240>>, {{0x02A0, 1}, {0x02C0, 1}, {0x0F80, 0x80}}},
    {"UASW", 8192, make<ModelTwo<0x1260, 0x240, 0x220>>, {{0x0220, 1}, {0x0240, 1}, {0x0280, 0x80}}},
    {"0FA0", 8192, make<ModelTwo<0x16E0, 0x6A0, 0x6C0>>, {{0x06A0, 1}, {0x06C0, 1}, {0x0F80, 0x80}}},
    {"0840", 8192, make<ModelTwo<0x1840, 0x800, 0x840>>, {{0x0800, 0x80}, {0x0F00, 0x80}}},
    {"03E0", 8192, make<Model03e0>, {{0x0380, 0x80}, {0x0280, 0x80}}},
    {"WD", 8192, make<ModelWd<false>>, {{0x0030, 16}, {0x0020, 32}, {0x1000, 0x80}}},
    {"WDSW", 8195, make<ModelWd<true>>, {{0x0030, 16}, {0x0020, 32}, {0x1000, 0x80}}},
    {"SB", 131072, make<ModelSb>, {{0x0800, 0x40}, {0x0840, 0x40}}},
    {"SB", 262144, make<ModelSb>, {{0x0800, 0x40}}},
    {"MDM", 32768, make<ModelMdm>, {{0x0800, 0x80}, {0x0900, 0x80}, {0x0B00, 0x80}, {0x0000, 0x800}}},
    {"MDM", 524288, make<ModelMdm>, {{0x0800, 0x80}, {0x0E00, 0x80}, {0x0F70, 0x11}}},
    {"X07", 65536, make<ModelX07>, {{0x0800, 0x400}, {0x080D, 1}, {0x08ED, 1}, {0x08FD, 1}, {0x0000, 0x80}}},
    {"FA2", 24576, make<ModelFa2>, {{0x1FF4, 8}, {0x1000, 0x200}}},
    {"FA2", 28672, make<ModelFa2>, {{0x1FF4, 8}, {0x1000, 0x200}}},
    {"FA2", 29696, make<ModelFa2>, {{0x1FF4, 8}, {0x1000, 0x200}}},
    {"FC", 8192, make<ModelFc>, {{0x1FF8, 2}, {0x1FFC, 1}}},
    {"FC", 32768, make<ModelFc>, {{0x1FF8, 2}, {0x1FFC, 1}}},
    {"3EX", 16384, make<Model3eLike<256>>, {{0x003E, 2}, {0x103E, 2}, {0x1000, 0x800}, {0x0000, 0x40}}},
    {"WF8", 8192, make<ModelWf8>, {{0x1FF8, 2}, {0x1FF8, 1}}},
    {"JANE", 16384, make<ModelJane>, {{0x1FF0, 16}}},
    {"CV", 2048, make<ModelCv>, {{0x1000, 0x800}}},
    {"CV 4K", 4096, make<ModelCv>, {{0x1000, 0x800}}},
    {"EF", 65536, make<ModelLarge<0x1FE0, 16, 1, 0>>, {{0x1FE0, 16}}},
    {"EFF", 65536, make<ModelEff>, {{0x1FF0, 5}, {0x1FF0, 4}, {0x1FE0, 16}}},
    {"EFSC", 65536, make<ModelLarge<0x1FE0, 16, 15, 128>>, {{0x1FE0, 16}, {0x1000, 0x100}}},
    {"DF", 131072, make<ModelLarge<0x1FC0, 32, 1, 0>>, {{0x1FC0, 32}}},
    {"DFSC", 131072, make<ModelLarge<0x1FC0, 32, 15, 128>>, {{0x1FC0, 32}, {0x1000, 0x100}}},
    {"BF", 262144, make<ModelLarge<0x1F80, 64, 1, 0>>, {{0x1F80, 64}}},
    {"BFSC", 262144, make<ModelLarge<0x1F80, 64, 15, 128>>, {{0x1F80, 64}, {0x1000, 0x100}}},
    {"2IN1", 4096, make<ModelMany<2, 0>>, {{0x1000, 0x1000}}},
    {"2IN1 2", 8192, make<ModelMany<2, 1>>, {{0x1000, 0x1000}}},
    {"4IN1", 16384, make<ModelMany<4, 0>>, {{0x1000, 0x1000}}},
    {"4IN1 3", 8192, make<ModelMany<4, 2>>, {{0x1000, 0x1000}}},
    {"8IN1", 32768, make<ModelMany<8, 0>>, {{0x1000, 0x1000}}},
    {"16IN1", 32768, make<ModelMany<16, 0>>, {{0x1000, 0x1000}}},
    {"32IN1", 65536, make<ModelMany<32, 0>>, {{0x1000, 0x1000}}},
    {"32IN1 31", 65536, make<ModelMany<32, 30>>, {{0x1000, 0x1000}}},
    {"64IN1", 131072, make<ModelMany<64, 0>>, {{0x1000, 0x1000}}},
    {"128IN1", 262144, make<ModelMany<128, 0>>, {{0x1000, 0x1000}}},
    {"128IN1 128", 524288, make<ModelMany<128, 127>>, {{0x1000, 0x1000}}},
    {"MB", 65536, make<ModelMb>, {{0x1FF0, 1}}},
    {"MC",
     131072,
     make<ModelMc>,
     {{0x003C, 4}, {0x0000, 0x40}, {0x1000, 0x800}, {0x1FFC, 2}, {0x1C00, 0x400}}},
    {"AR", 8448, make<ModelAr>, {{0x1000, 0x100}, {0x1FF8, 1}}},
    {"DPC", 10495, make<ModelDpc>, {{0x1000, 0x40}, {0x1000, 8}, {0x1040, 0x40}, {0x1058, 8}, {0x1FF8, 2}}},
    {"DPC+", 32768, make<ModelDpcPlus>, kDpcPlusPorts, prepare_dpcplus},
    {"DPC+", 29696, make<ModelDpcPlus>, kDpcPlusPorts, prepare_dpcplus},
    {"DPC+", 30001, make<ModelDpcPlus>, kDpcPlusPorts, prepare_dpcplus},
    {"CDF0", 32768, make<ModelCdf<0>>, kCdfPorts, prepare_cdf<0>},
    {"CDF", 32768, make<ModelCdf<1>>, kCdfPorts, prepare_cdf<1>},
    {"CDFJ", 32768, make<ModelCdf<2>>, kCdfPorts, prepare_cdf<2>},
    {"CDFJ+", 32768, make<ModelCdf<3>>, kCdfPorts, prepare_cdf<3>},
    {"CDFJ+", 65536, make<ModelCdf<3>>, kCdfPorts, prepare_cdf<3>},
    {"CDFJ+", 524288, make<ModelCdf<3>>, kCdfPorts, prepare_cdf<3>},
};

Properties asking_for(const char* scheme) {
  Properties properties = ntsc();
  properties.scheme = scheme;
  return properties;
}

class Trial {
 public:
  Trial(const Case& of, std::uint32_t seed)
      : case_(of),
        random_(seed),
        rom_(random_bytes()),
        bench_(rom_, asking_for(of.name)),
        model_(of.model(rom_)) {
    forget_vector();
    keep();
  }

  void run(int accesses) {
    for (int i = 0; i < accesses; ++i) {
      const int what = below(100);
      if (what == 0)
        keep();
      else if (what == 1)
        go_back();
      else if (what < 50)
        write(address(), value());
      else
        read(address());
      cycle_ += below(60);
    }
  }

 private:
  // The bench has read the reset vector already, which affects some cartridges.
  void forget_vector() {
    CartridgeSlot& slot = bench_.board.slot;
    bench_.state.cartridge.bank = {};
    slot.scheme.reset(slot);
    if (slot.scheme.power_on) slot.scheme.power_on(slot);
    bench_.board.map_memory();
  }

  int below(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }

  Rom random_bytes() {
    Rom rom(case_.size);
    for (std::uint8_t& byte : rom) byte = static_cast<std::uint8_t>(random_());
    case_.prepare(rom);
    return rom;
  }

  // Sometimes one behind the last.
  unsigned address() {
    if (last_ >= 0x1000 && last_ < 0x1FFF && below(4) == 0) return ++last_;
    return last_ = any_address();
  }

  unsigned any_address() {
    if (below(4) == 0) return 0x1000 + static_cast<unsigned>(below(0x1000));
    const Range& range = case_.lively[static_cast<std::size_t>(below(static_cast<int>(case_.lively.size())))];
    return range.first + static_cast<unsigned>(below(static_cast<int>(range.size)));
  }

  // Values near 0 and 255 are those that select functions.
  unsigned value() {
    const auto any = static_cast<unsigned>(below(256));
    return below(4) == 0 ? (any % 8 - 4) & 0xFF : any;
  }

  void read(unsigned a) {
    const unsigned high = below(2) ? 0xE000 : 0;  // the upper three bits are not decoded
    const unsigned theirs = model_->read(a, cycle_), ours = bench_.see(a | high, cycle_);
    INFO(case_.name << " read " << std::hex << a);
    if (theirs < 0x100) REQUIRE(ours == theirs);
  }

  void write(unsigned a, unsigned value) {
    model_->write(a, value);
    bench_.write_at(cycle_, a, value);
  }

  void keep() { kept_ = {bench_.state, bench_.board.cartridge_ram, model_->copy(), cycle_}; }

  // Rebuilds the map from the state; it must not change.
  void go_back() {
    bench_.board.cartridge_ram = kept_.ram;
    bench_.restore(kept_.state);
    model_ = kept_.model->copy();
    cycle_ = kept_.cycle;
  }

  struct Kept {
    State state;
    std::vector<std::uint8_t> ram;
    std::unique_ptr<CartridgeModel> model;
    int cycle;
  };

  const Case& case_;
  std::mt19937 random_;
  Rom rom_;
  Bench bench_;
  std::unique_ptr<CartridgeModel> model_;
  int cycle_ = 0;
  unsigned last_ = 0;
  Kept kept_;
};

TEST_CASE("Random accesses find each cartridge as its model has it, through saved states too") {
  for (const Case& one : kCases)
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      INFO("seed " << seed);
      Trial(one, seed).run(5000);
    }
}

}  // namespace

std::set<std::string> modelled_schemes() {
  std::set<std::string> names = {"4A50"};  // payson_test.cpp
  for (const Case& one : kCases) names.insert(one.name);
  return names;
}

}  // namespace racebeam::test

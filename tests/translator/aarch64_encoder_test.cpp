// The encoder of AArch64, compared with words that GNU as makes of the same instructions.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "emulator/translator/aarch64/encoder.hpp"

using namespace racebeam::translator::aarch64;

namespace {

using Words = std::vector<std::uint32_t>;

struct Row {
  const char* assembly;
  void (*emit)(Encoder&);
  Words words;
};

Words encoded(const auto& emit) {
  Words words(64);
  Encoder encoder(words.data(), words.size() * 4);
  emit(encoder);
  words.resize(encoder.size() / 4);
  return words;
}

}  // namespace

TEST_CASE("Each instruction of AArch64 is the word that GNU as makes of it") {
  const std::vector<Row> rows = {
      // clang-format off
      {"add w3, w24, #5", [](Encoder& e) { e.add(w(3), w(24), 5); }, {0x11001703}},
      {"add x0, x19, #0xfff", [](Encoder& e) { e.add(x(0), x(19), 0xFFF); }, {0x913FFE60}},
      {"add w1, w2, #0xf000", [](Encoder& e) { e.add(w(1), w(2), 0xF000); }, {0x11403C41}},
      {"sub w4, w1, #0x1000", [](Encoder& e) { e.sub(w(4), w(1), 0x1000); }, {0x51400424}},
      {"sub x5, x6, #7", [](Encoder& e) { e.sub(x(5), x(6), 7); }, {0xD1001CC5}},
      {"subs w25, w21, #200", [](Encoder& e) { e.subs(w(25), w(21), 200); }, {0x710322B9}},
      {"add w17, w21, w26", [](Encoder& e) { e.add(w(17), w(21), w(26)); }, {0x0B1A02B1}},
      {"add x5, x19, x4, lsl #3", [](Encoder& e) { e.add(x(5), x(19), x(4), 3); }, {0x8B040E65}},
      {"add w24, w24, w16, lsr #8", [](Encoder& e) { e.add_lsr(w(24), w(24), w(16), 8); }, {0x0B502318}},
      {"sub w1, w2, w3", [](Encoder& e) { e.sub(w(1), w(2), w(3)); }, {0x4B030041}},
      {"sub x1, x2, x3, lsl #63", [](Encoder& e) { e.sub(x(1), x(2), x(3), 63); }, {0xCB03FC41}},
      {"sub w24, w24, w16, lsr #31", [](Encoder& e) { e.sub_lsr(w(24), w(24), w(16), 31); }, {0x4B507F18}},
      {"subs w25, w21, w16", [](Encoder& e) { e.subs(w(25), w(21), w(16)); }, {0x6B1002B9}},
      {"and w1, w2, #0xff", [](Encoder& e) { e.and_(w(1), w(2), 0xFFU); }, {0x12001C41}},
      {"and w1, w2, #0x80", [](Encoder& e) { e.and_(w(1), w(2), 0x80U); }, {0x12190041}},
      {"and w30, w2, #0x1ff", [](Encoder& e) { e.and_(w(30), w(2), 0x1FFU); }, {0x1200205E}},
      {"and w1, w2, #0xffff0000", [](Encoder& e) { e.and_(w(1), w(2), 0xFFFF0000U); }, {0x12103C41}},
      {"and w1, w2, #1", [](Encoder& e) { e.and_(w(1), w(2), 1U); }, {0x12000041}},
      {"orr w1, w2, #0x30", [](Encoder& e) { e.orr(w(1), w(2), 0x30U); }, {0x321C0441}},
      {"orr w1, w2, #0x100", [](Encoder& e) { e.orr(w(1), w(2), 0x100U); }, {0x32180041}},
      {"eor w1, w2, #0x80", [](Encoder& e) { e.eor(w(1), w(2), 0x80U); }, {0x52190041}},
      {"eor w1, w2, #0x80000000", [](Encoder& e) { e.eor(w(1), w(2), 0x80000000U); }, {0x52010041}},
      {"tst w25, #0xff", [](Encoder& e) { e.tst(w(25), 0xFFU); }, {0x72001F3F}},
      {"and w1, w2, w3", [](Encoder& e) { e.and_(w(1), w(2), w(3)); }, {0x0A030041}},
      {"orr w1, w2, w3", [](Encoder& e) { e.orr(w(1), w(2), w(3)); }, {0x2A030041}},
      {"orr w1, w2, w3, lsl #14", [](Encoder& e) { e.orr(w(1), w(2), w(3), 14); }, {0x2A033841}},
      {"orr w1, w2, w3, lsr #8", [](Encoder& e) { e.orr_lsr(w(1), w(2), w(3), 8); }, {0x2A432041}},
      {"eor x1, x2, x30", [](Encoder& e) { e.eor(x(1), x(2), x(30)); }, {0xCA1E0041}},
      {"cmp w24, #0x7f", [](Encoder& e) { e.cmp(w(24), 0x7FU); }, {0x7101FF1F}},
      {"cmp w24, #0x1000", [](Encoder& e) { e.cmp(w(24), 0x1000U); }, {0x7140071F}},
      {"cmp w24, w28", [](Encoder& e) { e.cmp(w(24), w(28)); }, {0x6B1C031F}},
      {"cmp x24, x28", [](Encoder& e) { e.cmp(x(24), x(28)); }, {0xEB1C031F}},
      {"mov w25, w21", [](Encoder& e) { e.mov(w(25), w(21)); }, {0x2A1503F9}},
      {"mov x0, x19", [](Encoder& e) { e.mov(x(0), x(19)); }, {0xAA1303E0}},
      {"mov w0, #0", [](Encoder& e) { e.mov(w(0), 0U); }, {0x52800000}},
      {"mov w0, #0xffff", [](Encoder& e) { e.mov(w(0), 0xFFFFU); }, {0x529FFFE0}},
      {"movz w0, #1, lsl #16", [](Encoder& e) { e.mov(w(0), 0x10000U); }, {0x52A00020}},
      {"movz w0, #0xf123 ; movk w0, #1, lsl #16", [](Encoder& e) { e.mov(w(0), 0x1F123U); }, {0x529E2460, 0x72A00020}},
      {"movz x16, #0x9abc ; movk x16, #0x5678, lsl #16 ; movk x16, #0x1234, lsl #32", [](Encoder& e) { e.mov(x(16), 0x0000123456789ABCU); }, {0xD2935790, 0xF2AACF10, 0xF2C24690}},
      {"movz x16, #1 ; movk x16, #0xfedc, lsl #48", [](Encoder& e) { e.mov(x(16), 0xFEDC000000000001U); }, {0xD2800030, 0xF2FFDB90}},
      {"madd w17, w5, w6, w16", [](Encoder& e) { e.madd(w(17), w(5), w(6), w(16)); }, {0x1B0640B1}},
      {"mul x17, x5, x6", [](Encoder& e) { e.madd(x(17), x(5), x(6), xzr); }, {0x9B067CB1}},
      {"ubfx w4, w1, #6, #8", [](Encoder& e) { e.ubfx(w(4), w(1), 6, 8); }, {0x53063424}},
      {"ubfiz w4, w1, #1, #7", [](Encoder& e) { e.ubfiz(w(4), w(1), 1, 7); }, {0x531F1824}},
      {"lsl w4, w1, #7", [](Encoder& e) { e.lsl(w(4), w(1), 7); }, {0x53196024}},
      {"lsr w4, w1, #22", [](Encoder& e) { e.lsr(w(4), w(1), 22); }, {0x53167C24}},
      {"cset w26, hs", [](Encoder& e) { e.cset(w(26), Condition::hs); }, {0x1A9F37FA}},
      {"cset w26, eq", [](Encoder& e) { e.cset(w(26), Condition::eq); }, {0x1A9F17FA}},
      {"csel w1, w2, w3, lo", [](Encoder& e) { e.csel(w(1), w(2), w(3), Condition::lo); }, {0x1A833041}},
      {"csel x1, x2, x3, le", [](Encoder& e) { e.csel(x(1), x(2), x(3), Condition::le); }, {0x9A83D041}},
      {"cinc w24, w24, hs", [](Encoder& e) { e.cinc(w(24), w(24), Condition::hs); }, {0x1A983718}},
      {"ldrb w1, [x19, #13]", [](Encoder& e) { e.ldrb(w(1), x(19), 13); }, {0x39403661}},
      {"ldrb w1, [x19, #4095]", [](Encoder& e) { e.ldrb(w(1), x(19), 4095); }, {0x397FFE61}},
      {"ldurb w1, [x16, #-108]", [](Encoder& e) { e.ldrb(w(1), x(16), -108); }, {0x38594201}},
      {"ldrh w1, [x19, #8190]", [](Encoder& e) { e.ldrh(w(1), x(19), 8190); }, {0x797FFE61}},
      {"ldurh w1, [x19, #21]", [](Encoder& e) { e.ldrh(w(1), x(19), 21); }, {0x78415261}},
      {"ldr w1, [x19, #4992]", [](Encoder& e) { e.ldr(w(1), x(19), 4992); }, {0xB9538261}},
      {"ldr x1, [x19, #536]", [](Encoder& e) { e.ldr(x(1), x(19), 536); }, {0xF9410E61}},
      {"ldr x1, [sp, #16]", [](Encoder& e) { e.ldr(x(1), sp, 16); }, {0xF9400BE1}},
      {"strb wzr, [x19, #3352]", [](Encoder& e) { e.strb(wzr, x(19), 3352); }, {0x3934627F}},
      {"sturb w2, [x16, #-256]", [](Encoder& e) { e.strb(w(2), x(16), -256); }, {0x38100202}},
      {"strh w2, [x20, #12]", [](Encoder& e) { e.strh(w(2), x(20), 12); }, {0x79001A82}},
      {"sturh w2, [x17, #-109]", [](Encoder& e) { e.strh(w(2), x(17), -109); }, {0x78193222}},
      {"str w2, [x19, #4992]", [](Encoder& e) { e.str(w(2), x(19), 4992); }, {0xB9138262}},
      {"str x2, [x20]", [](Encoder& e) { e.str(x(2), x(20), 0); }, {0xF9000282}},
      {"ldrb w0, [x27, w4, uxtw]", [](Encoder& e) { e.ldrb(w(0), x(27), w(4)); }, {0x38644B60}},
      {"ldr x5, [x16, w6, uxtw #3]", [](Encoder& e) { e.ldr_lsl3(x(5), x(16), w(6)); }, {0xF8665A05}},
      {"str w8, [x10], #4", [](Encoder& e) { e.str_post(w(8), x(10), 4); }, {0xB8004548}},
      {"str w8, [x10], #-4", [](Encoder& e) { e.str_post(w(8), x(10), -4); }, {0xB81FC548}},
      {"stp x19, x20, [sp, #16]", [](Encoder& e) { e.stp(x(19), x(20), sp, 16); }, {0xA90153F3}},
      {"ldp x27, x28, [sp, #80]", [](Encoder& e) { e.ldp(x(27), x(28), sp, 80); }, {0xA94573FB}},
      {"stp x29, x30, [sp, #-96]!", [](Encoder& e) { e.stp_pre(x(29), x(30), sp, -96); }, {0xA9BA7BFD}},
      {"ldp x29, x30, [sp], #96", [](Encoder& e) { e.ldp_post(x(29), x(30), sp, 96); }, {0xA8C67BFD}},
      {"br x16", [](Encoder& e) { e.br(x(16)); }, {0xD61F0200}},
      {"blr x16", [](Encoder& e) { e.blr(x(16)); }, {0xD63F0200}},
      {"ret", [](Encoder& e) { e.ret(); }, {0xD65F03C0}},
      // clang-format on
  };
  for (const Row& row : rows) {
    INFO(row.assembly);
    CHECK(encoded(row.emit) == row.words);
  }
}

TEST_CASE("Jumps of AArch64 lead forward and back, to labels bound before and after them") {
  const Words expected = {0x14000008, 0x17FFFFFF, 0x540000CA, 0x54FFFFA0, 0x34000083,
                          0xB5FFFF65, 0x36600041, 0x373FFF39, 0xD65F03C0};
  CHECK(encoded([](Encoder& e) {
          racebeam::translator::Label back, ahead;
          e.bind(back);
          e.b(ahead);
          e.b(back);
          e.b(Condition::ge, ahead);
          e.b(Condition::eq, back);
          e.cbz(w(3), ahead);
          e.cbnz(x(5), back);
          e.tbz(w(1), 12, ahead);
          e.tbnz(w(25), 7, back);
          e.bind(ahead);
          e.ret();
        }) == expected);
}

TEST_CASE("A jump to code of another batch has its distance") {
  Words words(4);
  Encoder encoder(words.data(), words.size() * 4);
  encoder.ret();
  encoder.ret();
  encoder.b(words.data());
  CHECK(words[2] == 0x17FFFFFE);
  encoder.bl(words.data());
  CHECK(words[3] == 0x97FFFFFD);
}

TEST_CASE("What AArch64 cannot encode is refused") {
  CHECK_THROWS_AS(encoded([](Encoder& e) { e.and_(w(0), w(0), 0x1280U); }), AssemblyError);
  CHECK_THROWS_AS(encoded([](Encoder& e) { e.and_(w(0), w(0), 0U); }), AssemblyError);
  CHECK_THROWS_AS(encoded([](Encoder& e) { e.and_(w(0), w(0), ~0U); }), AssemblyError);
  CHECK_THROWS_AS(encoded([](Encoder& e) { e.ldrb(w(0), x(1), 4096); }), AssemblyError);
  CHECK_THROWS_AS(encoded([](Encoder& e) { e.ldrb(w(0), x(1), -257); }), AssemblyError);
  CHECK_THROWS_AS(encoded([](Encoder& e) {
                    for (int i = 0; i < 65; ++i) e.ret();
                  }),
                  AssemblyError);
}

TEST_CASE("A bit is tested across at most 32 KiB, and a label found within them") {
  for (const int distance : {8191, 8192}) {
    Words words(9000);
    Encoder encoder(words.data(), words.size() * 4);
    racebeam::translator::Label far;
    encoder.tbz(w(0), 0, far);
    for (int i = 1; i < distance; ++i) encoder.ret();
    if (distance < 8192)
      CHECK_NOTHROW(encoder.bind(far));
    else
      CHECK_THROWS_AS(encoder.bind(far), AssemblyError);
  }
}

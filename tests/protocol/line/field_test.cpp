// Fields: how they are written in requests, what they show, and how much memory is asked for them.
#include "protocol/line/field.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "games/catalogue.hpp"
#include "protocol/line/loaded_machine.hpp"
#include "protocol/request_error.hpp"
#include "system/invalid_input.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

std::vector<Field> fields_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto word = next_word(text); !word.empty(); word = next_word(text)) words.push_back(word);
  return parse_fields(words);
}

std::string refusal(const std::string& text) {
  try {
    fields_of(text);
  } catch (const RequestError& refused) {
    return refused.what();
  } catch (const InvalidInput& refused) {
    return refused.what();
  }
  return "accepted";
}

StackSettings stack_of(const std::string& word) { return fields_of(word).at(0).stack.value(); }

Cartridge with_height(const std::string& height) {
  const auto image = load_image("builtin:beamfall");
  PropertyOverrides console;
  console.set("height", height);
  return {image, with_overrides(find_game("beamfall"), *image, console)};
}

// A machine that shows these fields.
struct Shown {
  explicit Shown(const std::string& text, const std::string& height = "210")
      : fields(fields_of(text)), slot(with_height(height), slot_settings({})) {
    observe(slot, fields);
  }

  // The fields of the next reply, after one act.
  std::string next() {
    slot.act({});
    std::string out, raw;
    view.append(out, raw, slot);
    return out + raw;
  }

  std::vector<Field> fields;
  Slot slot;
  View view{fields};
};

std::string value_of(const std::string& shown, const std::string& name) {
  const std::size_t at = shown.find(" " + name + "=") + name.size() + 2;
  return shown.substr(at, shown.find(' ', at) - at);
}

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789ABCDEF"[byte >> 4];
    text += "0123456789ABCDEF"[byte & 15];
  }
  return text;
}

// Each field of bytes that a machine has, with a stack of either kind.
std::vector<std::string> names_of_bytes() {
  std::vector<std::string> names = {"grey84x84x4", "rgb100x50x2"};
  for (const FieldRow& row : field_rows())
    if (row.bytes != nullptr) names.emplace_back(row.name);
  return names;
}

}  // namespace

TEST_CASE("A stack may have each size up to its limits") {
  CHECK(stack_of("grey1x9x1") == StackSettings{.depth = 1, .width = 1, .height = 9, .rgb = false});
  CHECK(stack_of("rgb320x600x16") == StackSettings{.depth = 16, .width = 320, .height = 600, .rgb = true});
  CHECK(stack_of("grey9x10x2").width == 9);
  CHECK(stack_of("grey84") == StackSettings{.depth = 1, .width = 84, .height = 84, .rgb = false});
  CHECK(stack_of("grey84x3") == StackSettings{.depth = 3, .width = 84, .height = 84, .rgb = false});
  CHECK(refusal("grey0x9x1") == "the width of a stack is '0'; it takes a whole number from 1 to 320");
  CHECK(refusal("grey321x9x1") == "the width of a stack is '321'; it takes a whole number from 1 to 320");
  CHECK(refusal("rgb1x8x1") == "the height of a stack is '8'; it takes a whole number from 9 to 600");
  CHECK(refusal("rgb1x601x1") == "the height of a stack is '601'; it takes a whole number from 9 to 600");
  CHECK(refusal("rgb1x9x0") == "the depth of a stack is '0'; it takes a whole number from 1 to 16");
  CHECK(refusal("grey84x17") == "the depth of a stack is '17'; it takes a whole number from 1 to 16");
}

TEST_CASE("A stack that is not whole is refused with an example, and what begins like one by name") {
  for (const std::string word :
       {"grey84x", "grey83", "grey85x2", "rgb84", "rgb84x4", "grey1x9", "grey1x9x1x1"})
    CHECK(refusal(word) ==
          "'" + word + "' is not a stack of screens; accepted: greyWxHxN and rgbWxHxN, such as grey84x84x4");
  for (const std::string word : {"greyish", "rgba", "greyWxHxN", "rgbWxHxN", "grey:x84"})
    CHECK_THAT(refusal(word), Contains("unknown ") || Contains("accepted"));
}

TEST_CASE("A field that is given twice is named as it was given the second time") {
  CHECK(refusal("grey84x4 grey84x3") == "the field grey84x3 is given twice");
  CHECK(refusal("ram ram:zlib") == "the field ram is given twice");
}

TEST_CASE("A number has no encoding, and bytes have those of the table, without delta for audio_all") {
  CHECK(refusal("reward:hex") == "the field reward is a number, so it takes no encoding");
  CHECK(refusal("screen:delta audio_all:rle") == "accepted");
  CHECK(refusal("audio:delta") == "accepted");
  CHECK(refusal("audio_all:delta") ==
        "the size of audio_all changes from reply to reply, so delta is not accepted");
  CHECK_THAT(refusal("ram:"), Contains("encoding ''") && Contains("hex"));
  CHECK(fields_of("ram:zlib").at(0).encoding == Encoding::kZlib);
  CHECK(fields_of("ram").at(0).encoding == Encoding::kHex);
}

TEST_CASE("Sound is shown by either of its fields, beside whatever others") {
  for (const std::string all : {"audio_all", "reward audio_all", "audio_all ram"}) {
    CHECK(shows_audio(fields_of(all)));
    CHECK(shows_all_audio(fields_of(all)));
  }
  for (const std::string last : {"audio", "reward audio ram"}) {
    CHECK(shows_audio(fields_of(last)));
    CHECK_FALSE(shows_all_audio(fields_of(last)));
  }
  for (const std::string none : {"none", "reward ram screen"}) CHECK_FALSE(shows_audio(fields_of(none)));
}

TEST_CASE("A field of the screen needs one frame of an act, with averaging and in stacks two") {
  const auto drawing = [](const std::string& text, bool averaging) {
    return drawing_of(fields_of(text), averaging);
  };
  for (const std::string none : {"none", "ram reward", "palette audio"}) {
    CHECK(drawing(none, false) == Drawing::kNone);
    CHECK(drawing(none, true) == Drawing::kNone);
  }
  for (const std::string one : {"screen", "ram grey lives", "rgb ram"}) {
    CHECK(drawing(one, false) == Drawing::kLast);
    CHECK(drawing(one, true) == Drawing::kLastTwo);
  }
  for (const std::string two : {"grey84x84x4", "screen rgb20x20x1", "grey84x84x1 ram"}) {
    CHECK(drawing(two, false) == Drawing::kLastTwo);
    CHECK(drawing(two, true) == Drawing::kLastTwo);
  }
}

TEST_CASE("Fields of bytes show what the machine has, whichever stand before them") {
  Shown shown("rgb:hex palette:hex state_hash:hex tia:hex grey:hex ram:hex"), colours("palette:hex");
  const std::string text = shown.next();
  CHECK(value_of(text, "palette") == value_of(colours.next(), "palette"));
  const Environment& machine = shown.slot.environment();
  std::vector<std::uint8_t> bytes;
  machine.tia_values(bytes);
  CHECK_FALSE(bytes.empty());
  CHECK(value_of(text, "tia") == hex(bytes));
  machine.screen_rgb(bytes);
  CHECK(value_of(text, "rgb") == hex(bytes));
  machine.screen_grey(bytes);
  CHECK(value_of(text, "grey") == hex(bytes));
  CHECK(value_of(text, "ram") == hex(machine.ram()));
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4)
    digits += "0123456789ABCDEF"[machine.state_hash() >> shift & 15];
  CHECK(value_of(text, "state_hash") == digits);
}

TEST_CASE("A reply has the estimated length where the encoding fixes it, and else at most that") {
  constexpr std::size_t kNumber = 8;  // of bytes that follow the line
  for (const std::string& name : names_of_bytes())
    for (const EncodingRow& encoding : encodings()) {
      if (name == "audio_all" && encoding.encoding == Encoding::kDelta) continue;
      CAPTURE(name, encoding.name);
      Shown shown(name + ":" + std::string(encoding.name));
      const std::size_t estimate = text_size(shown.fields, shown.slot.environment());
      const std::size_t length = shown.next().size();
      CHECK(length <= estimate + (encoding.encoding == Encoding::kRaw ? kNumber : 0));
      const bool is_without_act = name == "audio_all";  // it has the samples of an act; the slot lacks one
      if (encoding.encoding == Encoding::kHex && !is_without_act) CHECK(length == estimate);
      CHECK(length <= View::longest_text(shown.fields) + name.size() + 2);
      CHECK(View::longest_text(shown.fields) < 8'000'000);
    }
}

TEST_CASE("The longest text has room for the tallest screen") {
  for (const std::string name : {"screen", "grey", "rgb"}) {
    Shown shown(name + ":hex", "256");
    CHECK(shown.slot.environment().height() == 256);
    CHECK(shown.next().size() <= View::longest_text(shown.fields) + name.size() + 2);
  }
}

TEST_CASE("A view holds at most the estimated bytes, which are less than some megabytes") {
  constexpr std::size_t kRest = 1024;  // beside the values
  for (const std::string& name : names_of_bytes())
    for (const EncodingRow& encoding : encodings()) {
      if (name == "audio_all" && encoding.encoding == Encoding::kDelta) continue;
      CAPTURE(name, encoding.name);
      Shown shown(name + ":" + std::string(encoding.name));
      shown.next();
      shown.next();
      const ScreenStack* const stack = shown.slot.stack();
      const std::size_t stacked = stack != nullptr ? stack->size() : 0;
      CHECK(shown.view.footprint() + stacked <= View::max_footprint(shown.fields) + kRest);
      CHECK(View::max_footprint(shown.fields) < 4'000'000);
    }
  CHECK(View::max_footprint(fields_of("reward lives")) == 0);
}

#include "protocol/line/field.hpp"

#include <algorithm>
#include <array>

#include "emulator/tia/palette.hpp"

namespace racebeam {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Scratch = std::vector<std::uint8_t>;

constexpr std::string_view kGreyStack = "greyWxHxN", kRgbStack = "rgbWxHxN";
constexpr int kDeepest = 16;

#define NUMBER(name, of_request, expression, summary)                                  \
  FieldRow {                                                                           \
    name, summary, of_request,                                                         \
        []([[maybe_unused]] const Environment& e, [[maybe_unused]] const Outcome& o) { \
          return std::int64_t{expression};                                             \
        },                                                                             \
        nullptr, Encoding::kHex                                                        \
  }

constexpr std::array kFields = {
    NUMBER("reward", true, o.reward,
           "sum over the acts of the request; each act's reward is clamped as loaded"),
    NUMBER("reward_b", true, o.reward_b, "the same for player B"),
    NUMBER("raw_reward", true, o.raw_reward, "the same before clamping"),
    NUMBER("raw_reward_b", true, o.raw_reward_b, "the same for player B"),
    NUMBER("terminated", true, o.terminated, "1: the game is over"),
    NUMBER("truncated", true, o.truncated, "1: the episode was cut short, by frames or by a lost life"),
    NUMBER("game_over", true, o.game_over, "1: the game itself is over; lost lives and limits do not count"),
    NUMBER("lives", false, e.lives(), "remaining lives; 0 in games without lives"),
    NUMBER("frame", false, e.frame_number(), "frames since the game was loaded"),
    NUMBER("episode_frame", false, e.episode_frame_number(), "frames since the episode began"),
    NUMBER("acts", true, o.acts, "acts that were played; fewer than requested if the episode ended"),
    NUMBER("frames", true, o.frames, "frames that the request ran"),
    FieldRow{"ram", "128 bytes", false, nullptr,
             [](const Environment& e, Scratch&) -> Bytes { return e.ram(); }, Encoding::kHex},
    FieldRow{"tia", "53 bytes: the registers of the TIA and its collision latches; names has their names",
             false, nullptr,
             [](const Environment& e, Scratch& scratch) -> Bytes {
               e.tia_values(scratch);
               return scratch;
             },
             Encoding::kHex},
    FieldRow{"screen", "height x 160 palette indices, row by row", false, nullptr,
             [](const Environment& e, Scratch&) { return e.screen(); }, Encoding::kRunLength, Drawing::kLast},
    FieldRow{"rgb", "height x 160 x 3: red, green, blue", false, nullptr,
             [](const Environment& e, Scratch& scratch) -> Bytes {
               e.screen_rgb(scratch);
               return scratch;
             },
             Encoding::kZlib, Drawing::kLast},
    FieldRow{"grey", "height x 160", false, nullptr,
             [](const Environment& e, Scratch& scratch) -> Bytes {
               e.screen_grey(scratch);
               return scratch;
             },
             Encoding::kZlib, Drawing::kLast},
    FieldRow{"grey84",
             "84 x 84 grey, the brighter of the last two frames; grey84x4: a stack of 4, oldest first", false,
             nullptr, nullptr, Encoding::kZlib, Drawing::kLastTwo},
    FieldRow{kGreyStack,
             "a stack of N screens, W x H, grey, each the brighter of two frames; grey84x4 is short for "
             "grey84x84x4",
             false, nullptr, nullptr, Encoding::kZlib, Drawing::kLastTwo},
    FieldRow{kRgbStack, "the same in colour: red, green and blue of each pixel", false, nullptr, nullptr,
             Encoding::kZlib, Drawing::kLastTwo},
    FieldRow{"palette", "256 x 3: red, green, blue of each value of screen", false, nullptr,
             [](const Environment& e, Scratch& scratch) -> Bytes {
               scratch.clear();
               for (const auto [r, g, b] : palette(e.format())) scratch.insert(scratch.end(), {r, g, b});
               return scratch;
             },
             Encoding::kHex},
    FieldRow{"audio", "512 samples of the last act; needs sound=1", false, nullptr,
             [](const Environment& e, Scratch&) -> Bytes { return e.audio(); }, Encoding::kHex},
};

#undef NUMBER

int size_within(std::string_view text, std::string_view what, int least, int most) {
  return static_cast<int>(number_within(text, what, least, most));
}

// Parses grey84, grey84xN, greyWxHxN and rgbWxHxN, and sets `name` to the name of their row. Returns nothing
// for other fields.
std::optional<StackSettings> parse_stack(std::string_view& name) {
  constexpr int kLeastHeight = 9, kMostHeight = 300;  // ScreenStack checks against the machine's screen
  const bool rgb = name.starts_with("rgb");
  if (!rgb && !name.starts_with("grey")) return std::nullopt;
  std::string_view width = name.substr(rgb ? 3 : 4);
  if (width.empty() || width[0] < '0' || width[0] > '9') return std::nullopt;
  std::string_view height = cut_behind(width, 'x');
  std::string_view depth = cut_behind(height, 'x');
  const auto stack_of = [rgb](std::string_view screens, int wide, int high) {
    return StackSettings{size_within(screens, "the depth of a stack", 1, kDeepest), wide, high, rgb};
  };
  if (!rgb && width == "84" && depth.empty() && !name.ends_with('x')) {
    const bool alone = name == "grey84";
    name = "grey84";
    return stack_of(alone ? "1" : height, kSmallSide, kSmallSide);
  }
  if (depth.empty() || depth.find('x') != std::string_view::npos)
    throw RequestError(ErrorCode::kBadArguments,
                       "a stack is written as in grey84x4, grey100x50x4 or rgb100x50x4");
  name = rgb ? kRgbStack : kGreyStack;
  return stack_of(depth, size_within(width, "the width of a stack", 1, kScreenWidth),
                  size_within(height, "the height of a stack", kLeastHeight, kMostHeight));
}

std::size_t bytes_of(const StackSettings& stack) {
  const int pictures = stack.depth * stack.channels();
  return static_cast<std::size_t>(stack.width) * static_cast<std::size_t>(stack.height) *
         static_cast<std::size_t>(pictures);
}

constexpr std::size_t kTallScreen = 250 * std::size_t{kScreenWidth}, kRgbScreen = 3 * kTallScreen;

// Of a field of bytes, on whatever machine.
std::size_t most_bytes(const Field& field) {
  constexpr std::size_t kNoScreen = 1024;
  if (field.stack) return bytes_of(*field.stack);
  if (field.row->looks_at == Drawing::kNone) return kNoScreen;
  return field.row->name == "rgb" ? kRgbScreen : kTallScreen;
}

Field parse_field(std::string_view word) {
  std::string_view name = word;
  const std::string_view encoding = cut_behind(name, ':');
  const bool encoded = name.size() < word.size();
  std::string written(name);
  const auto stack = parse_stack(name);
  const auto row = std::ranges::find(kFields, name, &FieldRow::name);
  if (row == kFields.end() || (!stack && (name == kGreyStack || name == kRgbStack))) {
    auto known = names_of(kFields);
    known.insert(known.end(), {"ends", "none"});
    refuse_name(ErrorCode::kBadArguments, "field", name, known);
  }
  if (!encoded) return {&*row, row->usual, stack, std::move(written)};
  if (row->number)
    throw RequestError(ErrorCode::kBadArguments, written + " is a number, and has no encoding");
  const auto chosen = encoding_of(encoding);
  if (!chosen) refuse_name(ErrorCode::kBadArguments, "encoding", encoding, names_of(encodings()));
  return {&*row, *chosen, stack, std::move(written)};
}

// Adds a field, which must not be among them yet.
void add(std::vector<Field>& fields, Field field) {
  for (const Field& other : fields) {
    if (other.row == field.row)
      throw RequestError(ErrorCode::kBadArguments, std::string(field.row->name) + " is asked for twice");
    if (other.stack && field.stack)
      throw RequestError(ErrorCode::kBadArguments,
                         other.name + " and " + field.name + " are two stacks; there can be one");
  }
  fields.push_back(std::move(field));
}

}  // namespace

std::span<const FieldRow> field_rows() { return kFields; }

std::string_view row_of_field(std::string_view name) {
  parse_stack(name);
  return name;
}

bool shows_audio(const std::vector<Field>& fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return field.row->name == "audio"; });
}

Drawing drawing_of(const std::vector<Field>& fields, bool averaging) {
  Drawing most = Drawing::kNone;
  for (const Field& field : fields) most = std::min(most, field.row->looks_at);
  return averaging && most == Drawing::kLast ? Drawing::kLastTwo : most;
}

std::vector<Field> parse_fields(Words words) {
  std::vector<Field> fields;
  for (const std::string_view word : words) {
    if (word == "none") {
      if (words.size() == 1) break;
      throw RequestError(ErrorCode::kBadArguments, "none stands alone; it chooses no field");
    }
    if (word == "ends") {
      add(fields, parse_field("terminated"));
      add(fields, parse_field("truncated"));
    } else {
      add(fields, parse_field(word));
    }
  }
  return fields;
}

std::size_t text_size(const std::vector<Field>& fields, const Environment& machine) {
  constexpr std::size_t kNumber = 8;
  std::size_t size = 0;
  Scratch scratch;
  for (const Field& field : fields) {
    const std::size_t bytes = field.stack        ? bytes_of(*field.stack)
                              : field.row->bytes ? field.row->bytes(machine, scratch).size()
                                                 : 0;
    size += field.name.size() + 2 + (field.row->number ? kNumber : text_size(field.encoding, bytes));
  }
  return size;
}

View::View(std::vector<Field> fields, BetweenPieces pause)
    : fields_(std::move(fields)), pause_(std::move(pause)) {
  for (const Field& field : fields_) encoders_.emplace_back(field.encoding);
}

std::size_t View::footprint(const std::vector<Field>& fields) {
  constexpr std::size_t kDeflater = std::size_t{300} << 10;
  std::size_t bytes = 0;
  for (const Field& field : fields) {
    if (field.row->number) continue;
    bytes += most_bytes(field);  // for scratch_
    if (field.stack)
      bytes += bytes_of(*field.stack) + kRgbScreen;  // itself, and the picture that it takes in
    if (field.encoding == Encoding::kZlib) bytes += kDeflater + most_bytes(field);
    if (field.encoding == Encoding::kDelta) bytes += most_bytes(field);
  }
  return bytes;
}

std::size_t View::longest_text(const std::vector<Field>& fields) {
  std::size_t size = 0;
  for (const Field& field : fields) {
    const std::size_t copies = field.encoding == Encoding::kRaw ? 2 : 1;  // beside the line, and behind it
    if (!field.row->number) size += copies * text_size(field.encoding, most_bytes(field));
  }
  return size;
}

void View::append(std::string& out, std::string& raw, const Shown& shown) {
  if (shown.outcome.over) append_pair(out, "over", 1);
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    ((out += ' ') += fields_[i].name) += '=';
    append_value(out, raw, i, shown);
  }
}

void View::append_final(std::string& out, std::string& raw, const Slot& slot) {
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (fields_[i].row->of_request) continue;
    ((out += " final_") += fields_[i].name) += '=';
    append_value(out, raw, i, shown(slot));
  }
}

void View::append_value(std::string& out, std::string& raw, std::size_t field, const Shown& shown) {
  const FieldRow& row = *fields_[field].row;
  if (row.number) return append_number(out, row.number(shown.machine, shown.outcome));
  if (!fields_[field].stack)
    return encoders_[field].append(out, row.bytes(shown.machine, scratch_), raw, pause_);
  scratch_.resize(shown.stack->size());
  shown.stack->copy_to(scratch_);
  encoders_[field].append(out, scratch_, raw, pause_);
}

}  // namespace racebeam

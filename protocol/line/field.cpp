#include "protocol/line/field.hpp"

#include <algorithm>
#include <array>

#include "emulator/tia/palette.hpp"
#include "environment/settings/play_settings.hpp"
#include "games/game/property_overrides.hpp"
#include "protocol/description/tables.hpp"
#include "protocol/request_error.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

using Bytes = std::span<const std::uint8_t>;
using ByteBuffer = std::vector<std::uint8_t>;

constexpr std::string_view kGreyStack = "greyWxHxN", kRgbStack = "rgbWxHxN", kAllAudio = "audio_all";
constexpr int kDeepest = 16;

using Number = std::int64_t (*)(const Environment&, const Outcome&);
using BytesOf = Bytes (*)(const Environment&, ByteBuffer&);

constexpr Encoding encoding_named(std::string_view name) { return row_named(kEncodingNames, name).value; }

constexpr FieldRow number(std::string_view name, Number of) {
  const description::Field& row = row_named(description::kFields, name);
  return {name, row.summary, row.of_request, of, nullptr, Encoding::kHex};
}

// `of` is null for stacks, which a slot makes.
constexpr FieldRow bytes(std::string_view name, BytesOf of, Drawing looks_at = Drawing::kNone) {
  const description::Field& row = row_named(description::kFields, name);
  return {name, row.summary, row.of_request, nullptr, of, encoding_named(row.encoding), looks_at};
}

// A short way to write the function of a number: of the machine `e`, or of the outcome `o` of the request's
// acts.
#define NUMBER(expression)                     \
  [](const Environment& e, const Outcome& o) { \
    (void)e, (void)o;                          \
    return std::int64_t{expression};           \
  }

constexpr std::array kFields = {
    number("reward", NUMBER(o.reward)),
    number("reward_b", NUMBER(o.reward_b)),
    number("raw_reward", NUMBER(o.raw_reward)),
    number("raw_reward_b", NUMBER(o.raw_reward_b)),
    number("terminated", NUMBER(o.terminated)),
    number("truncated", NUMBER(o.truncated)),
    number("game_over", NUMBER(o.game_over)),
    number("lives", NUMBER(e.lives())),
    number("frame", NUMBER(e.frame_number())),
    number("episode_frame", NUMBER(e.episode_frame_number())),
    number("acts", NUMBER(o.acts)),
    number("frames", NUMBER(o.frames)),
    bytes("ram", [](const Environment& e, ByteBuffer&) -> Bytes { return e.ram(); }),
    bytes("tia",
          [](const Environment& e, ByteBuffer& scratch) -> Bytes {
            e.tia_values(scratch);
            return scratch;
          }),
    bytes("state_hash",
          [](const Environment& e, ByteBuffer& scratch) -> Bytes {
            const std::uint64_t hash = e.state_hash();
            scratch.clear();  // the highest byte first, as the digits of results.csv
            for (int shift = 56; shift >= 0; shift -= 8)
              scratch.push_back(static_cast<std::uint8_t>(hash >> shift));
            return scratch;
          }),
    bytes(
        "screen", [](const Environment& e, ByteBuffer&) { return e.screen(); }, Drawing::kLast),
    bytes(
        "rgb",
        [](const Environment& e, ByteBuffer& scratch) -> Bytes {
          e.screen_rgb(scratch);
          return scratch;
        },
        Drawing::kLast),
    bytes(
        "grey",
        [](const Environment& e, ByteBuffer& scratch) -> Bytes {
          e.screen_grey(scratch);
          return scratch;
        },
        Drawing::kLast),
    bytes(kGreyStack, nullptr, Drawing::kLastTwo),
    bytes(kRgbStack, nullptr, Drawing::kLastTwo),
    bytes("palette",
          [](const Environment& e, ByteBuffer& scratch) -> Bytes {
            scratch.clear();
            for (const auto [r, g, b] : palette(e.format())) scratch.insert(scratch.end(), {r, g, b});
            return scratch;
          }),
    bytes("audio", [](const Environment& e, ByteBuffer&) -> Bytes { return e.audio(); }),
    bytes(kAllAudio, [](const Environment& e, ByteBuffer&) { return e.all_audio(); }),
};

#undef NUMBER

static_assert(same_names(kFields, description::kFields));

int size_within(std::string_view text, std::string_view what, int least, int most) {
  return static_cast<int>(number_within(text, what, least, most));
}

// Parses greyWxHxN and rgbWxHxN, and the old names grey84 and grey84xN. Sets `name` to the name of their row.
// Returns nothing for other fields.
std::optional<StackSettings> parse_stack(std::string_view& name) {
  constexpr int kMinHeight = 9, kMaxHeight = 600;  // ScreenStack checks against the machine's screen
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
    name = kGreyStack;
    return stack_of(alone ? "1" : height, kSmallSide, kSmallSide);
  }
  if (depth.empty() || depth.find('x') != std::string_view::npos)
    throw RequestError(
        ErrorCode::kBadArguments,
        quote(name) + " is not a stack of screens; accepted: greyWxHxN and rgbWxHxN, such as grey84x84x4");
  name = rgb ? kRgbStack : kGreyStack;
  return stack_of(depth, size_within(width, "the width of a stack", 1, 2 * kScreenWidth),
                  size_within(height, "the height of a stack", kMinHeight, kMaxHeight));
}

std::size_t bytes_of(const StackSettings& stack) {
  const int pictures = stack.depth * stack.channels();
  return static_cast<std::size_t>(stack.width) * static_cast<std::size_t>(stack.height) *
         static_cast<std::size_t>(pictures);
}

// The samples of an act.
std::size_t bytes_of_all_audio(const Environment& machine) {
  const Settings& settings = machine.settings();
  return kAudioSize * static_cast<std::size_t>(std::max(settings.frame_skip, settings.frame_skip_max));
}

constexpr std::size_t kTallScreen = std::size_t{kMaxHeight} * kScreenWidth, kRgbScreen = 3 * kTallScreen;

// The most bytes of a field of bytes, on any machine.
std::size_t most_bytes(const Field& field) {
  constexpr std::size_t kNoScreen = 1024;
  if (field.stack) return bytes_of(*field.stack);
  if (field.row->name == kAllAudio) return std::size_t{kMaxFrameSkip} * kAudioSize;
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
    auto names = names_of(kFields);
    names.emplace_back("none");
    refuse_name("field", name, names);
  }
  if (!encoded) return {&*row, row->usual, stack, std::move(written)};
  if (row->number)
    throw RequestError(ErrorCode::kBadArguments,
                       "the field " + written + " is a number, so it takes no encoding");
  const auto chosen = encoding_of(encoding);
  if (!chosen) refuse_name("encoding", encoding, names_of(encodings()));
  if (chosen == Encoding::kDelta && name == kAllAudio)
    throw RequestError(ErrorCode::kBadArguments,
                       "the size of audio_all changes from reply to reply, so delta is not accepted");
  return {&*row, *chosen, stack, std::move(written)};
}

// Adds a field, which must not be among them yet.
void add(std::vector<Field>& fields, Field field) {
  for (const Field& other : fields) {
    if (other.row == field.row)
      throw RequestError(ErrorCode::kBadArguments, "the field " + field.name + " is given twice");
    if (other.stack && field.stack)
      throw RequestError(
          ErrorCode::kBadArguments,
          other.name + " and " + field.name + " are two stacks of screens; a session can select one");
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
  return std::ranges::any_of(fields, [](const Field& field) { return field.row->name == "audio"; }) ||
         shows_all_audio(fields);
}

bool shows_all_audio(const std::vector<Field>& fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return field.row->name == kAllAudio; });
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
      throw RequestError(ErrorCode::kBadArguments, "none cannot be combined with other fields");
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
  ByteBuffer scratch;
  for (const Field& field : fields) {
    const std::size_t bytes = field.stack                    ? bytes_of(*field.stack)
                              : field.row->name == kAllAudio ? bytes_of_all_audio(machine)
                              : field.row->bytes             ? field.row->bytes(machine, scratch).size()
                                                             : 0;
    size += field.name.size() + 2 + (field.row->number ? kNumber : text_size(field.encoding, bytes));
  }
  return size;
}

View::View(std::vector<Field> fields, BetweenPieces pause)
    : fields_(std::move(fields)), pause_(std::move(pause)) {
  for (const Field& field : fields_) encoders_.emplace_back(field.encoding);
}

std::size_t View::max_footprint(const std::vector<Field>& fields) {
  constexpr std::size_t kDeflater = std::size_t{300} << 10;
  std::size_t bytes = 0;
  for (const Field& field : fields) {
    if (field.row->number) continue;
    bytes += most_bytes(field);  // for scratch_, or in the machine
    // The stack, and the picture that it takes in.
    if (field.stack) bytes += bytes_of(*field.stack) + kRgbScreen;
    if (field.encoding == Encoding::kZlib) bytes += kDeflater + most_bytes(field);
    if (field.encoding == Encoding::kDelta) bytes += most_bytes(field);
  }
  return bytes;
}

std::size_t View::footprint() const {
  std::size_t bytes = scratch_.capacity() + fields_.capacity() * sizeof(Field);
  for (const Encoder& encoder : encoders_) bytes += sizeof encoder + encoder.footprint();
  return bytes;
}

void View::release_caches() {
  for (Encoder& encoder : encoders_) encoder.release_caches();
  std::vector<std::uint8_t>().swap(scratch_);
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

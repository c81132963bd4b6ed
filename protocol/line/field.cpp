#include "protocol/line/field.hpp"

#include <algorithm>
#include <array>

#include "emulator/tia/palette.hpp"

namespace racebeam {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Scratch = std::vector<std::uint8_t>;

constexpr std::string_view kStack = "grey84";
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
    NUMBER("reward", true, o.reward, "sum over the acts of the request; each act's is limited as loaded"),
    NUMBER("reward_b", true, o.reward_b, "the same for player B"),
    NUMBER("terminated", true, o.terminated, "1: the game is over"),
    NUMBER("truncated", true, o.truncated, "1: the episode was cut short, by frames or by a lost life"),
    NUMBER("lives", false, e.lives(), "lives that are left; 0 in games without"),
    NUMBER("frame", false, e.frame_number(), "frames since the game was loaded"),
    NUMBER("episode_frame", false, e.episode_frame_number(), "frames since the episode began"),
    NUMBER("acts", true, o.acts, "acts that were carried out; fewer than asked for when the episode ended"),
    NUMBER("frames", true, o.frames, "frames that the request ran"),
    FieldRow{"ram", "128 bytes", false, nullptr,
             [](const Environment& e, Scratch&) -> Bytes { return e.ram(); }, Encoding::kHex},
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
    FieldRow{kStack,
             "84 x 84 grey, the brighter of the last two frames; grey84x4: a stack of 4, oldest first", false,
             nullptr, nullptr, Encoding::kZlib, Drawing::kLastTwo},
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

int parse_depth(std::string_view& name) {
  if (!name.starts_with(kStack)) return 0;
  if (name == kStack) return 1;
  const std::string_view depth = name.substr(kStack.size());
  name = kStack;
  if (!depth.starts_with('x')) throw Refusal(Code::kBadArguments, "a stack is written as in grey84x4");
  return static_cast<int>(number_within(depth.substr(1), "the depth of a stack", 1, kDeepest));
}

Field parse_field(std::string_view word) {
  std::string_view name = word;
  const std::string_view encoding = cut_behind(name, ':');
  const bool encoded = name.size() < word.size();
  std::string written(name);
  const int depth = parse_depth(name);
  const auto row = std::ranges::find(kFields, name, &FieldRow::name);
  if (row == kFields.end()) {
    auto known = names_of(kFields);
    known.insert(known.end(), {"ends", "none"});
    refuse_name(Code::kBadArguments, "field", name, known);
  }
  if (!encoded) return {&*row, row->usual, depth, std::move(written)};
  if (row->number) throw Refusal(Code::kBadArguments, written + " is a number, and has no encoding");
  const auto chosen = encoding_of(encoding);
  if (!chosen) refuse_name(Code::kBadArguments, "encoding", encoding, names_of(encodings()));
  return {&*row, *chosen, depth, std::move(written)};
}

void check(const std::vector<Field>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (fields[i].row == fields[j].row)
        throw Refusal(Code::kBadArguments, std::string(fields[i].row->name) + " is asked for twice");
    }
  }
}

}  // namespace

std::span<const FieldRow> field_rows() { return kFields; }

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
      throw Refusal(Code::kBadArguments, "none stands alone; it chooses no field");
    }
    if (word == "ends") {
      fields.push_back(parse_field("terminated"));
      fields.push_back(parse_field("truncated"));
    } else {
      fields.push_back(parse_field(word));
    }
  }
  check(fields);
  return fields;
}

std::size_t text_size(const std::vector<Field>& fields, const Environment& machine) {
  constexpr std::size_t kNumber = 8;
  std::size_t size = 0;
  Scratch scratch;
  for (const Field& field : fields) {
    const auto screens = static_cast<std::size_t>(field.depth) * kSmallSize;
    const std::size_t bytes = field.row->bytes ? field.row->bytes(machine, scratch).size() : screens;
    size += field.name.size() + 2 + (field.row->number ? kNumber : text_size(field.encoding, bytes));
  }
  return size;
}

View::View(std::vector<Field> fields, int height) : fields_(std::move(fields)) {
  for (const Field& field : fields_) {
    encoders_.emplace_back(field.encoding);
    if (field.depth > 0) stack_.emplace(field.depth, height);
  }
}

std::size_t View::footprint(const std::vector<Field>& fields) {
  constexpr std::size_t kDeflater = std::size_t{300} << 10, kTallScreen = 250 * std::size_t{kScreenWidth};
  std::size_t bytes = 0;
  for (const Field& field : fields) {
    if (field.row->number) continue;
    const std::size_t stack = static_cast<std::size_t>(field.depth) * kSmallSize;
    bytes += 3 * kTallScreen + stack;  // the scratch copy, at most
    if (field.encoding == Encoding::kZlib) bytes += kDeflater;
    if (field.encoding == Encoding::kDelta) bytes += 3 * kTallScreen + stack;
  }
  return bytes;
}

void View::acted(const Environment& machine, int frames) {
  if (stack_ && frames > 0) stack_->push(machine, frames > 1);
}

void View::began(const Environment& machine, bool blends) {
  if (!stack_) return;
  stack_->clear();
  stack_->push(machine, blends);
}

void View::append(std::string& out, const Environment& machine, const Outcome& outcome) {
  if (outcome.over) append_pair(out, "over", 1);
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    ((out += ' ') += fields_[i].name) += '=';
    append_value(out, i, machine, outcome);
  }
}

void View::append_final(std::string& out, const Environment& machine) {
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (fields_[i].row->of_request) continue;
    ((out += " final_") += fields_[i].name) += '=';
    append_value(out, i, machine, {});
  }
}

void View::append_value(std::string& out, std::size_t field, const Environment& machine,
                        const Outcome& outcome) {
  const FieldRow& row = *fields_[field].row;
  if (row.number) return append_number(out, row.number(machine, outcome));
  const bool stacked = fields_[field].depth > 0;
  encoders_[field].append(out, stacked ? stack_->bytes() : row.bytes(machine, scratch_));
}

}  // namespace racebeam

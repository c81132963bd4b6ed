// What a reply can carry: one table of fields, and the choice that a client has made.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment/observe/preprocess.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/words.hpp"

namespace racebeam {

// Of the acts of one request.
struct Outcome {
  std::int64_t reward = 0, reward_b = 0;
  int acts = 0;
  int frames = 0;
  bool terminated = false, truncated = false;
  bool over = false;  // nothing was done: the episode had ended before
};

struct FieldRow {
  std::string_view name;
  std::string_view summary;
  bool of_request;  // what an act led to, not what the machine shows
  std::int64_t (*number)(const Environment&, const Outcome&);  // null for those that are bytes
  std::span<const std::uint8_t> (*bytes)(const Environment&, std::vector<std::uint8_t>& scratch);
  Encoding usual;  // encoding of bytes
  Drawing looks_at = Drawing::kNone;
};
std::span<const FieldRow> field_rows();

struct Field {
  const FieldRow* row;
  Encoding encoding;
  int depth;         // of a stack of small screens; 0: no stack
  std::string name;  // with the depth
};

// Words such as lives, screen:rle, grey84x4; `ends` is two of them, `none` is none. Throws Refusal.
std::vector<Field> parse_fields(Words words);

// Which of an act's screens they look at, on a machine with colour averaging or without.
Drawing drawing_of(const std::vector<Field>& fields, bool averaging);

// How long they are in a reply about such a machine, about: text_size() of each that is bytes.
std::size_t text_size(const std::vector<Field>& fields, const Environment& machine);

// Writes the chosen fields of one machine, reply after reply.
class View {
 public:
  View(std::vector<Field> fields, int height);

  const std::vector<Field>& fields() const { return fields_; }

  static std::size_t footprint(const std::vector<Field>& fields);  // bytes of memory, about

  // Called when the machine has run, so that stacks are right.
  void acted(const Environment& machine, int frames);
  // A stack begins anew, with what is there: a new episode, other fields, or a state of unknown past.
  // `blends`: made of two frames.
  void began(const Environment& machine, bool blends);

  // " name=value" for each field, behind " over=1" where nothing was done.
  void append(std::string& out, const Environment& machine, const Outcome& outcome);

  // " final_name=value" for each that the machine shows: how an episode ended.
  void append_final(std::string& out, const Environment& machine);

  SmallScreens* stack() { return stack_ ? &*stack_ : nullptr; }

 private:
  void append_value(std::string& out, std::size_t field, const Environment& machine, const Outcome& outcome);

  std::vector<Field> fields_;
  std::vector<Encoder> encoders_;  // one a field
  std::optional<SmallScreens> stack_;
  std::vector<std::uint8_t> scratch_;
};

}  // namespace racebeam

// What a reply can carry: one table of fields, and the choice that a client has made.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment/vector/slot.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/words.hpp"

namespace racebeam {

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
  std::optional<StackSettings> stack;  // of screens; none: it is no stack
  std::string name;                    // with the stack's size
};

// Words such as lives, screen:rle, grey84x4, rgb100x50x2; `ends` is two of them, `none` is none. Throws
// Refusal.
std::vector<Field> parse_fields(Words words);

// Which of an act's screens they look at, on a machine with colour averaging or without.
Drawing drawing_of(const std::vector<Field>& fields, bool averaging);

// How long they are in a reply about such a machine, about: text_size() of each that is bytes.
std::size_t text_size(const std::vector<Field>& fields, const Environment& machine);

// Writes the chosen fields of one machine, reply after reply.
class View {
 public:
  explicit View(std::vector<Field> fields);

  static std::size_t footprint(const std::vector<Field>& fields);  // bytes of memory, about

  // What a machine shows, what acts led to, and the stack of screens; null: no field is one.
  struct Shown {
    const Environment& machine;
    const Outcome& outcome;
    const ScreenStack* stack;
  };

  // " name=value" for each field, behind " over=1" where nothing was done.
  void append(std::string& out, const Shown& shown);
  void append(std::string& out, const Slot& slot) { append(out, shown(slot)); }

  // " final_name=value" for each that the machine shows: how an episode ended.
  void append_final(std::string& out, const Slot& slot);

 private:
  static Shown shown(const Slot& slot) { return {slot.environment(), slot.outcome(), slot.stack()}; }
  void append_value(std::string& out, std::size_t field, const Shown& shown);

  std::vector<Field> fields_;
  std::vector<Encoder> encoders_;  // one a field
  std::vector<std::uint8_t> scratch_;
};

}  // namespace racebeam

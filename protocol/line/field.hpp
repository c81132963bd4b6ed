// The fields of replies: the table of all fields, those that a client has selected, and how they are written.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment/vector/slot.hpp"
#include "protocol/encoding/encoding.hpp"
#include "system/words.hpp"

namespace racebeam {

struct FieldRow {
  std::string_view name;
  std::string_view summary;
  bool of_request;  // a result of the request's acts; else a part of what the machine shows
  // The function of a number, or that of bytes. The other one is null.
  std::int64_t (*number)(const Environment&, const Outcome&);
  std::span<const std::uint8_t> (*bytes)(const Environment&, std::vector<std::uint8_t>& scratch);
  Encoding usual;  // default encoding of a field of bytes
  Drawing looks_at = Drawing::kNone;
};
std::span<const FieldRow> field_rows();

// The name of a field's row: that of a stack of screens has letters for its size.
std::string_view row_of_field(std::string_view name);

struct Field {
  const FieldRow* row;
  Encoding encoding;
  std::optional<StackSettings> stack;  // set if the field is a stack of screens
  std::string name;                    // as in replies; contains the size of a stack
};

// Parses words such as lives, screen:rle, grey84x84x4 and rgb100x50x2. `none` stands for no field, the old
// word `ends` for two. Throws RequestError.
std::vector<Field> parse_fields(Words words);

// Which screens of an act the fields need, on a machine with colour averaging or without.
Drawing drawing_of(const std::vector<Field>& fields, bool averaging);

bool shows_audio(const std::vector<Field>& fields);      // or all of it
bool shows_all_audio(const std::vector<Field>& fields);  // each frame's

// The greatest length of the fields in a reply about an act of `machine`. Numbers count with a typical
// length.
std::size_t text_size(const std::vector<Field>& fields, const Environment& machine);

// Writes the selected fields of one machine into its replies. It has state: the delta encoding needs the last
// reply.
class View {
 public:
  // `pause` is called in the middle of long values.
  explicit View(std::vector<Field> fields, BetweenPieces pause = {});

  static std::size_t max_footprint(
      const std::vector<Field>& fields);  // bytes of memory that it may come to hold
  std::size_t footprint() const;          // bytes that it holds
  void release_caches();                  // releases memory that the next reply can allocate again
  // Bytes of memory for the fields in the longest reply about any machine.
  static std::size_t longest_text(const std::vector<Field>& fields);

  // The sources of values. `stack` is null if no field is a stack.
  struct Shown {
    const Environment& machine;
    const Outcome& outcome;
    const ScreenStack* stack;
  };

  // Appends " name=value" for each field, after " over=1" if the episode was over and nothing was run. `raw`
  // gets the bytes of fields that are encoded as raw.
  void append(std::string& out, std::string& raw, const Shown& shown);
  void append(std::string& out, std::string& raw, const Slot& slot) { append(out, raw, shown(slot)); }

  // Appends " final_name=value" for each field that the machine shows, at the end of an episode.
  void append_final(std::string& out, std::string& raw, const Slot& slot);

 private:
  static Shown shown(const Slot& slot) { return {slot.environment(), slot.outcome(), slot.stack()}; }
  void append_value(std::string& out, std::string& raw, std::size_t field, const Shown& shown);

  std::vector<Field> fields_;
  BetweenPieces pause_;
  std::vector<Encoder> encoders_;  // one for each field
  std::vector<std::uint8_t> scratch_;
};

}  // namespace racebeam

#include "protocol/line/watching.hpp"
#include "protocol/request_error.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct WatchedField {
  std::string_view name;
  Bytes (*bytes)(const Snapshot&, std::vector<std::uint8_t>& scratch);
};

constexpr std::array kFields = {
    WatchedField{"screen", [](const Snapshot& s, std::vector<std::uint8_t>&) -> Bytes { return s.screen; }},
    WatchedField{"ram", [](const Snapshot& s, std::vector<std::uint8_t>&) -> Bytes { return s.ram; }},
    WatchedField{"palette",
                 [](const Snapshot& s, std::vector<std::uint8_t>& scratch) -> Bytes {
                   for (const auto [r, g, b] : palette(s.format)) scratch.insert(scratch.end(), {r, g, b});
                   return scratch;
                 }},
};

bool is_same(const Field& a, const Field& b) { return a.row == b.row && a.encoding == b.encoding; }

}  // namespace

std::vector<Field> parse_watched_fields(Words words) {
  std::vector<Field> fields = parse_fields(words);
  for (const Field& field : fields) {
    if (std::ranges::find(kFields, field.name, &WatchedField::name) == kFields.end())
      throw RequestError(ErrorCode::kBadArguments,
                         "watch does not show " + field.name + "; it shows screen, ram and palette");
  }
  return fields;
}

void Watched::choose(const std::vector<Field>& fields, int height) {
  if (height == height_ && std::ranges::equal(fields, fields_, is_same)) return;
  fields_ = fields;
  height_ = height;
  encoders_.clear();
  for (const Field& field : fields) encoders_.emplace_back(field.encoding);
  footprint_ = View::max_footprint(fields);
}

void Watched::append(std::string& out, std::string& raw, const std::vector<Field>& fields,
                     const Snapshot& snapshot) {
  choose(fields, snapshot.height());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto row = std::ranges::find(kFields, fields[i].name, &WatchedField::name);
    std::vector<std::uint8_t> scratch;
    append_pair(out, fields[i].name, "");
    encoders_[i].append(out, row->bytes(snapshot, scratch), raw);
  }
}

}  // namespace racebeam

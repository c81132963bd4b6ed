#include "protocol/request_error.hpp"

#include <algorithm>
#include <array>

#include "protocol/description/tables.hpp"

namespace racebeam {
namespace {

constexpr auto kCodes = [] {
  std::array<ErrorRow, description::kErrors.size()> rows;
  std::ranges::transform(description::kErrors, rows.begin(), [](const description::Error& row) {
    return ErrorRow{row.name, row.meaning};
  });
  return rows;
}();

}  // namespace

std::span<const ErrorRow> codes() { return kCodes; }

std::string_view name_of(ErrorCode code) { return kCodes[static_cast<std::size_t>(code)].name; }

}  // namespace racebeam

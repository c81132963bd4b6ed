#include "emulator/cartridge/mappers/unsupported.hpp"

#include <algorithm>

namespace racebeam {
namespace {

constexpr std::string_view kNames[] = {
    "2IN1", "4IN1", "8IN1", "16IN1", "32IN1", "64IN1", "128IN1", "4A50",  "BUS", "CDF",  "CM",
    "CTY",  "DEVC", "EFF",  "ELF",   "GL",    "MVC",    "TVBOY", "WDSW", "WF8",
};

}  // namespace

std::span<const std::string_view> unsupported_schemes() { return kNames; }

bool is_unsupported(std::string_view name) { return std::ranges::find(kNames, name) != std::end(kNames); }

}  // namespace racebeam

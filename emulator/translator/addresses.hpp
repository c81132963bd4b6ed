// Which device an address selects (emulator/README.md, "The address map").
#pragma once

#include <cstdint>

namespace racebeam::translator {

constexpr bool is_ram(std::uint16_t address) { return (address & 0x1280) == 0x0080; }
constexpr bool is_cartridge(std::uint16_t address) { return (address & 0x1000) != 0; }
constexpr bool is_tia(std::uint16_t address) { return (address & 0x1080) == 0; }
constexpr bool is_pin(std::uint16_t address) { return (address & 0x1088) == 0x0008; }  // a read of INPT0-5

}  // namespace racebeam::translator

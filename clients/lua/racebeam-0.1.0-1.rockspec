rockspec_format = "3.0"
package = "racebeam"
version = "0.1.0-1"
source = {
  url = "git+https://example.org/racebeam.git",
  dir = "racebeam/clients/lua",
}
description = {
  summary = "A client of racebeam, the Atari 2600 for agents",
  license = "MIT",
}
dependencies = {
  "lua >= 5.1, < 5.5",
}
test_dependencies = {
  "busted",
  "luasocket", -- the client needs it only for TCP and Unix sockets, and luasec for TLS
}
test = {
  type = "busted",
}
build = {
  type = "builtin",
  modules = {
    racebeam = "racebeam/init.lua",
    ["racebeam.commands"] = "racebeam/commands.lua",
    ["racebeam.decode"] = "racebeam/decode.lua",
    ["racebeam.fault"] = "racebeam/fault.lua",
    ["racebeam.field_table"] = "racebeam/field_table.lua",
    ["racebeam.fields"] = "racebeam/fields.lua",
    ["racebeam.inflate"] = "racebeam/inflate.lua",
    ["racebeam.transport"] = "racebeam/transport.lua",
  },
}

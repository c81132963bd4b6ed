-- Decodes the fields of replies. It follows what requests that were granted change about later replies.

local decode = require("racebeam.decode")

local known = require("racebeam.field_table")

local WIDTH = 160

-- The size in bytes of fields such as grey84x84x4 and rgb40x30x2; nil for others.
local function small_size(field)
  local kind, width, height, depth = field:match("^(%a+)(%d+)x(%d+)x(%d+)$")
  if not kind then
    local screens = field:match("^grey84x(%d+)$") or field == "grey84" and 1
    kind, width, height, depth = screens and "grey", 84, 84, screens
  end
  if kind == "grey" or kind == "rgb" then
    return tonumber(width) * tonumber(height) * tonumber(depth) * (kind == "rgb" and 3 or 1)
  end
end

-- Returns the encodings of the fields among the words from `first` on.
local function encodings(words, first)
  local found = {}
  for at = first, #words do
    local name, encoding = words[at]:match("^([^:]*):?(.*)$")
    if encoding == "" then
      encoding = known.usual[name] or small_size(name) and "zlib"
    end
    found[name] = not words[at]:find("=", 1, true) and encoding or nil
  end
  return found
end

-- The boolean or the number that a text is, or the text. An MD5 is not a number, nor are bytes such as 0046.
local function value(field, text)
  if known.flags[field] and (text == "0" or text == "1") then
    return text == "1"
  elseif #text <= 15 and (text:find("^%-?[1-9]%d*$") or text:find("^%-?[1-9]%d*%.%d+$") or text:find("^%-?0%.%d+$") or text == "0") then
    return tonumber(text)
  end
  return text
end

local Fields = {}
Fields.__index = Fields

-- The bytes of a field of screens of this height.
local function size_of(field, height)
  return small_size(field) or known.sizes[field] or height * WIDTH * known.pixels[field]
end

local has_ffi, ffi = pcall(require, "ffi")

local function zeros(size)
  if has_ffi then
    return ffi.new("uint8_t[?]", size)
  end
  local array = {}
  for index = 0, size - 1 do
    array[index] = 0
  end
  return array
end

-- Applies the delta line[from..to] to the field's bytes in `source`, and returns them: an array if `live`, else a string.
function Fields:apply_delta(source, field, line, from, to)
  local kept = source.kept
  local size = size_of(field, source.height)
  if self.live then
    kept[field] = kept[field] or zeros(size)
    decode.apply_delta(kept[field], size, line, from, to)
  else
    kept[field] = decode.delta(line:sub(from, to), kept[field] or ("\0"):rep(size))
  end
  return kept[field]
end

-- Remembers what a request that was granted changes: the encodings of fields, and the height of screens.
function Fields:follow(words, line)
  local command = words[1]
  if command == "observe" and words[2] then
    self.encodings, self.machines = encodings(words, 2), {}
  elseif command == "load" then
    self.height, self.machines = tonumber(line:match(" height=(%d+)")), {}
  elseif command == "open" then
    self.machines = { [0] = self.machines[0] }
  end
end

-- What deltas have made of the fields of a machine, and the height of its screen.
function Fields:machine(number)
  self.machines[number] = self.machines[number] or { kept = {}, height = self.height }
  return self.machines[number]
end

-- Follows a watched session, as follow() follows this one. Other fields and another height begin it anew.
function Fields:watch(words, line)
  local fields, height = {}, tonumber(line:match(" height=(%d+)")) or self.height
  for at = 3, #words do
    fields[#fields + 1] = not words[at]:find("=", 1, true) and words[at] or nil
  end
  fields = table.concat(fields, " ")
  local before = self.watched[words[2]]
  if not before or before.fields ~= fields or before.height ~= height then
    self.watched[words[2]] = { kept = {}, fields = fields, height = height }
  end
  return self.watched[words[2]]
end

-- The encodings of the fields that a request names, or else of those that `observe` chose.
function Fields:encodings_of(words)
  if words[1] == "watch" then
    return encodings(words, 3)
  end
  return words[1] == "look" and words[2] and encodings(words, 2) or self.encodings
end

-- Takes the next `count` bytes of those that followed the line.
function Fields:take_raw(count)
  local begin = self.taken
  if not count or begin + count > #self.raw then
    error("fewer bytes follow the line than it says", 0)
  end
  self.taken = begin + count
  return self.raw:sub(begin + 1, self.taken)
end

-- The machine of the first group: 0 is that of load, 1 the first of open, which `machine=0` restores.
local function first_machine(words)
  for at = 3, words[1] == "restore" and #words or 0 do
    local restored = words[at]:match("^machine=(%d+)$")
    if restored then
      return tonumber(restored) + 1
    end
  end
  return 0
end

-- The groups of a reply, the first of them at 1. `words`: those of the request; `raw`: the bytes that followed the line.
function Fields:groups(words, line, raw)
  self:follow(words, line)
  self.raw, self.taken = raw, 0
  local chosen = self:encodings_of(words)
  local watched = words[1] == "watch" and self:watch(words, line)
  local first = first_machine(words)
  local source = watched or self:machine(first)
  local groups, at = { {} }, 3
  while true do
    local from, to = line:find("[^ ]+", at)
    if not from then
      break
    end
    local equals = line:find("=", from, true)
    if equals and equals <= to then
      local key = line:sub(from, equals - 1)
      local field = key:gsub("^final_", "")
      local encoding = chosen[field]
      if encoding == "delta" then
        groups[#groups][key] = self:apply_delta(source, field, line, equals + 1, to)
      elseif encoding == "raw" then
        groups[#groups][key] = self:take_raw(tonumber(line:sub(equals + 1, to)))
      elseif key ~= "raw" then
        local text = line:sub(equals + 1, to)
        if encoding then
          groups[#groups][key] = decode[encoding](text)
        else
          groups[#groups][key] = value(field, text)
        end
      end
    elseif to == from and line:sub(from, to) == "|" then
      source = watched or self:machine(first + #groups)
      groups[#groups + 1] = {}
    end
    at = to + 2
  end
  if self.taken < #raw then
    error("bytes follow the line that belong to no field", 0)
  end
  self.raw = nil
  return groups
end

return function(live)
  return setmetatable({ encodings = {}, machines = {}, watched = {}, height = 0, live = live }, Fields)
end

-- Decodes the fields of replies. It follows what requests that were granted change about later replies.

local decode = require("racebeam.decode")

local USUAL = { ram = "hex", tia = "hex", screen = "rle", rgb = "zlib", grey = "zlib", palette = "hex", audio = "hex" }
local SIZES = { ram = 128, tia = 53, palette = 768, audio = 512 }
local WIDTH = 160

-- Width, height, depth and bytes a pixel of fields such as grey84x4 and rgb40x30x2; nil for others.
local function small(field)
  local kind, width, height, depth = field:match("^(%a+)(%d+)x(%d+)x(%d+)$")
  if not kind then
    local screens = field:match("^grey84x(%d+)$") or field == "grey84" and 1
    kind, width, height, depth = screens and "grey", 84, 84, screens
  end
  if kind == "grey" or kind == "rgb" then
    return tonumber(width) * tonumber(height) * tonumber(depth) * (kind == "rgb" and 3 or 1)
  end
end

local function encodings(words)
  local found = {}
  for at = 2, #words do
    local name, encoding = words[at]:match("^([^:]*):?(.*)$")
    if encoding == "" then
      encoding = USUAL[name] or small(name) and "zlib"
    end
    found[name] = encoding or nil
  end
  return found
end

-- The number that a text is, or the text. An MD5 is none, nor are bytes such as 0046.
local function value(text)
  if #text <= 15 and (text:find("^%-?[1-9]%d*$") or text:find("^%-?[1-9]%d*%.%d+$") or text:find("^%-?0%.%d+$") or text == "0") then
    return tonumber(text)
  end
  return text
end

local Fields = {}
Fields.__index = Fields

function Fields:size(field)
  return small(field) or SIZES[field] or self.height * WIDTH * (field == "rgb" and 3 or 1)
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

-- Bytes line[from..to] of a delta field: what they change is `live`, an array, or a string.
function Fields:changed(machine, field, line, from, to)
  local kept = self.kept[machine] or {}
  self.kept[machine] = kept
  local size = self:size(field)
  if self.live then
    kept[field] = kept[field] or zeros(size)
    decode.apply_delta(kept[field], size, line, from, to)
  else
    kept[field] = decode.delta(line:sub(from, to), kept[field] or ("\0"):rep(size))
  end
  return kept[field]
end

-- Remembers what a request that was granted changes.
function Fields:follow(words, line)
  local command = words[1]
  if command == "observe" and words[2] then
    self.encodings, self.kept = encodings(words), {}
  elseif command == "load" then
    self.height, self.kept = tonumber(line:match(" height=(%d+)")), {}
  elseif command == "open" then
    self.kept = { [0] = self.kept[0] }
  end
end

-- The next `count` bytes of those that followed the line.
function Fields:followed(count)
  local begin = self.taken
  if not count or begin + count > #self.raw then
    error("fewer bytes follow the line than it says", 0)
  end
  self.taken = begin + count
  return self.raw:sub(begin + 1, self.taken)
end

-- The groups of a reply, the first of them at 1. `words`: those of the request; `raw`: the bytes that followed the line.
function Fields:groups(words, line, raw)
  self:follow(words, line)
  self.raw, self.taken = raw, 0
  local chosen = words[1] == "look" and words[2] and encodings(words) or self.encodings
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
        groups[#groups][key] = self:changed(#groups - 1, field, line, equals + 1, to)
      elseif encoding == "raw" then
        groups[#groups][key] = self:followed(tonumber(line:sub(equals + 1, to)))
      elseif key ~= "raw" then
        local text = line:sub(equals + 1, to)
        groups[#groups][key] = encoding and decode[encoding](text) or not encoding and value(text)
      end
    elseif to == from and line:sub(from, to) == "|" then
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
  return setmetatable({ encodings = {}, kept = {}, height = 0, live = live }, Fields)
end

-- The encodings of fields that are bytes. Each function takes a text, and gives a string of bytes; it raises a string if the
-- text has another form.

local inflate = require("racebeam.inflate")

local decode = {}

local BYTES, DIGITS = {}, {} -- two digits to a character; a digit's code to its value
for value = 0, 255 do
  BYTES[("%02X"):format(value)] = string.char(value)
  BYTES[("%02x"):format(value)] = string.char(value)
end
for value = 0, 15 do
  DIGITS[("%X"):format(value):byte()] = value
  DIGITS[("%x"):format(value):byte()] = value
end

function decode.hex(text)
  local bytes, count = text:gsub("..", BYTES)
  if count * 2 ~= #text or #bytes ~= count then
    error("not hexadecimal digits", 0)
  end
  return bytes
end

function decode.rle(text)
  local runs, pieces = decode.hex(text), {}
  if #runs % 2 ~= 0 then
    error("half a run", 0)
  end
  for at = 1, #runs, 2 do
    pieces[#pieces + 1] = runs:sub(at, at):rep(runs:byte(at + 1))
  end
  return table.concat(pieces)
end

local ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
local SEXTETS = {}
for value, character in ALPHABET:gmatch("()(.)") do
  SEXTETS[character:byte()] = value - 1
end

function decode.base64(text)
  local digits = text:gsub("=+$", "")
  if #text % 4 ~= 0 or #text - #digits > 2 then
    error("base64 is cut off", 0)
  end
  local pieces = {}
  for at = 1, #digits, 4 do
    local a, b, c, d = digits:byte(at, at + 3)
    a, b, c, d = SEXTETS[a], SEXTETS[b], c and SEXTETS[c] or not c and 0, d and SEXTETS[d] or not d and 0
    if not (a and b and c and d) then
      error("not base64", 0)
    end
    local three = ((a * 64 + b) * 64 + c) * 64 + d
    pieces[#pieces + 1] = string.char(math.floor(three / 65536), math.floor(three / 256) % 256, three % 256)
  end
  return table.concat(pieces):sub(1, math.floor(#digits * 3 / 4))
end

function decode.zlib(text)
  return inflate(decode.base64(text))
end

-- The byte of the two digits at `at`.
local function octet(text, at)
  local high, low = text:byte(at, at + 1)
  high, low = DIGITS[high], DIGITS[low]
  if not (high and low) then
    error("not hexadecimal digits", 0)
  end
  return high * 16 + low
end

-- Changes an array by the delta text[from..to]. The array's first byte is array[0]. Makes no garbage.
function decode.apply_delta(array, size, text, from, to)
  local at, place = from or 1, 0
  to = to or #text
  while at <= to do
    place = place + octet(text, at) * 256 + octet(text, at + 2)
    local runs = octet(text, at + 4)
    at = at + 6
    for _ = 1, runs do
      local value, length = octet(text, at), octet(text, at + 2)
      at = at + 4
      if place + length > size or at > to + 1 then
        error("a delta does not fit", 0)
      end
      for index = place, place + length - 1 do
        array[index] = value
      end
      place = place + length
    end
  end
end

-- The string `old`, changed by a delta.
function decode.delta(text, old)
  local pieces, at, copied, place = {}, 1, 0, 0
  while at <= #text do
    place = place + octet(text, at) * 256 + octet(text, at + 2)
    local runs = octet(text, at + 4)
    at = at + 6
    pieces[#pieces + 1] = old:sub(copied + 1, place)
    for _ = 1, runs do
      local length = octet(text, at + 2)
      pieces[#pieces + 1] = string.char(octet(text, at)):rep(length)
      place = place + length
      at = at + 4
    end
    copied = place
  end
  if place > #old then
    error("a delta does not fit", 0)
  end
  pieces[#pieces + 1] = old:sub(copied + 1)
  return table.concat(pieces)
end

-- Bytes as base64, for images and states.
function decode.to_base64(bytes)
  local text = bytes:gsub("..?.?", function(three)
    local a, b, c = three:byte(1, 3)
    local value = a * 65536 + (b or 0) * 256 + (c or 0)
    local digits = {}
    for place = 1, 4 do
      local sextet = math.floor(value / 64 ^ (4 - place)) % 64 + 1
      digits[place] = place <= #three + 1 and ALPHABET:sub(sextet, sextet) or "="
    end
    return table.concat(digits)
  end)
  return text
end

return decode

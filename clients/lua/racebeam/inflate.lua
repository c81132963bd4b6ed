-- zlib streams (RFC 1950, RFC 1951) in plain Lua, for versions without operators for bits.

local unpack = table.unpack or unpack
local floor = math.floor

local LENGTHS = { 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258 }
local LENGTH_BITS = { 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0 }
local DISTANCES = { 1, 2, 3, 4, 5, 7, 9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145,
  8193, 12289, 16385, 24577 }
local DISTANCE_BITS = { 0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13 }
local ORDER = { 16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15 } -- of the lengths of code lengths
local MOST_BITS = 15

-- A reader of bits, the lowest of each byte first.
local Bits = {}
Bits.__index = Bits

function Bits:take(count)
  while self.count < count do
    local byte = self.data:byte(self.at)
    if not byte then
      error("the stream is cut off", 0)
    end
    self.held = self.held + byte * 2 ^ self.count
    self.count = self.count + 8
    self.at = self.at + 1
  end
  local range = 2 ^ count
  local value = self.held % range
  self.held = floor(self.held / range)
  self.count = self.count - count
  return value
end

-- A Huffman code from the lengths of its symbols, which count from 0: how many codes there are of each length, and the
-- symbols in the order of their codes.
local function huffman(lengths, count)
  local counts, starts, symbols = {}, {}, {}
  for length = 0, MOST_BITS do
    counts[length] = 0
  end
  for symbol = 0, count - 1 do
    counts[lengths[symbol]] = counts[lengths[symbol]] + 1
  end
  local start = 1
  for length = 1, MOST_BITS do
    starts[length] = start
    start = start + counts[length]
  end
  for symbol = 0, count - 1 do
    local length = lengths[symbol]
    if length > 0 then
      symbols[starts[length]] = symbol
      starts[length] = starts[length] + 1
    end
  end
  return { counts = counts, symbols = symbols }
end

-- Reads the next symbol of a code.
local function decode(bits, code)
  local value, first, index = 0, 0, 1
  for length = 1, MOST_BITS do
    value = value + bits:take(1)
    local count = code.counts[length]
    if value - count < first then
      return code.symbols[index + value - first]
    end
    index = index + count
    first = (first + count) * 2
    value = value * 2
  end
  error("a code is not in use", 0)
end

-- The codes of RFC 1951, 3.2.6: of literals and lengths, and of distances.
local function fixed_codes()
  local lengths, distances = {}, {}
  for symbol = 0, 287 do
    lengths[symbol] = symbol < 144 and 8 or symbol < 256 and 9 or symbol < 280 and 7 or 8
  end
  for symbol = 0, 29 do
    distances[symbol] = 5
  end
  return huffman(lengths, 288), huffman(distances, 30)
end

-- Reads the codes of a block (RFC 1951, 3.2.7).
local function dynamic_codes(bits)
  local literals, distances, codes = bits:take(5) + 257, bits:take(5) + 1, bits:take(4) + 4
  local lengths = {}
  for symbol = 0, 18 do
    lengths[symbol] = 0
  end
  for at = 1, codes do
    lengths[ORDER[at]] = bits:take(3)
  end
  local code = huffman(lengths, 19)
  local all, filled = {}, 0
  local function append(value, times)
    for _ = 1, times do
      all[filled] = value
      filled = filled + 1
    end
  end
  while filled < literals + distances do
    local symbol = decode(bits, code)
    if symbol < 16 then
      append(symbol, 1)
    elseif symbol == 16 then
      append(all[filled - 1] or error("nothing to repeat", 0), 3 + bits:take(2))
    else
      append(0, symbol == 17 and 3 + bits:take(3) or 11 + bits:take(7))
    end
  end
  if filled > literals + distances then
    error("too many code lengths", 0)
  end
  local distance_lengths = {}
  for symbol = 0, distances - 1 do
    distance_lengths[symbol] = all[literals + symbol]
  end
  return huffman(all, literals), huffman(distance_lengths, distances)
end

-- Inflates a compressed block behind output[1..filled]. Returns how many bytes there are then.
local function inflate_block(bits, output, filled, literals, distances)
  while true do
    local symbol = decode(bits, literals)
    if symbol < 256 then
      filled = filled + 1
      output[filled] = symbol
    elseif symbol == 256 then
      return filled
    else
      local length = LENGTHS[symbol - 256] + bits:take(LENGTH_BITS[symbol - 256])
      local which = decode(bits, distances) + 1
      local from = filled - DISTANCES[which] - bits:take(DISTANCE_BITS[which])
      if from < 0 then
        error("a distance leads before the beginning", 0)
      end
      for at = 1, length do
        output[filled + at] = output[from + at]
      end
      filled = filled + length
    end
  end
end

-- Copies a stored block, as inflate_block() does with a compressed one.
local function copy_block(bits, output, filled)
  bits:take(bits.count % 8)
  local length = bits:take(16)
  bits:take(16) -- its complement
  for at = 1, length do
    output[filled + at] = bits:take(8)
  end
  return filled + length
end

local function adler(output, filled)
  local a, b = 1, 0
  for at = 1, filled do
    a = (a + output[at]) % 65521
    b = (b + a) % 65521
  end
  return b * 65536 + a
end

-- The bytes of a zlib stream. Raises a string that says what is wrong with it.
return function(data)
  local bits = setmetatable({ data = data, at = 3, held = 0, count = 0 }, Bits)
  if #data < 2 or data:byte(1) % 16 ~= 8 or (data:byte(1) * 256 + data:byte(2)) % 31 ~= 0 then
    error("not a zlib stream", 0)
  end
  local output, filled, last = {}, 0, 0
  while last == 0 do
    last = bits:take(1)
    local kind = bits:take(2)
    if kind == 0 then
      filled = copy_block(bits, output, filled)
    elseif kind == 1 then
      filled = inflate_block(bits, output, filled, fixed_codes())
    elseif kind == 2 then
      filled = inflate_block(bits, output, filled, dynamic_codes(bits))
    else
      error("a block of kind 3, which is not in use", 0)
    end
  end
  bits:take(bits.count % 8)
  local sum = 0
  for _ = 1, 4 do
    sum = sum * 256 + bits:take(8)
  end
  if sum ~= adler(output, filled) then
    error("the checksum is wrong", 0)
  end
  local pieces = {}
  for at = 1, filled, 4096 do
    pieces[#pieces + 1] = string.char(unpack(output, at, math.min(at + 4095, filled)))
  end
  return table.concat(pieces)
end

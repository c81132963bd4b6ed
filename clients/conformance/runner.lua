-- Takes the steps of a file with the client in Lua, and prints what came of each: runner.lua FILE.

local racebeam = require("racebeam")
local socket = require("socket")

local USUAL = { longest_reply = 2 ^ 20, timeout = 60 }

local game, last, stack
local options = {}
local variables, sent = {}, {}

local function adler(bytes)
  local a, b = 1, 0
  for at = 1, #bytes do
    a = (a + bytes:byte(at)) % 65521
    b = (b + a) % 65521
  end
  return ("%d:%04x%04x"):format(#bytes, b, a)
end

local BYTES = require("racebeam.field_table").usual

local function is_bytes(key)
  local field = key:gsub("^final_", "")
  return BYTES[field] or field:find("^grey%d") or field:find("^rgb%d")
end

-- A value as the server sent it, or the digest of bytes.
local function plain(key, value)
  if is_bytes(key) then
    return adler(value)
  elseif type(value) == "boolean" then
    return value and "1" or "0"
  end
  return tostring(value)
end

local function shown(command, group)
  if stack then
    if command == "reset" or command == "load" or command == "observe" then
      stack.screens:clear()
    end
    if group[stack.field] then
      group[stack.name] = stack.screens:push(group[stack.field])
      group[stack.field] = nil
    end
  end
  local keys, words = {}, {}
  for key in pairs(group) do
    keys[#keys + 1] = key
  end
  table.sort(keys)
  for at, key in ipairs(keys) do
    words[at] = (" %s=%s"):format(key, plain(key, group[key]))
  end
  return table.concat(words)
end

local function reply()
  local command = table.remove(sent, 1)
  local groups = game:receive()
  last = groups[1]
  local texts = {}
  for at, group in ipairs(groups) do
    texts[at] = shown(command, group)
  end
  return "ok" .. table.concat(texts, " |")
end

-- Prints what a step gives, or the word for its failure.
local function say(step, ...)
  local done, printed = pcall(step, ...)
  if not done then
    if type(printed) ~= "table" then
      error(printed, 0)
    end
    printed = printed.kind == "refused" and "error " .. printed.code or printed.kind
  end
  if printed then
    print(printed)
  end
end

local function connect(address, token)
  options.token = token
  return racebeam.connect(address, options)
end

local steps = {}

function steps.section(_, name)
  options, stack, sent = { longest_reply = USUAL.longest_reply, timeout = USUAL.timeout }, nil, {}
  return "section " .. name
end

function steps.connect(_, address, token)
  steps.close()
  game = connect(address, token)
  return "connected"
end

function steps.another(_, address, token)
  connect(address, token):close_connection()
  return "connected"
end

function steps.connections(_, count, address)
  for _ = 1, tonumber(count) do
    connect(address):close_connection()
  end
  return "connected"
end

function steps.launch()
  steps.close()
  game = racebeam.launch({ program = os.getenv("RACEBEAM_BINARY") })
  return "connected"
end

function steps.send(line)
  game:send(line)
  sent[#sent + 1] = line:match("%S*")
end

steps[">"] = function(line)
  steps.send(line)
  return reply()
end

function steps.receive(_, count)
  for _ = 1, tonumber(count) do
    say(reply)
  end
end

function steps.picture(_, path)
  game:save_png(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:read("*a")
  file:close()
  return "picture " .. adler(bytes)
end

function steps.keep(_, name, key)
  variables[name] = last[key]
end

function steps.close()
  if game then
    game:close_connection()
  end
end

function steps.timeout(_, seconds)
  options.timeout = tonumber(seconds)
end

function steps.trust(_, path)
  options.tls = path
end

function steps.stack(_, field, depth)
  stack = { field = field, name = field .. "x" .. depth, screens = racebeam.stack(tonumber(depth)) }
end

function steps.wait(_, seconds)
  socket.sleep(tonumber(seconds))
end

function steps.time(line, count, ahead)
  local request = line:match("^%S+ %S+ (.*)$")
  local start = socket.gettime()
  for _ = 1, count / ahead do
    for _ = 1, ahead do
      game:send(request)
    end
    for _ = 1, ahead do
      game:receive()
    end
  end
  return ("time %s %.6f"):format(ahead, socket.gettime() - start)
end

io.stdout:setvbuf("line")
for line in io.lines(arg[1]) do
  if line:find("%S") and line:sub(1, 1) ~= "#" then
    local filled = line:gsub("%$([%w_]+)", function(name)
      return variables[name] or os.getenv(name)
    end)
    local word, rest = filled:match("^(%S+) ?(.*)$")
    local words = {}
    for part in rest:gmatch("%S+") do
      words[#words + 1] = part
    end
    say(steps[word], rest, (table.unpack or unpack)(words))
  end
end
steps.close()

-- A client of the racebeam line protocol, for Lua 5.1 to 5.4 and LuaJIT.
--
--   local racebeam = require("racebeam")
--   local game = racebeam.connect("tcp://127.0.0.1:7800")
--   game:load("beamfall", { seed = 7, frame_skip = 4 })
--   game:observe("reward", "terminated", "truncated", "screen:delta")
--   local shown = game:act("FIRE")      -- { reward = 0, terminated = false, truncated = false, screen = "..." }
--   game:close_connection()
--
-- Numbers come as numbers, bytes as strings, and what is true or false, such as terminated, over and rule, as booleans.
-- racebeam/fault.lua says what is raised. README.md is the page of this client.

local decode = require("racebeam.decode")
local fault = require("racebeam.fault")
local new_fields = require("racebeam.fields")
local transport = require("racebeam.transport")

local racebeam = { _VERSION = "0.1.0", PROTOCOL = 1, decode = decode }

local LONGEST_REPLY = 2 ^ 28 -- bytes; a server that sends a longer line is taken for broken
local LONGEST_RAW = 20 -- characters of " raw=N" at the end of a line; of more bytes a session ends
local MOST_AHEAD = 2 ^ 15 -- bytes of requests without a reply; a server that cannot send its replies stops reading

local Session = {}
Session.__index = Session

local function session(connection, options)
  return setmetatable({ connection = connection, fields = new_fields(options.arrays), timeout = options.timeout,
    longest = options.longest_reply or LONGEST_REPLY, unanswered = {}, first = 1, last = 0, ahead = 0, arrived = {} }, Session)
end

-- Opens a session with the server at `address`, by default that in the environment variable RACEBEAM_ADDRESS.
--
-- address: tcp://HOST:PORT, tls://HOST:PORT and unix:PATH (with LuaSocket and LuaSec), pipes:PREFIX (named pipes), stdio, or
-- file:PATH (the first address in the server's ready file or announce file; file:PATH?wait=SECONDS waits for the server, and
-- needs LuaSocket). options:
--   token          the token for servers that require one; default: that of the announce file
--   timeout        seconds to wait for a connection and for each reply, on sockets
--   tls            a file of certificates to trust, or parameters of LuaSec
--   longest_reply  the most bytes of a line of a reply; a longer one ends the session
--   arrays         true: fields observed with :delta are given as the array that the client keeps, whose first byte is [0]
function racebeam.connect(address, options)
  options = options or {}
  address = address or os.getenv("RACEBEAM_ADDRESS") or ""
  local connection, token = transport.open(address, options)
  local made = session(connection, options)
  local done, problem = pcall(function()
    local hello = made:hello(options.token or token)
    if hello.protocol ~= racebeam.PROTOCOL then
      fault("lost", ("%s speaks version %s of the protocol; this client speaks %d"):format(address, tostring(hello.protocol),
        racebeam.PROTOCOL))
    end
  end)
  if not done then
    made:close_connection()
    error(problem, 0)
  end
  return made
end

-- Starts a server, and opens a session with it. The server stops when the session ends. options: those of connect, and
-- `program` (default: RACEBEAM_PROGRAM, or racebeam of the PATH). The other arguments are those of `racebeam serve`. Needs
-- no module.
function racebeam.launch(options, ...)
  options = options or {}
  local program = options.program or os.getenv("RACEBEAM_PROGRAM") or "racebeam"
  return session(transport.launch(program, { ... }), options)
end

-- Ends the session. Further calls do nothing.
function Session:close_connection()
  if not self.closed then
    self.closed = true
    self.connection:close()
  end
end

-- Lua 5.4 calls this at the end of the block of `local game <close> = racebeam.connect()`.
Session.__close = Session.close_connection

-- Requests and replies

-- A word of a request: true is 1, and false is 0. A whole number has no fraction: Lua 5.3 and later write 10 / 2 as 5.0.
local function text_of(value)
  if type(value) == "boolean" then
    return value and "1" or "0"
  elseif type(value) == "number" and value % 1 == 0 and math.abs(value) < 2 ^ 53 then
    return ("%d"):format(value)
  end
  return tostring(value)
end

-- The line of a request. A table among the words has settings, which are sent in the order of their names.
local function line_of(...)
  local words = { ... }
  for at, word in ipairs(words) do
    if type(word) == "table" then -- settings
      local pairs_ = {}
      for key, setting in pairs(word) do
        pairs_[#pairs_ + 1] = ("%s=%s"):format(key, text_of(setting))
      end
      table.sort(pairs_)
      words[at] = table.concat(pairs_, " ")
    else
      words[at] = text_of(word)
    end
  end
  return (table.concat(words, " "):gsub(" +$", ""))
end

-- Sends a request without waiting for its reply; receive() returns the replies in their order. Blanks join the words, and a
-- table stands for settings.
function Session:send(...)
  local line = line_of(...)
  if line:find("\n", 1, true) or line:find("^ *#") then
    fault("invalid", ("a request is one line, and no comment: '%s'"):format(line))
  end
  while self.ahead > 0 and self.ahead + #line > MOST_AHEAD do
    self.arrived[#self.arrived + 1] = self:outcome()
  end
  if self.closed then
    fault("lost", "the session has ended")
  end
  self.last = self.last + 1
  self.unanswered[self.last] = line
  self.ahead = self.ahead + #line
  self.connection:send(line)
end

-- Ends the session, and raises a fault of this kind.
local function lose(self, kind, sentence)
  self:close_connection()
  fault(kind, "the session has ended: " .. sentence)
end

-- What a server sent, for people: a terminal would execute some of its bytes.
local function printable(text)
  return (text:gsub("[^ -~]", function(byte)
    return ("\\x%02x"):format(byte:byte())
  end))
end

-- Receives the bytes that follow a reply's line, which then ends in raw=N.
local function receive_raw(self, line)
  local count = tonumber(line:match(" raw=(%d+)$", -LONGEST_RAW)) or 0
  if count == 0 then
    return ""
  elseif count > self.longest then
    lose(self, "lost", ("%d bytes follow its reply, which is longer than %d bytes"):format(count, self.longest))
  end
  local bytes, problem = self.connection:receive_bytes(count)
  return bytes or lose(self, problem == "timeout" and "timeout" or "lost", problem)
end

-- The next reply that arrives: its groups and its line, or the code and the sentence of a refusal.
function Session:outcome()
  if self.closed then
    fault("lost", "the session has ended")
  end
  local line, problem = self.connection:receive(self.timeout, self.longest)
  if not line then
    lose(self, problem == "timeout" and "timeout" or "lost", problem)
  end
  local request = self.unanswered[self.first] or "" -- without one, the server says why it ends
  self.unanswered[self.first] = nil
  self.first = math.min(self.first, self.last) + 1
  self.ahead = self.ahead - #request
  local code, sentence = line:match("^error (%S+) ?(.*)$")
  if code then
    return { code = code, sentence = sentence }
  elseif line ~= "ok" and line:sub(1, 3) ~= "ok " then
    lose(self, "lost", ("the server sent an invalid reply: '%s'"):format(printable(line:sub(1, 60))))
  end
  local words = {}
  for word in request:gmatch("%S+") do
    words[#words + 1] = word
  end
  local done, groups = pcall(self.fields.groups, self.fields, words, line, receive_raw(self, line))
  if not done then
    lose(self, "lost", "a reply is damaged: " .. printable(tostring(groups)))
  end
  return { groups = groups, line = line }
end

-- Returns the groups and the line of an outcome, or raises its refusal.
local function unwrap(outcome)
  if outcome.code then
    fault("refused", outcome.sentence, outcome.code)
  end
  return outcome.groups, outcome.line
end

-- Receives the next reply to a request that was sent ahead. Returns its groups, and its line.
function Session:receive()
  return unwrap(table.remove(self.arrived, 1) or self:outcome())
end

-- Sends a request. Returns the groups of its reply, and its line. Replies of requests that were sent ahead stay to be
-- received.
function Session:request(...)
  self:send(...)
  while self.first < self.last do
    self.arrived[#self.arrived + 1] = self:outcome()
  end
  return unwrap(self:outcome())
end

local function first(self, ...)
  return self:request(...)[1]
end

local function split(text)
  local found = {}
  for part in tostring(text):gmatch("[^,]+") do
    found[#found + 1] = part
  end
  return found
end

-- Sends a request. Returns the value of `key` in its reply as it was sent, or nil if the reply lacks it.
function Session:request_text(key, ...)
  local _, line = self:request(...)
  return (line .. " "):match(" " .. key .. "=(%S*) ")
end

-- Commands that need more than their words

for name, method in pairs(require("racebeam.commands")) do
  Session[name] = method
end

-- Explains a command, setting, field, preset, encoding or error code. Returns a text for people.
function Session:help(...)
  local _, line = self:request("help", ...)
  return line:sub(4)
end

-- Describes a game. Returns what the server knows about it.
function Session:game(name)
  return first(self, "games", name)
end

-- Powers on and begins an episode. Returns the settings in effect. game: its name, or the MD5 of its image.
-- settings.image: the bytes of a cartridge, if `game` is "inline".
function Session:load(game, settings)
  if settings ~= nil and type(settings) ~= "table" then
    fault("invalid", ("the settings are of type %s; load takes a table"):format(type(settings)))
  end
  local words = {}
  for key, setting in pairs(settings or {}) do
    words[key] = key == "image" and decode.to_base64(setting) or setting
  end
  return first(self, "load", game, words)
end

-- Names bytes of the fields ram and tia. Returns ram_names, pairs of index and name, and tia_names, the names in order.
function Session:names()
  return first(self, "names")
end

-- Lists the actions that act accepts. Returns their names by number.
function Session:actions()
  local found = {}
  for _, pair in ipairs(split(first(self, "actions").actions)) do
    local number, name = pair:match("(%d+):(.*)")
    found[tonumber(number)] = name
  end
  return found
end

-- Reads the colours of the field screen. Returns { red, green, blue } for each value of a pixel, from 0.
function Session:palette()
  local bytes, colours = self:look("palette").palette, {}
  for value = 0, 255 do
    colours[value] = { bytes:byte(3 * value + 1, 3 * value + 3) }
  end
  return colours
end

-- Reads `count` bytes of RAM (default: 1) from an index on, 0 to 127. Returns a string.
function Session:peek(index, count)
  return decode.hex(tostring(self:request_text("bytes", "peek", index, count or 1)))
end

-- Writes a string of bytes to RAM from an index on, 0 to 127.
function Session:poke(index, bytes)
  if type(bytes) ~= "string" then
    fault("invalid", ("the bytes are of type %s; poke takes a string of bytes"):format(type(bytes)))
  end
  self:request("poke", index, (bytes:gsub(".", function(byte)
    return ("%02X"):format(byte:byte())
  end)))
end

-- Exports a state, for later or for another process. Returns a string. settings: { episode = 1 } includes the score, the
-- progress of the episode and the stack of screens.
function Session:export_state(name, settings)
  return decode.base64(self:request_text("data", "export", name, settings or ""))
end

-- Saves a state that was exported, under a name.
function Session:import_state(name, bytes)
  self:request("import", name, decode.to_base64(bytes))
end

-- A list from R,R*TIMES,...
local function rewards(text)
  local found = {}
  for _, run in ipairs(split(text)) do
    local reward, times = run:match("^(%-?%d+)%*?(%d*)$")
    for _ = 1, tonumber(times) or 1 do
      found[#found + 1] = tonumber(reward)
    end
  end
  return found
end

-- Plays lists of actions from a state; the session itself does not change. Returns a table for each list, in which
-- `rewards` is a list. settings: { keep = PREFIX } saves the states at the ends of the lists under names with this prefix.
function Session:branch(name, lists, settings)
  local words = {}
  for at, actions in ipairs(lists) do
    words[at] = table.concat(actions, ",")
  end
  local branches = self:request("branch", name, settings or "", table.concat(words, " "))
  table.remove(branches, 1)
  for _, branch in ipairs(branches) do
    branch.rewards = rewards(branch.rewards)
    branch.rewards_b = branch.rewards_b and rewards(branch.rewards_b)
  end
  return branches
end

-- Closes the machines, as close_machines() does. The session continues.
function Session:close()
  self:close_machines()
end

-- Saves a picture of the screen as a PNG file. machine: the index of a machine of open, from 0.
function Session:save_png(path, machine)
  if type(path) ~= "string" then
    fault("invalid", ("the path is of type %s; save_png takes a string"):format(type(path)))
  end
  local bytes = decode.base64(self:request_text("data", "shot", machine and { machine = machine } or ""))
  local file, problem = io.open(path, "wb")
  if file then
    local written, why = file:write(bytes)
    local closed, too_late = file:close()
    problem = not (written and closed) and (why or too_late)
  end
  if problem then
    fault("invalid", ("the picture cannot be saved: %s"):format(problem))
  end
end

-- Ends the recording. Returns what was kept.
function Session:stop_recording()
  return first(self, "record", "stop")
end

-- A stack of screens that the client makes, as the server does for grey84x84xN. It has the last `depth` screens, oldest first,
-- and zeros before the first one. With observe("grey84x84x1:delta"), a reply has fewer bytes than with a stack of the server.
local Stack = {}
Stack.__index = Stack

function racebeam.stack(depth)
  return setmetatable({ depth = depth, screens = {} }, Stack)
end

-- Begins anew, as after a reset.
function Stack:clear()
  self.screens = {}
end

-- Adds a screen. Returns the stack.
function Stack:push(screen)
  table.insert(self.screens, screen)
  if #self.screens > self.depth then
    table.remove(self.screens, 1)
  end
  return ("\0"):rep(#screen * (self.depth - #self.screens)) .. table.concat(self.screens)
end

return racebeam

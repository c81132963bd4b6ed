-- Connections: tables with send(line), which returns nothing; receive(timeout, longest), which returns a line without its
-- end, or nil and "timeout" or another sentence; receive_bytes(count), which does so with the bytes that follow the line, in
-- the time that it left; and close().

local fault = require("racebeam.fault")

local transport = {}

-- Sockets, with LuaSocket.

local Socket = {}
Socket.__index = Socket

function Socket:send(line)
  self.socket:settimeout(self.timeout)
  self.socket:send(line .. "\n") -- if this fails, receive() tells why
end

-- What a read waits for, by what it says: TLS may have to write first.
local WAITS = { timeout = "reads", wantread = "reads", wantwrite = "writes" }

-- What arrives next: not empty; or nil and "timeout" or another sentence.
function Socket:piece()
  while true do
    local left = self.until_ and self.until_ - self.clock()
    if left and left <= 0 then
      return nil, "timeout"
    end
    local all, problem, some = self.socket:receive(65536)
    local piece = all or some
    if piece and #piece > 0 then
      return piece
    elseif not WAITS[problem] then
      return nil, problem
    end
    local sockets = { [WAITS[problem]] = { self.socket } }
    self.select(sockets.reads, sockets.writes, left)
  end
end

function Socket:receive(timeout, longest)
  self.until_ = timeout and self.clock() + timeout
  self.socket:settimeout(0)
  local pieces, length = { self.held }, #self.held
  while true do
    local last = pieces[#pieces]
    local stop = last:find("\n", 1, true)
    if stop then
      self.held = last:sub(stop + 1)
      pieces[#pieces] = last:sub(1, stop - 1)
      return table.concat(pieces)
    end
    if length > longest then
      return nil, ("its reply is longer than %d bytes"):format(longest)
    end
    local piece, problem = self:piece()
    if not piece then
      return nil, problem
    end
    pieces[#pieces + 1] = piece
    length = length + #piece
  end
end

function Socket:receive_bytes(count)
  local pieces, length = { self.held }, #self.held
  while length < count do
    local piece, problem = self:piece()
    if not piece then
      return nil, problem
    end
    pieces[#pieces + 1] = piece
    length = length + #piece
  end
  local all = table.concat(pieces)
  self.held = all:sub(count + 1)
  return all:sub(1, count)
end

function Socket:close()
  self.socket:close()
end

-- Requires a module that this kind of address needs.
local function require_module(module, kind)
  local found, value = pcall(require, module)
  if not found then
    fault("invalid", ("%s needs the module %s, which is not installed"):format(kind, module))
  end
  return value
end

-- Connects a socket to ..., the place of `address`.
local function connect(address, socket, timeout, ...)
  local core = require_module("socket", "this address")
  socket:settimeout(timeout)
  local done, problem = socket:connect(...)
  if not done then
    socket:close()
    fault(problem == "timeout" and "timeout" or "lost", ("no server answers at %s: %s"):format(address, tostring(problem)))
  end
  return setmetatable({ socket = socket, held = "", clock = core.gettime, select = core.select, timeout = timeout }, Socket)
end

-- Whether a certificate is that of a host. LuaSec looks only at who signed it.
local function certifies(certificate, host)
  local alternatives = certificate:extensions()["2.5.29.17"] or {}
  for _, kind in ipairs({ "dNSName", "iPAddress" }) do
    for _, name in ipairs(alternatives[kind] or {}) do
      if name == host or name:sub(1, 2) == "*." and name:sub(2) == host:match("%..*$") then
        return true
      end
    end
  end
  return false
end

-- Begins TLS on a connection. `trust`: a file of certificates, or parameters of LuaSec.
local function secure(connection, host, trust)
  local ssl = require_module("ssl", "tls://")
  local parameters = { mode = "client", protocol = "any", options = { "all", "no_sslv2", "no_sslv3", "no_tlsv1", "no_tlsv1_1" },
    verify = "peer", capath = "/etc/ssl/certs" }
  if type(trust) == "string" then
    parameters.cafile = trust
  end
  for key, value in pairs(type(trust) == "table" and trust or {}) do
    parameters[key] = value
  end
  local socket, problem = ssl.wrap(connection.socket, parameters)
  if socket then
    socket:settimeout(connection.timeout)
    socket:sni(host)
    local done
    done, problem = socket:dohandshake()
    if done and not certifies(socket:getpeercertificate(), host) then
      done, problem = false, "its certificate is not that of " .. host
    end
    if done then
      connection.socket = socket
      return connection
    end
    socket:close()
  end
  connection:close()
  fault("lost", "the server is not trusted: " .. tostring(problem))
end

local function network(kind, rest, options)
  local host, port = rest:match("^//%[?(.-)%]?:(%d+)$")
  if not host or host == "" or tonumber(port) > 65535 then
    return nil
  end
  local core = require_module("socket", kind .. "://")
  local socket = core.tcp()
  local connection = connect(kind .. ":" .. rest, socket, options.timeout, host, tonumber(port))
  socket:setoption("tcp-nodelay", true)
  return kind == "tls" and secure(connection, host, options.tls) or connection
end

local function unix(path, options)
  local module = require_module("socket.unix", "unix:")
  local make = type(module) == "table" and (module.stream or module) or module
  return connect("unix:" .. path, make(), options.timeout, path)
end

-- Streams, with plain Lua. Time limits are not possible.

local CLOSED = "it has closed the connection"

local Streams = {}
Streams.__index = Streams

function Streams:send(line)
  self.output:write(line, "\n")
  self.output:flush()
end

function Streams:receive()
  local line = self.input:read("*L")
  if line and line:sub(-1) == "\n" then
    return line:sub(1, -2)
  end
  return nil, CLOSED
end

function Streams:receive_bytes(count)
  local bytes = self.input:read(count)
  if bytes and #bytes == count then
    return bytes
  end
  return nil, CLOSED
end

-- Lua 5.1 has no "*L".
if _VERSION == "Lua 5.1" and not rawget(_G, "jit") then
  function Streams:receive()
    local line = self.input:read("*l")
    return line, CLOSED
  end
end

function Streams:close()
  if self.output ~= io.stdout then
    self.output:close()
    self.input:close()
  end
end

-- Opens a file, or raises a fault.
local function open_file(path, mode)
  local file, problem = io.open(path, mode)
  return file or fault("lost", problem)
end

-- The pipe for requests is opened for reading, too: without a reader, a write would end this process.
local function pipes(prefix)
  local input = open_file(prefix .. "_out", "rb")
  return setmetatable({ input = input, output = open_file(prefix .. "_in", "r+b") }, Streams)
end

-- A word as the shell reads it.
local function quote(word)
  return "'" .. word:gsub("'", "'\\''") .. "'"
end

-- A server that this client starts. Its input is a named pipe, whose name is removed once both have opened it. Its
-- output is read with io.popen. The first line is the shell's, and is empty: if this client closed the pipe before the
-- shell has opened it, the shell would wait forever.
function transport.launch(program, options)
  local fifo = os.tmpname()
  os.remove(fifo)
  local made = os.execute("mkfifo -m 600 " .. quote(fifo))
  if made ~= 0 and made ~= true then
    fault("lost", "no pipe can be made at " .. fifo)
  end
  local words = { ("exec <%s && rm -f %s && echo && exec"):format(quote(fifo), quote(fifo)), quote(program),
    "serve --stdio --log-level warning" }
  for _, option in ipairs(options) do
    words[#words + 1] = quote(option)
  end
  local input = io.popen(table.concat(words, " "), "r")
  local output = open_file(fifo, "r+b")
  input:read()
  return setmetatable({ input = input, output = output }, Streams)
end

local FILES = "; file:PATH takes the --ready-file or --announce file of a server"

-- Whether `test` of a shell says so of a file.
local function is(what, path)
  local done = os.execute(("test %s %s"):format(what, quote(path)))
  return done == 0 or done == true
end

local ANNOUNCEMENT = "1" -- the version of announce files that this client reads
local RETRY_SECONDS = 0.05

-- The lines of an announce file as those of a ready file, and its token. It has each address on its own line, and the
-- token last (server/README.md).
local function parse_announcement(path, text)
  local version = text:match('^{"racebeam_announce": ([^,\n]*)')
  local token = text:match('\n "token": "([^"\n]*)"}%s*$')
  if version and version ~= ANNOUNCEMENT then
    fault("invalid", ("%s is an announce file of version %s; this client reads version %s"):format(path, version, ANNOUNCEMENT))
  elseif not version or not token then
    fault("invalid", path .. " is not a whole announce file")
  end
  return text:gsub('\n  "([^\n]*)"', function(address)
    return "\n" .. address:gsub("\\(.)", "%1") .. "\n"
  end), token
end

-- The first address of a ready file or an announce file that this client can use, and the token of the latter.
local function address_in_file(path)
  if not is("-f", path) and is("-e", path) then -- a pipe might block
    fault("invalid", path .. " is not a regular file" .. FILES)
  end
  local file = open_file(path, "r")
  local text, token = file:read("*a"), nil
  file:close()
  if text:sub(1, 1) == "{" then
    text, token = parse_announcement(path, text)
  end
  for line in text:gmatch("[^\n]+") do
    if line:match("^tcp:") or line:match("^tls:") or line:match("^unix:") or line:match("^pipes:") then
      return line, token
    end
  end
  if not text:match("^[{#]") then
    fault("invalid", path .. (text == "" and " is empty" or " has other contents") .. FILES)
  end
  fault("invalid", path .. " names no address that this client can use")
end

-- A connection to the server that a file names, and the file's token. Waits for both, `seconds` at most; needs LuaSocket then.
local function connect_by_file(path, seconds, options)
  local core = seconds > 0 and require_module("socket", "file:PATH?wait=SECONDS")
  local until_ = core and core.gettime() + seconds
  while true do
    local done, connection, token = pcall(function()
      local address, found = address_in_file(path)
      local opens, connection = pcall(transport.open, address, options)
      if not opens and type(connection) == "table" then
        connection.sentence = ("%s (%s names %s)"):format(connection.sentence, path, address)
      end
      return opens and connection or error(connection, 0), found
    end)
    if done then
      return connection, token
    elseif not core or type(connection) ~= "table" or connection.kind == "invalid" or core.gettime() >= until_ then
      error(connection, 0)
    end
    core.sleep(RETRY_SECONDS)
  end
end

-- Whether a text is a number of seconds below 10^9.
local function is_time(text)
  local whole = text:match("^(%d+)$") or text:match("^(%d+)%.%d+$")
  return whole and #whole <= 9
end

-- A connection to the server at an address, and the token of its announce file, if there is one.
function transport.open(address, options)
  address = tostring(address)
  local kind, rest = address:match("^(%w+):(.+)$")
  local found, token
  if address == "stdio" then
    found = setmetatable({ input = io.stdin, output = io.stdout }, Streams)
  elseif kind == "tcp" or kind == "tls" then
    found = network(kind, rest, options)
  elseif kind == "unix" then
    found = unix(rest, options)
  elseif kind == "pipes" then
    found = pipes(rest)
  elseif kind == "file" then
    local path, seconds = rest:match("^(.+)%?wait=(.*)$")
    if seconds and not is_time(seconds) then
      fault("invalid", ("the address is '%s'; ?wait= takes seconds, from 0 to 999999999"):format(address))
    end
    found, token = connect_by_file(path or rest, tonumber(seconds) or 0, options)
  end
  if found then
    return found, token
  end
  local given = address == "" and "no address was given, and the variable RACEBEAM_ADDRESS is not set"
    or ("the address is '%s'"):format(address)
  fault("invalid", given .. "; it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, also in "
    .. "RACEBEAM_ADDRESS")
end

return transport

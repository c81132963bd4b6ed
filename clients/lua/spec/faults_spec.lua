-- Servers that misbehave, and bad input of the caller. No server of racebeam is needed: a socket of this process is one.

local racebeam = require("racebeam")
local socket = require("socket")

local HELLO = "ok server=test protocol=1\n"

-- What a call raises.
local function raised(call, ...)
  local done, problem = pcall(call, ...)
  assert.is_false(done)
  return problem
end

-- A session and the server's end. The server sends the greeting and `replies` as soon as it is connected, since nothing else
-- runs while the client waits.
local function prepared(replies)
  local listener = assert(socket.bind("127.0.0.1", 0))
  local _, port = listener:getsockname()
  local tcp, select, peer = socket.tcp, socket.select, nil
  socket.tcp = function()
    local real = tcp()
    return setmetatable({}, { __index = function(_, name)
      return function(_, ...)
        local results = { real[name](real, ...) }
        if name == "connect" and results[1] then
          peer = listener:accept()
          peer:send(HELLO .. replies)
        end
        return (table.unpack or unpack)(results)
      end
    end })
  end
  socket.select = function(_, _, wait) -- which takes no such table
    socket.sleep(math.min(wait, 0.01))
  end
  finally(function()
    socket.tcp, socket.select = tcp, select
    listener:close()
    peer:close()
  end)
  return racebeam.connect("tcp://127.0.0.1:" .. port, { timeout = 0.3, longest_reply = 65536 }), peer
end

describe("a session", function()
  for name, case in pairs({
    ["that is sent an invalid reply"] = { "220 mail.example.org\n", "lost" },
    ["that is sent binary data"] = { "\255\128\n", "lost" },
    ["that is sent an endless line"] = { "ok a=" .. ("0"):rep(131072), "lost" },
    ["that gets half a reply"] = { "ok rew", "timeout" },
    ["that gets none"] = { "", "timeout" },
    ["that gets half of the bytes after a line"] = { "ok ram=4 raw=4\nab", "timeout" },
    ["that is promised too many bytes"] = { "ok ram=65537 raw=65537\n", "lost" },
    ["whose fields have more bytes than follow the line"] = { "ok ram=3 raw=2\nab", "lost", "observe ram:raw" },
    ["whose fields have less"] = { "ok ram=1 raw=2\nab", "lost", "observe ram:raw" },
    ["whose field has no number of bytes"] = { "ok ram=x raw=2\nab", "lost", "observe ram:raw" },
  }) do
    it(name .. " ends", function()
      local game = prepared((case[3] and "ok\n" or "") .. case[1])
      if case[3] then
        game:request(case[3])
      end
      assert.equal(case[2], raised(game.request, game, "act FIRE").kind)
      assert.equal("lost", raised(game.request, game, "act FIRE").kind)
      assert.equal("lost", raised(game.send, game, "act FIRE").kind)
    end)
  end

  it("quotes an invalid reply for a terminal", function()
    local game = prepared("\27[31mred\255\n")
    local problem = tostring(raised(game.request, game, "act FIRE"))
    assert.equal("the session has ended: the server sent an invalid reply: '\\x1b[31mred\\xff'", problem)
  end)

  it("waits until TLS can write, if a read has to write first", function()
    local game, peer = prepared("")
    local receive, waited = game.connection.socket.receive, {}
    local problems = { "wantwrite", "wantread" }
    game.connection.socket.receive = function(...)
      local problem = table.remove(problems, 1)
      if problem then
        return nil, problem, ""
      end
      return receive(...)
    end
    game.connection.select = function(reads, writes)
      waited[#waited + 1] = (reads and "reads" or "") .. (writes and "writes" or "")
    end
    peer:send("ok reward=1\n")
    assert.equal(1, game:request("act FIRE")[1].reward)
    assert.equal("writes reads", table.concat(waited, " "))
  end)

  it("whose server dies in mid-line ends", function()
    local game, peer = prepared("ok rew")
    peer:close()
    assert.equal("lost", raised(game.request, game, "act FIRE").kind)
  end)

  it("keeps the replies around an error in a pipeline", function()
    local game = prepared("ok n=1\nerror bad-action it is\nok n=2\nok n=3\n")
    game:send("1")
    game:send("bad")
    game:send("2")
    assert.equal(3, game:request("3")[1].n) -- its own reply, though others wait
    assert.equal(1, game:receive()[1].n)
    local refused = raised(game.receive, game)
    assert.equal("refused", refused.kind)
    assert.equal("bad-action", refused.code)
    assert.equal("bad-action: it is", tostring(refused))
    assert.equal(2, game:receive()[1].n)
  end)

  it("takes the bytes after a line in any pieces", function()
    local game, peer = prepared("ok\nok ram=4 raw=4\n\n\1")
    game:observe("ram:raw")
    game:send("act FIRE")
    game:send("act FIRE")
    local receive = game.connection.receive_bytes
    function game.connection.receive_bytes(...)
      peer:send("\n\255ok ram=1 raw=1\n\7")
      game.connection.receive_bytes = receive
      return receive(...)
    end
    assert.same({ ram = "\n\1\n\255" }, game:receive()[1])
    assert.same({ ram = "\7" }, game:receive()[1])
  end)

  it("reads replies before it would block the server", function()
    local game = prepared(("ok a=1\n"):rep(2000))
    for _ = 1, 2000 do
      game:send("act " .. ("NOOP "):rep(20))
    end
    assert.is_true(#game.arrived > 0)
    for _ = 1, 2000 do
      assert.equal(1, game:receive()[1].a)
    end
  end)

  it("refuses what is not one line", function()
    local game = prepared("ok\n")
    assert.equal("invalid", raised(game.request, game, "act\nact").kind)
    assert.equal("invalid", raised(game.request, game, " # a comment").kind)
    game:close_connection()
    game:close_connection()
    assert.equal("lost", raised(game.act, game, "FIRE").kind)
  end)
end)

describe("connect", function()
  it("refuses an invalid address", function()
    for _, address in ipairs({ "", "nonsense", "tcp://host", "tcp://host:99999", "unix:", "http://host:1" }) do
      assert.equal("invalid", raised(racebeam.connect, address).kind)
    end
  end)

  it("says that no server is there", function()
    local taken = assert(socket.tcp()) -- bound, so that no other program gets the port, but not listening
    assert(taken:bind("127.0.0.1", 0))
    local _, port = taken:getsockname()
    finally(function()
      taken:close()
    end)
    assert.equal("lost", raised(racebeam.connect, "tcp://127.0.0.1:" .. port).kind)
    assert.equal("lost", raised(racebeam.connect, "unix:/nonexistent/socket").kind)
    assert.equal("lost", raised(racebeam.connect, "pipes:/nonexistent/pipes").kind)
    assert.equal("lost", raised(racebeam.connect, "file:/nonexistent/ready").kind)
  end)

  it("names the module that is missing", function()
    local real = package.loaded["socket"]
    package.loaded["socket"], package.preload["socket"] = nil, function()
      error("module 'socket' not found")
    end
    finally(function()
      package.loaded["socket"], package.preload["socket"] = real, nil
    end)
    local problem = raised(racebeam.connect, "tcp://127.0.0.1:1")
    assert.equal("invalid", problem.kind)
    assert.matches("socket", tostring(problem))
  end)
end)

-- A method for each command, with its own server: the program that RACEBEAM_PROGRAM names. No module is needed.

local racebeam = require("racebeam")

if not os.getenv("RACEBEAM_PROGRAM") then
  pending("RACEBEAM_PROGRAM names no program")
  return
end

-- A session that ends with the test.
local function launched(options, ...)
  local game = racebeam.launch(options, ...)
  finally(function()
    game:close_connection()
  end)
  return game
end

local function refused(call, ...)
  local done, problem = pcall(call, ...)
  assert.is_false(done)
  assert.equal("refused", problem.kind)
  return problem.code
end

describe("a server that the client starts", function()
  it("has a pipe without a name as soon as it answers", function()
    local tmpname, name = os.tmpname, nil
    os.tmpname = function()
      os.tmpname, name = tmpname, tmpname()
      return name
    end
    launched():hello()
    assert.is_nil(os.rename(name, name))
  end)

  it("ends with the block of a variable to be closed", function()
    if not _VERSION:match("5%.[4-9]") then
      return pending("this Lua has no variables to be closed")
    end
    local play = assert(load([[
      local racebeam = require("racebeam")
      local kept
      local done, problem = pcall(function()
        local game <close> = racebeam.launch()
        kept = game
        error("an agent fails", 0)
      end)
      return kept, problem]]))
    local game, problem = play()
    assert.equal("an agent fails", problem)
    local done, lost = pcall(game.hello, game)
    assert.is_false(done)
    assert.equal("lost", lost.kind)
  end)

  it("has a method for each command", function()
    local folder = os.tmpname()
    os.remove(folder)
    os.execute("mkdir " .. folder)
    local game = launched(nil, "--record-dir", folder, "--roms", folder)
    finally(function()
      game:close_connection()
      os.execute("rm -r " .. folder)
    end)
    assert.matches("^racebeam/", game:hello().server)
    assert.matches("act A", game:help("act"))
    assert.same({ "beamfall", "updraft" }, game:games())
    assert.is_true(game:game("beamfall").here)
    assert.equal(5, game:load("beamfall", { seed = 3, sticky = 0, preset = "paper2013" }).frame_skip)
    assert.equal(3, game:settings().seed)
    assert.is_true(game:settings().rule)
    assert.is_false(game:settings().autoreset)
    assert.is_true(game:hello().recording)
    assert.equal(1, game:set({ difficulty = 1 }).difficulty)
    assert.same({ 0 }, game:modes())
    assert.same({ 0, 1 }, game:difficulties())
    assert.equal("1:lives,2:score,3:score,4:score", game:names().ram_names)
    assert.equal("DOWNLEFTFIRE", game:actions()[17])
    assert.same({ "reward", "terminated", "truncated", "frame" }, game:observe("reward", "terminated", "truncated", "frame"))
    assert.equal(15, game:act("UP", "FIRE*2").frame)
    game:poke(5, "\18\244")
    assert.equal("\18\244", game:peek(5, 2))
    assert.equal("\18", game:peek(5))
    game:save("a")
    game:save("r", { generator = 1 })
    game:import_state("b", game:export_state("a"))
    assert.same({ "a", "b", "r" }, game:states())
    game:drop("a", "r")
    assert.equal(15, game:restore("b").frame)
    local branches = game:branch("b", { { "FIRE*4", "UP" }, { 0 } }, { keep = "leaf" })
    assert.equal(5, #branches[1].rewards)
    assert.equal("leaf1", branches[2].state)
    assert.equal("film.gif", game:record("gif", "film").recording)
    game:act("FIRE")
    local stopped = game:stop_recording()
    assert.same({ 5, true }, { stopped.frames, stopped.complete })
    assert.equal("now.png", game:shot("now").picture)
    game:save_png(folder .. "/saved.png")
    local saved, written = io.open(folder .. "/saved.png", "rb"), io.open(folder .. "/now.png", "rb")
    assert.equal(written:read("*a"), saved:read("*a"))
    saved:close()
    written:close()
    assert.equal("invalid", select(2, pcall(game.save_png, game, folder .. "/missing/saved.png")).kind)
    assert.equal(3, #game:open(3, { autoreset = "same-step" }))
    game:record("png", "pictures", { machine = 2 })
    assert.equal(5, game:step("UP", "FIRE", "NOOP")[3].frame)
    game:save("c", { machine = 1 })
    assert.equal(game:restore("c", 2).frame, game:restore("c", { machine = 0 }).frame)
    assert.is_true(#game:export_state("c", { episode = true }) > #game:export_state("c"))
    assert.equal(3, #game:restart("010", { seed = 4 }))
    game:close_machines()
    assert.equal("room", game:share("room", 2).share)
    assert.equal("room", game:shared()[1].name)
    local frame = game:watch("room", nil, "screen:delta").frame
    assert.equal(33600, #game:watch("room", nil, "screen:delta", "ram").screen)
    assert.is_nil(game:watch("room", { since = frame }, "screen").screen)
    game:unshare()
    assert.is_false(game:look("terminated").terminated)
    assert.equal(0, game:reset().reward)
    assert.equal(0, game:reset(9).reward)
    assert.is_true(game:stats().requests > 20)
    game:quit()
    assert.equal("lost", select(2, pcall(game.act, game, "FIRE")).kind)
  end)

  it("takes an image, and refuses with a code", function()
    local game = launched()
    assert.equal("unknown-game", refused(game.load, game, "nothing"))
    assert.equal("bad-image", refused(game.load, game, "inline", { image = "abc" }))
    local file = assert(io.open("../../games/homebrew/updraft.bin", "rb"))
    local image = file:read("*a")
    file:close()
    assert.equal("updraft", game:load("inline", { image = image }).game)
  end)

  it("shows colours", function()
    local game = launched()
    game:load("beamfall")
    local shown, palette = game:look("screen:raw", "rgb"), game:palette()
    for at = 1, #shown.screen do
      assert.same(palette[shown.screen:byte(at)], { shown.rgb:byte(3 * at - 2, 3 * at) })
    end
  end)

  it("keeps arrays on request", function()
    local game, strings = launched({ arrays = true }), launched()
    for _, one in ipairs({ game, strings }) do
      one:load("beamfall", { seed = 7, sticky = 0, frame_skip = 4 })
      one:observe("screen:delta")
    end
    local first = game:act("FIRE").screen
    strings:act("FIRE")
    for _ = 1, 5 do
      local array, text = game:act("UP").screen, strings:act("UP").screen
      assert.equal(first, array) -- the same array
      for at = 0, #text - 1 do
        if array[at] ~= text:byte(at + 1) then
          error("byte " .. at .. " differs")
        end
      end
    end
  end)

  it("takes whole numbers of any type, and only strings as bytes", function()
    local game = launched()
    assert.equal(5, game:load("beamfall", { seed = 10 / 2, sticky = 0.25, frame_skip = 2 ^ 2 }).seed)
    assert.equal(0.25, game:settings().sticky)
    game:observe("frame")
    assert.equal(4, game:act(2 / 2).frame)
    assert.equal("refused", select(2, pcall(game.act, game, 1.5)).kind)
    for _, bytes in ipairs({ 3, true, { 1, 2 } }) do
      assert.equal("invalid", select(2, pcall(game.poke, game, 0, bytes)).kind)
    end
    assert.equal("invalid", select(2, pcall(racebeam.connect, 3)).kind)
    assert.equal("invalid", select(2, pcall(game.load, game, "beamfall", "seed=7")).kind)
    assert.equal("invalid", select(2, pcall(game.save_png, game)).kind)
  end)

  it("whose program is missing raises an error", function()
    local done, problem = pcall(function()
      racebeam.launch({ program = "/nonexistent/racebeam" }):hello()
    end)
    assert.is_false(done)
    assert.equal("lost", problem.kind)
  end)
end)

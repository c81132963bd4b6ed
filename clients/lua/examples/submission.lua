-- Plays three episodes of Beamfall at random, with sticky actions. The server writes their logs into a folder, which
-- `racebeam verify FOLDER` confirms. The server's address is in RACEBEAM_ADDRESS; it needs --record-dir.
-- Usage: submission.lua FOLDER

local racebeam = require("racebeam")

local FOLDER, EPISODES, SEED = arg[1] or "lua-random", 3, 5
math.randomseed(SEED)

local game = racebeam.connect()
game:load("beamfall", { seed = 1, preset = "machado2018" })
game:observe("reward", "terminated", "truncated")
game:log(FOLDER, { agent = "lua-random", agent_seed = SEED, role = "baseline" })
for _ = 1, EPISODES do
  local shown, score = game:reset(), 0
  while not (shown.terminated or shown.truncated) do
    shown = game:act(math.random(0, 17))
    score = score + shown.reward
  end
  print(("score %d"):format(score))
end
local ended = game:log("stop")
print(("%d episodes are in the server's folder %s"):format(ended.logged, FOLDER))
game:close_connection()

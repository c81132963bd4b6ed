-- Plays three episodes of Beamfall at random, with sticky actions. The server writes their logs into a folder, which
-- `racebeam verify FOLDER` confirms. RACEBEAM_ADDRESS has the address of the server, which needs --record-dir.
-- Usage: submission.lua FOLDER

local racebeam = require("racebeam")

local FOLDER, EPISODES, SEED = arg[1] or "lua-random", 3, 5
math.randomseed(SEED)

local game = racebeam.connect()
game:load("beamfall", { seed = 1, preset = "machado2018" })
game:observe("reward", "terminated", "truncated")
game:log(FOLDER, { agent = "lua-random", agent_seed = SEED, role = "baseline" })
for _ = 1, EPISODES do
  local reply, score = game:reset(), 0
  while not (reply.terminated or reply.truncated) do
    reply = game:act(math.random(0, 17))
    score = score + reply.reward
  end
  print(("score %d"):format(score))
end
local logged = game:log("stop").logged
print(("%d episodes are in the server's folder %s"):format(logged, FOLDER))
game:close_connection()

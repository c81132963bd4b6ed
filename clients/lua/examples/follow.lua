-- Reads screens without garbage: the client keeps one array, and each reply changes it. Steers towards the brighter side of the
-- picture, and prints how much garbage a step makes. For LuaJIT, where the array is one of FFI; any Lua runs it. The server's
-- address is in RACEBEAM_ADDRESS.

local racebeam = require("racebeam")

local STEPS = 500
local WIDTH, HEIGHT = 160, 210

-- Whether the right half has more pixels that are not background than the left half.
local function right_is_brighter(screen)
  local balance = 0
  for row = 0, HEIGHT - 1, 3 do
    for column = 0, WIDTH / 2 - 1, 2 do
      local at = row * WIDTH + column
      balance = balance + (screen[at + WIDTH / 2] > 0 and 1 or 0) - (screen[at] > 0 and 1 or 0)
    end
  end
  return balance > 0
end

local game = racebeam.connect(nil, { arrays = true })
game:load("beamfall", { seed = 1, frame_skip = 4, autoreset = 1 })
game:observe("screen:delta", "reward")
local shown, score = game:act("FIRE"), 0
collectgarbage()
collectgarbage("stop")
local before = collectgarbage("count")
for _ = 1, STEPS do
  shown = game:act(right_is_brighter(shown.screen) and "RIGHTFIRE" or "LEFTFIRE")
  score = score + shown.reward
end
print(("score %d, %.1f KiB of garbage a step; a screen has %.1f KiB"):format(score, (collectgarbage("count") - before) / STEPS,
  WIDTH * HEIGHT / 1024))
game:close_connection()

-- Plays an episode of Beamfall by what is in RAM: it flies to the nearest gap of the beam, and shoots. The server's address is
-- in RACEBEAM_ADDRESS.

local racebeam = require("racebeam")

-- Variables of Beamfall (games/homebrew/README.md): bytes of RAM, the first of them 1.
local SHIP_X, BEAM = 7, 16
local WIDE = 4 -- cells of a gap that the ship fits into

local function bit(byte, number)
  return math.floor(byte / 2 ^ number) % 2
end

-- Whether a cell of the beam burns; they count from 0 on the left. PF0 has four of them, and PF1 its bits the other way round.
local function burns(ram, cell)
  local half, place = BEAM + 3 * math.floor(cell / 20), cell % 20
  if place < 4 then
    return bit(ram:byte(half), 4 + place) == 1
  elseif place < 12 then
    return bit(ram:byte(half + 1), 11 - place) == 1
  end
  return bit(ram:byte(half + 2), place - 12) == 1
end

-- Cells to the middle of the nearest wide gap, negative to the left; nil if no gap is wide.
local function way(ram)
  local ship, gap, nearest = (ram:byte(SHIP_X) + 10) / 4, 0, nil
  for cell = 0, 40 do
    if cell < 40 and not burns(ram, cell) then
      gap = gap + 1
    else
      local distance = cell - gap / 2 - ship
      if gap >= WIDE and (not nearest or math.abs(distance) < math.abs(nearest)) then
        nearest = distance
      end
      gap = 0
    end
  end
  return nearest
end

local game = racebeam.connect()
game:load("beamfall", { seed = 1, frame_skip = 4 })
game:observe("reward", "terminated", "truncated", "ram")
local shown, score, acts = game:look(), 0, 0
repeat
  local distance = way(shown.ram)
  local here = not distance or math.abs(distance) < 0.6
  shown = game:act(here and "FIRE" or distance > 0 and "RIGHTFIRE" or "LEFTFIRE")
  score, acts = score + shown.reward, acts + 1
until shown.terminated or shown.truncated
print(("score %d in %d acts"):format(score, acts))
game:close_connection()

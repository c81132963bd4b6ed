-- Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

-- The commands whose methods only send their words. `request` is a session's.

local methods = {}

-- The setting of a method that takes one: its value, or a table that has it.
local function keyed(key, value)
  return type(value) == "table" and value or value ~= nil and { [key] = value } or ""
end

local function first(session, ...)
  return session:request(...)[1]
end

local function rest(session, ...)
  local groups = session:request(...)
  table.remove(groups, 1)
  return groups
end

local function nothing(session, ...)
  session:request(...)
end

local function list(session, key, ...)
  local found = {}
  for part in tostring(first(session, ...)[key]):gmatch("[^,]+") do
    found[#found + 1] = part
  end
  return found
end

local function ints(session, key, ...)
  local found = list(session, key, ...)
  for at, text in ipairs(found) do
    found[at] = tonumber(text)
  end
  return found
end

-- Greet the server; the reply has its name, version and limits.
-- token: a token that the server accepts.
function methods:hello(token)
  return first(self, "hello", keyed("token", token))
end

-- List the games whose image is here, or all known games; or describe one.
-- which: all for all known games, or the name of a game to describe.
function methods:games(which)
  return list(self, "games", "games", which or "")
end

-- Show the settings in effect.
function methods:settings()
  return first(self, "settings")
end

-- Change the mode, from the next reset on, or the difficulty, at once.
-- mode: a number that modes lists.
-- difficulty: a number that difficulties lists.
function methods:set(settings)
  return first(self, "set", settings or "")
end

-- List the game's modes.
function methods:modes()
  return ints(self, "modes", "modes")
end

-- List the game's difficulties.
function methods:difficulties()
  return ints(self, "difficulties", "difficulties")
end

-- Select the fields of replies.
-- fields: the fields, such as lives or screen:rle, or none; without them, the selection does not change.
function methods:observe(...)
  return list(self, "fields", "observe", ...)
end

-- Show these fields once; without fields, the selected ones.
-- fields: the fields, such as lives or screen:rle.
function methods:look(...)
  return first(self, "look", ...)
end

-- Play actions until the episode ends.
-- actions: names or numbers of actions, also with marks, such as RIGHT*10.
function methods:act(...)
  return first(self, "act", ...)
end

-- Begin an episode; with a seed, power on anew with it.
-- seed: the seed with which the console is powered on anew, or random.
function methods:reset(seed)
  return first(self, "reset", keyed("seed", seed))
end

-- Save the state; generator=1: with the random generator.
-- name: a name for the state.
-- generator: 1: the state includes the random generator.
-- machine: the index of a machine of open, from 0.
function methods:save(name, settings)
  nothing(self, "save", name, settings or "")
end

-- Restore a saved state.
-- name: the name of the state.
-- machine: the index of a machine of open, from 0.
function methods:restore(name, machine)
  return first(self, "restore", name, keyed("machine", machine))
end

-- Delete states.
-- names: the names of the states, or all.
function methods:drop(...)
  nothing(self, "drop", ...)
end

-- List the names of the states.
function methods:states()
  return list(self, "states", "states")
end

-- Create N machines with the loaded game and settings; their seeds count up.
-- count: the number of machines.
-- autoreset: what happens at the end of an episode.
-- steps: what a step is.
-- start: how an episode begins; requires steps=frames.
-- life_loss: what a lost life does.
-- stack: what a stack of screens begins with; requires steps=frames.
-- pool: which frames a stack shows; requires steps=frames.
function methods:open(count, settings)
  return rest(self, "open", count, settings or "")
end

-- Play one act on each machine: an action each, or one for all.
-- actions: an action for each machine, or one for all.
function methods:step(...)
  return rest(self, "step", ...)
end

-- Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
-- mask: a 0 or a 1 for each machine, such as 0110.
-- seed: the seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on.
function methods:restart(mask, seed)
  return rest(self, "restart", mask or "", keyed("seed", seed))
end

-- Close the machines.
function methods:close_machines()
  nothing(self, "close")
end

-- Record frames, sound or both into the server's folder.
-- kinds: the kinds of files, separated by commas, such as gif,wav.
-- name: a name for the files, without an extension.
-- machine: the index of a machine of open, from 0.
function methods:record(kinds, name, machine)
  return first(self, "record", kinds, name, keyed("machine", machine))
end

-- Log the episodes from the next reset on, so that anybody can verify them.
-- name: a name for the submission, or inline; last answers with the last log, and stop ends logging.
-- agent: the agent's name (default: agent).
-- version: the agent's version (default: 1).
-- agent_seed: the agent's seed (default: 0).
-- trial: the number of the trial (default: 1).
-- training_frames: frames that the agent was trained on (default: 0).
-- phrase: the phrase that the episodes' seeds follow from, with _ for a blank.
-- role: what the agent is.
-- link: a page about the agent.
-- machine: the index of a machine of open, from 0.
function methods:log(name, settings)
  return first(self, "log", name, settings or "")
end

-- Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
-- name: a name for the file, without .png.
-- machine: the index of a machine of open, from 0.
function methods:shot(name, machine)
  return first(self, "shot", name or "", keyed("machine", machine))
end

-- Let other sessions watch the game under this name.
-- name: a name for the shared session.
-- watchers: the most sessions that may watch at the same time.
function methods:share(name, watchers)
  return first(self, "share", name, keyed("watchers", watchers))
end

-- Stop sharing the game.
function methods:unshare()
  nothing(self, "unshare")
end

-- List the shared sessions.
function methods:shared()
  return rest(self, "shared")
end

-- Show the latest copy of a shared session.
-- name: the name of the shared session.
-- since: the frame of the last reply; the fields come only if there is a newer one.
-- fields: fields among screen, ram and palette, such as screen:delta.
function methods:watch(name, settings, ...)
  return first(self, "watch", name, settings or "", ...)
end

-- Show counters of this session.
function methods:stats()
  return first(self, "stats")
end

-- End the session.
function methods:quit()
  nothing(self, "quit")
end

return methods

-- What this client raises: tables with the field `kind`, which tostring() turns into a sentence.
--   refused  the server refused a request; `code` and `sentence`; the session continues
--   lost     the server is not there, has gone, or sent an invalid reply; the session has ended
--   timeout  the server did not answer in time; the session has ended
--   invalid  the caller's words are not accepted
local Fault = {}
Fault.__index = Fault

function Fault:__tostring()
  return (self.code and self.code .. ": " or "") .. self.sentence
end

return function(kind, sentence, code)
  error(setmetatable({ kind = kind, sentence = sentence, code = code }, Fault), 0)
end

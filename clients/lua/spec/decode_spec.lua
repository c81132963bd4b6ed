local racebeam = require("racebeam")

local decode = racebeam.decode
-- Its codes are dynamic.
local SQUARES = ""
  .. "eNpdk0tuBSEMBK/CEfAPBs1pIiWLLJOn3D/0rKi3xLLs6qZt7fXz9/H79dm+X83u5uc77xbne90t0T/uVmfB627jLMTumBi5Z1xnYewl6yxcm8"
  .. "I61vS+S4aSqwuwlnuSBfn2NiPy2kRGaFHboA51AdwvzQJ6uDYu6pWHoE/RO+gz1UWrrz3LQV++Nzroa24uB/0QvYN+PF2gn88s0M9nI60XV4B+"
  .. "iT5Av6Qx6H2XFUHzuxwLum8yNopfKQUxWNM3BSRY6Dfjevtz7YUIK2UjmaAhGckIDSUtqWMqjkkdlzKbbylSsJMx6tKRzJHpRJJB8q550OHRtR"
  .. "c6PPvmq85cSkdBh4+nDzp8al4FA6y9BR2+nhOGjnh0FM/YpLfmW/o1jxcR8q94EimfR+eZSMc/0klPJA=="

local BYTES = "\0\0\0\255\255\26"

describe("decode", function()
  it("gives the bytes of each encoding", function()
    assert.equal(BYTES, decode.hex("000000FFFF1A"))
    assert.equal(BYTES, decode.rle("0003FF021A01"))
    assert.equal(BYTES, decode.base64("AAAA//8a"))
    assert.equal(BYTES, decode.zlib("eJxjYGD4/18KAAUbAhk="))
    assert.equal(BYTES, decode.delta("000301FF020000011A01", ("\0"):rep(6)))
    assert.equal(BYTES, decode.delta("", BYTES))
    local array = { [0] = 0, 0, 0, 0, 0, 0 }
    decode.apply_delta(array, 6, "000301FF020000011A01")
    assert.same({ [0] = 0, 0, 0, 255, 255, 26 }, array)
  end)

  it("gives the bytes of each kind of zlib block", function()
    assert.equal("abc", decode.zlib("eAEBAwD8/2FiYwJNASc=")) -- stored
    assert.equal(("ab"):rep(600), decode.zlib("eAFLTEochaNwFI7CIQEBUZjJGA==")) -- fixed codes
    local text = {}
    for n = 1, 60 do
      text[n] = ("%d squared is %d; "):format(n, n * n)
    end
    assert.equal(table.concat(text), decode.zlib(SQUARES))
  end)

  it("goes to base64 and back", function()
    for size = 0, 9 do
      local bytes = ("\0\255\128abcdef"):sub(1, size)
      assert.equal(bytes, decode.base64(decode.to_base64(bytes)))
    end
  end)

  it("refuses what is damaged", function()
    for name, texts in pairs({
      hex = { "0", "0G", "G0", "\255\48" },
      rle = { "00", "0" },
      base64 = { "!AAA", "AAA", "A===", "AA=A" },
      zlib = { "AAAA", "eJxjYGD4/18K", "eJxjYGD4/18KAAUbAhg=" },
    }) do
      for _, text in ipairs(texts) do
        assert.is_false(pcall(decode[name], text), name .. " " .. text)
      end
    end
    for _, text in ipairs({ "00", "000001", "00000101", "0006010101", "FFFF01AAFF" }) do
      assert.is_false(pcall(decode.delta, text, ("\0"):rep(6)), text)
      assert.is_false(pcall(decode.apply_delta, { [0] = 0, 0, 0, 0, 0, 0 }, 6, text), text)
    end
  end)
end)

describe("a stack", function()
  it("has the last screens", function()
    local stack = racebeam.stack(3)
    assert.equal("\0\0\0\0ab", stack:push("ab"))
    stack:push("cd")
    stack:push("ef")
    assert.equal("cdefgh", stack:push("gh"))
    stack:clear()
    assert.equal("\0\0\0\0ij", stack:push("ij"))
  end)
end)

-- Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

return {
  -- The encodings of fields of bytes where a request does not name one.
  usual = {
    ram = "hex",
    tia = "hex",
    state_hash = "hex",
    screen = "rle",
    rgb = "zlib",
    grey = "zlib",
    palette = "hex",
    audio = "hex",
    audio_all = "hex",
  },
  -- The sizes in bytes of fields whose size never changes.
  sizes = {
    ram = 128,
    tia = 53,
    state_hash = 8,
    palette = 768,
    audio = 512,
  },
  -- Bytes per pixel of fields with the size of the screen.
  pixels = {
    screen = 1,
    rgb = 3,
    grey = 1,
  },
  -- Values that become true or false: 0 would be true in Lua.
  flags = {
    terminated = true,
    truncated = true,
    game_over = true,
    life_loss_ends = true,
    color_averaging = true,
    sound = true,
    autoreset = true,
    recording = true,
    admitted = true,
    here = true,
    rule = true,
    over = true,
    complete = true,
  },
}

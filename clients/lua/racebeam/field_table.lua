-- Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

return {
  -- What bytes are written in where the client does not say.
  usual = { ram = "hex", tia = "hex", state_hash = "hex", screen = "rle", rgb = "zlib", grey = "zlib", palette = "hex", audio = "hex", audio_all = "hex" },
  -- Bytes of fields that always have the same number.
  sizes = { ram = 128, tia = 53, state_hash = 8, palette = 768, audio = 512 },
  -- Bytes of a pixel of fields that have the size of the screen.
  pixels = { screen = 1, rgb = 3, grey = 1 },
  -- What is true or false where its value is 1 or 0: 0 would be true in Lua.
  flags = { terminated = true, truncated = true, game_over = true, life_loss_ends = true, color_averaging = true, sound = true, autoreset = true, recording = true, admitted = true, here = true, rule = true, over = true, complete = true },
}

// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

/** The encodings of fields of bytes where a request does not name one. */
export const USUAL = {
  ram: "hex",
  tia: "hex",
  state_hash: "hex",
  screen: "rle",
  rgb: "zlib",
  grey: "zlib",
  palette: "hex",
  audio: "hex",
  audio_all: "hex",
};
/** The sizes in bytes of fields whose size never changes. */
export const SIZES = {
  ram: 128,
  tia: 53,
  state_hash: 8,
  palette: 768,
  audio: 512,
};
/** Bytes per pixel of fields with the size of the screen. */
export const PIXELS = {
  screen: 1,
  rgb: 3,
  grey: 1,
};

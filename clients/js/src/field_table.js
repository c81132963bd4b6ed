// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

/** What bytes are written in where the client does not say. */
export const USUAL = { ram: "hex", tia: "hex", state_hash: "hex", screen: "rle", rgb: "zlib", grey: "zlib", palette: "hex", audio: "hex", audio_all: "hex" };
/** Bytes of fields that always have the same number. */
export const SIZES = { ram: 128, tia: 53, state_hash: 8, palette: 768, audio: 512 };
/** Bytes of a pixel of fields that have the size of the screen. */
export const PIXELS = { screen: 1, rgb: 3, grey: 1 };

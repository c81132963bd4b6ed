// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
package racebeam;

import java.util.Map;

/** The fields of bytes. */
final class FieldTable {
  /** The encodings of fields of bytes where a request does not name one. */
  static final Map<String, Encoding> USUAL = Map.of(
      "ram", Encoding.HEX,
      "tia", Encoding.HEX,
      "state_hash", Encoding.HEX,
      "screen", Encoding.RLE,
      "rgb", Encoding.ZLIB,
      "grey", Encoding.ZLIB,
      "palette", Encoding.HEX,
      "audio", Encoding.HEX,
      "audio_all", Encoding.HEX);
  /** The sizes in bytes of fields whose size never changes. */
  static final Map<String, Integer> SIZES = Map.of(
      "ram", 128,
      "tia", 53,
      "state_hash", 8,
      "palette", 768,
      "audio", 512);
  /** Bytes per pixel of fields with the size of the screen. */
  static final Map<String, Integer> PIXELS = Map.of(
      "screen", 1,
      "rgb", 3,
      "grey", 1);

  private FieldTable() { }
}

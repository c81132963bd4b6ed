package racebeam;

import java.io.ByteArrayInputStream;
import java.io.ByteArrayOutputStream;
import java.io.IOException;
import java.util.Arrays;
import java.util.Base64;
import java.util.zip.InflaterInputStream;

/** The encodings of fields that are bytes. */
public enum Encoding {
  /** Two digits a byte. */
  HEX {
    @Override
    public byte[] decode(String text) {
      return unhex(text);
    }
  },
  /** Runs: value and length. */
  RLE {
    @Override
    public byte[] decode(String text) {
      byte[] runs = unhex(text);
      if (runs.length % 2 != 0) {
        throw new IllegalArgumentException("half a run");
      }
      int size = 0;
      for (int at = 1; at < runs.length; at += 2) {
        size += runs[at] & 0xFF;
      }
      byte[] decoded = new byte[size];
      for (int at = 0, place = 0; at < runs.length; at += 2) {
        int end = place + (runs[at + 1] & 0xFF);
        Arrays.fill(decoded, place, end, runs[at]);
        place = end;
      }
      return decoded;
    }
  },
  /** The changes since the previous reply; {@link #applyDelta} needs the array of that reply. */
  DELTA {
    @Override
    public byte[] decode(String text) {
      throw new UnsupportedOperationException("a delta changes an array: applyDelta(array, text)");
    }
  },
  /** Base64, RFC 4648. */
  BASE64 {
    @Override
    public byte[] decode(String text) {
      return Base64.getDecoder().decode(text);
    }
  },
  /** zlib, RFC 1950, then base64. */
  ZLIB {
    @Override
    public byte[] decode(String text) {
      try (var input = new InflaterInputStream(new ByteArrayInputStream(BASE64.decode(text)))) {
        var output = new ByteArrayOutputStream(1 << 16);
        input.transferTo(output);
        return output.toByteArray();
      } catch (IOException failure) {
        throw new IllegalArgumentException("the zlib stream is damaged: " + failure.getMessage(), failure);
      }
    }
  },
  /** Unencoded bytes, after the line of the reply, which has only their number. */
  RAW {
    @Override
    public byte[] decode(String text) {
      throw new UnsupportedOperationException("raw bytes follow the line of a reply; the line has only their number, " + text);
    }
  };

  private static final byte[] DIGITS = new byte[256];

  static {
    Arrays.fill(DIGITS, (byte) -1);
    for (char digit : "0123456789ABCDEFabcdef".toCharArray()) {
      DIGITS[digit] = (byte) Character.digit(digit, 16);
    }
  }

  /**
   * Decodes a text.
   *
   * @param text a value of a reply
   * @return the bytes of the field
   * @throws IllegalArgumentException if the text has another form
   */
  public abstract byte[] decode(String text);

  /**
   * Changes an array by a delta.
   *
   * @param array the field as of the previous reply; zeros at first
   * @param text a value of a reply
   * @throws IllegalArgumentException if the text has another form, or reaches beyond the array
   */
  public static void applyDelta(byte[] array, String text) {
    int at = 0;
    int place = 0;
    while (at < text.length()) {
      place += octet(text, at) << 8 | octet(text, at + 2);
      int runs = octet(text, at + 4);
      at += 6;
      for (int run = 0; run < runs; ++run, at += 4) {
        int end = place + octet(text, at + 2);
        if (end > array.length) {
          throw new IllegalArgumentException("a delta reaches byte " + end + " of " + array.length);
        }
        Arrays.fill(array, place, end, (byte) octet(text, at));
        place = end;
      }
    }
  }

  private static byte[] unhex(String text) {
    byte[] bytes = new byte[(text.length() + 1) / 2];
    for (int at = 0; at < bytes.length; ++at) {
      bytes[at] = (byte) octet(text, 2 * at);
    }
    return bytes;
  }

  private static int octet(String text, int at) {
    if (at + 2 > text.length()) {
      throw new IllegalArgumentException("hexadecimal digits are missing at the end");
    }
    int value = DIGITS[text.charAt(at) & 0xFF] << 4 | DIGITS[text.charAt(at + 1) & 0xFF];
    if (value < 0) {
      throw new IllegalArgumentException("'" + text.substring(at, at + 2) + "' is not a byte in hexadecimal");
    }
    return value;
  }
}

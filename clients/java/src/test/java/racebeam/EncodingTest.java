package racebeam;

import static org.junit.jupiter.api.Assertions.assertArrayEquals;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;

import java.io.ByteArrayOutputStream;
import java.io.IOException;
import java.util.Base64;
import java.util.zip.DeflaterOutputStream;
import org.junit.jupiter.api.Test;

class EncodingTest {
  private static final byte[] BYTES = {0, 0, 0, -1, -1, 26};

  @Test
  void eachEncodingGivesTheBytes() throws IOException {
    var compressed = new ByteArrayOutputStream();
    try (var deflater = new DeflaterOutputStream(compressed)) {
      deflater.write(BYTES);
    }
    assertArrayEquals(BYTES, Encoding.HEX.decode("000000FFFF1A"));
    assertArrayEquals(BYTES, Encoding.RLE.decode("0003FF021A01"));
    assertArrayEquals(BYTES, Encoding.BASE64.decode(Base64.getEncoder().encodeToString(BYTES)));
    assertArrayEquals(BYTES, Encoding.ZLIB.decode(Base64.getEncoder().encodeToString(compressed.toByteArray())));
    byte[] array = new byte[6];
    Encoding.applyDelta(array, "000301FF02" + "0000011A01");
    assertArrayEquals(BYTES, array);
    Encoding.applyDelta(array, "");
    assertArrayEquals(BYTES, array);
  }

  @Test
  void whatIsDamagedIsRefused() {
    for (String text : new String[] {"0", "0G", "G0", "\u00ff0"}) {
      assertThrows(IllegalArgumentException.class, () -> Encoding.HEX.decode(text), text);
    }
    assertThrows(IllegalArgumentException.class, () -> Encoding.RLE.decode("00"));
    assertThrows(IllegalArgumentException.class, () -> Encoding.BASE64.decode("!"));
    assertThrows(IllegalArgumentException.class, () -> Encoding.ZLIB.decode("AAAA"));
    for (String delta : new String[] {"00", "000001", "00000101", "0006010101", "FFFF01AAFF"}) {
      assertThrows(IllegalArgumentException.class, () -> Encoding.applyDelta(new byte[6], delta), delta);
    }
    for (Encoding without : new Encoding[] {Encoding.DELTA, Encoding.RAW}) {
      assertThrows(UnsupportedOperationException.class, () -> without.decode("00"));
    }
  }

  @Test
  void aStackHasTheLastScreens() {
    ScreenStack stack = new ScreenStack(3);
    assertArrayEquals(new byte[] {0, 0, 0, 0, 1, 2}, stack.push(new byte[] {1, 2}));
    stack.push(new byte[] {3, 4});
    stack.push(new byte[] {5, 6});
    assertArrayEquals(new byte[] {3, 4, 5, 6, 7, 8}, stack.push(new byte[] {7, 8}));
    stack.clear();
    assertArrayEquals(new byte[] {0, 0, 0, 0, 9, 9}, stack.push(new byte[] {9, 9}));
  }

  @Test
  void aPaletteHasPackedColours() {
    byte[] bytes = new byte[768];
    bytes[3] = (byte) 0xAB;
    bytes[4] = 1;
    bytes[5] = (byte) 0xFF;
    Palette palette = new Palette(bytes);
    assertEquals(0xFFAB01FF, palette.colour(1));
    assertArrayEquals(new int[] {0xFF000000, 0xFFAB01FF}, palette.colours(new byte[] {0, 1}));
  }
}

package racebeam;

/** The colours of a screen's pixels. */
public final class Palette {
  private final int[] packed = new int[256];

  /**
   * Makes a palette.
   *
   * @param bytes the field palette: red, green and blue of each value
   */
  public Palette(byte[] bytes) {
    for (int value = 0; value < packed.length; ++value) {
      packed[value] = 0xFF << 24 | (bytes[3 * value] & 0xFF) << 16 | (bytes[3 * value + 1] & 0xFF) << 8 | bytes[3 * value + 2] & 0xFF;
    }
  }

  /**
   * Returns the colour of a value.
   *
   * @param value the value of a pixel, 0 to 255
   * @return 0xFFRRGGBB
   */
  public int colour(int value) {
    return packed[value];
  }

  /**
   * Converts a screen to colours, as {@code java.awt.image.BufferedImage.setRGB} takes them.
   *
   * @param screen the field screen
   * @return 0xFFRRGGBB of each pixel, row by row
   */
  public int[] colours(byte[] screen) {
    int[] pixels = new int[screen.length];
    for (int at = 0; at < pixels.length; ++at) {
      pixels[at] = packed[screen[at] & 0xFF];
    }
    return pixels;
  }
}

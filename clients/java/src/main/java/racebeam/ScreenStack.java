package racebeam;

import java.util.Arrays;

/**
 * A stack of screens that the client makes, as the server does for the field {@code grey84x84xN}. It has the last screens,
 * oldest first, and zeros before the first one. With {@code observe("grey84x84x1:delta")}, a reply has fewer bytes than with
 * a stack of the server.
 */
public final class ScreenStack {
  private final int depth;
  private byte[] stack = {};

  /**
   * Makes a stack without screens.
   *
   * @param depth the number of screens
   */
  public ScreenStack(int depth) {
    this.depth = depth;
  }

  /** Begins anew, as after a reset. */
  public void clear() {
    Arrays.fill(stack, (byte) 0);
  }

  /**
   * Adds a screen.
   *
   * @param screen a screen, of the same size in each call
   * @return the stack, a copy
   */
  public byte[] push(byte[] screen) {
    if (stack.length == 0) {
      stack = new byte[depth * screen.length];
    }
    System.arraycopy(stack, screen.length, stack, 0, stack.length - screen.length);
    System.arraycopy(screen, 0, stack, stack.length - screen.length, screen.length);
    return stack.clone();
  }
}

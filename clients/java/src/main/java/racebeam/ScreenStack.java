package racebeam;

import java.util.Arrays;

/**
 * A stack of screens that the client makes, as the server does for the field {@code grey84xN}: of the last, oldest first,
 * zeros where there was none. For {@code observe("grey84:delta")}, of which a reply has fewer bytes than of a stack.
 */
public final class ScreenStack {
  private final int depth;
  private byte[] stack = {};

  /**
   * An empty stack.
   *
   * @param depth screens
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
   * @param screen of the same size each time
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

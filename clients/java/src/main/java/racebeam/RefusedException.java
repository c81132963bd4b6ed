package racebeam;

/** The server refused a request: {@code error CODE sentence}. The session continues. */
public final class RefusedException extends RuntimeException {
  private static final long serialVersionUID = 1;

  /** For programs. */
  private final String code;

  RefusedException(String code, String sentence) {
    super(code + ": " + sentence);
    this.code = code;
  }

  /**
   * Returns the error code, which is for programs; the message is for people.
   *
   * @return a code of the protocol, such as {@code bad-action}
   */
  public String code() {
    return code;
  }
}

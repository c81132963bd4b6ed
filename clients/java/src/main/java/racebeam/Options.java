package racebeam;

import java.time.Duration;
import javax.net.ssl.SSLContext;

/**
 * How to connect.
 *
 * @param token the token for servers that require one, or null
 * @param timeout the longest wait for a connection and for each reply, on sockets; null for no limit
 * @param tls the context that decides which certificates are trusted; null for the JDK's default
 * @param longestReply the most bytes of a line of a reply; a longer one ends the session
 */
public record Options(String token, Duration timeout, SSLContext tls, int longestReply) {
  /** No token, no time limit, the default certificates, replies of at most 256 MiB. */
  public static final Options DEFAULT = new Options(null, null, null, 1 << 28);

  /**
   * Returns these options with a token.
   *
   * @param value the token
   * @return changed options
   */
  public Options withToken(String value) {
    return new Options(value, timeout, tls, longestReply);
  }

  /**
   * Returns these options with a time limit.
   *
   * @param value the limit, or null
   * @return changed options
   */
  public Options withTimeout(Duration value) {
    return new Options(token, value, tls, longestReply);
  }

  /**
   * Returns these options with another context for TLS.
   *
   * @param value the context that decides which certificates are trusted
   * @return changed options
   */
  public Options withTls(SSLContext value) {
    return new Options(token, timeout, value, longestReply);
  }

  /**
   * Returns these options with another limit of replies.
   *
   * @param value the most bytes of a line of a reply
   * @return changed options
   */
  public Options withLongestReply(int value) {
    return new Options(token, timeout, tls, value);
  }
}

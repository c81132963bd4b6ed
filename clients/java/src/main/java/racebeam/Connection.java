package racebeam;

import java.io.Closeable;
import java.io.IOException;
import java.io.InputStream;
import java.io.OutputStream;
import java.net.SocketTimeoutException;
import java.nio.charset.StandardCharsets;
import java.time.Duration;
import java.util.Arrays;

/** Lines to and from a server, and bytes that follow a line. */
final class Connection implements Closeable {
  /** A stream of bytes whose reads can be limited in time. */
  interface Source {
    /** As {@link InputStream#read(byte[], int, int)}; waits for at most {@code milliseconds}, or for ever if 0. */
    int read(byte[] data, int at, int length, int milliseconds) throws IOException;
  }

  private static final int LARGEST = Integer.MAX_VALUE - 8; // elements of an array

  private final Source source;
  private final OutputStream output;
  private final Closeable end;
  private final Duration timeout;
  private final int longest;
  private final String token;
  private byte[] data = new byte[1 << 16];
  private int begin;
  private int filled;
  private long start; // of the wait for a reply, by System.nanoTime()

  Connection(Source source, OutputStream output, Closeable end, Options options) {
    this.source = source;
    this.output = output;
    this.end = end;
    this.timeout = options.timeout();
    this.longest = options.longestReply();
    this.token = options.token();
  }

  /** Returns the token for the greeting: that of the caller, or of an announce file; or null. */
  String token() {
    return token;
  }

  void write(String line) throws IOException {
    output.write((line + "\n").getBytes(StandardCharsets.ISO_8859_1)); // in one write
    output.flush();
  }

  /** Reads the next line. Returns it without its end. */
  String readLine() throws IOException {
    start = System.nanoTime();
    int searched = begin;
    while (true) {
      for (; searched < filled; ++searched) {
        if (data[searched] == '\n') {
          String line = new String(data, begin, searched - begin, StandardCharsets.ISO_8859_1);
          begin = searched + 1;
          return line;
        }
      }
      searched -= readMore();
    }
  }

  /** Reads the next bytes, which follow a line. The time limit is that of the line. */
  byte[] readBytes(int count) throws IOException {
    if (count > longest) {
      throw tooLong();
    }
    while (filled - begin < count) {
      readMore();
    }
    byte[] bytes = Arrays.copyOfRange(data, begin, begin + count);
    begin += count;
    return bytes;
  }

  /** Reads what arrives next. Returns by how much {@code begin} and {@code filled} were moved to the front. */
  private int readMore() throws IOException {
    int moved = makeRoom();
    int read = source.read(data, filled, data.length - filled, remaining());
    if (read < 0) {
      throw new IOException("the server has closed the connection");
    }
    filled += read;
    return moved;
  }

  private IOException tooLong() {
    return new IOException("the reply of the server is longer than " + longest + " bytes");
  }

  /** Makes room behind what was read. Returns by how much that was moved to the front. */
  private int makeRoom() throws IOException {
    int moved = begin;
    if (filled - begin > longest || filled - begin == LARGEST) {
      throw tooLong();
    }
    if (begin > 0) {
      System.arraycopy(data, begin, data, 0, filled - begin);
      filled -= begin;
      begin = 0;
    }
    if (filled == data.length) {
      grow();
    }
    return moved;
  }

  private void grow() throws IOException {
    try {
      data = Arrays.copyOf(data, (int) Math.min(2L * data.length, Math.min(longest + 1L, LARGEST)));
    } catch (OutOfMemoryError full) {
      throw new IOException("out of memory for a reply of more than " + data.length + " bytes", full);
    }
  }

  private int remaining() throws SocketTimeoutException {
    if (timeout == null) {
      return 0;
    }
    long milliseconds = timeout.toMillis() - (System.nanoTime() - start) / 1_000_000;
    if (milliseconds <= 0) {
      throw new SocketTimeoutException("the server did not answer in " + timeout);
    }
    return (int) Math.min(milliseconds, Integer.MAX_VALUE);
  }

  @Override
  public void close() throws IOException {
    end.close();
  }
}

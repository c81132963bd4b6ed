package racebeam;

import java.io.Closeable;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Deque;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.regex.Pattern;

/** Requests over a connection, and their replies, in order. Threads may share it. */
final class Exchange implements Closeable {
  private static final Pattern NOT_SHOWN = Pattern.compile("[^ -~]");
  /** Bytes of requests without a reply. A server that cannot send its replies stops reading, so this must fit in its pipe. */
  private static final int MOST_AHEAD = 1 << 15;

  private record Outcome(Reply reply, RefusedException refusal) {
    Reply get() {
      if (refusal != null) {
        throw refusal;
      }
      return reply;
    }
  }

  private final Connection connection;
  private final Fields fields = new Fields();
  private final Deque<String> unanswered = new ArrayDeque<>();
  private final Deque<Outcome> arrived = new ArrayDeque<>(); // replies that were read to make room for a request
  private int ahead; // bytes of `unanswered`
  private volatile boolean closed;

  Exchange(Connection connection) {
    this.connection = connection;
  }

  /** Ends the session. Further calls do nothing. */
  @Override
  public void close() {
    if (!closed) {
      closed = true;
      try {
        connection.close();
      } catch (IOException ignored) {
        return; // what was not sent cannot be
      }
    }
  }

  /** Sends a request, and returns its reply. Replies of requests that were sent ahead stay to be received. */
  synchronized Reply request(String line) throws IOException {
    send(line);
    while (unanswered.size() > 1) {
      arrived.add(outcome());
    }
    return outcome().get();
  }

  /** Sends a request without waiting for its reply. */
  synchronized void send(String line) throws IOException {
    if (line.indexOf('\n') >= 0 || line.stripLeading().startsWith("#")) {
      throw new IllegalArgumentException("a request is one line, and no comment: '" + line + "'");
    }
    while (ahead > 0 && ahead + line.length() > MOST_AHEAD) {
      arrived.add(outcome());
    }
    if (closed) {
      throw new IOException("the session has ended");
    }
    unanswered.add(line);
    ahead += line.length();
    try {
      connection.write(line);
    } catch (IOException ignored) {
      return; // the server may have said why it ends, before it did: outcome() reads that
    }
  }

  /** Receives the next reply to a request that was sent ahead. */
  synchronized Reply receive() throws IOException {
    return (arrived.isEmpty() ? outcome() : arrived.remove()).get();
  }

  private Outcome outcome() throws IOException {
    if (closed) {
      throw new IOException("the session has ended");
    }
    try {
      String line = connection.readLine();
      String request = unanswered.isEmpty() ? "" : unanswered.remove(); // without one, the server says why it ends
      ahead -= request.length();
      if (line.startsWith("error ")) {
        String[] parts = line.split(" ", 3);
        return new Outcome(null, new RefusedException(parts[1], parts.length > 2 ? parts[2] : ""));
      }
      if (!line.equals("ok") && !line.startsWith("ok ")) {
        throw new IOException("the server sent an invalid reply: '" + printable(line.substring(0, Math.min(60, line.length()))) + "'");
      }
      List<Map<String, String>> groups = groups(line);
      ByteBuffer raw = ByteBuffer.wrap(connection.readBytes(takeRaw(groups)));
      return new Outcome(new Reply(fields.decode(List.of(request.strip().split(" +")), groups, raw), line), null);
    } catch (IOException failure) {
      refuseIfClosed(failure);
      close(); // half a reply may have been read
      throw failure;
    } catch (RuntimeException damaged) {
      refuseIfClosed(damaged);
      close();
      throw new IOException("a reply of the server is damaged: " + printable(damaged.getMessage()), damaged);
    }
  }

  /** What a read of a connection says that another thread closes depends on the kind of connection. */
  private void refuseIfClosed(Exception failure) throws IOException {
    if (closed) {
      throw new IOException("another thread has closed the session", failure);
    }
  }

  /** What a server sent, for people: a terminal would execute some of its characters. */
  private static String printable(String text) {
    return text == null ? "" : NOT_SHOWN.matcher(text).replaceAll(found -> String.format("\\\\x%02x", (int) found.group().charAt(0)));
  }

  private static List<Map<String, String>> groups(String line) {
    List<Map<String, String>> groups = new ArrayList<>();
    groups.add(new LinkedHashMap<>());
    for (int at = 2; at < line.length(); ) {
      int end = line.indexOf(' ', at + 1);
      String word = line.substring(at + 1, end < 0 ? line.length() : end);
      int equals = word.indexOf('=');
      if (word.equals("|")) {
        groups.add(new LinkedHashMap<>());
      } else if (equals >= 0) {
        groups.get(groups.size() - 1).put(word.substring(0, equals), word.substring(equals + 1));
      }
      at = end < 0 ? line.length() : end;
    }
    return groups;
  }

  /** Returns how many bytes follow the line, and removes the pair that says so. */
  private static int takeRaw(List<Map<String, String>> groups) {
    String raw = groups.get(groups.size() - 1).remove("raw");
    int count = raw == null ? 0 : Integer.parseInt(raw);
    if (count < 0) {
      throw new IllegalArgumentException(count + " bytes follow its line");
    }
    return count;
  }
}

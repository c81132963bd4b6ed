package racebeam;

import static org.junit.jupiter.api.Assertions.assertArrayEquals;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTimeoutPreemptively;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.net.ServerSocket;
import java.net.Socket;
import java.net.SocketTimeoutException;
import java.net.StandardProtocolFamily;
import java.net.UnixDomainSocketAddress;
import java.nio.ByteBuffer;
import java.nio.channels.ServerSocketChannel;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.time.Duration;
import java.util.Map;
import java.util.NoSuchElementException;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import java.util.function.Function;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.io.TempDir;

/** Servers that misbehave, and bad input of the caller. No server of racebeam is needed. */
class FaultsTest {
  private static final String HELLO = "ok server=test protocol=1\n";

  /** For replies that never come. The greeting has to come in time, though its classes are loaded first and the machine is busy. */
  private static final Duration TIMEOUT = Duration.ofSeconds(3);

  /** A server that answers each line as it is told; null closes the connection. */
  private static final class Server implements AutoCloseable {
    private final ServerSocket listener;

    Server(Function<String, String> answer) throws IOException {
      listener = new ServerSocket(0);
      Thread thread = new Thread(() -> serve(answer));
      thread.setDaemon(true);
      thread.start();
    }

    private void serve(Function<String, String> answer) {
      while (!listener.isClosed()) {
        try (Socket socket = listener.accept()) {
          var lines = new BufferedReader(new InputStreamReader(socket.getInputStream(), StandardCharsets.US_ASCII));
          for (String line; (line = lines.readLine()) != null; ) {
            String text = line.startsWith("hello") ? HELLO : answer.apply(line);
            if (text == null) {
              break;
            }
            socket.getOutputStream().write(text.getBytes(StandardCharsets.ISO_8859_1));
          }
        } catch (IOException ended) {
          continue;
        }
      }
    }

    Session connect(Options options) throws IOException {
      return Racebeam.connect("tcp://127.0.0.1:" + listener.getLocalPort(), options);
    }

    @Override
    public void close() throws IOException {
      listener.close();
    }
  }

  private static void endsWith(Class<? extends IOException> kind, String answer) throws IOException {
    try (Server server = new Server(line -> answer);
        Session session = server.connect(Options.DEFAULT.withTimeout(TIMEOUT).withLongestReply(1 << 16))) {
      assertTimeoutPreemptively(Duration.ofSeconds(20), () -> {
        assertThrows(kind, () -> session.request("act FIRE"));
        assertThrows(IOException.class, () -> session.request("act FIRE"), "the session has ended");
      });
    }
  }

  @Test
  void whatIsNoReplyEndsTheSession() throws IOException {
    endsWith(IOException.class, null);
    endsWith(IOException.class, "220 mail.example.org\n");
    endsWith(IOException.class, "\u00ff\u0080\n");
    endsWith(IOException.class, "ok a=" + "0".repeat(1 << 17));
    endsWith(SocketTimeoutException.class, "ok half a line");
    endsWith(SocketTimeoutException.class, "");
  }

  @Test
  void whatIsNoReplyIsQuotedForATerminal() throws IOException {
    try (Server server = new Server(line -> "\u001b[31mred\u00ff\n"); Session session = server.connect(Options.DEFAULT)) {
      IOException lost = assertThrows(IOException.class, () -> session.request("act FIRE"));
      assertEquals("the server sent an invalid reply: '\\x1b[31mred\\xff'", lost.getMessage());
    }
  }

  @Test
  void aReplyGrowsToTheLimitAtMost() {
    int[] largest = {0};
    Connection.Source endless = (data, at, length, limit) -> {
      largest[0] = Math.max(largest[0], data.length);
      return length;
    };
    Connection connection = new Connection(endless, null, () -> {}, Options.DEFAULT.withLongestReply(100_000));
    assertThrows(IOException.class, connection::readLine);
    assertEquals(100_001, largest[0]);
  }

  /** A client in its own process. */
  static final class InLittleMemory {
    public static void main(String[] arguments) throws Exception {
      try (Session session = Racebeam.connect(arguments[0])) {
        session.request("act FIRE");
      } catch (IOException lost) {
        System.out.println(lost.getMessage());
      }
    }
  }

  @Test
  void aReplyThatMemoryDoesNotHoldEndsTheSession() throws Exception {
    String classes = Path.of(Session.class.getProtectionDomain().getCodeSource().getLocation().toURI())
        + java.io.File.pathSeparator + Path.of(FaultsTest.class.getProtectionDomain().getCodeSource().getLocation().toURI());
    try (Server server = new Server(line -> "0".repeat(1 << 25))) {
      Process client = new ProcessBuilder(Path.of(System.getProperty("java.home"), "bin", "java").toString(), "-Xmx32m", "-cp",
          classes, InLittleMemory.class.getName(), "tcp://127.0.0.1:" + server.listener.getLocalPort()).redirectErrorStream(true).start();
      String printed = new String(client.getInputStream().readAllBytes(), StandardCharsets.UTF_8);
      assertTrue(printed.startsWith("out of memory for a reply of more than "), printed);
      assertEquals(0, client.waitFor());
    }
  }

  private static String refusal(String address) {
    return assertThrows(IllegalArgumentException.class, () -> Racebeam.connect(address), address).getMessage();
  }

  @Test
  void aFileThatNamesNoServerIsRefusedInASentence(@TempDir Path folder) throws IOException {
    String tail = "; file:PATH takes the --ready-file or --announce file of a server";
    Path file = folder.resolve("file");
    Files.writeString(file, "");
    assertEquals(file + " is empty" + tail, refusal("file:" + file));
    Files.writeString(file, "dear diary\n");
    assertEquals(file + " has other contents" + tail, refusal("file:" + file));
    Files.write(file, new byte[] {'{', 0, -1, -128, '\n'});
    assertEquals(file + " is not a whole announce file", refusal("file:" + file));
    assertEquals(folder + " is not a regular file" + tail, refusal("file:" + folder));
    for (String time : new String[] {"", "x", "-1", "1e3", "99999999999999999999"}) {
      assertTrue(refusal("file:" + file + "?wait=" + time).endsWith("; ?wait= takes seconds, from 0 to 999999999"), time);
    }
    Files.writeString(file, "# addresses\nunix:" + folder.resolve("nothing") + "\n");
    String lost = assertThrows(IOException.class, () -> Racebeam.connect("file:" + file)).getMessage();
    assertTrue(lost.startsWith("no server answers at unix:" + folder.resolve("nothing") + ": "), lost);
    assertTrue(lost.endsWith(" (" + file + " names this address)"), lost);
  }

  @Test
  void anErrorInAPipelineLeavesTheOthers() throws IOException {
    try (Server server = new Server(line -> line.equals("bad") ? "error bad-action it is\n" : "ok n=" + line + "\n");
        Session session = server.connect(Options.DEFAULT)) {
      for (String line : new String[] {"1", "bad", "2"}) {
        session.send(line);
      }
      assertEquals(3, session.request("3").first().number("n")); // its own reply, though others wait
      assertEquals(1, session.receive().first().number("n"));
      RefusedException refused = assertThrows(RefusedException.class, session::receive);
      assertEquals("bad-action", refused.code());
      assertEquals(2, session.receive().first().number("n"));
    }
  }

  @Test
  void bytesAfterALineMayComeInAnyPieces() throws IOException {
    Map<String, String> pieces = Map.of("1", "ok ram=4 ra", "2", "w=4\n\n\u0001", "3", "\n\u00ffok ram=1 raw=1\n", "4", "\u0007ok\n");
    try (Server server = new Server(line -> pieces.getOrDefault(line, "ok fields=ram\n"));
        Session session = server.connect(Options.DEFAULT)) {
      session.observe("ram:raw");
      for (String line : new String[] {"1", "2", "3", "4"}) {
        session.send(line);
      }
      Group first = session.receive().first();
      assertArrayEquals(new byte[] {10, 1, 10, -1}, first.bytes("ram"));
      assertFalse(first.has("raw"));
      assertArrayEquals(new byte[] {7}, session.receive().first().bytes("ram"));
      assertEquals("ok", session.receive().line());
    }
  }

  @Test
  void bytesThatDoNotFitTheirFieldsEndTheSession() throws IOException {
    for (String answer : new String[] {"ok ram=3 raw=2\n12", "ok ram=1 raw=2\n12", "ok ram=-1 raw=1\n1", "ok ram=x raw=1\n1", "ok raw=-1\n"}) {
      try (Server server = new Server(line -> line.equals("act FIRE") ? answer : "ok fields=ram\n");
          Session session = server.connect(Options.DEFAULT)) {
        session.observe("ram:raw");
        assertThrows(IOException.class, () -> session.act("FIRE"), answer);
        assertThrows(IOException.class, () -> session.act("FIRE"), "the session has ended");
      }
    }
  }

  @Test
  void anyNumberOfRequestsCanBeSentAhead() throws IOException {
    String reply = "ok a=" + "0".repeat(10_000) + "\n"; // in all 200 MB, more than all buffers hold
    try (Server server = new Server(line -> reply); Session session = server.connect(Options.DEFAULT)) {
      assertTimeoutPreemptively(Duration.ofSeconds(60), () -> {
        for (int n = 0; n < 20_000; ++n) {
          session.send("act " + n);
        }
        for (int n = 0; n < 20_000; ++n) {
          session.receive();
        }
      });
    }
  }

  @Test
  void threadsGetTheirOwnReplies() throws Exception {
    try (Server server = new Server(line -> "ok n=" + line + "\n"); Session session = server.connect(Options.DEFAULT)) {
      CompletableFuture<?>[] threads = new CompletableFuture<?>[2];
      for (int thread = 0; thread < threads.length; ++thread) {
        int first = 100_000 * thread;
        threads[thread] = CompletableFuture.runAsync(() -> {
          for (int n = first; n < first + 500; ++n) {
            try {
              assertEquals(n, session.request("" + n).first().number("n"));
            } catch (IOException failure) {
              throw new AssertionError(failure);
            }
          }
        });
      }
      CompletableFuture.allOf(threads).get();
    }
  }

  private static void closeWhileItWaits(Session session) throws Exception {
    CompletableFuture<IOException> waiting = CompletableFuture.supplyAsync(
        () -> assertThrows(IOException.class, () -> session.request("act FIRE")));
    Thread.sleep(100);
    session.close();
    assertEquals("another thread has closed the session", waiting.get(20, TimeUnit.SECONDS).getMessage());
    assertEquals("the session has ended", assertThrows(IOException.class, () -> session.request("act FIRE")).getMessage());
  }

  @Test
  void closingWakesAThreadThatWaits() throws Exception {
    for (Options options : new Options[] {Options.DEFAULT, Options.DEFAULT.withTimeout(Duration.ofSeconds(60))}) {
      try (Server server = new Server(line -> ""); Session session = server.connect(options)) {
        closeWhileItWaits(session);
      }
    }
  }

  /** A server on a Unix socket that sends the greeting, and nothing more. */
  private static ServerSocketChannel silent(Path path) throws IOException {
    var listener = ServerSocketChannel.open(StandardProtocolFamily.UNIX).bind(UnixDomainSocketAddress.of(path));
    CompletableFuture.runAsync(() -> {
      try (var channel = listener.accept()) {
        channel.write(ByteBuffer.wrap(HELLO.getBytes(StandardCharsets.US_ASCII)));
        while (channel.read(ByteBuffer.allocate(100)) >= 0) {
          continue;
        }
      } catch (IOException ended) {
        return;
      }
    });
    return listener;
  }

  @Test
  void closingWakesAThreadThatWaitsForAUnixSocket(@TempDir Path folder) throws Exception {
    for (Options options : new Options[] {Options.DEFAULT.withTimeout(null), Options.DEFAULT.withTimeout(Duration.ofSeconds(60))}) {
      Path path = folder.resolve("socket" + options.timeout());
      try (var listener = silent(path); Session session = Racebeam.connect("unix:" + path, options)) {
        closeWhileItWaits(session);
      }
    }
  }

  @Test
  void aThreadThatIsInterruptedIsNotToldThatTheServerIsLate(@TempDir Path folder) throws Exception {
    Path path = folder.resolve("socket");
    try (var listener = silent(path);
        Session session = Racebeam.connect("unix:" + path, Options.DEFAULT.withTimeout(Duration.ofSeconds(60)))) {
      Thread.currentThread().interrupt();
      IOException failure = assertThrows(IOException.class, () -> session.request("act FIRE"));
      assertTrue(Thread.interrupted());
      assertEquals("interrupted while waiting for the server", failure.getMessage());
    }
  }

  @Test
  void aUnixSocketHasATimeLimit(@TempDir Path folder) throws IOException {
    Path path = folder.resolve("socket");
    try (var listener = silent(path); Session session = Racebeam.connect("unix:" + path, Options.DEFAULT.withTimeout(TIMEOUT))) {
      assertThrows(SocketTimeoutException.class, () -> session.request("act FIRE"));
    }
    assertThrows(IOException.class, () -> Racebeam.connect("unix:" + folder.resolve("nothing")));
  }

  @Test
  void theCallersWordsAreChecked(@TempDir Path folder) throws IOException {
    for (String address : new String[] {"", "nonsense", "tcp://host", "tcp://host:99999", "unix:", "http://host:1"}) {
      assertThrows(IllegalArgumentException.class, () -> Racebeam.connect(address), address);
    }
    Path ready = folder.resolve("ready");
    Files.writeString(ready, "# addresses\nclassic+unix:x\n");
    assertThrows(IllegalArgumentException.class, () -> Racebeam.connect("file:" + ready));
    assertThrows(IOException.class, () -> Racebeam.connect("file:" + folder.resolve("nothing")));
    assertThrows(IOException.class, () -> Racebeam.launchProgram("/nonexistent/racebeam"));
    try (Server server = new Server(line -> "ok\n"); Session session = server.connect(Options.DEFAULT)) {
      assertThrows(IllegalArgumentException.class, () -> session.request("act\nact"));
      assertThrows(IllegalArgumentException.class, () -> session.request("# a comment"));
      NoSuchElementException missing = assertThrows(NoSuchElementException.class, () -> session.act("FIRE").reward());
      assertTrue(missing.getMessage().contains("reward"));
    }
  }
}

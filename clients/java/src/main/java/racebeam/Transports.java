package racebeam;

import java.io.FileInputStream;
import java.io.FileOutputStream;
import java.io.IOException;
import java.io.InputStream;
import java.io.InterruptedIOException;
import java.io.OutputStream;
import java.net.InetSocketAddress;
import java.net.Socket;
import java.net.SocketTimeoutException;
import java.net.StandardProtocolFamily;
import java.net.UnixDomainSocketAddress;
import java.nio.ByteBuffer;
import java.nio.channels.AsynchronousCloseException;
import java.nio.channels.Channels;
import java.nio.channels.ClosedSelectorException;
import java.nio.channels.SelectionKey;
import java.nio.channels.Selector;
import java.nio.channels.SocketChannel;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.security.NoSuchAlgorithmException;
import java.time.Duration;
import java.util.List;
import java.util.concurrent.TimeUnit;
import java.util.regex.Matcher;
import java.util.regex.Pattern;
import javax.net.ssl.SSLContext;
import javax.net.ssl.SSLParameters;
import javax.net.ssl.SSLSocket;

/** Opens connections. */
final class Transports {
  private static final Pattern NETWORK = Pattern.compile("(tcp|tls)://\\[?(.+?)]?:([0-9]{1,5})");
  private static final Pattern FILE = Pattern.compile("file:(.+?)(?:\\?wait=(.*))?", Pattern.DOTALL);
  private static final Pattern SECONDS = Pattern.compile("[0-9]{1,9}(\\.[0-9]+)?");
  private static final String FILES = "; file:PATH takes the --ready-file or --announce file of a server";
  private static final long RETRY_MILLISECONDS = 50;
  private static final Pattern USABLE = Pattern.compile("(tcp:|tls:|unix:|pipes:).*");
  private static final int SECONDS_TO_END = 10; // for its own server

  private Transports() {}

  static Connection open(String address, Options options) throws IOException {
    Matcher network = NETWORK.matcher(address);
    if (network.matches() && Integer.parseInt(network.group(3)) < 65536) {
      boolean tls = network.group(1).equals("tls");
      return openAt(address, () -> network(tls, network.group(2), Integer.parseInt(network.group(3)), options));
    }
    Matcher file = FILE.matcher(address);
    if (file.matches()) {
      String seconds = file.group(2) == null ? "0" : file.group(2);
      if (!SECONDS.matcher(seconds).matches()) {
        throw new IllegalArgumentException("the address is '" + address + "'; ?wait= takes seconds, from 0 to 999999999");
      }
      return openFile(Path.of(file.group(1)), Double.parseDouble(seconds), options);
    }
    if (address.equals("stdio")) {
      return new Connection(untimed(System.in), System.out, () -> {}, options);
    }
    int colon = address.indexOf(':') + 1;
    String rest = address.substring(colon);
    String kind = rest.isEmpty() ? "" : address.substring(0, colon);
    return switch (kind) {
      case "unix:" -> openAt(address, () -> unix(rest, options));
      case "pipes:" -> pipes(rest, options);
      default -> throw new IllegalArgumentException((address.isEmpty()
          ? "no address was given, and the variable RACEBEAM_ADDRESS is not set" : "the address is '" + address + "'")
          + "; it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, also in RACEBEAM_ADDRESS");
    };
  }

  /** Opens a connection, or fails. */
  private interface Opener {
    Connection open() throws IOException;
  }

  /** Opens a connection. A failure says at which address. */
  private static Connection openAt(String address, Opener opener) throws IOException {
    return openOrExplain("no server answers at " + address + ": ", opener, "");
  }

  /** Opens a connection. A failure has a text before and after its message, except when the time was over. */
  private static Connection openOrExplain(String before, Opener opener, String after) throws IOException {
    try {
      return opener.open();
    } catch (SocketTimeoutException late) {
      throw late;
    } catch (IOException failure) {
      throw new IOException(before + failure.getMessage() + after, failure);
    }
  }

  /** A connection to the server that a file names. Waits for both, for a limited time. */
  private static Connection openFile(Path path, double seconds, Options options) throws IOException {
    long until = System.nanoTime() + (long) (seconds * 1e9);
    while (true) {
      try {
        List<String> lines = linesOf(path);
        boolean isAnnounced = lines.get(0).startsWith("{");
        Announcement announced = isAnnounced ? Announcement.of(path, lines) : new Announcement(lines, null);
        String address = announced.addresses().stream().filter(line -> USABLE.matcher(line).matches()).findFirst().orElseThrow(
            () -> new IllegalArgumentException(isAnnounced || lines.get(0).startsWith("#")
                ? path + " names no address that this client can use" : path + " has other contents" + FILES));
        Options admitted = options.token() == null ? options.withToken(announced.token()) : options;
        return openOrExplain("", () -> open(address, admitted), " (" + path + " names this address)");
      } catch (IOException failure) {
        if (System.nanoTime() >= until) {
          throw failure;
        }
      }
      pause();
    }
  }

  /** Reads the lines of a file, at least one. A pipe might block, and is refused. */
  private static List<String> linesOf(Path path) throws IOException {
    if (Files.exists(path) && !Files.isRegularFile(path)) {
      throw new IllegalArgumentException(path + " is not a regular file" + FILES);
    }
    List<String> lines = new String(Files.readAllBytes(path), StandardCharsets.UTF_8).lines().toList();
    if (lines.isEmpty()) {
      throw new IllegalArgumentException(path + " is empty" + FILES);
    }
    return lines;
  }

  private static void pause() throws IOException {
    try {
      Thread.sleep(RETRY_MILLISECONDS);
    } catch (InterruptedException interrupted) {
      Thread.currentThread().interrupt();
      throw new InterruptedIOException("interrupted while waiting for a server");
    }
  }

  private static int milliseconds(Duration timeout) {
    return timeout == null ? 0 : (int) Math.max(1, Math.min(timeout.toMillis(), Integer.MAX_VALUE));
  }

  private static Connection network(boolean tls, String host, int port, Options options) throws IOException {
    Socket plain = new Socket();
    try {
      plain.connect(new InetSocketAddress(host, port), milliseconds(options.timeout()));
      plain.setTcpNoDelay(true);
      Socket socket = tls ? secure(plain, host, port, options) : plain;
      InputStream input = socket.getInputStream();
      Connection.Source source = (data, at, length, limit) -> {
        socket.setSoTimeout(limit);
        return input.read(data, at, length);
      };
      return new Connection(source, socket.getOutputStream(), socket, options);
    } catch (IOException | RuntimeException failure) {
      plain.close();
      throw failure;
    }
  }

  private static Socket secure(Socket plain, String host, int port, Options options) throws IOException {
    try {
      SSLContext context = options.tls() != null ? options.tls() : SSLContext.getDefault();
      SSLSocket socket = (SSLSocket) context.getSocketFactory().createSocket(plain, host, port, true);
      SSLParameters parameters = socket.getSSLParameters();
      parameters.setEndpointIdentificationAlgorithm("HTTPS"); // the certificate must be that of the host
      socket.setSSLParameters(parameters);
      socket.setSoTimeout(milliseconds(options.timeout()));
      socket.startHandshake();
      return socket;
    } catch (NoSuchAlgorithmException failure) {
      throw new IOException(failure);
    }
  }

  private static Connection unix(String path, Options options) throws IOException {
    SocketChannel channel = SocketChannel.open(StandardProtocolFamily.UNIX);
    try {
      channel.connect(UnixDomainSocketAddress.of(path));
      if (options.timeout() == null) {
        return new Connection(untimed(Channels.newInputStream(channel)), Channels.newOutputStream(channel), channel, options);
      }
      return timed(channel, options);
    } catch (IOException | RuntimeException failure) {
      channel.close();
      throw failure;
    }
  }

  /** A channel has no time limits; a selector has. Writes block, since a limited amount is sent ahead. */
  private static Connection timed(SocketChannel channel, Options options) throws IOException {
    channel.configureBlocking(false);
    Selector readable = Selector.open();
    Selector writable = Selector.open();
    channel.register(readable, SelectionKey.OP_READ);
    channel.register(writable, SelectionKey.OP_WRITE);
    Connection.Source source = (data, at, length, limit) -> {
      int read;
      while ((read = channel.read(ByteBuffer.wrap(data, at, length))) == 0) {
        await(channel, readable, limit);
      }
      return read;
    };
    var output = new OutputStream() {
      @Override
      public void write(int value) throws IOException {
        write(new byte[] {(byte) value}, 0, 1);
      }

      @Override
      public void write(byte[] data, int at, int length) throws IOException {
        ByteBuffer rest = ByteBuffer.wrap(data, at, length);
        while (channel.write(rest) == 0 || rest.hasRemaining()) {
          await(channel, writable, milliseconds(options.timeout()));
        }
      }
    };
    return new Connection(source, output, () -> {
      channel.close();
      readable.close();
      writable.close();
    }, options);
  }

  /** Another thread that closes the channel, or interrupts this one, wakes the selector, too. */
  private static void await(SocketChannel channel, Selector selector, int limit) throws IOException {
    try {
      int ready = selector.select(limit);
      if (Thread.interrupted()) {
        Thread.currentThread().interrupt();
        throw new InterruptedIOException("interrupted while waiting for the server");
      }
      if (!channel.isOpen()) {
        throw new AsynchronousCloseException();
      }
      if (ready == 0) {
        throw new SocketTimeoutException("the server did not answer in time");
      }
      selector.selectedKeys().clear();
    } catch (ClosedSelectorException closed) {
      throw (IOException) new AsynchronousCloseException().initCause(closed);
    }
  }

  private static Connection pipes(String prefix, Options options) throws IOException {
    FileInputStream input = new FileInputStream(prefix + "_out"); // in this order, as the server opens them
    try {
      FileOutputStream output = new FileOutputStream(prefix + "_in");
      return new Connection(untimed(input), output, () -> {
        output.close();
        input.close();
      }, options);
    } catch (IOException failure) {
      input.close();
      throw failure;
    }
  }

  /** A process that speaks the protocol on its standard streams. It ends when its input does. */
  static Connection process(List<String> command, Options options) throws IOException {
    Process process = new ProcessBuilder(command).redirectError(ProcessBuilder.Redirect.INHERIT).start();
    return new Connection(untimed(process.getInputStream()), process.getOutputStream(), () -> end(process), options);
  }

  private static void end(Process process) throws IOException {
    try {
      process.getOutputStream().close();
      if (!process.waitFor(SECONDS_TO_END, TimeUnit.SECONDS)) {
        process.destroyForcibly();
      }
    } catch (InterruptedException interrupted) {
      process.destroyForcibly();
      Thread.currentThread().interrupt();
    } finally {
      process.getInputStream().close();
    }
  }

  private static Connection.Source untimed(InputStream input) {
    return (data, at, length, limit) -> input.read(data, at, length);
  }
}

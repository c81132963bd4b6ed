package racebeam;

import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;

/** Opens sessions. */
public final class Racebeam {
  /** The version of the protocol that this client speaks. */
  public static final int PROTOCOL = 1;

  private Racebeam() {}

  /**
   * Opens a session with the server at the address in the environment variable RACEBEAM_ADDRESS.
   *
   * @return the session
   * @throws IOException if no server answers there
   */
  public static Session connect() throws IOException {
    return connect(System.getenv().getOrDefault("RACEBEAM_ADDRESS", ""));
  }

  /**
   * Opens a session with the server at an address.
   *
   * @param address {@code tcp://HOST:PORT}, {@code tls://HOST:PORT}, {@code unix:PATH}, {@code pipes:PREFIX} (named pipes),
   *     {@code stdio} (the streams of this process), or {@code file:PATH} (the first address in the server's ready file or
   *     announce file, with the token of the latter; {@code file:PATH?wait=SECONDS} waits for the server)
   * @return the session
   * @throws IOException if no server answers there
   * @throws IllegalArgumentException if the address has another form
   */
  public static Session connect(String address) throws IOException {
    return connect(address, Options.DEFAULT);
  }

  /**
   * Opens a session with the server at an address.
   *
   * @param address an address, as {@link #connect(String)} takes it
   * @param options token, time limit, certificates
   * @return the session
   * @throws IOException if no server answers there, or its certificate is not trusted
   * @throws RefusedException if the server refuses the token, or is full
   */
  public static Session connect(String address, Options options) throws IOException {
    Connection connection = Transports.open(address, options);
    Session session = new Session(connection);
    try {
      Group hello = connection.token() == null ? session.hello() : session.hello(connection.token());
      if (!hello.has("protocol") || hello.number("protocol") != PROTOCOL) {
        throw new IOException(address + " speaks another version of the protocol; this client speaks " + PROTOCOL);
      }
      return session;
    } catch (IOException | RuntimeException failure) {
      session.close();
      throw failure;
    }
  }

  /**
   * Starts a server, and opens a session with it. The server stops when the session ends. The program is that of the
   * environment variable RACEBEAM_PROGRAM, or else {@code racebeam} of the PATH.
   *
   * @param options options of {@code racebeam serve}, such as "--roms", DIR
   * @return the session
   * @throws IOException if the program does not start
   */
  public static Session launch(String... options) throws IOException {
    return launchProgram(System.getenv().getOrDefault("RACEBEAM_PROGRAM", "racebeam"), options);
  }

  /**
   * Starts a server, and opens a session with it. The server stops when the session ends.
   *
   * @param program the path of the program racebeam
   * @param options options of {@code racebeam serve}
   * @return the session
   * @throws IOException if the program does not start
   */
  public static Session launchProgram(String program, String... options) throws IOException {
    List<String> command = new ArrayList<>(List.of(program, "serve", "--stdio"));
    if (!List.of(options).contains("--log-level")) {
      command.addAll(List.of("--log-level", "warning"));
    }
    command.addAll(List.of(options));
    return new Session(Transports.process(command, Options.DEFAULT));
  }

  /** {@code KEY=VALUE} for each entry, with a blank before it. */
  static String pairs(Map<String, ?> settings) {
    StringBuilder words = new StringBuilder();
    settings.forEach((key, value) -> words.append(' ').append(key).append('=').append(value));
    return words.toString();
  }
}

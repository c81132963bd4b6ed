package racebeam;

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Arrays;
import java.util.Base64;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.stream.Collectors;

/**
 * One session, with a method for each command. Threads may share it: each request gets its own reply.
 *
 * <p>Every method that asks throws {@link RefusedException} if the server refuses the request, and the session continues.
 * It throws {@link IOException} if the server has gone, does not answer in time, or sends an invalid reply. The session
 * has then ended.
 */
public final class Session extends Commands implements AutoCloseable {
  private final Exchange exchange;

  Session(Connection connection) {
    exchange = new Exchange(connection);
  }

  /** Ends the session. Further calls do nothing. */
  @Override
  public void close() {
    exchange.close();
  }

  @Override
  public Reply request(String line) throws IOException {
    return exchange.request(line);
  }

  /**
   * Sends a request without waiting for its reply.
   *
   * @param line the request, such as {@code act FIRE}
   * @throws IOException if the session has ended
   */
  public void send(String line) throws IOException {
    exchange.send(line);
  }

  /**
   * Receives the next reply to a request that was sent ahead.
   *
   * @return the reply
   * @throws IOException if the session has ended
   */
  public Reply receive() throws IOException {
    return exchange.receive();
  }

  private Group first(String line) throws IOException {
    return request(line).first();
  }

  // Commands that need more than their words

  /**
   * Describes a game.
   *
   * @param name the name of the game
   * @return what the server knows about the game
   * @throws IOException if the session has ended
   */
  public Group game(String name) throws IOException {
    return first("games " + name);
  }

  /**
   * Powers on and begins an episode, with default settings.
   *
   * @param game its name, or the MD5 of its image
   * @return the settings in effect
   * @throws IOException if the session has ended
   */
  public Group load(String game) throws IOException {
    return load(game, Map.of());
  }

  /**
   * Powers on and begins an episode.
   *
   * @param game its name, or the MD5 of its image
   * @param settings such as {@code Map.of("seed", 7, "preset", "dqn2015")}
   * @return the settings in effect
   * @throws IOException if the session has ended
   */
  public Group load(String game, Map<String, ?> settings) throws IOException {
    return first("load " + game + Racebeam.pairs(settings));
  }

  /**
   * Powers on with an image that the client sends, and begins an episode.
   *
   * @param image the bytes of a cartridge
   * @param settings the settings of {@link #load(String, Map)}, and {@code as}, which names the game whose rules apply
   * @return the settings in effect
   * @throws IOException if the session has ended
   */
  public Group load(byte[] image, Map<String, ?> settings) throws IOException {
    return first("load inline image=" + Base64.getEncoder().encodeToString(image) + Racebeam.pairs(settings));
  }

  /**
   * Names bytes of the fields ram and tia.
   *
   * @return ram_names: pairs of index and name; tia_names: the names in order
   * @throws IOException if the session has ended
   */
  public Group names() throws IOException {
    return first("names");
  }

  /**
   * Lists the actions that {@code act} accepts.
   *
   * @return their names by number
   * @throws IOException if the session has ended
   */
  public Map<Integer, String> actions() throws IOException {
    Map<Integer, String> actions = new LinkedHashMap<>();
    for (String pair : first("actions").list("actions")) {
      actions.put(Integer.valueOf(pair.substring(0, pair.indexOf(':'))), pair.substring(pair.indexOf(':') + 1));
    }
    return actions;
  }

  /**
   * Reads the colours of the field screen.
   *
   * @return the palette
   * @throws IOException if the session has ended
   */
  public Palette palette() throws IOException {
    return new Palette(look("palette").bytes("palette"));
  }

  /**
   * Plays an action.
   *
   * @param action the number of the action
   * @return the selected fields
   * @throws IOException if the session has ended
   */
  public Group act(int action) throws IOException {
    return first("act " + action);
  }

  /**
   * Reads bytes of RAM.
   *
   * @param index the index of the first byte, 0 to 127
   * @param count the number of bytes
   * @return the bytes
   * @throws IOException if the session has ended
   */
  public byte[] peek(int index, int count) throws IOException {
    return Encoding.HEX.decode(first("peek " + index + " " + count).text("bytes"));
  }

  /**
   * Writes bytes of RAM.
   *
   * @param index the index of the first byte, 0 to 127
   * @param bytes the bytes to write
   * @throws IOException if the session has ended
   */
  public void poke(int index, byte... bytes) throws IOException {
    StringBuilder hex = new StringBuilder();
    for (byte value : bytes) {
      hex.append(String.format("%02X", value));
    }
    request("poke " + index + " " + hex);
  }

  /**
   * Saves the state with the random generator.
   *
   * @param name a name for the state
   * @throws IOException if the session has ended
   */
  public void saveWithRandom(String name) throws IOException {
    request("save " + name + " generator=1");
  }

  /**
   * Exports a state, for later or for another process.
   *
   * @param name the name of the state
   * @return the bytes of the state
   * @throws IOException if the session has ended
   */
  public byte[] exportState(String name) throws IOException {
    return Encoding.BASE64.decode(first("export " + name).text("data"));
  }

  /**
   * Exports a state with the score, the progress of the episode and the stack of screens.
   *
   * @param name the name of the state
   * @return the bytes of the state
   * @throws IOException if the session has ended
   */
  public byte[] exportEpisode(String name) throws IOException {
    return Encoding.BASE64.decode(first("export " + name + " episode=1").text("data"));
  }

  /**
   * Saves a state that was exported.
   *
   * @param name a name for the state
   * @param state the bytes of the state
   * @throws IOException if the session has ended
   */
  public void importState(String name, byte[] state) throws IOException {
    request("import " + name + " " + Base64.getEncoder().encodeToString(state));
  }

  /**
   * Plays lists of actions from a state; the session itself does not change.
   *
   * @param state the name of the state
   * @param lists lists of actions
   * @return the result of each list
   * @throws IOException if the session has ended
   */
  public List<Branch> branch(String state, List<List<String>> lists) throws IOException {
    return branches("branch " + state, lists);
  }

  /**
   * Plays lists of actions from a state, and saves the states in which they end.
   *
   * @param state the name of the state
   * @param keep the prefix of the new names, which end in 0, 1 and so on
   * @param lists lists of actions
   * @return the result of each list
   * @throws IOException if the session has ended
   */
  public List<Branch> branch(String state, String keep, List<List<String>> lists) throws IOException {
    return branches("branch " + state + " keep=" + keep, lists);
  }

  private List<Branch> branches(String command, List<List<String>> lists) throws IOException {
    String line = lists.stream().map(list -> " " + String.join(",", list)).collect(Collectors.joining("", command, ""));
    return request(line).rest().stream().map(Branch::of).toList();
  }

  /**
   * Plays one act on each machine, with actions by their numbers.
   *
   * @param actions an action for each machine, or one for all
   * @return the selected fields of each machine
   * @throws IOException if the session has ended
   */
  public List<Group> step(int... actions) throws IOException {
    return step(Arrays.stream(actions).mapToObj(Integer::toString).toArray(String[]::new));
  }

  /**
   * Saves a picture of the screen as a PNG file.
   *
   * @param path the path of the file, on this computer
   * @throws IOException if the session has ended, or the file cannot be written
   */
  public void savePng(Path path) throws IOException {
    Files.write(path, Encoding.BASE64.decode(shot().text("data")));
  }

  /**
   * Saves a picture of the screen of one of the machines of {@code open} as a PNG file.
   *
   * @param path the path of the file, on this computer
   * @param machine the index of the machine, from 0
   * @throws IOException if the session has ended, or the file cannot be written
   */
  public void savePng(Path path, long machine) throws IOException {
    Files.write(path, Encoding.BASE64.decode(shot(machine).text("data")));
  }

  /**
   * Ends the recording.
   *
   * @return what was kept
   * @throws IOException if the session has ended
   */
  public Group stopRecording() throws IOException {
    return first("record stop");
  }

  /**
   * Explains a command, setting, field, preset, encoding or error code.
   *
   * @param word the word to explain, or nothing
   * @return a text for people
   * @throws IOException if the session has ended
   */
  public String help(String... word) throws IOException {
    return request("help" + words(word)).line().substring("ok ".length());
  }
}

// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
package racebeam;

import java.io.IOException;
import java.util.List;
import java.util.Map;

/** The commands whose methods only send their words. */
public abstract sealed class Commands permits Session {
  Commands() { }

  /**
   * Sends a request, and returns its reply. Replies of requests that were sent ahead stay to be received.
   *
   * @param line such as {@code act FIRE}
   * @return its reply
   * @throws IOException if the session has ended
   */
  public abstract Reply request(String line) throws IOException;

  static String words(String... words) {
    return words.length == 0 ? "" : " " + String.join(" ", words);
  }

  private static List<Integer> integers(List<String> texts) {
    return texts.stream().map(Integer::valueOf).toList();
  }

  /**
   * Greet the server; the reply has its name, version and limits.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group hello() throws IOException {
    return request("hello").first();
  }

  /**
   * Greet the server; the reply has its name, version and limits.
   *
   * @param token a token that the server accepts
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group hello(String token) throws IOException {
    return request("hello token=" + token).first();
  }

  /**
   * List the games whose image is here, or all known games; or describe one.
   *
   * @return the list games of the reply
   * @throws IOException if the session has ended
   */
  public List<String> games() throws IOException {
    return request("games").first().list("games");
  }

  /**
   * List the games whose image is here, or all known games; or describe one.
   *
   * @param which all for all known games, or the name of a game to describe
   * @return the list games of the reply
   * @throws IOException if the session has ended
   */
  public List<String> games(String which) throws IOException {
    return request("games " + which).first().list("games");
  }

  /**
   * Show the settings in effect.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group settings() throws IOException {
    return request("settings").first();
  }

  /**
   * Change the mode, from the next reset on, or the difficulty, at once.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group set() throws IOException {
    return request("set").first();
  }

  /**
   * Change the mode, from the next reset on, or the difficulty, at once.
   *
   * @param settings mode: a number that modes lists; difficulty: a number that difficulties lists
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group set(Map<String, ?> settings) throws IOException {
    return request("set" + Racebeam.pairs(settings)).first();
  }

  /**
   * List the game's modes.
   *
   * @return the list modes of the reply
   * @throws IOException if the session has ended
   */
  public List<Integer> modes() throws IOException {
    return integers(request("modes").first().list("modes"));
  }

  /**
   * List the game's difficulties.
   *
   * @return the list difficulties of the reply
   * @throws IOException if the session has ended
   */
  public List<Integer> difficulties() throws IOException {
    return integers(request("difficulties").first().list("difficulties"));
  }

  /**
   * Select the fields of replies.
   *
   * @param fields the fields, such as lives or screen:rle, or none; without them, the selection does not
   *     change
   * @return the list fields of the reply
   * @throws IOException if the session has ended
   */
  public List<String> observe(String... fields) throws IOException {
    return request("observe" + words(fields)).first().list("fields");
  }

  /**
   * Show these fields once; without fields, the selected ones.
   *
   * @param fields the fields, such as lives or screen:rle
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group look(String... fields) throws IOException {
    return request("look" + words(fields)).first();
  }

  /**
   * Play actions until the episode ends.
   *
   * @param actions names or numbers of actions, also with marks, such as RIGHT*10
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group act(String... actions) throws IOException {
    return request("act" + words(actions)).first();
  }

  /**
   * Begin an episode; with a seed, power on anew with it.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group reset() throws IOException {
    return request("reset").first();
  }

  /**
   * Begin an episode; with a seed, power on anew with it.
   *
   * @param seed the seed with which the console is powered on anew
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group reset(long seed) throws IOException {
    return request("reset seed=" + seed).first();
  }

  /**
   * Save the state; generator=1: with the random generator.
   *
   * @param name a name for the state
   * @throws IOException if the session has ended
   */
  public void save(String name) throws IOException {
    request("save " + name);
  }

  /**
   * Save the state; generator=1: with the random generator.
   *
   * @param name a name for the state
   * @param settings generator: 1: the state includes the random generator; machine: the index of a machine of
   *     open, from 0
   * @throws IOException if the session has ended
   */
  public void save(String name, Map<String, ?> settings) throws IOException {
    request("save " + name + Racebeam.pairs(settings));
  }

  /**
   * Restore a saved state.
   *
   * @param name the name of the state
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group restore(String name) throws IOException {
    return request("restore " + name).first();
  }

  /**
   * Restore a saved state.
   *
   * @param name the name of the state
   * @param machine the index of a machine of open, from 0
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group restore(String name, long machine) throws IOException {
    return request("restore " + name + " machine=" + machine).first();
  }

  /**
   * Delete states.
   *
   * @param names the names of the states, or all
   * @throws IOException if the session has ended
   */
  public void drop(String... names) throws IOException {
    request("drop" + words(names));
  }

  /**
   * List the names of the states.
   *
   * @return the list states of the reply
   * @throws IOException if the session has ended
   */
  public List<String> states() throws IOException {
    return request("states").first().list("states");
  }

  /**
   * Create N machines with the loaded game and settings; their seeds count up.
   *
   * @param count the number of machines
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> open(long count) throws IOException {
    return request("open " + count).rest();
  }

  /**
   * Create N machines with the loaded game and settings; their seeds count up.
   *
   * @param count the number of machines
   * @param settings autoreset: what happens at the end of an episode; steps: what a step is; start: how an
   *     episode begins; requires steps=frames; life_loss: what a lost life does; stack: what a stack of
   *     screens begins with; requires steps=frames; pool: which frames a stack shows; requires steps=frames
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> open(long count, Map<String, ?> settings) throws IOException {
    return request("open " + count + Racebeam.pairs(settings)).rest();
  }

  /**
   * Play one act on each machine: an action each, or one for all.
   *
   * @param actions an action for each machine, or one for all
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> step(String... actions) throws IOException {
    return request("step" + words(actions)).rest();
  }

  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   *
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> restart() throws IOException {
    return request("restart").rest();
  }

  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   *
   * @param seed the seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> restart(long seed) throws IOException {
    return request("restart seed=" + seed).rest();
  }

  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   *
   * @param mask a 0 or a 1 for each machine, such as 0110
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> restart(String mask) throws IOException {
    return request("restart " + mask).rest();
  }

  /**
   * Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.
   *
   * @param mask a 0 or a 1 for each machine, such as 0110
   * @param seed the seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> restart(String mask, long seed) throws IOException {
    return request("restart " + mask + " seed=" + seed).rest();
  }

  /**
   * Close the machines.
   *
   * @throws IOException if the session has ended
   */
  public void closeMachines() throws IOException {
    request("close");
  }

  /**
   * Record frames, sound or both into the server's folder.
   *
   * @param kinds the kinds of files, separated by commas, such as gif,wav
   * @param name a name for the files, without an extension
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group record(String kinds, String name) throws IOException {
    return request("record " + kinds + " " + name).first();
  }

  /**
   * Record frames, sound or both into the server's folder.
   *
   * @param kinds the kinds of files, separated by commas, such as gif,wav
   * @param name a name for the files, without an extension
   * @param machine the index of a machine of open, from 0
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group record(String kinds, String name, long machine) throws IOException {
    return request("record " + kinds + " " + name + " machine=" + machine).first();
  }

  /**
   * Log the episodes from the next reset on, so that anybody can verify them.
   *
   * @param name a name for the submission, or inline; last answers with the last log, and stop ends logging
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group log(String name) throws IOException {
    return request("log " + name).first();
  }

  /**
   * Log the episodes from the next reset on, so that anybody can verify them.
   *
   * @param name a name for the submission, or inline; last answers with the last log, and stop ends logging
   * @param settings agent: the agent's name (default: agent); version: the agent's version (default: 1);
   *     agent_seed: the agent's seed (default: 0); trial: the number of the trial (default: 1);
   *     training_frames: frames that the agent was trained on (default: 0); phrase: the phrase that the
   *     episodes' seeds follow from, with _ for a blank; role: what the agent is; link: a page about the
   *     agent; machine: the index of a machine of open, from 0
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group log(String name, Map<String, ?> settings) throws IOException {
    return request("log " + name + Racebeam.pairs(settings)).first();
  }

  /**
   * Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group shot() throws IOException {
    return request("shot").first();
  }

  /**
   * Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
   *
   * @param machine the index of a machine of open, from 0
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group shot(long machine) throws IOException {
    return request("shot machine=" + machine).first();
  }

  /**
   * Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
   *
   * @param name a name for the file, without .png
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group shot(String name) throws IOException {
    return request("shot " + name).first();
  }

  /**
   * Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.
   *
   * @param name a name for the file, without .png
   * @param machine the index of a machine of open, from 0
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group shot(String name, long machine) throws IOException {
    return request("shot " + name + " machine=" + machine).first();
  }

  /**
   * Let other sessions watch the game under this name.
   *
   * @param name a name for the shared session
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group share(String name) throws IOException {
    return request("share " + name).first();
  }

  /**
   * Let other sessions watch the game under this name.
   *
   * @param name a name for the shared session
   * @param watchers the most sessions that may watch at the same time
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group share(String name, long watchers) throws IOException {
    return request("share " + name + " watchers=" + watchers).first();
  }

  /**
   * Stop sharing the game.
   *
   * @throws IOException if the session has ended
   */
  public void unshare() throws IOException {
    request("unshare");
  }

  /**
   * List the shared sessions.
   *
   * @return the groups after the first
   * @throws IOException if the session has ended
   */
  public List<Group> shared() throws IOException {
    return request("shared").rest();
  }

  /**
   * Show the latest copy of a shared session.
   *
   * @param name the name of the shared session
   * @param fields fields among screen, ram and palette, such as screen:delta
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group watch(String name, String... fields) throws IOException {
    return request("watch " + name + words(fields)).first();
  }

  /**
   * Show the latest copy of a shared session.
   *
   * @param name the name of the shared session
   * @param since the frame of the last reply; the fields come only if there is a newer one
   * @param fields fields among screen, ram and palette, such as screen:delta
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group watch(String name, long since, String... fields) throws IOException {
    return request("watch " + name + " since=" + since + words(fields)).first();
  }

  /**
   * Show counters of this session.
   *
   * @return the first group of the reply
   * @throws IOException if the session has ended
   */
  public Group stats() throws IOException {
    return request("stats").first();
  }

  /**
   * End the session.
   *
   * @throws IOException if the session has ended
   */
  public void quit() throws IOException {
    request("quit");
  }
}

package racebeam;

import static org.junit.jupiter.api.Assertions.assertArrayEquals;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.IOException;
import java.util.List;
import java.util.Map;
import org.junit.jupiter.api.AfterEach;
import org.junit.jupiter.api.Assumptions;
import org.junit.jupiter.api.BeforeEach;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.io.TempDir;

/** A method for each command, with its own server: the program that RACEBEAM_PROGRAM names. */
class ServerTest {
  @TempDir java.nio.file.Path folder;
  private Session session;

  @BeforeEach
  void launch() throws IOException {
    Assumptions.assumeTrue(System.getenv("RACEBEAM_PROGRAM") != null, "RACEBEAM_PROGRAM names no program");
    session = Racebeam.launch("--record-dir", folder.toString(), "--roms", folder.toString());
  }

  @AfterEach
  void end() {
    if (session != null) {
      session.close();
    }
  }

  @Test
  void eachCommandHasAMethod() throws IOException {
    assertTrue(session.hello().text("server").startsWith("racebeam/"));
    assertTrue(session.help("act").contains("act A"));
    assertEquals(List.of("beamfall", "updraft"), session.games());
    assertEquals(1, session.game("beamfall").number("here"));
    assertEquals(5, session.load("beamfall", Map.of("seed", 3, "sticky", 0, "preset", "paper2013")).number("frame_skip"));
    assertEquals(0.0, session.settings().real("sticky"));
    assertEquals(1, session.set(Map.of("difficulty", 1)).number("difficulty"));
    assertEquals(List.of(0), session.modes());
    assertEquals(List.of(0, 1), session.difficulties());
    assertEquals(53, session.names().list("tia_names").size());
    assertEquals("DOWNLEFTFIRE", session.actions().get(17));
    assertEquals(List.of("reward", "terminated", "truncated", "frame"), session.observe("reward", "terminated", "truncated", "frame"));
    assertEquals(15, session.act("UP", "FIRE*2").number("frame"));
    assertEquals(20, session.act(1).number("frame"));
    session.poke(5, (byte) 0x12, (byte) 0xF4);
    assertArrayEquals(new byte[] {0x12, (byte) 0xF4}, session.peek(5, 2));
    session.save("a");
    session.saveWithRandom("r");
    session.importState("b", session.exportState("a"));
    assertEquals(List.of("a", "b", "r"), session.states());
    session.drop("a", "r");
    assertEquals(20, session.restore("b").number("frame"));
    List<Branch> branches = session.branch("b", "leaf", List.of(List.of("FIRE*4", "UP"), List.of("0")));
    assertEquals(List.of(5, 1), branches.stream().map(branch -> branch.rewards().size()).toList());
    assertEquals("leaf1", branches.get(1).group().text("state"));
    assertEquals(branches.get(0).reward(), branches.get(0).rewards().stream().mapToLong(Long::longValue).sum());
    assertEquals(1, session.branch("b", List.of(List.of("UP"))).size());
    assertEquals("film.gif", session.record("gif", "film").text("recording"));
    session.act("FIRE");
    assertEquals(5, session.stopRecording().number("frames"));
    assertEquals(3, session.open(3, Map.of("autoreset", "same-step")).size());
    session.record("png", "pictures", 2);
    assertEquals(5, session.step("UP", "FIRE", "NOOP").get(2).number("frame"));
    assertEquals(10, session.step(1).get(2).number("frame"));
    session.save("c", Map.of("machine", 1, "random", 1));
    assertEquals(10, session.restore("c", 2).number("frame"));
    assertTrue(session.exportEpisode("c").length > session.exportState("c").length);
    assertEquals(3, session.restart("010", 4).size());
    session.closeMachines();
    assertEquals("room", session.share("room", 2).text("share"));
    assertEquals("room", session.shared().get(0).text("name"));
    long frame = session.watch("room", "screen:delta").number("frame");
    assertEquals(33600, session.watch("room", "screen:delta", "ram").bytes("screen").length);
    assertFalse(session.watch("room", frame, "screen").has("screen"));
    session.unshare();
    assertEquals(0, session.reset().reward());
    assertEquals(0, session.reset(9).reward());
    assertTrue(session.stats().number("requests") > 20);
    session.quit();
    assertThrows(IOException.class, () -> session.act("FIRE"));
  }

  @Test
  void screensHaveColours() throws IOException {
    session.load("beamfall");
    Group shown = session.look("screen:raw", "rgb:zlib", "lives");
    int[] pixels = session.palette().colours(shown.bytes("screen"));
    byte[] rgb = shown.bytes("rgb");
    for (int at = 0; at < pixels.length; ++at) {
      assertEquals(pixels[at] & 0xFFFFFF, (rgb[3 * at] & 0xFF) << 16 | (rgb[3 * at + 1] & 0xFF) << 8 | rgb[3 * at + 2] & 0xFF);
    }
    assertEquals(4, shown.lives());
  }

  @Test
  void aRefusalHasACodeAndLeavesTheSession() throws IOException {
    assertEquals("unknown-game", assertThrows(RefusedException.class, () -> session.load("nothing")).code());
    assertEquals("bad-image", assertThrows(RefusedException.class, () -> session.load(new byte[3], Map.of())).code());
    assertEquals("beamfall", session.load("beamfall").text("game"));
  }
}

/**
 * A client of the racebeam line protocol.
 *
 * <pre>{@code
 * try (Session game = Racebeam.connect("tcp://127.0.0.1:7800")) {
 *   game.load("beamfall", Map.of("seed", 7, "frame_skip", 4));
 *   game.observe("reward", "terminated", "truncated", "screen:delta");
 *   Group shown = game.act("FIRE");
 *   System.out.println(shown.reward() + " " + shown.bytes("screen").length);
 * }
 * }</pre>
 *
 * {@link racebeam.Racebeam} opens sessions. {@link racebeam.Session} has a method for each command. What the server
 * refuses is a {@link racebeam.RefusedException}, and the session continues. A server that has gone, that does not answer in
 * time, or that sends an invalid reply, is an {@link java.io.IOException}, and the session has ended.
 */
package racebeam;

package racebeam;

import java.nio.file.Path;
import java.util.List;
import java.util.regex.MatchResult;
import java.util.regex.Matcher;
import java.util.regex.Pattern;

/**
 * What an announce file says. It has each address on its own line, and the token in the last line (server/README.md).
 *
 * @param addresses of the server
 * @param token for TCP, or null
 */
record Announcement(List<String> addresses, String token) {
  private static final String VERSION = "1"; // of the files that this client reads
  private static final Pattern FIRST = Pattern.compile("\\{\"racebeam_announce\": ([0-9]+),");
  private static final Pattern ADDRESS = Pattern.compile("^  \"(.*)\",?$");
  private static final Pattern LAST = Pattern.compile(" \"token\": \"([^\"]*)\"}");

  static Announcement of(Path path, List<String> lines) {
    Matcher first = FIRST.matcher(lines.get(0));
    Matcher last = LAST.matcher(lines.get(lines.size() - 1));
    if (first.matches() && !first.group(1).equals(VERSION)) {
      throw new IllegalArgumentException(
          path + " is an announce file of version " + first.group(1) + "; this client reads version " + VERSION);
    }
    if (!first.matches() || !last.matches()) {
      throw new IllegalArgumentException(path + " is not a whole announce file");
    }
    List<String> addresses = lines.stream().flatMap(line -> ADDRESS.matcher(line).results()).map(Announcement::unescape).toList();
    return new Announcement(addresses, last.group(1));
  }

  private static String unescape(MatchResult found) {
    return found.group(1).replaceAll("\\\\(.)", "$1");
  }
}

package racebeam;

import java.nio.ByteBuffer;
import java.util.HashMap;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.regex.Matcher;
import java.util.regex.Pattern;

/** Decodes the fields of replies. It follows what requests that were granted change about later replies. */
final class Fields {
  private static final Pattern SMALL = Pattern.compile("grey84(?:x(\\d+))?|(grey|rgb)(\\d+)x(\\d+)x(\\d+)");
  private static final int WIDTH = 160;

  /** What deltas have made of the fields of a machine, by their names, and the height of its screen. */
  private record Source(List<String> fields, int height, Map<String, byte[]> arrays) { }

  private Map<String, Encoding> chosen = Map.of();
  private final Map<Integer, Source> machines = new HashMap<>(); // 0 is that of load
  private final Map<String, Source> watched = new HashMap<>(); // by the name of the session
  private int height;

  /**
   * Decodes the groups of a reply.
   *
   * @param words the words of the request
   * @param groups the pairs of each group
   * @param raw the bytes that followed the reply's line
   */
  List<Group> decode(List<String> words, List<Map<String, String>> groups, ByteBuffer raw) {
    String command = words.get(0);
    List<String> fields = words.subList(1, words.size());
    switch (command) {
      case "observe" -> {
        if (!fields.isEmpty()) {
          chosen = encodings(fields);
          machines.clear();
        }
      }
      case "load" -> {
        height = Integer.parseInt(groups.get(0).get("height"));
        machines.clear();
      }
      case "open" -> machines.keySet().removeIf(machine -> machine > 0);
      default -> { }
    }
    boolean watches = command.equals("watch");
    List<String> names = watches ? watchedFields(fields) : fields;
    Map<String, Encoding> encodings = watches || command.equals("look") && !fields.isEmpty() ? encodings(names) : chosen;
    int first = firstMachine(words);
    Group[] decoded = new Group[groups.size()];
    for (int number = 0; number < decoded.length; ++number) {
      Source source = watches ? watched(fields.get(0), names, groups.get(0)) : machine(first + number);
      decoded[number] = decode(source, groups.get(number), encodings, raw);
    }
    if (raw.hasRemaining()) {
      throw new IllegalArgumentException(raw.remaining() + " bytes follow the line that belong to no field");
    }
    return List.of(decoded);
  }

  /** The fields of a request {@code watch NAME [since=FRAME] FIELD...}. */
  private static List<String> watchedFields(List<String> words) {
    return words.stream().skip(1).filter(word -> word.indexOf('=') < 0).toList();
  }

  /** The machine of the first group: 0 is that of load, 1 the first of open, which {@code machine=0} restores. */
  private static int firstMachine(List<String> words) {
    return words.stream().skip(2).filter(word -> words.get(0).equals("restore") && word.startsWith("machine="))
        .mapToInt(word -> Integer.parseInt(word.substring("machine=".length())) + 1).findFirst().orElse(0);
  }

  private Source machine(int number) {
    return machines.computeIfAbsent(number, unused -> new Source(List.of(), height, new HashMap<>()));
  }

  /** A watched session begins anew with other fields, and with another height. */
  private Source watched(String name, List<String> fields, Map<String, String> texts) {
    String rowCount = texts.get("height");
    int rows = rowCount == null ? height : Integer.parseInt(rowCount);
    return watched.compute(name, (unused, known) -> known != null && known.fields.equals(fields) && known.height == rows
        ? known : new Source(fields, rows, new HashMap<>()));
  }

  private Group decode(Source source, Map<String, String> texts, Map<String, Encoding> encodings, ByteBuffer raw) {
    Map<String, byte[]> bytes = new LinkedHashMap<>();
    texts.entrySet().removeIf(entry -> {
      String field = entry.getKey().startsWith("final_") ? entry.getKey().substring(6) : entry.getKey();
      Encoding encoding = encodings.get(field);
      if (encoding != null) {
        bytes.put(entry.getKey(), switch (encoding) {
          case DELTA -> applyDelta(source, field, entry.getValue());
          case RAW -> take(raw, Integer.parseInt(entry.getValue()));
          default -> encoding.decode(entry.getValue());
        });
      }
      return encoding != null;
    });
    return new Group(texts, bytes);
  }

  private static byte[] take(ByteBuffer raw, int count) {
    if (count < 0 || count > raw.remaining()) {
      throw new IllegalArgumentException("a field has " + count + " bytes, but " + raw.remaining() + " are left behind the line");
    }
    byte[] bytes = new byte[count];
    raw.get(bytes);
    return bytes;
  }

  /** Applies a delta to the field's array in {@code source}. Returns a copy. */
  private static byte[] applyDelta(Source source, String field, String delta) {
    byte[] array = source.arrays.computeIfAbsent(field, unused -> new byte[size(field, source.height)]);
    Encoding.applyDelta(array, delta);
    return array.clone();
  }

  private static int size(String field, int height) {
    Matcher small = SMALL.matcher(field);
    if (!small.matches()) {
      Integer size = FieldTable.SIZES.get(field);
      return size != null ? size : height * WIDTH * FieldTable.PIXELS.get(field);
    }
    if (small.group(2) == null) {
      return 84 * 84 * (small.group(1) == null ? 1 : Integer.parseInt(small.group(1)));
    }
    int bytes = small.group(2).equals("rgb") ? 3 : 1;
    for (int part = 3; part <= 5; ++part) {
      bytes *= Integer.parseInt(small.group(part));
    }
    return bytes;
  }

  private static Map<String, Encoding> encodings(List<String> fields) {
    Map<String, Encoding> found = new HashMap<>();
    for (String field : fields) {
      int colon = field.indexOf(':');
      String name = colon < 0 ? field : field.substring(0, colon);
      Encoding usual = SMALL.matcher(name).matches() ? Encoding.ZLIB : FieldTable.USUAL.get(name);
      Encoding encoding = colon < 0 ? usual : Encoding.valueOf(field.substring(colon + 1).toUpperCase(Locale.ROOT));
      if (encoding != null) {
        found.put(name, encoding);
      }
    }
    return found;
  }
}

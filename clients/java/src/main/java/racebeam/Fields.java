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
  private static final Map<String, Encoding> USUAL = Map.of("ram", Encoding.HEX, "tia", Encoding.HEX, "screen", Encoding.RLE,
      "rgb", Encoding.ZLIB, "grey", Encoding.ZLIB, "palette", Encoding.HEX, "audio", Encoding.HEX);
  private static final Pattern SMALL = Pattern.compile("grey84(?:x(\\d+))?|(grey|rgb)(\\d+)x(\\d+)x(\\d+)");
  private static final int WIDTH = 160;

  private Map<String, Encoding> chosen = Map.of();
  private Map<Integer, Map<String, byte[]>> arrays = new HashMap<>(); // by machine; 0 is that of load
  private int height;

  /** The groups of a reply, decoded. `words`: those of the request; `raw`: the bytes that followed the reply's line. */
  List<Group> follow(List<String> words, List<Map<String, String>> groups, ByteBuffer raw) {
    String command = words.get(0);
    List<String> fields = words.subList(1, words.size());
    switch (command) {
      case "observe" -> {
        if (!fields.isEmpty()) {
          chosen = encodings(fields);
          arrays.clear();
        }
      }
      case "load" -> {
        height = Integer.parseInt(groups.get(0).get("height"));
        arrays.clear();
      }
      case "open" -> arrays.keySet().removeIf(machine -> machine > 0);
      default -> { }
    }
    Map<String, Encoding> encodings = command.equals("look") && !fields.isEmpty() ? encodings(fields) : chosen;
    Group[] decoded = new Group[groups.size()];
    for (int machine = 0; machine < decoded.length; ++machine) {
      decoded[machine] = decode(machine, groups.get(machine), encodings, raw);
    }
    if (raw.hasRemaining()) {
      throw new IllegalArgumentException(raw.remaining() + " bytes follow the line that belong to no field");
    }
    return List.of(decoded);
  }

  private Group decode(int machine, Map<String, String> texts, Map<String, Encoding> encodings, ByteBuffer raw) {
    Map<String, byte[]> bytes = new LinkedHashMap<>();
    texts.entrySet().removeIf(entry -> {
      String field = entry.getKey().startsWith("final_") ? entry.getKey().substring(6) : entry.getKey();
      Encoding encoding = encodings.get(field);
      if (encoding != null) {
        bytes.put(entry.getKey(), switch (encoding) {
          case DELTA -> changed(machine, field, entry.getValue());
          case RAW -> taken(raw, Integer.parseInt(entry.getValue()));
          default -> encoding.decode(entry.getValue());
        });
      }
      return encoding != null;
    });
    return new Group(texts, bytes);
  }

  private static byte[] taken(ByteBuffer raw, int count) {
    if (count < 0 || count > raw.remaining()) {
      throw new IllegalArgumentException("a field has " + count + " bytes, but " + raw.remaining() + " are left behind the line");
    }
    byte[] bytes = new byte[count];
    raw.get(bytes);
    return bytes;
  }

  private byte[] changed(int machine, String field, String delta) {
    byte[] array = arrays.computeIfAbsent(machine, unused -> new HashMap<>()).computeIfAbsent(field, unused -> new byte[size(field)]);
    Encoding.applyDelta(array, delta);
    return array.clone();
  }

  private int size(String field) {
    Matcher small = SMALL.matcher(field);
    if (!small.matches()) {
      return switch (field) {
        case "ram" -> 128;
        case "tia" -> 53;
        case "palette" -> 256 * 3;
        case "audio" -> 512;
        case "rgb" -> height * WIDTH * 3;
        default -> height * WIDTH;
      };
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
      Encoding usual = SMALL.matcher(name).matches() ? Encoding.ZLIB : USUAL.get(name);
      Encoding encoding = colon < 0 ? usual : Encoding.valueOf(field.substring(colon + 1).toUpperCase(Locale.ROOT));
      if (encoding != null) {
        found.put(name, encoding);
      }
    }
    return found;
  }
}

import java.io.FileInputStream;
import java.io.IOException;
import java.net.SocketTimeoutException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.security.KeyStore;
import java.security.cert.CertificateFactory;
import java.time.Duration;
import java.util.ArrayDeque;
import java.util.Deque;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import java.util.regex.Pattern;
import java.util.stream.Collectors;
import java.util.zip.Adler32;
import javax.net.ssl.SSLContext;
import javax.net.ssl.TrustManagerFactory;
import racebeam.Group;
import racebeam.Options;
import racebeam.Racebeam;
import racebeam.RefusedException;
import racebeam.Reply;
import racebeam.ScreenStack;
import racebeam.Session;

/** Takes the steps of a file with the client in Java, and prints what came of each: Runner FILE. */
public final class Runner {
  private static final Pattern VARIABLE = Pattern.compile("\\$(\\w+)");
  private static final Options USUAL = Options.DEFAULT.withLongestReply(1 << 20).withTimeout(Duration.ofSeconds(60));

  private interface Step {
    String take() throws Exception;
  }

  private final Map<String, String> variables = new HashMap<>(System.getenv());
  private final Deque<String> sent = new ArrayDeque<>(); // the commands of requests without a reply
  private Options options = USUAL;
  private Session session;
  private Group last;
  private String stackField = "";
  private String stackName;
  private ScreenStack stack;

  public static void main(String[] words) throws Exception {
    Runner runner = new Runner();
    for (String line : Files.readAllLines(Path.of(words[0]))) {
      if (!line.isBlank() && !line.startsWith("#")) {
        runner.print(() -> runner.take(line));
      }
    }
    runner.close();
  }

  /** Prints what a step gives, or the word for its failure. */
  private void print(Step step) throws Exception {
    String printed;
    try {
      printed = step.take();
    } catch (RefusedException refused) {
      printed = "error " + refused.code();
    } catch (SocketTimeoutException timeout) {
      printed = "timeout";
    } catch (IOException lost) {
      printed = "lost";
    } catch (IllegalArgumentException invalid) {
      printed = "invalid";
    }
    if (printed != null) {
      System.out.println(printed);
    }
  }

  private String take(String step) throws Exception {
    String line = VARIABLE.matcher(step).replaceAll(found -> variables.get(found.group(1)));
    String[] words = line.strip().split(" ", 2);
    String rest = words.length > 1 ? words[1] : "";
    String[] parts = rest.split(" ");
    switch (words[0]) {
      case "section" -> {
        options = USUAL;
        stackField = "";
        sent.clear();
        return "section " + parts[0];
      }
      case "connect" -> {
        close();
        session = connected(parts);
        return "connected";
      }
      case "another" -> {
        connected(parts).close();
        return "connected";
      }
      case "connections" -> {
        for (int n = 0; n < Integer.parseInt(parts[0]); ++n) {
          connected(parts[1]).close();
        }
        return "connected";
      }
      case "launch" -> {
        close();
        session = Racebeam.launchProgram(System.getenv("RACEBEAM_BINARY"));
        return "connected";
      }
      case ">" -> {
        send(rest);
        return reply();
      }
      case "send" -> send(rest);
      case "receive" -> {
        for (int n = 0; n < Integer.parseInt(rest); ++n) {
          print(this::reply);
        }
      }
      case "picture" -> {
        session.savePng(Path.of(rest));
        return "picture " + digest(Files.readAllBytes(Path.of(rest)));
      }
      case "keep" -> variables.put(parts[0], last.text(parts[1]));
      case "close" -> close();
      case "timeout" -> options = options.withTimeout(Duration.ofSeconds(Long.parseLong(rest)));
      case "trust" -> options = options.withTls(trusting(rest));
      case "stack" -> {
        stackField = parts[0];
        stackName = parts[0] + "x" + parts[1];
        stack = new ScreenStack(Integer.parseInt(parts[1]));
      }
      case "wait" -> Thread.sleep(1000 * Long.parseLong(rest));
      case "time" -> {
        return time(Integer.parseInt(parts[0]), Integer.parseInt(parts[1]), rest.split(" ", 3)[2]);
      }
      default -> throw new AssertionError("no such step: " + line);
    }
    return null;
  }

  private Session connected(String... words) throws IOException {
    return Racebeam.connect(words[0], words.length > 1 ? options.withToken(words[1]) : options);
  }

  private void close() {
    if (session != null) {
      session.close();
    }
  }

  private void send(String request) throws IOException {
    session.send(request);
    sent.add(request.split(" ")[0]);
  }

  private String reply() throws IOException {
    String command = sent.remove();
    Reply reply = session.receive();
    last = reply.first();
    return "ok" + reply.groups().stream().map(group -> shown(command, group)).collect(Collectors.joining(" |"));
  }

  private String shown(String command, Group group) {
    TreeMap<String, String> pairs = new TreeMap<>(group.texts());
    group.bytes().forEach((key, bytes) -> pairs.put(key, digest(bytes)));
    if (!stackField.isEmpty()) {
      if (List.of("reset", "load", "observe").contains(command)) {
        stack.clear();
      }
      if (pairs.remove(stackField) != null) {
        pairs.put(stackName, digest(stack.push(group.bytes(stackField))));
      }
    }
    StringBuilder text = new StringBuilder();
    pairs.forEach((key, value) -> text.append(' ').append(key).append('=').append(value));
    return text.toString();
  }

  private static String digest(byte[] bytes) {
    Adler32 adler = new Adler32();
    adler.update(bytes);
    return String.format("%d:%08x", bytes.length, adler.getValue());
  }

  private String time(int steps, int ahead, String request) throws IOException {
    long start = System.nanoTime();
    for (int step = 0; step < steps; step += ahead) {
      for (int n = 0; n < ahead; ++n) {
        session.send(request);
      }
      for (int n = 0; n < ahead; ++n) {
        session.receive();
      }
    }
    return String.format("time %d %.6f", ahead, (System.nanoTime() - start) / 1e9);
  }

  private static SSLContext trusting(String path) throws Exception {
    KeyStore store = KeyStore.getInstance(KeyStore.getDefaultType());
    store.load(null, null);
    try (var file = new FileInputStream(path)) {
      store.setCertificateEntry("server", CertificateFactory.getInstance("X.509").generateCertificate(file));
    }
    TrustManagerFactory trust = TrustManagerFactory.getInstance(TrustManagerFactory.getDefaultAlgorithm());
    trust.init(store);
    SSLContext context = SSLContext.getInstance("TLS");
    context.init(null, trust.getTrustManagers(), null);
    return context;
  }
}

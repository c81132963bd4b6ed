// The client in C++ (clients/cpp): a method for each command, several threads and coroutines, and servers
// that misbehave in ways that clients/conformance/faults.txt cannot say.
#include <boost/asio/detached.hpp>
#include <catch2/catch.hpp>
#include <filesystem>
#include <future>
#include <racebeam/client.hpp>
#include <thread>
#include <type_traits>

namespace {

namespace asio = boost::asio;
namespace client = racebeam::client;
using asio::ip::tcp;
static_assert(std::is_same_v<client::Session, client::v0::Session>);

// A server that accepts one connection after the other, and answers each line as it is told.
class Server {
 public:
  explicit Server(std::function<std::string(const std::string&)> answer)
      : answer_(std::move(answer)), thread_([this] { serve(); }) {}
  ~Server() {
    ending_ = true;
    tcp::socket last(loop_);
    last.connect(acceptor_.local_endpoint());
    last.close();
    thread_.join();
  }

  std::string address() const {
    return "tcp://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port());
  }

 private:
  void serve() {
    while (!ending_) {
      tcp::iostream stream(acceptor_.accept());
      stream.rdbuf()->set_option(tcp::no_delay(true));
      for (std::string line; std::getline(stream, line);)
        stream << (line == "hello" ? "ok server=test protocol=1\n" : answer_(line)) << std::flush;
    }
  }

  asio::io_context loop_;
  tcp::acceptor acceptor_{loop_, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::function<std::string(const std::string&)> answer_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

// Runs a coroutine that gets what it refers to by reference.
void run(asio::awaitable<void> work) {
  asio::io_context loop;
  std::exception_ptr failure;
  asio::co_spawn(loop, std::move(work), [&](const std::exception_ptr& thrown) { failure = thrown; });
  loop.run();
  if (failure) std::rethrow_exception(failure);
}

std::string code_of(const std::function<void()>& request) {
  try {
    request();
  } catch (const client::Refused& refused) {
    return refused.code();
  }
  return "";
}

}  // namespace

TEST_CASE("Each command has a method") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("racebeam-client-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  {
    auto game = client::launch(RACEBEAM_BINARY, {"--record-dir", folder, "--roms", folder});
    CHECK(game.hello().text("server").starts_with("racebeam/"));
    CHECK(game.help("act").starts_with("act A"));
    CHECK(game.games() == std::vector<std::string>{"beamfall", "updraft"});
    CHECK(game.game("beamfall").number("here") == 1);
    CHECK(
        game.load("beamfall", client::Setting("seed", 3), client::Setting("sticky", 0.0), "preset=paper2013")
            .number("frame_skip") == 5);
    CHECK(game.settings().number("seed") == 3);
    CHECK(game.set("difficulty=1").number("difficulty") == 1);
    CHECK(game.modes() == std::vector<int>{0});
    CHECK(game.difficulties() == std::vector<int>{0, 1});
    CHECK(game.names().list("tia_names").size() == game.look("tia").bytes("tia").size());
    CHECK(game.actions().at(17) == "DOWNLEFTFIRE");
    CHECK(game.observe("reward", "ends", "frame") ==
          std::vector<std::string>{"reward", "terminated", "truncated", "frame"});
    CHECK(game.act("UP", "FIRE*2").number("frame") == 15);
    game.poke(5, client::Bytes{0x12, 0xF4});
    CHECK(game.peek(5, 2) == client::Bytes{0x12, 0xF4});
    game.save("a");
    game.save("r", "random=1");
    game.import_state("b", game.export_state("a"));
    CHECK(game.states() == std::vector<std::string>{"a", "b", "r"});
    game.drop("a", "r");
    CHECK(game.restore("b").number("frame") == 15);
    const auto branches = game.branch("b", {{"FIRE*4", "UP"}, {"0"}}, "leaf");
    CHECK(branches.at(0).rewards.size() == 5);
    CHECK(branches.at(1).group.text("state") == "leaf1");
    CHECK(game.record("gif", "film").text("recording") == "film.gif");
    game.act(1);
    CHECK(game.stop_recording().number("frames") == 5);
    CHECK(game.open(3, "autoreset=same-step").size() == 3);
    game.record("png", "pictures", client::Setting("machine", 2));
    CHECK(game.step(std::vector<int>{2, 1, 0}).at(1).number("frame") == 5);
    CHECK(game.restart("010", client::Setting("seed", 4)).size() == 3);
    game.save("c", client::Setting("machine", 1));
    CHECK(game.restore("c", client::Setting("machine", 0)).has("frame"));
    CHECK(game.export_state("c", "whole=1").size() > game.export_state("c").size());
    game.close_machines();
    CHECK(game.share("room", client::Setting("watchers", 2)).text("share") == "room");
    CHECK(game.shared().at(0).text("name") == "room");
    const auto frame = game.watch("room", "screen:delta").number("frame");
    CHECK(game.watch("room", "screen:delta", "ram").bytes("screen").size() == 33600);
    CHECK_FALSE(game.watch("room", client::Setting("since", frame), "screen").has("screen"));
    game.unshare();
    CHECK(game.reset().reward() == 0);
    CHECK_FALSE(game.reset(9).over());
    CHECK(game.stats().number("requests") > 20);
    game.quit();
    CHECK_THROWS_AS(game.act("FIRE"), client::Lost);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("Screens have colours, and a stack of them begins with zeros") {
  auto game = client::launch(RACEBEAM_BINARY);
  game.load("beamfall");
  const auto look = game.look("screen:zlib", "rgb");
  const client::Bytes& rgb = look.bytes("rgb");
  std::vector<std::uint32_t> expected;
  for (std::size_t at = 0; at < rgb.size(); at += 3)
    expected.push_back(0xFF000000U | unsigned{rgb[at]} << 16 | unsigned{rgb[at + 1]} << 8 | rgb[at + 2]);
  CHECK(game.palette().colours(look.bytes("screen")) == expected);
  CHECK(look.has("screen"));
  CHECK_THROWS_AS(look.text("ram"), std::out_of_range);
  CHECK_THROWS_AS(game.settings().bytes("seed"), std::invalid_argument);
  client::ScreenStack stack(2);
  CHECK(stack.push(client::Bytes{1, 2}) == client::Bytes{0, 0, 1, 2});
  CHECK(stack.push(client::Bytes{3, 4}) == client::Bytes{1, 2, 3, 4});
  stack.clear();
  CHECK(stack.push(client::Bytes{5, 6}) == client::Bytes{0, 0, 5, 6});
  CHECK_THROWS_AS(stack.push(client::Bytes{7}), std::invalid_argument);
}

TEST_CASE("A client's image is loaded, and an invalid one is refused") {
  auto game = client::launch(RACEBEAM_BINARY);
  CHECK(code_of([&] { game.load_image(client::Bytes{1, 2, 3}); }) == "bad-image");
  CHECK(game.load_image(client::Bytes(4096, 0xEA), "as=beamfall").number("rule") == 1);
}

TEST_CASE("Bytes that follow a line belong to its reply") {
  const Server server([](const std::string& line) {
    if (line.starts_with("observe")) return std::string("ok fields=ram\n");
    if (line == "less") return std::string("ok ram=3 raw=2\n\n\n");
    return std::string("ok ram=3 raw=3\n\n|\n");
  });
  auto game = client::connect(server.address());
  game.observe("ram:raw");
  for (int n = 0; n < 2; ++n) game.send("act FIRE");
  CHECK(game.act("FIRE").bytes("ram") == client::Bytes{'\n', '|', '\n'});
  CHECK(game.receive().first().bytes("ram") == client::Bytes{'\n', '|', '\n'});
  CHECK_FALSE(game.receive().first().has("raw"));
  CHECK_THROWS_AS(game.request("less"), client::Lost);
}

TEST_CASE("base64 ends in any number of bytes") {
  for (std::size_t size = 0; size < 7; ++size) {
    const client::Bytes bytes(size, 0xA7);
    CHECK(client::from_base64(client::to_base64(bytes)) == bytes);
  }
  CHECK(client::to_base64(client::Bytes{'f', 'o', 'o', 'b'}) == "Zm9vYg==");
  CHECK_THROWS_AS(client::from_base64("Zm9"), std::invalid_argument);
  CHECK_THROWS_AS(client::from_base64("Zm9*"), std::invalid_argument);
  CHECK_THROWS_AS(client::from_base64("===="), std::invalid_argument);
}

TEST_CASE("An error in a pipeline leaves the other requests") {
  const Server server([](const std::string& line) {
    return line == "bad" ? std::string("error bad-action it is\n") : "ok n=" + line + "\n";
  });
  auto game = client::connect(server.address());
  for (const char* line : {"1", "bad", "2"}) game.send(line);
  CHECK(game.request("3").first().number("n") == 3);
  CHECK(game.receive().first().number("n") == 1);
  CHECK(code_of([&] { game.receive(); }) == "bad-action");
  CHECK(game.receive().first().number("n") == 2);
}

TEST_CASE("Any number of requests can be sent ahead") {
  const std::string reply = "ok a=" + std::string(10'000, '0') + "\n";  // together more than all buffers hold
  const Server server([&](const std::string&) { return reply; });
  auto game = client::connect(server.address());
  for (int n = 0; n < 5'000; ++n) game.send("act " + std::to_string(n));
  for (int n = 0; n < 5'000; ++n) game.receive();
}

TEST_CASE("Threads that share a session get their own replies") {
  const Server server([](const std::string& line) { return "ok n=" + line + "\n"; });
  auto game = client::connect(server.address());
  const auto ask = [&](int first) {
    int wrong = 0;
    for (int n = first; n < first + 300; ++n)
      wrong += game.request(std::to_string(n)).first().number("n") != n;
    return wrong;
  };
  auto other = std::async(std::launch::async, ask, 1000);
  CHECK(ask(2000) == 0);
  CHECK(other.get() == 0);
}

TEST_CASE("Closing a session wakes the thread that waits for it") {
  std::promise<void> request;
  const Server server([&](const std::string&) {
    request.set_value();
    return "";
  });
  auto game = client::connect(server.address());
  auto waiting = std::async(std::launch::async, [&] { game.act("FIRE"); });
  request.get_future().wait();
  game.close();
  CHECK_THROWS_AS(waiting.get(), client::Lost);
  game.close();
  CHECK_THROWS_AS(game.act("FIRE"), client::Lost);
}

TEST_CASE("A second coroutine that uses a session is refused") {
  const Server server([](const std::string&) { return "ok\n"; });
  run([](std::string address) -> asio::awaitable<void> {
    auto game = co_await client::async_connect(address);
    int done = 0;
    const auto play = [&]() -> asio::awaitable<void> {
      try {
        co_await game.act("FIRE");
        done += 1;
      } catch (const std::logic_error&) {
        done += 10;
      }
    };
    asio::co_spawn(co_await asio::this_coro::executor, play(), asio::detached);
    co_await play();
    while (done < 11) co_await asio::post(co_await asio::this_coro::executor, asio::use_awaitable);
    CHECK(done == 11);
    co_await game.request("act FIRE");
  }(server.address()));
}

TEST_CASE("Coroutines have the same methods and the same errors") {
  run([]() -> asio::awaitable<void> {
    auto game = co_await client::async_launch(RACEBEAM_BINARY);
    co_await game.load("beamfall", client::Setting("seed", 7), "preset=dqn2015");
    co_await game.observe("frame");
    for (int n = 0; n < 3; ++n) co_await game.send("act NOOP");
    CHECK((co_await game.act("NOOP")).number("frame") >= 16);
    const client::Reply first = co_await game.receive();
    CHECK(first.first().has("frame"));
    co_await game.save("start", "random=1");
    const std::vector<std::vector<std::string>> lists{{"FIRE*3", "UP"}, {"NOOP"}};
    const auto branches = co_await game.branch("start", lists);
    CHECK(branches.size() == 2);
    std::string code;
    try {
      co_await game.act("JUMP");
    } catch (const client::Refused& refused) {
      code = refused.code();
    }
    CHECK(code == "bad-action");
    co_await game.quit();
    bool is_lost = false;
    try {
      co_await game.act("FIRE");
    } catch (const client::Lost&) {
      is_lost = true;
    }
    CHECK(is_lost);
  }());
}

TEST_CASE("A program that cannot be started, and pipes that no server opens, are lost") {
  CHECK_THROWS_AS(client::launch("/nonexistent/racebeam"), client::Lost);
  CHECK_THROWS_AS(client::connect("pipes:/nonexistent/pipes"), client::Lost);
  CHECK_THROWS_AS(client::connect("file:/nonexistent/ready"), client::Lost);
  const auto prefix =
      std::filesystem::temp_directory_path() / ("racebeam-pipes-" + std::to_string(::getpid()));
  for (const char* suffix : {"_in", "_out"}) REQUIRE(::mkfifo((prefix.string() + suffix).c_str(), 0600) == 0);
  client::Options options;
  options.timeout = std::chrono::milliseconds(200);
  CHECK_THROWS_AS(client::connect("pipes:" + prefix.string(), options), client::TimedOut);
  for (const char* suffix : {"_in", "_out"}) std::filesystem::remove(prefix.string() + suffix);
}

TEST_CASE("A file that names no server is refused in a sentence") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("racebeam-files-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const auto refusal = [&](const std::string& name) {
    try {
      client::connect("file:" + (folder / name).string());
      return std::string("none");
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  const auto put = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return refusal(name);
  };
  const std::string tail = "; file:PATH takes the --ready-file or --announce file of a server";
  const auto path = [&](const std::string& name) { return (folder / name).string(); };
  REQUIRE(::mkfifo(path("pipe").c_str(), 0600) == 0);
  CHECK(refusal("pipe") == path("pipe") + " is not a regular file" + tail);
  CHECK(refusal("pipe?wait=60") == path("pipe") + " is not a regular file" + tail);
  CHECK(refusal(".") == path(".") + " is not a regular file" + tail);
  CHECK(put("empty", "") == path("empty") + " is empty" + tail);
  CHECK(put("notes", "dear diary\n") == path("notes") + " has other contents" + tail);
  CHECK(put("ready", "# addresses\nhttp://a:1\n") ==
        path("ready") + " names no address that this client can use");
  for (const std::string time : {"", "x", "-1", "1e3", "99999999999999999999", "inf"}) {
    CHECK(refusal("empty?wait=" + time) == "the address is 'file:" + path("empty?wait=") + time +
                                               "'; ?wait= takes seconds, from 0 to 999999999");
  }
  CHECK_THAT(put("stale", "# addresses\nunix:/nonexistent/socket\n"),
             Catch::Matchers::StartsWith("no server answers at unix:/nonexistent/socket, which " +
                                         path("stale") + " names: "));
  std::filesystem::remove_all(folder);
}

TEST_CASE("An invalid reply is quoted for a terminal") {
  const Server server([](const std::string&) { return "\x1B[31mred\xFF\n"; });
  auto game = client::connect(server.address());
  CHECK_THROWS_MATCHES(
      game.request("act FIRE"), client::Lost,
      Catch::Matchers::Message("a reply of the server is damaged: '\\x1b[31mred\\xff' is not a reply"));
}

TEST_CASE("The caller's words are checked") {
  for (const char* address :
       {"nonsense", "tcp://host", "tcp://host:99999", "tcp://:80", "unix:", "http://host:1"}) {
    CAPTURE(address);
    CHECK_THROWS_AS(client::connect(address), std::invalid_argument);
  }
  client::Options options;
  options.authorities = "/nonexistent/certificates";
  CHECK_THROWS_AS(client::connect("tls://127.0.0.1:1", options), std::invalid_argument);
  const Server server([](const std::string&) { return "ok\n"; });
  auto game = client::connect(server.address());
  CHECK_THROWS_AS(game.request("act\nact"), std::invalid_argument);
  CHECK_THROWS_AS(game.request(" # a comment"), std::invalid_argument);
  CHECK(game.request("act FIRE").line() == "ok");
}

// Lines, errors and limits of a session; load_test.cpp tests `load`.
#include <catch2/catch.hpp>

#include "protocol/line/commands/command_table.hpp"
#include "recording/recorder.hpp"
#include "tests/games/scratch.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using test::code;
using test::kLoad;
using test::line_service;
using test::LineClient;
using test::value;

namespace {

constexpr auto kLongSlice = 60s;  // numbers of replies end it, however slow the machine

}  // namespace

TEST_CASE("A request is answered by one line, and requests sent ahead in their order") {
  LineClient client;
  const std::string answers = client.say(kLoad + "\nobserve frame\nact NOOP\nact NOOP\nlook\n");
  CHECK(std::ranges::count(answers, '\n') == 5);
  CHECK_THAT(answers, Contains("\nok fields=frame\nok frame=1\nok frame=2\nok frame=2\n"));
}

TEST_CASE("Half a line is not answered until it is whole, whatever the pieces") {
  LineClient client;
  std::string answers;
  for (const char letter : kLoad + "\nobserve frame\nact NOOP\n") answers += client.say({&letter, 1});
  CHECK_THAT(answers, Contains("\nok fields=frame\nok frame=1\n"));
}

TEST_CASE("A line ends with LF; CR before it and blanks between words do no harm") {
  LineClient client;
  CHECK(client.say("help  act \r\n") == client.say(" help act\n"));
}

TEST_CASE("A fault of the server is internal and reported, and the session continues") {
  LineService service = line_service();
  service.admission = [](std::string_view) -> bool { throw std::invalid_argument("stoi"); };
  std::vector<std::string> reports;
  service.report_fault = [&reports](const std::string& sentence) { reports.push_back(sentence); };
  LineClient client(service);
  CHECK(client.ask("hello token=a") == "error internal stoi");
  CHECK(reports == std::vector<std::string>{"internal error in hello: stoi"});
  CHECK(code(client.ask("help")).empty());
}

TEST_CASE("Lines that are not requests are refused, and the session continues") {
  LineClient client;
  CHECK(code(client.ask("")) == "bad-line");
  CHECK(code(client.ask("   ")) == "bad-line");
  CHECK_THAT(client.ask(std::string("act \0", 5)), Contains("byte 5 of the line has the value 0"));
  CHECK_THAT(client.ask("act\tUP"), Contains("byte 4 of the line has the value 9"));
  CHECK(code(client.ask("load p\xC3\xB6ng")) == "bad-line");
  CHECK(code(client.ask("load \xFF\xFE")) == "bad-line");
  CHECK(code(client.ask("LOAD beamfall")) == "unknown-command");
  CHECK(code(client.ask(kLoad)) == "");
}

TEST_CASE("A line that is too long is skipped as a whole and reported once") {
  LineLimits limits;
  limits.line = 100;
  LineClient client(line_service(limits));
  CHECK(code(client.ask("help " + std::string(95, ' '))) == "");
  CHECK(code(client.ask("help " + std::string(96, ' '))) == "line-too-long");
  const std::string answers = client.say(std::string(100'000, 'x') + "\nhelp act\n");
  CHECK(std::ranges::count(answers, '\n') == 2);
  CHECK_THAT(answers, StartsWith("error line-too-long ") && Contains("\nok act"));
}

TEST_CASE("A rest without LF at the end of input is not executed") {
  LineClient client;
  client.ask(kLoad);
  client.say("act NOOP");
  CHECK(code(client.close()) == "half-line");
  CHECK(client.session.finished());
}

TEST_CASE("The end of input ends the session after the requests that came") {
  LineClient client;
  CHECK(client.close().empty());
  CHECK(client.session.finished());
}

TEST_CASE("quit is the last request that is answered") {
  LineClient client;
  CHECK(client.say("quit\nhelp\n") == "ok\n");
  CHECK(client.session.finished());
}

TEST_CASE("A session that begins with a request of HTTP is closed before the lines that a page has sent") {
  const std::string page = "Host: 127.0.0.1:7800\r\nContent-Length: 16\r\n\r\nload beamfall\n";
  for (const std::string first : {"POST / HTTP/1.1\r\n", "# a comment\nGET /load?beamfall HTTP/1.0\n"}) {
    LineClient client;
    const std::string answers = client.say(first + page);
    CHECK(code(answers) == "unknown-command");
    CHECK_THAT(answers, Contains("takes the line protocol, not HTTP"));
    CHECK(std::ranges::count(answers, '\n') == 1);
    CHECK(client.session.finished());
  }
  LineClient client;
  client.ask(kLoad);
  CHECK(code(client.ask("POST / HTTP/1.1")) == "unknown-command");
  CHECK_FALSE(client.session.finished());
}

TEST_CASE("Commands say what they need") {
  LineClient client;
  CHECK(code(client.ask("act NOOP")) == "no-game");
  CHECK(code(client.ask("step NOOP")) == "no-game");
  client.ask(kLoad);
  CHECK(code(client.ask("step NOOP")) == "no-machines");
  CHECK_THAT(client.ask("act"), Contains("takes at least 1 argument, not 0: act A["));
  CHECK_THAT(client.ask("peek 1 2 3"), Contains("takes 1 to 2 arguments, not 3"));
  CHECK_THAT(client.ask("modes now"), Contains("takes no arguments, not 1"));
}

TEST_CASE("The examples of help are executed") {
  LineService service = line_service();
  const Scratch folder;
  service.recorder = std::make_shared<Recorder>(folder.path(""));
  LineClient client(service);
  for (const Command& command : commands()) {
    if (command.example.empty()) continue;
    INFO(command.example);
    CHECK(command.example.starts_with(command.name));
    if (command.name == "export") client.ask("save start");  // drop comes before
    CHECK(client.ask(std::string(command.example)).starts_with("ok"));
    CHECK(client.ask("help " + std::string(command.name))
              .ends_with("; example: " + std::string(command.example)));
  }
}

TEST_CASE("A request is done in slices, between which others have their turn") {
  LineClient client;
  client.ask(kLoad + " max_episode_frames=0");
  client.ask("observe frames");
  const std::string request = "act NOOP*5000\n";
  std::ranges::copy(request, client.session.space().begin());
  client.session.received(request.size());
  int slices = 0;
  while (client.session.output().empty()) {
    REQUIRE(client.session.run(0us));
    REQUIRE(++slices < 5000);
  }
  CHECK(slices >= 2);  // an episode without a player ends before 5000 frames
  CHECK(client.session.output().starts_with("ok frames="));
}

TEST_CASE("A client that sends ahead gets the first replies before the last request is executed") {
  LineClient client;
  client.ask(kLoad);
  client.ask("observe frame");
  std::string requests, replies;
  for (int act = 0; act < 200; ++act) requests += "act NOOP\n";
  client.hand_in(requests);
  CHECK(client.session.run(kLongSlice));
  const auto first = std::ranges::count(client.session.output(), '\n');
  CHECK(first >= 1);
  CHECK(first <= 64);
  replies += client.session.output();
  client.session.sent(replies.size());
  replies += client.listen();
  CHECK(std::ranges::count(replies, '\n') == 200);
  CHECK(replies.ends_with("ok frame=200\n"));
}

TEST_CASE("Replies to requests that were sent ahead are sent together, but for the last few") {
  LineClient client;
  client.ask(kLoad);
  client.ask("observe frame");
  for (int act = 0; act < 16; ++act) client.hand_in("act NOOP\n");
  client.hand_in("act");                  // half a line
  CHECK(client.session.run(kLongSlice));  // the client reads these replies
  CHECK(client.session.output().ends_with("ok frame=13\n"));
  client.session.sent(client.session.output().size());
  CHECK_FALSE(client.session.run(kLongSlice));  // while the server does the rest
  CHECK(client.session.output() == "ok frame=14\nok frame=15\nok frame=16\n");
}

TEST_CASE("Replies to a few requests that were sent ahead are sent at once") {
  LineClient client;
  client.ask(kLoad);
  client.ask("observe frame");
  for (int act = 0; act < 6; ++act) client.hand_in("act NOOP\n");
  CHECK_FALSE(client.session.run(kLongSlice));
  CHECK(std::ranges::count(client.session.output(), '\n') == 6);
}

TEST_CASE("A request that has been cancelled is not answered") {
  LineClient client;
  client.ask(kLoad);
  const std::string request = "save a\nbranch a NOOP*100000\n";
  std::ranges::copy(request, client.session.space().begin());
  client.session.received(request.size());
  CHECK(client.session.run(0us));
  CHECK(client.session.run(0us));  // the branch is in progress
  client.session.cancel();
  CHECK_FALSE(client.session.run(0us));
  CHECK(client.session.finished());
  CHECK(client.session.output() == "ok state=a\n");
}

TEST_CASE("A reply is not to be sent before it is whole") {
  LineClient client;
  client.ask(kLoad);
  const std::string request = "save a\nbranch a NOOP*300 NOOP*300 NOOP*300\n";
  std::ranges::copy(request, client.session.space().begin());
  client.session.received(request.size());
  CHECK(client.session.run(0us));
  CHECK(client.session.run(0us));  // the branch is in progress
  CHECK(client.session.output() == "ok state=a\n");
  client.session.sent(11);
  CHECK(client.session.output().empty());
  CHECK(std::ranges::count(client.listen(), '|') == 3);
}

TEST_CASE("A client that does not read gets no more replies, and loses no reply") {
  LineLimits limits;
  limits.output = 1000;
  LineClient client(line_service(limits));
  client.ask(kLoad);
  client.ask("observe frame ram");
  std::string requests;
  for (int act = 0; act < 50; ++act) requests += "act NOOP\n";
  std::ranges::copy(requests, client.session.space().begin());
  client.session.received(requests.size());
  for (int turn = 0; turn < 10; ++turn) CHECK(client.session.run());
  CHECK(client.session.output().size() < 1600);
  const std::string answers = client.listen();
  CHECK(std::ranges::count(answers, '\n') == 50);
  CHECK_THAT(answers, Contains("ok frame=50 "));
}

TEST_CASE("A reply that would be too long is refused before anything is done") {
  LineLimits limits;
  limits.reply = 1 << 20;  // 15 screens of beamfall, 160 x 210, in hex
  LineClient client(line_service(limits));
  CHECK(value(client.ask("hello"), "max_reply") == "1048576");
  client.ask(kLoad);
  client.ask("observe screen:hex");
  CHECK_THAT(client.ask("open 16"),
             StartsWith("error limit a reply about 16 machines with these fields would have "
                        "about 1075328 bytes; it may have 1048576"));
  CHECK(code(client.ask("step NOOP")) == "no-machines");
  CHECK(client.ask("open 15").size() < limits.reply);
  CHECK(code(client.ask("observe screen:hex ram screen:rle")) == "bad-arguments");
  CHECK(code(client.ask("observe screen:hex grey:hex")) == "limit");
  CHECK(client.ask("observe") == "ok fields=screen");
  CHECK(client.ask("step NOOP").size() > 15 * 67200);
  CHECK(code(client.ask("observe rgb:rle")) == "limit");  // nearly as long, where the screen is not black
  CHECK(code(client.ask("observe screen:base64 reward")) == "");
  CHECK(code(client.ask("open 15")) == "");
  CHECK(code(client.ask("open 15 autoreset=same-step")) == "limit");
  client.ask("save a");
  CHECK(code(client.ask("branch a NOOP*140000")) == "limit");
}

TEST_CASE("The samples of all frames of a step count against the longest reply") {
  LineLimits limits;
  limits.reply = 1 << 20;
  LineClient client(line_service(limits));
  for (const std::string frames : {"100", "2-100"}) {
    client.ask(kLoad + " sound=1 frame_skip=" + frames);
    client.ask("observe audio_all:raw");  // 51,200 bytes for each machine
    CHECK(code(client.ask("open 21")) == "limit");
    CHECK(code(client.ask("open 20")) == "");
    CHECK(client.ask("step NOOP").size() < limits.reply);
    CHECK(code(client.ask("observe audio_all:hex")) == "limit");
    CHECK(client.ask("observe") == "ok fields=audio_all");
    client.ask("observe none");
  }
}

TEST_CASE("A reply of exactly the longest length is given") {
  LineLimits limits;
  limits.reply = 1'075'328;
  LineClient client(line_service(limits));
  client.ask(kLoad);
  client.ask("observe screen:hex");
  CHECK(code(client.ask("open 16")) == "");
  CHECK(code(client.ask("open 17")) == "limit");
}

TEST_CASE("Limits are reported and enforced") {
  LineLimits limits;
  limits.machines = 2;
  limits.states = 2;
  limits.request_frames = 100;
  LineClient client(line_service(limits));
  CHECK(value(client.ask("hello"), "max_machines") == "2");
  client.ask(kLoad);
  for (const std::string many : {"3", "9223372036854775807"})
    CHECK(code(client.ask("open " + many)) == "limit");
  for (const std::string none : {"0", "-1", "x", "9223372036854775808"})
    CHECK(code(client.ask("open " + none)) == "bad-value");
  CHECK(code(client.ask("act NOOP*101")) == "limit");
  CHECK(code(client.ask("act NOOP*100")) == "");
  CHECK(code(client.ask("act NOOP*1000000000 NOOP*1000000000")) == "limit");
  CHECK(code(client.ask("act NOOP*99999999999")) == "bad-value");
  client.say("save a\nsave b\n");
  CHECK(code(client.ask("save c")) == "limit");
  CHECK(code(client.ask("save b")) == "");
  CHECK(code(client.ask("branch a NOOP*60 NOOP*60")) == "limit");
  CHECK(code(client.ask("branch a keep=x NOOP")) == "limit");
}

TEST_CASE("Errors name what is accepted") {
  LineClient client;
  client.ask(kLoad);
  CHECK_THAT(client.ask("open 2 same-step"), Contains("; accepted: autoreset="));
  CHECK_THAT(client.ask("save a b"), Contains("save takes generator="));
  CHECK_THAT(client.ask("hello tok=1"), Contains("hello takes token="));
  CHECK_THAT(client.ask("observe none reward"), Contains("none cannot be combined with other fields"));
  CHECK_THAT(client.ask("load updraft as=x"), Contains("games all lists"));
  CHECK_THAT(client.ask("load beamfall rules=x"), Contains("ale-0.12 or fixed"));
  CHECK(client.ask("modes now") == "error bad-arguments modes takes no arguments, not 1: modes");
}

TEST_CASE("Names of states and recordings cannot lead out of their folder") {
  LineClient client;
  client.ask(kLoad);
  for (const std::string& name :
       {std::string("../a"), std::string("a/b"), std::string("."), std::string(65, 'a')}) {
    CHECK(code(client.ask("save " + name)) == "bad-value");
  }
  CHECK_THAT(client.ask("save all"), Contains("drop all deletes all states"));
  CHECK_THAT(client.ask("record gif a"), Contains("--record-dir"));
}

TEST_CASE("No request makes a session fall over") {
  LineClient client;
  const std::vector<std::string> words = {
      "load", "beamfall", "act",  "observe", "look",         "save",     "a",        "restore", "branch",
      "open", "2",        "step", "restart", "export",       "import",   "AAAA",     "poke",    "peek",
      "0",    "127",      "FF",   "UP",      "FIRE*3",       "1/2@0.5",  "-1",       "@",       "/",
      "*",    "keep=k",   "a,b",  "UP,UP",   "screen:delta", "grey84x4", "rgb",      "none",    "ends",
      "set",  "mode=0",   "=",    "sound=1", "audio",        "random=1", "drop",     "all",     "close",
      "01",   "record",   "stop", "help",    "stats",        "games",    "grey84x99"};
  std::uint32_t random = 1;
  const auto draw = [&random](std::size_t below) {
    random = random * 1664525U + 1013904223U;
    return (random >> 8) % below;
  };
  client.ask(kLoad);
  for (int request = 0; request < 5000; ++request) {
    std::string line;
    for (std::size_t count = 1 + draw(4); count > 0; --count) line += words[draw(words.size())] + " ";
    const std::string reply = client.ask(line);
    REQUIRE((reply.starts_with("ok") || (reply.starts_with("error ") && code(reply) != "internal")));
    REQUIRE(reply.find('\n') == std::string::npos);
  }
}

// A session of the line protocol: the input is the client's.
#include "protocol/line_session.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>
#include <vector>

#include "fuzz/support/folder.hpp"
#include "fuzz/support/keep_code.hpp"
#include "fuzz/support/target.hpp"
#include "recording/recorder.hpp"

namespace racebeam::fuzz {
namespace {

using Lines = std::vector<std::string>;

std::shared_ptr<const Images> make_images() {
  auto images = std::make_shared<const Images>();
  for (const char* name : {"beamfall", "updraft"}) keep_code(*images->find(name));
  return images;
}

// Small, so that an execution is quick.
LineService make_service(const std::string& record_folder) {
  static const auto images = make_images();
  LineService service;
  service.version = "fuzz";
  service.images = images;
  service.limits.line = 4096;
  service.limits.output = 4096;
  service.limits.reply = 1 << 20;
  service.limits.machines = 3;
  service.limits.states = 4;
  service.limits.request_frames = 200;
  service.limits.recording = 1 << 20;
  service.recorder = std::make_shared<Recorder>(record_folder);
  return service;
}

// The bytes that follow a reply's line.
std::size_t raw_size(std::string_view line) {
  constexpr std::string_view kRaw = " raw=";
  const std::size_t at = line.rfind(kRaw);
  if (!line.starts_with("ok ") || at == std::string_view::npos) return 0;
  const std::string_view digits = line.substr(at + kRaw.size());
  std::size_t size = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), size);
  return error == std::errc() && end == digits.data() + digits.size() ? size : 0;
}

// Lines of replies, without the bytes that follow them.
Lines replies_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    require(raw_size(lines.back()) <= text.size(), "as many bytes follow a line as it says", lines.back());
    text.remove_prefix(raw_size(lines.back()));
  }
  return lines;
}

Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// `load` without a seed, or with 0, draws one: the same input would then give different replies.
std::string with_seed(std::string line) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  if (!std::string_view(line).substr(first).starts_with("load ")) return line;
  constexpr std::string_view kKey = " seed=";
  const std::size_t seed = line.find(kKey);
  if (seed == std::string::npos) return line.insert(line.find_last_not_of('\r') + 1, " seed=1");
  const std::size_t value = seed + kKey.size();
  if (value < line.size() && (line[value] == '0' || line[value] == '-')) line.insert(value, 1, '1');
  return line;
}

class Client {
 public:
  // slice: duration of the slices of requests; it must not change the replies.
  explicit Client(std::chrono::microseconds slice)
      : slice_(slice), service_(make_service(folder_.path())), session_(service_) {}

  // Sends the text in pieces of at most `piece` bytes. Returns all replies, each ended by LF.
  std::string say(std::string_view text, std::size_t piece) {
    std::string replies;
    while (!text.empty() && !session_.finished()) {
      const std::span<char> space = session_.space();
      const std::size_t count = std::min({space.size(), text.size(), piece});
      std::copy_n(text.begin(), count, space.begin());
      if (count > 0) session_.received(count);
      text.remove_prefix(count);
      replies += listen();
    }
    return replies;
  }

  std::string close() {
    session_.received(0);
    const std::string replies = listen();
    require(session_.finished(), "a session whose input has ended ends");
    return replies;
  }

  // Sends as much as there is space for, lets a part be executed, and disconnects.
  void say_and_leave(std::string_view text) {
    const std::span<char> space = session_.space();
    session_.received(text.copy(space.data(), space.size()));
    session_.run(slice_);
    session_.cancel();
    require(session_.finished(), "a session whose client has gone has ended");
  }

 private:
  std::string listen() {
    std::string replies;
    bool more = true;
    while (more) {
      more = session_.run(slice_);
      replies += session_.output();
      session_.sent(session_.output().size());
      if (session_.waits()) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return replies;
  }

  std::chrono::microseconds slice_;
  ScratchFolder folder_;
  LineService service_;
  LineSession session_;
};

// A comment has no reply.
bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first != std::string_view::npos && line[first] == '#';
}

bool ends_session(std::string_view line) {
  constexpr std::string_view kEnds[] = {"quit", "exit", "HTTP/"};
  return std::ranges::any_of(kEnds, [&](auto end) { return line.find(end) != std::string_view::npos; });
}

bool is_reply(std::string_view reply) {
  const bool begins = reply == "ok" || reply.starts_with("ok ") || reply.starts_with("error ");
  return begins && is_printable(reply);
}

// Makes replies comparable. Counters of requests differ if requests are left out. The thread that writes a
// recording decides which reply first reports that its limit is reached.
std::string comparable(const std::string& request, std::string reply) {
  if (request.find("stats") != std::string::npos) return "";
  constexpr std::string_view kCut = " recording_ended=limit";
  if (const std::size_t at = reply.find(kCut); at != std::string::npos) reply.erase(at, kCut.size());
  return reply;
}

// A refused request leaves no trace: without it, all other requests get the same replies.
void check_refusals(const Lines& requests, const Lines& replies) {
  Client client(LineSession::kSlice);
  for (std::size_t n = 0; n < replies.size(); ++n) {
    if (replies[n].starts_with("error ")) continue;
    Lines again = replies_of(client.say(requests[n] + "\n", requests[n].size() + 1));
    require(again.size() == 1, "one line is answered by one line", requests[n]);
    require(comparable(requests[n], again[0]) == comparable(requests[n], replies[n]),
            "a request that was refused leaves no trace", requests[n] + "\n" + replies[n] + "\n" + again[0]);
  }
}

}  // namespace

void run(Bytes input) {
  Lines requests = lines_of(text_of(input));
  std::string text;
  for (std::string& request : requests) text += (request = with_seed(request)) + "\n";
  if (!text.empty() && text_of(input).back() != '\n') text.pop_back();
  const bool is_cut = !text.empty() && text.back() != '\n' && !is_comment(requests.back());
  std::erase_if(requests, is_comment);

  Client client(std::chrono::microseconds(1));
  const std::size_t piece = input.empty() ? 1 : 1 + input.size() * 7919 % 997;
  std::string all = client.say(text, piece);
  all += client.close();
  const Lines replies = replies_of(all);

  require(replies.size() <= requests.size(), "no line gets two replies");
  for (std::size_t n = 0; n < replies.size(); ++n)
    require(is_reply(replies[n]), "a reply is `ok` or an error, and printable",
            requests[n] + "\n" + replies[n]);
  if (replies.size() < requests.size()) {
    const bool has_quit =
        !replies.empty() && replies.back() == "ok" && ends_session(requests[replies.size() - 1]);
    require(has_quit, "every line gets a reply, until quit", text);
  }
  if (is_cut && replies.size() == requests.size())
    require(replies.back().starts_with("error "), "half a line is not executed", replies.back());
  check_refusals(requests, replies);
  if (!text.empty()) Client(std::chrono::microseconds(1)).say_and_leave(text);
}

}  // namespace racebeam::fuzz

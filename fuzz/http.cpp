// The requests of a client over HTTP. The first byte selects what the server offers, and how the input is cut
// the second time.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>

#include "fuzz/support/connection.hpp"
#include "fuzz/support/target.hpp"
#include "server/web/exchange.hpp"

namespace racebeam::fuzz {
namespace {

enum Option : unsigned { kNoPages = 1, kNoSessions = 2, kAnyName = 4, kStopping = 8 };
constexpr unsigned kOptionBits = 4;

Site site_of(unsigned options) {
  Site site;
  if ((options & kNoPages) == 0) {
    const bool ready = (options & kStopping) == 0;
    site.pages = OperatorPages{[ready] { return ready; }, [] { return std::string("metric 1\n"); }};
  }
  if ((options & kNoSessions) == 0)
    site.sessions = OriginRules{{"https://lab.example"}, (options & kAnyName) != 0};
  return site;
}

// How a server ends that has read a text.
struct Outcome {
  std::string answers;
  std::optional<HttpRequest> session;
  bool has_ended = false;
};

// Converses as server/web/http.cpp does.
Task<> converse(ByteStream stream, const Site& site, Outcome& outcome) {
  boost::beast::flat_buffer buffer;
  Exchange done;
  done.open = true;
  while (done.open) done = co_await exchange(stream, buffer, site);
  outcome.session = std::move(done.session);
  outcome.has_ended = true;
}

Outcome outcome_of(std::string_view text, const Site& site, std::size_t piece) {
  Outcome outcome;
  Connection connection;
  connection.serve(converse(ByteStream(connection.socket()), site, outcome));
  connection.say(text, piece);
  connection.end();
  outcome.answers = connection.answers();
  return outcome;
}

std::string_view value(const HttpRequest& request, boost::beast::http::field name) {
  const auto found = request[name];
  return {found.data(), found.size()};
}

void check_session(const HttpRequest& request, const Site& site) {
  using boost::beast::http::field;
  require(site.sessions.has_value(), "only a site with sessions opens one");
  const std::string_view target(request.target().data(), request.target().size());
  require(target.substr(0, target.find('?')) == "/session", "only /session opens a session", target);
  if (request.count(field::origin) == 0) return;
  require(admits(*site.sessions, value(request, field::origin), value(request, field::host)),
          "only admitted pages open a session", value(request, field::origin));
}

void check_answers(const std::string& answers) {
  constexpr std::string_view kVersion = "HTTP/1.";
  require(answers.empty() || answers.starts_with(kVersion), "an answer is HTTP", answers.substr(0, 200));
}

// The first lines of answers.
std::string statuses(const std::string& answers) {
  std::string lines;
  for (std::size_t at = 0; (at = answers.find("HTTP/1.", at)) != std::string::npos; ++at)
    lines += answers.substr(at, answers.find('\r', at) - at) + "\n";
  return lines;
}

// The parser may find another fault in bytes that come in parts, or wait for their end.
bool are_alike(const std::string& one, const std::string& other) {
  constexpr std::string_view kRefusal = "this is not HTTP: ";
  if (one.find(kRefusal) == std::string::npos && other.find(kRefusal) == std::string::npos)
    return one == other;
  return statuses(one).starts_with(statuses(other)) || statuses(other).starts_with(statuses(one));
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const unsigned first = reader.byte();
  const Site site = site_of(first);
  const std::string_view text = text_of(reader.rest());
  const Outcome whole = outcome_of(text, site, std::max<std::size_t>(text.size(), 1));
  require(whole.has_ended, "a conversation ends when the client has ended");
  check_answers(whole.answers);
  if (whole.session) check_session(*whole.session, site);

  const Outcome cut = outcome_of(text, site, 1 + (first >> kOptionBits));
  require(cut.has_ended, "a conversation ends when the client has ended, however it is cut");
  // A request for a session is refused if more follows it, which the server sees if it comes at once.
  if (cut.session.has_value() == whole.session.has_value())
    require(are_alike(cut.answers, whole.answers), "the answers do not depend on cuts",
            cut.answers.substr(0, 500) + "\n" + whole.answers.substr(0, 500));
}

}  // namespace racebeam::fuzz

// Loads a server: sessions that wait, sessions that act from time to time and are timed, and misbehaving
// ones.
//
//   load_client PORT SESSIONS ACTORS SECONDS PAUSE_MS CONNECTS_A_SECOND RUDE LOAD OBSERVE
//
// Connects SESSIONS, which send the requests LOAD and OBSERVE, prints "ready", and waits for a line. Then
// ACTORS of them act, one act each PAUSE_MS, or at once after a reply if that is 0. Prints one JSON object
// with the latencies of their acts and the bytes of the replies, and waits for a line or the end of its
// input. CONNECTS_A_SECOND others connect, send half a line and disconnect. RUDE clients of each kind request
// screens and never read, send a byte a second, or are killed within a line. Replies must not have raw bytes.
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <list>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/server/wire/line_channel.hpp"
#include "tests/server/wire/percentile.hpp"

namespace {

using wire::LineChannel;
using wire::now;

struct Plan {
  int port, sessions, actors;
  double seconds, pause;
  int connects, rude;
  std::string load, observe;  // requests
};

// An acting client: when its next act is due, and since when it waits for a reply.
struct Actor {
  explicit Actor(int with) : socket(with) {}
  int socket;
  double due = 0, asked = 0;  // asked: 0 when no reply is awaited
};

int connect_and_load(const Plan& plan) {
  const int socket = wire::connect_tcp(plan.port);
  LineChannel channel(socket, socket);
  for (const std::string& request : {plan.load, plan.observe}) {
    channel.send(request + "\n");
    if (!channel.line().starts_with("ok")) throw std::runtime_error("the server refused: " + request);
  }
  return socket;
}

// Reads the available bytes, and counts them. Returns whether the reply is complete.
bool take_reply(int socket, std::size_t& bytes) {
  static char buffer[1 << 16];
  const ssize_t count = ::recv(socket, buffer, sizeof buffer, MSG_DONTWAIT);
  if (count <= 0) throw std::runtime_error("the server closed a session that acts");
  bytes += static_cast<std::size_t>(count);
  return buffer[count - 1] == '\n';
}

struct Acts {
  std::vector<double> latencies;
  std::size_t bytes = 0;  // of their replies
  double seconds = 0;
};

// With a pause, the machine is not saturated: only the effect of the others is measured.
Acts act(std::vector<Actor>& actors, const Plan& plan) {
  Acts acts;
  std::vector<pollfd> polled;
  for (const Actor& actor : actors) polled.push_back({actor.socket, POLLIN, 0});
  const double begin = now(), end = begin + plan.seconds;
  for (std::size_t i = 0; i < actors.size(); ++i)
    actors[i].due = begin + plan.pause * static_cast<double>(i) / static_cast<double>(actors.size());
  while (now() < end) {
    double next = end;
    for (Actor& actor : actors) {
      if (actor.asked == 0 && actor.due <= now()) {
        actor.asked = now();
        LineChannel::send(actor.socket, "act FIRE\n");
      }
      if (actor.asked == 0) next = std::min(next, actor.due);
    }
    const double wait = std::max(0.0, next - now());
    timespec timeout{0, static_cast<long>(std::min(wait, 0.5) * 1e9)};
    if (::ppoll(polled.data(), polled.size(), &timeout, nullptr) <= 0) continue;
    for (std::size_t i = 0; i < actors.size(); ++i) {
      if ((polled[i].revents & (POLLIN | POLLHUP)) == 0 || !take_reply(actors[i].socket, acts.bytes))
        continue;
      acts.latencies.push_back(now() - actors[i].asked);
      actors[i].due = std::max(actors[i].due + plan.pause, now());
      actors[i].asked = 0;
    }
  }
  acts.seconds = now() - begin;
  return acts;
}

void sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Connects, sends half a line and disconnects.
void come_and_go(const Plan& plan, const std::atomic<bool>& over, std::atomic<int>& connected) {
  const double begin = now();
  for (int number = 0; !over; ++number) {
    const int socket = wire::connect_tcp(plan.port);
    LineChannel::send(socket, "load beamf");
    ::close(socket);
    ++connected;
    sleep(std::max(0.0, begin + (number + 1.0) / plan.connects - now()));
  }
}

void ask_and_never_read(const Plan& plan, std::list<int>& sockets) {
  for (int i = 0; i < plan.rude; ++i) {
    const int socket = sockets.emplace_back(connect_and_load(plan));
    LineChannel::send(socket, "observe screen:hex\n");
    for (int request = 0; request < 200; ++request) LineChannel::send(socket, "look\n");
  }
}

void dribble(const Plan& plan, const std::atomic<bool>& over) {
  std::vector<int> sockets;
  for (int i = 0; i < plan.rude; ++i) sockets.push_back(wire::connect_tcp(plan.port));
  while (!over) {
    for (const int socket : sockets) LineChannel::send(socket, "x");
    for (int tenths = 0; tenths < 10 && !over; ++tenths) sleep(0.1);
  }
}

int run(const Plan& plan) {
  std::vector<int> waiting;
  std::vector<Actor> actors;
  for (int i = 0; i < plan.actors; ++i) actors.emplace_back(connect_and_load(plan));
  for (int i = plan.actors; i < plan.sessions; ++i) waiting.push_back(connect_and_load(plan));
  std::cout << "ready" << std::endl;
  std::cin.get();
  std::atomic<bool> over = false;
  std::atomic<int> connected = 0;
  std::list<int> deaf;
  std::vector<std::thread> rude;
  if (plan.connects > 0) rude.emplace_back([&] { come_and_go(plan, over, connected); });
  if (plan.rude > 0) {
    ask_and_never_read(plan, deaf);
    rude.emplace_back([&] { dribble(plan, over); });
  }
  Acts acts = act(actors, plan);
  over = true;
  for (std::thread& thread : rude) thread.join();
  std::vector<double>& latencies = acts.latencies;
  std::ranges::sort(latencies);
  std::cout << nlohmann::ordered_json{{"acts", latencies.size()},
                                      {"bytes", acts.bytes},
                                      {"seconds", acts.seconds},
                                      {"p50", 1e6 * wire::percentile(latencies, 0.5)},
                                      {"p90", 1e6 * wire::percentile(latencies, 0.9)},
                                      {"p99", 1e6 * wire::percentile(latencies, 0.99)},
                                      {"p999", 1e6 * wire::percentile(latencies, 0.999)},
                                      {"max", 1e6 * wire::percentile(latencies, 1)},
                                      {"connects", connected.load()}}
                   .dump()
            << std::endl;
  std::cin.get();  // the parent examines the server now
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
  try {
    if (argc != 10)
      throw std::runtime_error("PORT SESSIONS ACTORS SECONDS PAUSE_MS CONNECTS_A_SECOND RUDE LOAD OBSERVE");
    const auto number = [argv](int place) { return std::atof(argv[place]); };
    return run({static_cast<int>(number(1)), static_cast<int>(number(2)), static_cast<int>(number(3)),
                number(4), number(5) / 1000, static_cast<int>(number(6)), static_cast<int>(number(7)),
                argv[8], argv[9]});
  } catch (const std::exception& error) {
    std::cerr << "load_client: " << error.what() << "\n";
    return 1;
  }
}

// What the wire costs: steps a second of one client that waits for each reply, or sends some requests ahead,
// over each transport; beside the same session without a wire, and an echo server that sends the same bytes.
// And the processor time that the serving process takes for a step, which does not depend on who else uses
// the machine.
//
//   wire_bench [--apart] RACEBEAM IMAGE STEPS AHEAD [KEY=VALUE...]
//   prints one JSON object; settings are those of load. --apart: client and server on a processor each.
//   wire_bench --machines N RACEBEAM IMAGE STEPS FIELD...
//   the same for N machines in one session, beside one in process; STEPS of that one, a tenth as
//   many of each of the others; rates are frames a second of all together.
//   wire_bench --echo FILE                                 the echo server on standard streams: a line of
//   FILE a line
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/server/wire/bench_job.hpp"
#include "tests/server/wire/line_channel.hpp"

namespace {

using wire::Job;
using wire::LineChannel;
using wire::Lines;
using wire::LocalSession;

struct Cost {
  double rate;          // steps a second
  double microseconds;  // of the processor, for a step, in the process that serves
};

double processor_seconds(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the server has ended");
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Of a piece of work, by the process that serves.
class Meter {
 public:
  explicit Meter(pid_t server) : server_(server) {}
  Cost of(int steps) const {
    return {steps / (wire::now() - begin_), 1e6 * (processor_seconds(server_) - busy_) / steps};
  }

 private:
  pid_t server_;
  double busy_ = processor_seconds(server_), begin_ = wire::now();
};

// Keeps what came back when `replies` is there.
Cost drive(LineChannel& channel, const Job& job, pid_t server, Lines* replies = nullptr) {
  std::size_t sent = 0, window = static_cast<std::size_t>(job.ahead);
  const Meter meter(server);
  for (std::size_t received = 0; received < job.requests.size(); ++received) {
    while (sent < job.requests.size() && sent < received + window) channel.send(job.requests[sent++]);
    const auto line = channel.line();
    if (line.empty() || line.starts_with("error"))
      throw std::runtime_error("the server said: " + std::string(line));
    if (replies) replies->emplace_back(line);
  }
  return meter.of(job.steps);
}

Cost drive_racebeam(LineChannel& channel, const Job& job, pid_t server, Lines* replies = nullptr) {
  for (const std::string& request : job.preparation) {
    channel.send(request);
    if (const auto line = channel.line(); !line.starts_with("ok"))
      throw std::runtime_error("the server said: " + std::string(line));
  }
  return drive(channel, job, server, replies);
}

std::string wait_for(const std::string& ready_file) {
  for (int tries = 0; tries < 2000; ++tries) {
    std::ifstream file(ready_file);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!text.empty()) return text;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the server does not start");
}

// racebeam over each transport

Cost over_standard_streams(const Job& job, Lines* replies) {
  const auto child =
      wire::start({job.racebeam, "serve", "--stdio", "--rom", job.image, "--log-level", "off"});
  LineChannel channel(child.in, child.out);
  const Cost cost = drive_racebeam(channel, job, child.process, replies);
  wire::stop(child);
  return cost;
}

Cost over_socket(const Job& job, bool tcp) {
  const std::string folder = std::filesystem::temp_directory_path() / ("wire-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const std::string address = tcp ? "tcp://127.0.0.1:0" : "unix:" + folder + "/s", ready = folder + "/ready";
  const auto child = wire::start({job.racebeam, "serve", "--listen", address, "--ready-file", ready, "--rom",
                                  job.image, "--log-level", "off", "--grace", "0"});
  const std::string name = wait_for(ready);
  const int socket = tcp ? wire::connect_tcp(std::atoi(name.c_str() + name.rfind(':') + 1))
                         : wire::connect_unix(folder + "/s");
  LineChannel channel(socket, socket);
  const Cost cost = drive_racebeam(channel, job, child.process);
  ::close(socket);
  ::kill(child.process, SIGTERM);
  wire::stop(child);
  std::filesystem::remove_all(folder);
  return cost;
}

// The echo server

void echo(LineChannel channel, const Lines& replies) {
  for (const std::string& reply : replies) {
    if (channel.line().empty()) return;
    channel.send(reply);
  }
}

Lines read_lines(const std::string& path) {
  std::ifstream file(path);
  Lines lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line + "\n");
  return lines;
}

Cost echo_over_standard_streams(const Job& job, const Lines& replies) {
  const std::string path = std::filesystem::temp_directory_path() / ("echo-" + std::to_string(::getpid()));
  std::ofstream file(path);
  for (const std::string& reply : replies) file << reply;
  file.close();
  const auto child = wire::start({"/proc/self/exe", "--echo", path});
  LineChannel channel(child.in, child.out);
  channel.send("ready?\n");  // its first line is not timed: it has to read the file
  channel.line();
  const Cost cost = drive(channel, job, child.process);
  wire::stop(child);
  std::filesystem::remove(path);
  return cost;
}

// In a process of its own, as racebeam is.
Cost echo_over_socket(const Job& job, const Lines& replies, bool tcp) {
  const std::string path = std::filesystem::temp_directory_path() / ("echo-s-" + std::to_string(::getpid()));
  int port = 0;
  const int listener = tcp ? wire::listen_tcp(port) : wire::listen_unix(path);
  const pid_t child = ::fork();
  if (child == 0) {
    wire::run_as_server();
    const int socket = wire::accept_one(listener);
    echo(LineChannel(socket, socket), replies);
    ::_exit(0);
  }
  const int socket = tcp ? wire::connect_tcp(port) : wire::connect_unix(path);
  LineChannel channel(socket, socket);
  const Cost cost = drive(channel, job, child);
  ::close(socket);
  ::close(listener);
  ::waitpid(child, nullptr, 0);
  ::unlink(path.c_str());
  return cost;
}

// The same session without a wire.
Cost in_process(const Job& job) {
  LocalSession session(job);
  const Meter meter(::getpid());
  for (const std::string& request : job.requests) session.ask(request);
  return meter.of(job.steps);
}

// Rounds alternate, so that all meet the same disturbances; the medians count.
using Measurement = std::pair<std::string, std::function<Cost()>>;
nlohmann::ordered_json measure(const std::vector<Measurement>& all) {
  constexpr std::size_t kRounds = 5;
  std::vector<std::vector<double>> rates(all.size()), times(all.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Cost cost = all[i].second();
      rates[i].push_back(cost.rate);
      times[i].push_back(cost.microseconds);
    }
  }
  nlohmann::ordered_json figures;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (auto* values : {&rates[i], &times[i]}) std::ranges::sort(*values);
    figures[all[i].first] = {{"rate", rates[i][kRounds / 2]}, {"microseconds", times[i][kRounds / 2]}};
  }
  return figures;
}

int bench(const std::vector<std::string>& words) {
  Job job{words.at(0), words.at(1), {}, std::atoi(words.at(2).c_str()), std::atoi(words.at(3).c_str()), {}};
  std::string load = wire::load_of(job.image);
  for (std::size_t i = 4; i < words.size(); ++i) load += " " + words[i];
  job.preparation = {load + "\n", "observe reward ends lives ram screen:rle\n"};
  job.requests = wire::draw_requests(job.steps, "act");
  wire::reset_where_it_ends(job);
  Lines replies;
  over_standard_streams(job, &replies);
  std::size_t bytes = 0;
  for (const std::string& reply : replies) bytes += reply.size();
  Lines with_first = {"ready\n"};
  with_first.insert(with_first.end(), replies.begin(), replies.end());
  nlohmann::ordered_json figures = measure({
      {"in_process", [&] { return in_process(job); }},
      {"stdio", [&] { return over_standard_streams(job, nullptr); }},
      {"echo_stdio", [&] { return echo_over_standard_streams(job, with_first); }},
      {"unix", [&] { return over_socket(job, false); }},
      {"echo_unix", [&] { return echo_over_socket(job, replies, false); }},
      {"tcp", [&] { return over_socket(job, true); }},
      {"echo_tcp", [&] { return echo_over_socket(job, replies, true); }},
  });
  figures["bytes"] = static_cast<double>(bytes) / job.steps;
  std::cout << figures.dump() << "\n";
  return 0;
}

int bench_machines(const std::string& machines, const std::vector<std::string>& words) {
  std::string observe = "observe";
  for (std::size_t i = 3; i < words.size(); ++i) observe += " " + words[i];
  const int steps = std::atoi(words.at(2).c_str());
  Job one{words.at(0), words.at(1), {wire::load_of(words.at(1)) + "\n", observe + "\n"}, steps, 1, {}};
  Job many = one;
  one.requests = wire::draw_requests(steps, "act");
  wire::reset_where_it_ends(one);
  many.preparation.push_back("open " + machines + " autoreset=same-step\n");
  many.requests = wire::draw_requests(steps / 10, "step");
  many.steps = static_cast<int>(many.requests.size()) * std::atoi(machines.c_str());
  std::cout << measure({
                           {"in_process", [&] { return in_process(one); }},
                           {"stdio", [&] { return over_standard_streams(many, nullptr); }},
                           {"unix", [&] { return over_socket(many, false); }},
                           {"tcp", [&] { return over_socket(many, true); }},
                       })
                   .dump()
            << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "--echo") {
      const Lines replies = read_lines(words[1]);
      echo(LineChannel(STDIN_FILENO, STDOUT_FILENO), replies);
      return 0;
    }
    if (!words.empty() && words[0] == "--apart") {
      wire::put_apart();
      words.erase(words.begin());
    }
    if (words.size() > 5 && words[0] == "--machines")
      return bench_machines(words[1], {words.begin() + 2, words.end()});
    if (words.size() < 4) throw std::runtime_error("[--apart] RACEBEAM IMAGE STEPS AHEAD [KEY=VALUE...]");
    return bench(words);
  } catch (const std::exception& error) {
    std::cerr << "wire_bench: " << error.what() << "\n";
    return 1;
  }
}

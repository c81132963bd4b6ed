#include "tests/server/wire/transports.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace wire {
namespace {

double processor_seconds(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the server has ended");
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Records the output if `replies` is not null.
Cost drive(LineChannel& channel, const Job& job, pid_t server, Lines* replies) {
  std::string unsent;
  std::size_t sent = 0, window = static_cast<std::size_t>(job.ahead);
  const Meter meter(server);
  for (std::size_t received = 0; received < job.requests.size(); ++received) {
    unsent.clear();
    while (sent < job.requests.size() && sent < received + window) {
      unsent += job.requests[sent++];
      if (!job.one_write) channel.send(std::exchange(unsent, {}));
    }
    channel.send(unsent);
    const auto line = channel.line();
    if (line.empty() || line.starts_with("error"))
      throw std::runtime_error("the server said: " + std::string(line));
    if (replies) replies->emplace_back(line);
  }
  return meter.of(job.steps);
}

Cost drive_racebeam(LineChannel& channel, const Job& job, pid_t server, Lines* replies) {
  for (const std::string& request : job.preparation) {
    channel.send(request);
    if (const auto line = channel.line(); !line.starts_with("ok"))
      throw std::runtime_error("the server said: " + std::string(line));
  }
  return drive(channel, job, server, replies);
}

// The first address.
std::string wait_for(const std::string& ready_file) {
  for (int tries = 0; tries < 2000; ++tries) {
    std::ifstream file(ready_file);
    for (std::string line; std::getline(file, line);)
      if (!line.starts_with('#')) return line;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the server does not start");
}

}  // namespace

Meter::Meter(pid_t server) : server_(server), busy_(processor_seconds(server)), begin_(now()) {}

Cost Meter::of(int steps) const {
  return {steps / (now() - begin_), 1e6 * (processor_seconds(server_) - busy_) / steps};
}

// racebeam over each transport

Cost over_standard_streams(const Job& job, Lines* replies) {
  const auto child = start({job.racebeam, "serve", "--stdio", "--rom", job.image, "--log-level", "off"});
  LineChannel channel(child.in, child.out);
  const Cost cost = drive_racebeam(channel, job, child.process, replies);
  stop(child);
  return cost;
}

Cost over_socket(const Job& job, bool tcp) {
  const std::string folder = std::filesystem::temp_directory_path() / ("wire-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const std::string address = tcp ? "tcp://127.0.0.1:0" : "unix:" + folder + "/s", ready = folder + "/ready";
  const auto child = start({job.racebeam, "serve", "--listen", address, "--ready-file", ready, "--rom",
                            job.image, "--log-level", "off", "--grace", "0"});
  const std::string name = wait_for(ready);
  const int socket =
      tcp ? connect_tcp(std::atoi(name.c_str() + name.rfind(':') + 1)) : connect_unix(folder + "/s");
  LineChannel channel(socket, socket);
  const Cost cost = drive_racebeam(channel, job, child.process, nullptr);
  ::close(socket);
  ::kill(child.process, SIGTERM);
  stop(child);
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
  const auto child = start({"/proc/self/exe", "--echo", path});
  LineChannel channel(child.in, child.out);
  channel.send("ready?\n");  // its first line is not timed: it has to read the file
  channel.line();
  const Cost cost = drive(channel, job, child.process, nullptr);
  stop(child);
  std::filesystem::remove(path);
  return cost;
}

// In its own process, like racebeam.
Cost echo_over_socket(const Job& job, const Lines& replies, bool tcp) {
  const std::string path = std::filesystem::temp_directory_path() / ("echo-s-" + std::to_string(::getpid()));
  int port = 0;
  const int listener = tcp ? listen_tcp(port) : listen_unix(path);
  const pid_t child = ::fork();
  if (child == 0) {
    run_as_server();
    const int socket = accept_one(listener);
    echo(LineChannel(socket, socket), replies);
    ::_exit(0);
  }
  const int socket = tcp ? connect_tcp(port) : connect_unix(path);
  LineChannel channel(socket, socket);
  const Cost cost = drive(channel, job, child, nullptr);
  ::close(socket);
  ::close(listener);
  ::waitpid(child, nullptr, 0);
  ::unlink(path.c_str());
  return cost;
}

}  // namespace wire

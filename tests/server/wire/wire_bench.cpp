// Measures the cost of the wire: steps a second of one client that waits for each reply, or sends some
// requests ahead, over each transport. Compares them with the same session without a wire, and with an echo
// server that sends the same bytes. Also measures the processor time of the serving process for a step, which
// does not depend on other processes.
//
//   wire_bench [--apart] [--one-write] RACEBEAM IMAGE STEPS AHEAD [KEY=VALUE...]
//       prints one JSON object; settings are those of load. --apart: client and server have a processor each.
//       --one-write: the client sends all requests that it may send in one write, else in one each.
//   wire_bench --machines N RACEBEAM IMAGE STEPS AHEAD FIELD|KEY=VALUE...
//       the same for N machines in one session, compared with one in process: STEPS of that one, a tenth as
//       many of each of the others; rates are steps a second of all together.
//   wire_bench --echo FILE
//       the echo server on standard streams: answers each line with a line of FILE
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/server/wire/transports.hpp"

namespace {

using wire::Cost;
using wire::Job;
using wire::Lines;

// Times the same session without a wire.
Cost in_process(const Job& job) {
  wire::LocalSession session(job);
  const wire::Meter meter(::getpid());
  for (const std::string& request : job.requests) session.ask(request);
  return meter.of(job.steps);
}

// Rounds alternate, so that all meet the same disturbances; measurements of the same round are compared.
// "rates" has them in order; "rate" and "microseconds" are medians.
using Measurement = std::pair<std::string, std::function<Cost()>>;
nlohmann::ordered_json measure(const std::vector<Measurement>& all) {
  constexpr std::size_t kRounds = 9;
  std::vector<std::vector<double>> rates(all.size()), times(all.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Cost cost = all[i].second();
      rates[i].push_back(cost.rate);
      times[i].push_back(cost.microseconds);
    }
  }
  nlohmann::ordered_json figures;
  const auto median = [](std::vector<double> values) {
    std::ranges::sort(values);
    return values[kRounds / 2];
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    figures[all[i].first] = {
        {"rate", median(rates[i])}, {"rates", rates[i]}, {"microseconds", median(times[i])}};
  return figures;
}

int bench(const std::vector<std::string>& words, bool one_write) {
  Job job{words.at(0), words.at(1), {}, std::atoi(words.at(2).c_str()), std::atoi(words.at(3).c_str()), {}};
  job.one_write = one_write;
  std::string load = wire::load_of(job.image);
  for (std::size_t i = 4; i < words.size(); ++i) load += " " + words[i];
  job.preparation = {load + "\n", "observe reward terminated truncated lives ram screen:rle\n"};
  job.requests = wire::draw_requests(job.steps, "act");
  wire::reset_where_it_ends(job);
  Lines replies;
  wire::over_standard_streams(job, &replies);
  std::size_t bytes = 0;
  for (const std::string& reply : replies) bytes += reply.size();
  Lines with_first = {"ready\n"};
  with_first.insert(with_first.end(), replies.begin(), replies.end());
  nlohmann::ordered_json figures = measure({
      {"in_process", [&] { return in_process(job); }},
      {"stdio", [&] { return wire::over_standard_streams(job, nullptr); }},
      {"echo_stdio", [&] { return wire::echo_over_standard_streams(job, with_first); }},
      {"unix", [&] { return wire::over_socket(job, false); }},
      {"echo_unix", [&] { return wire::echo_over_socket(job, replies, false); }},
      {"tcp", [&] { return wire::over_socket(job, true); }},
      {"echo_tcp", [&] { return wire::echo_over_socket(job, replies, true); }},
  });
  figures["bytes"] = static_cast<double>(bytes) / job.steps;
  std::cout << figures.dump() << "\n";
  return 0;
}

int bench_machines(const std::string& machines, const std::vector<std::string>& words) {
  std::string load = wire::load_of(words.at(1)), observe = "observe";
  for (std::size_t i = 4; i < words.size(); ++i)
    (words[i].find('=') != std::string::npos ? load : observe) += " " + words[i];
  const int steps = std::atoi(words.at(2).c_str());
  Job one{words.at(0), words.at(1), {load + "\n", observe + "\n"}, steps, 1, {}};
  Job many = one;
  many.ahead = std::atoi(words.at(3).c_str());
  one.requests = wire::draw_requests(steps, "act");
  wire::reset_where_it_ends(one);
  many.preparation.push_back("open " + machines + " autoreset=same-step\n");
  many.requests = wire::draw_requests(steps / 10, "step");
  many.steps = static_cast<int>(many.requests.size()) * std::atoi(machines.c_str());
  std::cout << measure({
                           {"in_process", [&] { return in_process(one); }},
                           {"stdio", [&] { return wire::over_standard_streams(many); }},
                           {"unix", [&] { return wire::over_socket(many, false); }},
                           {"tcp", [&] { return wire::over_socket(many, true); }},
                       })
                   .dump()
            << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto has_option = [&words](const char* name) {
    if (words.empty() || words[0] != name) return false;
    words.erase(words.begin());
    return true;
  };
  try {
    if (words.size() == 2 && has_option("--echo")) {
      wire::echo(wire::LineChannel(STDIN_FILENO, STDOUT_FILENO), wire::read_lines(words[0]));
      return 0;
    }
    if (has_option("--apart")) wire::put_apart();
    if (words.size() > 6 && has_option("--machines"))
      return bench_machines(words[0], {words.begin() + 1, words.end()});
    const bool one_write = has_option("--one-write");
    if (words.size() < 4)
      throw std::runtime_error("[--apart] [--one-write] RACEBEAM IMAGE STEPS AHEAD [KEY=VALUE...]");
    return bench(words, one_write);
  } catch (const std::exception& error) {
    std::cerr << "wire_bench: " << error.what() << "\n";
    return 1;
  }
}

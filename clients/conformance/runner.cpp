// Takes the steps of a file with the client in C++, and prints what came of each: runner FILE.

#include <zlib.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <racebeam/client.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace client = racebeam::client;

using Words = std::vector<std::string>;

std::string digest(std::span<const std::uint8_t> bytes) {
  char text[40];
  const auto sum = adler32(adler32(0, nullptr, 0), bytes.data(), static_cast<unsigned>(bytes.size()));
  std::snprintf(text, sizeof text, "%zu:%08lx", bytes.size(), sum);
  return text;
}

// Numbers and texts are printed as they came, and bytes by their digest.
class Runner {
 public:
  void take(const std::string& line) {
    print([&] { return taken(filled(line)); });
  }

  void close() {
    if (session_) session_->close();
  }

 private:
  using Printed = std::optional<std::string>;

  // Prints what a step gives, or the word for its failure.
  static void print(const std::function<Printed()>& step) {
    Printed printed;
    try {
      printed = step();
    } catch (const client::Refused& refused) {
      printed = "error " + refused.code();
    } catch (const client::TimedOut&) {
      printed = "timeout";
    } catch (const client::Lost&) {
      printed = "lost";
    } catch (const std::invalid_argument&) {
      printed = "invalid";
    }
    if (printed) std::cout << *printed << std::endl;
  }

  // The line with the values of its variables.
  std::string filled(const std::string& line) const {
    std::string text;
    for (std::size_t at = 0; at < line.size();) {
      if (line[at] != '$') {
        text += line[at++];
        continue;
      }
      const std::size_t end = std::min(line.find_first_not_of(kNameLetters, at + 1), line.size());
      const std::string name = line.substr(at + 1, end - at - 1);
      const auto variable = variables_.find(name);
      text += variable != variables_.end() ? variable->second : std::getenv(name.c_str());
      at = end;
    }
    return text;
  }

  Printed taken(const std::string& line) {
    const std::size_t blank = line.find(' ');
    const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
    std::istringstream stream(rest);
    Words words;
    for (std::string word; stream >> word;) words.push_back(word);
    words.resize(std::max<std::size_t>(2, words.size()));
    return (this->*kSteps.at(line.substr(0, blank)))(rest, words);
  }

  Printed section(const std::string&, const Words& words) {
    options_ = usual_options();
    stack_.reset();
    commands_.clear();
    return "section " + words[0];
  }

  Printed connect(const std::string&, const Words& words) {
    close();
    session_ = connected(words[0], words[1]);
    return "connected";
  }

  Printed another(const std::string&, const Words& words) {
    connected(words[0], words[1]).close();
    return "connected";
  }

  Printed connections(const std::string&, const Words& words) {
    for (int n = 0; n < std::stoi(words[0]); ++n) connected(words[1], "").close();
    return "connected";
  }

  Printed launch(const std::string&, const Words&) {
    close();
    session_ = client::launch(std::getenv("RACEBEAM_BINARY"));
    return "connected";
  }

  Printed ask(const std::string& rest, const Words& words) {
    send(rest, words);
    return reply();
  }

  Printed send(const std::string& rest, const Words& words) {
    session_->send(rest);
    commands_.push_back(words[0]);
    return {};
  }

  Printed receive(const std::string&, const Words& words) {
    for (int n = 0; n < std::stoi(words[0]); ++n) print([this] { return reply(); });
    return {};
  }

  Printed picture(const std::string& rest, const Words&) {
    session_->save_png(rest);
    std::ifstream file(rest, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return "picture " + digest({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }

  Printed keep(const std::string&, const Words& words) {
    variables_[words[0]] = last_.text(words[1]);
    return {};
  }

  Printed close_session(const std::string&, const Words&) {
    close();
    return {};
  }

  Printed timeout(const std::string&, const Words& words) {
    options_.timeout = std::chrono::seconds(std::stoi(words[0]));
    return {};
  }

  Printed trust(const std::string& rest, const Words&) {
    options_.authorities = rest;
    return {};
  }

  Printed stack(const std::string&, const Words& words) {
    stack_.emplace(Stack{words[0], words[0] + "x" + words[1], client::ScreenStack(std::stoul(words[1]))});
    return {};
  }

  Printed wait(const std::string&, const Words& words) {
    std::this_thread::sleep_for(std::chrono::seconds(std::stoi(words[0])));
    return {};
  }

  Printed time(const std::string& rest, const Words& words) {
    const int steps = std::stoi(words[0]), ahead = std::stoi(words[1]);
    const std::string request = rest.substr(rest.find(' ', rest.find(' ') + 1) + 1);
    const auto start = std::chrono::steady_clock::now();
    for (int step = 0; step < steps; step += ahead) {
      for (int n = 0; n < ahead; ++n) session_->send(request);
      for (int n = 0; n < ahead; ++n) session_->receive();
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return "time " + words[1] + " " + std::to_string(seconds.count());
  }

  client::Session connected(const std::string& address, const std::string& token) const {
    client::Options options = options_;
    options.token = token;
    return client::connect(address, options);
  }

  std::string reply() {
    const std::string command = commands_.empty() ? "" : commands_.front();
    if (!commands_.empty()) commands_.pop_front();
    const client::Reply reply = session_->receive();
    last_ = reply.first();
    std::string text = "ok";
    for (const client::Group& group : reply.groups())
      text += (text == "ok" ? "" : " |") + text_of(command, group);
    return text;
  }

  std::string text_of(const std::string& command, const client::Group& group) {
    if (stack_ && (command == "reset" || command == "load" || command == "observe")) stack_->screens.clear();
    std::map<std::string, std::string> pairs;
    for (const auto& [key, text, is_bytes, bytes] : group.values()) {
      if (stack_ && key == stack_->field) {
        pairs[stack_->name] = digest(stack_->screens.push(bytes));
      } else {
        pairs[std::string(key)] = is_bytes ? digest(bytes) : std::string(text);
      }
    }
    std::string text;
    for (const auto& [key, value] : pairs) text.append(" ").append(key).append("=").append(value);
    return text;
  }

  static client::Options usual_options() {
    client::Options options;
    options.longest_reply = std::size_t{1} << 20;
    options.timeout = std::chrono::seconds(60);
    return options;
  }

  struct Stack {
    std::string field, name;
    client::ScreenStack screens;
  };

  static constexpr const char* kNameLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  inline static const std::map<std::string, Printed (Runner::*)(const std::string&, const Words&)> kSteps{
      {"section", &Runner::section},
      {"connect", &Runner::connect},
      {"another", &Runner::another},
      {"launch", &Runner::launch},
      {"connections", &Runner::connections},
      {">", &Runner::ask},
      {"send", &Runner::send},
      {"receive", &Runner::receive},
      {"picture", &Runner::picture},
      {"keep", &Runner::keep},
      {"close", &Runner::close_session},
      {"timeout", &Runner::timeout},
      {"trust", &Runner::trust},
      {"stack", &Runner::stack},
      {"wait", &Runner::wait},
      {"time", &Runner::time}};

  std::map<std::string, std::string> variables_;
  client::Options options_ = usual_options();
  std::optional<client::Session> session_;
  client::Group last_;
  std::optional<Stack> stack_;
  std::deque<std::string> commands_;  // of requests without a reply
};

}  // namespace

int main(int, char** words) {
  Runner runner;
  std::ifstream file(words[1]);
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') runner.take(line);
  runner.close();
}

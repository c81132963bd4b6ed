// What the Tab key completes in a line to a server of the line protocol: commands, and the words of their
// arguments. The server is asked for all of them, so that a new command is completed, too.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace racebeam {

class Completion {
 public:
  // The text of a reply, without `ok`; empty if the server refuses the request.
  using Ask = std::function<std::string(const std::string& request)>;

  // own: the lines that the program itself takes.
  Completion(Ask ask, std::vector<std::string> own) : ask_(std::move(ask)), own_(std::move(own)) {}

  // The words that begin with `word`, where `before` is the line before it. Case does not matter.
  std::vector<std::string> words(std::string_view before, std::string_view word) const;

 private:
  std::vector<std::string> commands() const;
  std::vector<std::string> arguments(std::string_view command, std::string_view word) const;
  void add_alternatives(std::string_view command, std::string_view token, std::string_view word,
                        std::vector<std::string>& found) const;
  std::vector<std::string> named(std::string_view command, std::string_view placeholder,
                                 std::string_view word) const;
  std::vector<std::string> values_of(std::string_view key) const;
  std::vector<std::string> listed(const std::string& request, std::string_view key) const;

  Ask ask_;
  std::vector<std::string> own_;
};

}  // namespace racebeam

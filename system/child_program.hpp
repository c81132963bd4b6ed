// Another program, a child process of this one, that reads the bytes that it is sent.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

// Not thread-safe. The program has only its standard descriptors, in its own process group. Its standard
// output is lost.
class ChildProgram {
 public:
  // `words`: the program, found as a shell does, and its arguments. Throws std::system_error: with the code
  // no_such_file_or_directory, the PATH has no such program.
  explicit ChildProgram(std::vector<std::string> words);
  ~ChildProgram();  // kills the program, if it runs
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  // Sends what the program accepts within 20 ms, and returns the number of bytes; -1: it does not read any
  // more.
  std::ptrdiff_t send(std::string_view bytes);
  void close_input();
  bool has_input() const;

  bool has_ended();            // without waiting
  bool has_succeeded() const;  // it has ended with status 0
  std::string errors();        // what it has written to standard error since the last call

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

}  // namespace racebeam

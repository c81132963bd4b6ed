// A child process that runs another program, and reads the bytes that this process sends to it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

// Not thread-safe. The program has only its standard descriptors, and its own process group. Its standard
// output is discarded.
class ChildProgram {
 public:
  // words: the program, which is searched for in the PATH, and its arguments. Throws std::system_error; its
  // code is no_such_file_or_directory if the PATH does not have the program.
  explicit ChildProgram(std::vector<std::string> words);
  ~ChildProgram();  // kills the program, if it runs
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  // Sends what the program accepts within 20 ms. Returns the number of bytes; -1: it does not read any more.
  std::ptrdiff_t send(std::string_view bytes);
  void close_input();
  bool has_input() const;

  bool has_ended();            // without waiting
  bool has_succeeded() const;  // whether it has ended with status 0
  std::string errors();        // what it has written to standard error since the last call

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

}  // namespace racebeam

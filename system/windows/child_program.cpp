// On Windows, programs are not started: nobody has written and tested how to send bytes without waiting
// there.
#include "system/child_program.hpp"

#include <system_error>

namespace racebeam {

struct ChildProgram::Process {};

ChildProgram::ChildProgram(std::vector<std::string> words) {
  throw std::system_error(std::make_error_code(std::errc::function_not_supported),
                          "racebeam starts no other program on Windows, such as " + words.at(0));
}

ChildProgram::~ChildProgram() = default;
std::ptrdiff_t ChildProgram::send(std::string_view) { return -1; }
void ChildProgram::close_input() {}
bool ChildProgram::has_input() const { return false; }
bool ChildProgram::has_ended() { return true; }
bool ChildProgram::has_succeeded() const { return false; }
std::string ChildProgram::errors() { return {}; }

}  // namespace racebeam

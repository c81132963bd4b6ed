// Names, handles and errors of files, as functions of Windows use them.
#pragma once

#include <string>

namespace racebeam {

// `path` is UTF-8. A long path becomes an absolute path in its verbatim form, the only form in which the
// system accepts it.
std::wstring name_of(const std::string& path);

void* handle_of(int file);  // the handle of a descriptor of the C library

int reason_of(unsigned long error);  // the number in errno for an error of Windows

}  // namespace racebeam

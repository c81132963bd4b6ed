// Files, as functions of Windows take them.
#pragma once

#include <string>

namespace racebeam {

// `path` is UTF-8. A long path becomes the whole path in its verbatim form, since the system takes it only
// so.
std::wstring name_of(const std::string& path);

void* handle_of(int file);  // of a number of the C library

int reason_of(unsigned long error);  // the number in errno for an error of Windows

}  // namespace racebeam

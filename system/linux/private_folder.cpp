#include "system/program/private_folder.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace racebeam {

PrivateFolder::PrivateFolder() : owner_(::getpid()) {
  const char* const parent = std::getenv("TMPDIR");
  std::string name =
      (parent == nullptr || *parent == '\0' ? "/tmp" : std::string(parent)) + "/racebeam-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), "cannot make a folder " + name);
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  if (::getpid() != owner_ && ::getppid() == owner_) return;
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace racebeam

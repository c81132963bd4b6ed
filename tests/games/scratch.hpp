// A temporary folder for a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include "system/entropy.hpp"

namespace racebeam {

class Scratch {
 public:
  Scratch() : folder_((std::filesystem::temp_directory_path() / name_of_new()).string()) {
    if (!std::filesystem::create_directory(folder_))
      throw std::runtime_error("cannot make a temporary folder");
  }
  ~Scratch() {
    std::error_code ignored;  // a destructor must not throw
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  static std::string name_of_new() {
    return "racebeam-" + std::to_string(random_number()) + "-" + std::to_string(random_number());
  }

  std::string folder_;
};

}  // namespace racebeam

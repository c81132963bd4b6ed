// The only exception type that the library throws for invalid arguments. An Error belongs to the thread that
// catches it; the object whose function threw can be used as before.
//
//     try {
//       racebeam::Image::load("no_such_file.bin");
//     } catch (const racebeam::Error& error) {
//       std::cerr << error.what() << '\n';  // what failed, the value, and what is accepted
//       return error.cause() == racebeam::Error::Cause::kImage ? 0 : 1;
//     }
//
// std::bad_alloc and exceptions of the caller's own functions pass through the library unchanged.
#pragma once

#include <stdexcept>
#include <string>

#include "racebeam/config.hpp"

namespace RACEBEAM_NAMESPACE {

class RACEBEAM_API Error : public std::runtime_error {
 public:
  enum class Cause {
    kImage,     // a file or bytes that are not a cartridge image
    kGame,      // an unknown name of a game, or a game file with an error
    kSettings,  // settings that this game or this computer cannot have
    kSnapshot,  // bytes that are not a snapshot, or a snapshot of another image, game or console
    kArgument   // an action, a mode, the number of a machine, or the size of an array that is not accepted
  };

  // sentence: what() returns it.
  Error(Cause cause, const std::string& sentence);
  ~Error() override;
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;

  Cause cause() const noexcept { return cause_; }

 private:
  Cause cause_;
};

}  // namespace RACEBEAM_NAMESPACE

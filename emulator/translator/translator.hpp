// Runs a machine's 6507 code as x86-64 code, and with the interpreter what is no translated code (docs/translator.md).
// On other processors, and where the system refuses executable memory, there is only the interpreter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace racebeam {

class Board;

// What runs a machine's instructions. All do the same, to the byte.
enum class CpuKind { kAuto, kInterpreter, kTranslator };

// One machine's way to the translated code of its image, which all machines of the process that run it share.
class Translator {
 public:
  // Null where the interpreter is wanted, or kAuto finds that code can't be translated here. Throws std::system_error
  // if it can't and kTranslator was asked for.
  static std::unique_ptr<Translator> make(Board& board, CpuKind kind);
  ~Translator();

  // Like interpret(), but the instructions are not counted. False if there may have been `instructions` of them before
  // the frame closed: then there were no more, and the step must be run again by who counts.
  bool run(Board& board, std::int32_t instructions);

  // After run(), and what the machine does besides for its step: that time counts for what may be spent on translation.
  void end_step();

  // The most bytes of translated code for one image, at least 131072; 4 MiB unless told. When they are used up, all is
  // translated anew. Applies to images that are translated from now on.
  static void set_code_capacity(std::size_t bytes);

  // Why kAuto gives the interpreter in this process; empty if it does not.
  static const char* obstacle();

 private:
  struct Impl;
  bool run_blocks(Board& board, std::int32_t instructions);
  explicit Translator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

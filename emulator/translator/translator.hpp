// Translates a machine's 6507 code to code of the host and runs it. Interprets what is not translated
// (docs/translator.md). On processors without a back end, and on systems that refuse executable memory, there
// is only the interpreter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace racebeam {

class Board;

// The implementation of the CPU. The machine's output is the same with each.
enum class CpuKind { kAuto, kInterpreter, kTranslator };

// Connects one machine to the translated code of its image, which all machines of the process share.
class Translator {
 public:
  // Returns null for kInterpreter, and for kAuto where code cannot be translated. For kTranslator, throws
  // std::system_error if the system refuses executable memory.
  static std::unique_ptr<Translator> make(Board& board, CpuKind kind);
  ~Translator();

  // Like interpret(), but does not count instructions. Returns false if the step may have reached
  // `instructions` before the frame closed. The step then stopped there, and the caller must interpret it
  // again from its start.
  bool run(Board& board, std::int32_t instructions);

  // The caller calls it after run(), when the machine has finished its step. The time between the two calls
  // adds to the translation budget.
  void end_step();

  // Cycles of the machine that run() has left to the interpreter.
  std::int64_t interpreted_cycles() const;

  // Sets the most bytes of translated code for one image: at least 131072, 4 MiB by default. When they are
  // used up, translation starts again with new memory. Applies to images that are first translated
  // afterwards.
  static void set_code_capacity(std::size_t bytes);

  // Why kAuto selects the interpreter in this process; empty if it does not.
  static const char* obstacle();

 private:
  struct Impl;
  bool run_blocks(Board& board, std::int32_t instructions);
  void interpret_some(Board& board, std::int32_t most, std::int32_t enough, bool stays = false);
  explicit Translator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

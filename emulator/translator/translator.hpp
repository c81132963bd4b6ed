// Runs a machine's 6507 code as code of the host, and interprets what is not translated (docs/translator.md).
// Builds for processors without a back end have only the interpreter, as have systems that refuse executable
// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace racebeam {

class Board;

// The implementation of the CPU. All kinds give the same bytes.
enum class CpuKind { kAuto, kInterpreter, kTranslator };

// Connects one machine to the translated code of its image, which all machines of the process share.
class Translator {
 public:
  // Null for kInterpreter, and for kAuto where code cannot be translated. For kTranslator, throws
  // std::system_error there.
  static std::unique_ptr<Translator> make(Board& board, CpuKind kind);
  ~Translator();

  // Like interpret(), but does not count instructions. Returns false if the step may have reached
  // `instructions` before the frame closed. The step then stopped there, and the caller must interpret it
  // again from its start.
  bool run(Board& board, std::int32_t instructions);

  // Call it after run(), when the machine has finished its step. The time between the two adds to the
  // translation budget.
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
  void interpret_some(Board& board, std::int32_t most, std::int32_t enough);
  explicit Translator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

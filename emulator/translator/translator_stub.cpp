// Replaces translator.cpp in builds without the translator.
#include <system_error>

#include "emulator/translator/translator.hpp"

namespace racebeam {

struct Translator::Impl {};

Translator::Translator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Translator::~Translator() = default;

std::unique_ptr<Translator> Translator::make(Board&, CpuKind kind) {
  if (kind == CpuKind::kTranslator) {
    throw std::system_error(std::make_error_code(std::errc::function_not_supported), obstacle());
  }
  return nullptr;
}

bool Translator::run(Board&, std::int32_t) { return false; }
void Translator::end_step() {}
void Translator::set_code_capacity(std::size_t) {}
const char* Translator::obstacle() { return "this build has no translator (RACEBEAM_TRANSLATOR=OFF)"; }

}  // namespace racebeam

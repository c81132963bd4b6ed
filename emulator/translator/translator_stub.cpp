// Replaces translator.cpp in builds without the translator.
#include <system_error>
#include <utility>

#include "emulator/translator/code_owner.hpp"
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
std::int64_t Translator::interpreted_cycles() const { return 0; }
void Translator::set_code_capacity(std::size_t) {}
const char* Translator::obstacle() { return "this build has no translator (RACEBEAM_TRANSLATOR=OFF)"; }

CodeOwner::CodeOwner(std::shared_ptr<const std::vector<std::uint8_t>> image)
    : image_(std::move(image)), hash_(0) {}
CodeOwner::~CodeOwner() = default;
std::size_t CodeOwner::bytes() const { return 0; }
void limit_shared_code(std::size_t) {}
std::size_t shared_code() { return 0; }

}  // namespace racebeam

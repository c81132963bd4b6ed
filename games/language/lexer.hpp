// The tokens of the rule language, each with its position in the text.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "system/invalid_input.hpp"

namespace racebeam {

// An error in a part of a rule, with its line in the text (from 1).
struct SourceError : InvalidInput {
  SourceError(int at, const std::string& sentence) : InvalidInput(sentence), line(at) {}
  int line;
};

struct Token {
  enum class Kind { kName, kNumber, kText, kSymbol, kLineEnd, kEnd };
  Kind kind;
  std::string_view text;  // of the source, which must outlive it; kText: without the quotes
  int line;
  std::int32_t value = 0;  // kNumber
};

// The tokens of `source`; the last one is kEnd. Comments, and line ends inside ( and [, are left out.
std::vector<Token> tokens_of(std::string_view source);

// A position among tokens, as a parser moves it.
class TokenReader {
 public:
  explicit TokenReader(const std::vector<Token>& tokens) : at_(tokens.data()) {}

  const Token& peek(int ahead = 0) const;
  const Token& next();
  bool at_end() const { return at_->kind == Token::Kind::kEnd; }
  bool is(std::string_view symbol_or_name, int ahead = 0) const;
  bool accept(std::string_view symbol_or_name);
  void expect(std::string_view symbol, std::string_view where);
  void skip_separators();                                       // line ends and ';'
  void expect_separator();                                      // also accepts '}' or the end, and leaves it
  [[noreturn]] void refuse(const std::string& sentence) const;  // at the next token

  const Token* place() const { return at_; }  // to parse a part again
  void go_to(const Token* place) { at_ = place; }

 private:
  const Token* at_;
};

std::string quoted(std::string_view text);  // 'text'
std::string described(const Token& token);  // as errors name it: 'lives', the end of the line, ...

}  // namespace racebeam

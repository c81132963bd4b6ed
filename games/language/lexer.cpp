#include "games/language/lexer.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <limits>

namespace racebeam {
namespace {

using Kind = Token::Kind;

constexpr std::array<std::string_view, 8> kPairs = {"||", "&&", "==", "!=", "<=", ">=", "<<", ">>"};
constexpr std::string_view kSymbols = "|^&<>+-*/%!~()[]{}=,;";

bool starts_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool continues_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Lexer {
 public:
  explicit Lexer(std::string_view source) : rest_(source) {}

  std::vector<Token> run() {
    while (skip_blanks(), !rest_.empty()) scan();
    add(Kind::kLineEnd, 0);
    add(Kind::kEnd, 0);
    return std::move(tokens_);
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r'))
      rest_.remove_prefix(1);
    if (rest_.starts_with('#')) rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
  }

  void scan() {
    if (rest_[0] == '\n') return end_line();
    if (rest_[0] == '"') return text();
    if (starts_name(rest_[0])) return word(Kind::kName);
    if (std::isdigit(static_cast<unsigned char>(rest_[0]))) return number();
    symbol();
  }

  void add(Kind kind, std::size_t length) {
    tokens_.push_back({kind, rest_.substr(0, length), line_});
    rest_.remove_prefix(length);
  }

  void end_line() {
    if (open_ == 0) tokens_.push_back({Kind::kLineEnd, {}, line_});
    rest_.remove_prefix(1);
    ++line_;
  }

  void text() {
    const std::size_t end = rest_.find_first_of("\"\n", 1);
    if (end == std::string_view::npos || rest_[end] == '\n')
      throw SourceError(line_, "a text must end with \" on its line");
    tokens_.push_back({Kind::kText, rest_.substr(1, end - 1), line_});
    rest_.remove_prefix(end + 1);
  }

  void word(Kind kind) {
    std::size_t length = 1;
    while (length < rest_.size() && continues_name(rest_[length])) ++length;
    add(kind, length);
  }

  // Hexadecimal numbers may use all 32 bits; decimal ones must be representable.
  void number() {
    word(Kind::kNumber);
    Token& token = tokens_.back();
    const bool hexadecimal = token.text.starts_with("0x") || token.text.starts_with("0X");
    const std::string_view digits = token.text.substr(hexadecimal ? 2 : 0);
    std::uint32_t value = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
    const std::uint32_t largest = hexadecimal ? 0xFFFFFFFFu : 0x7FFFFFFFu;
    if (error != std::errc() || end != digits.data() + digits.size() || value > largest)
      throw SourceError(
          line_, quoted(token.text) +
                     " is not a number: write decimal digits or 0x and hexadecimal ones, within 32 bits");
    token.value = static_cast<std::int32_t>(value);
  }

  void symbol() {
    for (const std::string_view pair : kPairs)
      if (rest_.starts_with(pair)) return add(Kind::kSymbol, 2);
    if (kSymbols.find(rest_[0]) == std::string_view::npos)
      throw SourceError(line_, quoted(rest_.substr(0, 1)) + " is not part of the rule language");
    if (rest_[0] == '(' || rest_[0] == '[') ++open_;
    if ((rest_[0] == ')' || rest_[0] == ']') && open_ > 0) --open_;
    add(Kind::kSymbol, 1);
  }

  std::string_view rest_;
  int line_ = 1;
  int open_ = 0;  // open parentheses and brackets
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view source) { return Lexer(source).run(); }

std::string quoted(std::string_view text) {
  std::string quoted(1, '\'');
  return quoted.append(text).append(1, '\'');
}

std::string described(const Token& token) {
  if (token.kind == Kind::kLineEnd) return "the end of the line";
  if (token.kind == Kind::kEnd) return "the end of the text";
  return quoted(token.text);
}

const Token& TokenReader::peek(int ahead) const {
  const Token* token = at_;
  while (ahead-- > 0 && token->kind != Kind::kEnd) ++token;
  return *token;
}

const Token& TokenReader::next() { return at_end() ? *at_ : *at_++; }

bool TokenReader::is(std::string_view symbol_or_name, int ahead) const {
  const Token& token = peek(ahead);
  return (token.kind == Kind::kSymbol || token.kind == Kind::kName) && token.text == symbol_or_name;
}

bool TokenReader::accept(std::string_view symbol_or_name) {
  const bool there = is(symbol_or_name);
  if (there) next();
  return there;
}

void TokenReader::expect(std::string_view symbol, std::string_view where) {
  if (!accept(symbol))
    refuse("expected " + quoted(symbol) + " " + std::string(where) + ", found " + described(peek()));
}

void TokenReader::skip_separators() {
  while (peek().kind == Kind::kLineEnd || is(";")) next();
}

void TokenReader::expect_separator() {
  if (peek().kind != Kind::kLineEnd && !is(";") && !is("}") && !at_end())
    refuse("expected the end of the line, found " + described(peek()));
}

void TokenReader::refuse(const std::string& sentence) const { throw SourceError(at_->line, sentence); }

}  // namespace racebeam

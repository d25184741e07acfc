// Lines, words and numbers of text formats, the same on every machine.
//
// std::from_chars is the one way to read a number that no locale changes and that needs no copy; what it leaves out (a
// leading plus) and what it lets in (inf, nan) is put right here, so that no reader forgets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pliant {

/// Walks over the lines of a text. A line ends with \n, \r\n or \r, or where the text does.
class LineReader {
 public:
  explicit LineReader(std::string_view text, int first_line = 1) : text_(text), next_number_(first_line) {}

  /// Moves on. False at the end.
  bool next();

  std::string_view line() const { return line_; }   ///< without its end
  int number() const { return number_; }            ///< of line(), from 1
  std::size_t offset() const { return position_; }  ///< byte behind line() and its end

 private:
  std::string_view text_, line_;
  std::size_t position_ = 0;
  int number_ = 0, next_number_;
};

/// Takes the first word (no spaces or tabs) off `rest`. Empty where there is none.
std::string_view take_word(std::string_view& rest);

/// A name or number from a file, fit to stand in a message: cut to 40 bytes, with what is not printable as '?'.
std::string quoted(std::string_view word);

enum class NumberProblem { none, not_a_number, not_finite, too_large };

/// What is wrong, as the middle of a sentence: "is not a number".
const char* describe(NumberProblem problem);

/// The whole word as a float, correctly rounded. A leading '+' is taken; what is too small becomes 0.
NumberProblem parse_float(std::string_view word, float& value);

/// The whole word as a whole number; a leading '+' is taken. False where it is none or does not fit.
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace pliant

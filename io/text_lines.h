// Lines, words and numbers of text formats. Results are the same on every machine.
//
// std::from_chars parses numbers without a locale or a copy. But it rejects a leading plus, and accepts inf and nan;
// these functions correct both.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pliant {

/// Iterates over the lines of a text. A line ends with
/// , \r
/// , \r or at the end of the text.
class LineReader {
 public:
  explicit LineReader(std::string_view text, int first_line = 1) : text_(text), next_number_(first_line) {}

  /// Advances to the next line. Returns false at the end of the text.
  bool next();

  std::string_view line() const { return line_; }   ///< current line without its line end
  int number() const { return number_; }            ///< number of the current line; the first is 1
  std::size_t offset() const { return position_; }  ///< offset of the byte after the current line and its line end

 private:
  std::string_view text_, line_;
  std::size_t position_ = 0;
  int number_ = 0, next_number_;
};

/// Removes the first word (without blanks and tabs) from `rest`, and returns it; empty if there is none.
std::string_view take_word(std::string_view& rest);

/// Makes a word from a file safe for messages: at most 40 bytes, unprintable ones as '?'.
std::string in_quotes(std::string_view word);

enum class NumberProblem { none, not_a_number, not_finite, too_large };

/// Describes a problem as the end of a sentence: "is not a number".
const char* describe(NumberProblem problem);

/// Parses a whole word as a float, correctly rounded. Accepts a leading '+'; values that are too small become 0.
NumberProblem parse_float(std::string_view word, float& value);

/// Parses a whole word as an integer. Accepts a leading '+'. Returns false if it is none or out of range.
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace pliant

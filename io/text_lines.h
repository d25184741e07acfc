// Lines, words and numbers of text formats, with the same result on every machine.
//
// std::from_chars parses numbers without locale or copy. It rejects a leading
// plus and accepts inf and nan; these functions correct both, for all readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pliant {

/// Iterates over the lines of a text. A line ends with \n, \r\n, \r or the end of the text.
class LineReader {
 public:
  explicit LineReader(std::string_view text, int first_line = 1) : text_(text), next_number_(first_line) {}

  /// Advances. Returns false at the end.
  bool next();

  std::string_view line() const { return line_; }   ///< the current line without its line end
  int number() const { return number_; }            ///< number of line(), from 1
  std::size_t offset() const { return position_; }  ///< byte after line() and its line end

 private:
  std::string_view text_, line_;
  std::size_t position_ = 0;
  int number_ = 0, next_number_;
};

/// Takes the first word (no spaces or tabs) off `rest`; empty if there is none.
std::string_view take_word(std::string_view& rest);

/// A name or number from a file, made safe for a message: at most 40 bytes, unprintable ones as '?'.
std::string quoted(std::string_view word);

enum class NumberProblem { none, not_a_number, not_finite, too_large };

/// The problem as a clause: "is not a number".
const char* describe(NumberProblem problem);

/// Parses the whole word as a float, correctly rounded. Accepts a leading '+'; values too small become 0.
NumberProblem parse_float(std::string_view word, float& value);

/// Parses the whole word as an integer; accepts a leading '+'. Returns false if it is none or out of range.
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace pliant

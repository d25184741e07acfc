// Parses lines, words and numbers. It is short, and each of its rules is for a file that exists.
#include "text_lines.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace pliant {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Removes a leading plus sign, which std::from_chars does not accept. False if another sign follows.
bool strip_plus(std::string_view& word) {
  if (word.empty() || word.front() != '+') return true;
  word.remove_prefix(1);
  return !word.empty() && word.front() != '-' && word.front() != '+';
}

/// For a number out of range: true if it is too small, false if it is too large. It is too small if its exponent is
/// negative or, without an exponent, if only zeros precede the point.
bool is_small(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos) return exponent + 1 < word.size() && word[exponent + 1] == '-';
  for (const char c : word) {
    if (c == '.') return true;
    if (is_digit(c) && c != '0') return false;
  }
  return true;
}

#if defined(__cpp_lib_to_chars)
std::from_chars_result read_float(const char* first, const char* last, float& value) {
  return std::from_chars(first, last, value);
}
#else
/// Replaces std::from_chars for floats, where it supports only integers (libc++ 14): std::strtof in the C locale on a
/// terminated copy, for input that from_chars would accept.
std::from_chars_result read_float(const char* first, const char* last, float& value) {
  const std::string copy(first, last);
  if (copy.find_first_of("xX+ \t\n\v\f\r") == 0 || copy.find_first_of("xX") != std::string::npos)
    return {first, std::errc::invalid_argument};
  char* stop = nullptr;
  errno = 0;
  const float parsed = std::strtof(copy.c_str(), &stop);
  if (stop == copy.c_str()) return {first, std::errc::invalid_argument};
  const char* const end = first + (stop - copy.c_str());
  if (errno == ERANGE && (parsed == 0 || std::isinf(parsed))) return {end, std::errc::result_out_of_range};
  value = parsed;
  return {end, std::errc()};
}
#endif

}  // namespace

bool LineReader::next() {
  if (position_ >= text_.size()) return false;
  std::size_t end = text_.find_first_of("\r\n", position_);
  if (end == std::string_view::npos) end = text_.size();
  line_ = text_.substr(position_, end - position_);
  position_ = end;
  if (position_ < text_.size()) {
    const bool pair = text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n';
    position_ += pair ? 2 : 1;
  }
  number_ = next_number_;
  if (next_number_ < std::numeric_limits<int>::max()) ++next_number_;
  return true;
}

std::string_view take_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t most = 40;
  std::string text = "'";
  for (const char c : word.substr(0, most)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > most ? "...'" : "'");
}

const char* describe(NumberProblem problem) {
  switch (problem) {
    case NumberProblem::none:
      return "is a number";
    case NumberProblem::not_a_number:
      return "is not a number";
    case NumberProblem::not_finite:
      return "is not finite";
    case NumberProblem::too_large:
      return "is too large for single precision";
  }
  return "is not a number";
}

NumberProblem parse_float(std::string_view word, float& value) {
  if (!strip_plus(word)) return NumberProblem::not_a_number;
  const char* const end = word.data() + word.size();
  float parsed = 0;
  const auto [stop, code] = read_float(word.data(), end, parsed);
  if (code == std::errc::invalid_argument || stop != end) return NumberProblem::not_a_number;
  if (code == std::errc::result_out_of_range) {
    if (!is_small(word)) return NumberProblem::too_large;
    parsed = 0;
  }
  if (!std::isfinite(parsed)) return NumberProblem::not_finite;
  value = parsed;
  return NumberProblem::none;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (!strip_plus(word)) return false;
  const char* const end = word.data() + word.size();
  std::int64_t parsed = 0;
  const auto [stop, code] = std::from_chars(word.data(), end, parsed);
  if (code != std::errc() || stop != end) return false;
  value = parsed;
  return true;
}

}  // namespace pliant

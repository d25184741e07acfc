// Keeps one warning of each kind.
#include <algorithm>
#include <string>

#include "pliant/advise.h"

namespace pliant {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_of_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The character at a place of a text; a space beyond its ends.
char at(const std::string& text, std::size_t place) { return place < text.size() ? text[place] : ' '; }

/// One past the number that begins at `place`, with its sign, fraction and exponent; `place` if none does.
std::size_t end_of_number(const std::string& text, std::size_t place) {
  const auto after_digits = [&](std::size_t from) {
    while (is_digit(at(text, from))) ++from;
    return from;
  };
  const auto after_sign = [&](std::size_t from) {
    return from + (at(text, from) == '-' || at(text, from) == '+' ? 1 : 0);
  };
  const std::size_t digits = after_sign(place);
  std::size_t end = after_digits(digits);
  if (end == digits) return place;
  if (at(text, end) == '.' && is_digit(at(text, end + 1))) end = after_digits(end + 1);
  const std::size_t exponent = after_sign(end + 1);
  return at(text, end) == 'e' && is_digit(at(text, exponent)) ? after_digits(exponent) : end;
}

/// One past the name in quotes that begins at `place`; `place` if none does. A quote between letters is an apostrophe.
std::size_t end_of_name(const std::string& text, std::size_t place) {
  const char quote = at(text, place);
  if ((quote != '\'' && quote != '"') || is_of_word(at(text, place - 1))) return place;
  for (std::size_t i = place + 1; i < text.size(); ++i)
    if (text[i] == quote && !is_of_word(at(text, i + 1))) return i + 1;
  return place;
}

/// The text without its numbers, but with those in names: 'sheet1' and 'sheet2' are two objects.
std::string without_numbers(const std::string& text) {
  std::string rest;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t number = end_of_number(text, i), kept = std::max(end_of_name(text, i), i + 1);
    if (number == i) rest.append(text, i, kept - i);
    i = number == i ? kept : number;
  }
  return rest;
}

}  // namespace

void WarningLog::add(const Report& report) {
  for (const std::string& warning : report.warnings)
    if (kinds_.insert(without_numbers(warning)).second)
      lines_.push_back("frame " + std::to_string(report.frame) + ": " + warning);
}

}  // namespace pliant

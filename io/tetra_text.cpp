#include "tetra_text.h"

#include "pliant/error.h"

namespace pliant {

void WordReader::fail(const std::string& problem, const std::string& advice) const {
  throw Error({.file = name_, .line = line()}, problem, advice);
}

std::string_view WordReader::here() {
  const std::string_view word = take_word(rest_);
  if (word.empty() || comment_ == 0 || word.front() != comment_) return word;
  rest_ = {};
  return {};
}

bool WordReader::next_line() {
  while (lines_.next()) {
    rest_ = lines_.line();
    if (rest_.find('\0') != std::string_view::npos)
      fail("contains a zero byte, so it is not text", "export it as ASCII");
    std::string_view ahead = rest_;
    const std::string_view word = take_word(ahead);
    if (!word.empty() && (comment_ == 0 || word.front() != comment_)) return true;
  }
  rest_ = {};
  return false;
}

std::string_view WordReader::word() {
  for (;;) {
    const std::string_view word = here();
    if (!word.empty()) return word;
    if (!next_line()) return {};
  }
}

std::int64_t WordReader::integer(const char* what) {
  const std::string_view text = word();
  std::int64_t value = 0;
  if (text.empty()) fail(std::string("ends where ") + what + " should follow", "the file is cut off: export it again");
  if (!parse_integer(text, value)) fail(in_quotes(text) + " is no integer, but " + what + " should be here");
  return value;
}

float WordReader::real(const char* what) {
  const std::string_view text = word();
  float value = 0;
  if (text.empty()) fail(std::string("ends where ") + what + " should follow", "the file is cut off: export it again");
  if (const NumberProblem problem = parse_float(text, value); problem != NumberProblem::none)
    fail(in_quotes(text) + ", " + what + ", " + describe(problem), "give finite coordinates");
  return value;
}

std::int64_t WordReader::count(const char* what) {
  const std::int64_t value = integer(what);
  if (value < 0 || static_cast<std::uint64_t>(value) > remaining() / 2)
    fail(std::string(what) + " is " + std::to_string(value) + ", for which the file is too short",
         "the file is damaged or cut off: export it again");
  return value;
}

void WordReader::expect(std::string_view keyword) {
  const std::string_view found = word();
  if (found != keyword)
    fail(found.empty() ? "ends where '" + std::string(keyword) + "' should follow"
                       : in_quotes(found) + " is where '" + std::string(keyword) + "' should be");
}

}  // namespace pliant

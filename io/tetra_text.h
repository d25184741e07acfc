// Words of text formats of tetrahedral meshes, across lines, with the errors that all of them share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "text_lines.h"

namespace pliant {

/// Reads words one after another, whatever the lines. A word that begins with `comment` ends its line; 0: there are no
/// comments.
class WordReader {
 public:
  WordReader(std::string_view bytes, const std::string& name, char comment = '#')
      : bytes_(bytes), lines_(bytes), name_(name), comment_(comment) {}

  std::string_view word();  ///< the next word; empty at the end of the text
  std::string_view here();  ///< the next word of the current line; empty at its end
  bool next_line();         ///< goes on with the next line that has a word; false at the end
  void skip_line() { rest_ = {}; }

  std::int64_t integer(const char* what);
  float real(const char* what);
  /// How many of something follow. Throws an Error if there are fewer bytes left than so many need, two each.
  std::int64_t count(const char* what);
  void expect(std::string_view keyword);

  const std::string& name() const { return name_; }
  int line() const { return lines_.number(); }
  std::size_t offset() const { return lines_.offset(); }  ///< of the line after the current one
  std::size_t remaining() const { return bytes_.size() - lines_.offset() + rest_.size(); }

  /// Throws an Error at the current line.
  [[noreturn]] void fail(const std::string& problem, const std::string& advice = {}) const;

 private:
  std::string_view bytes_;
  LineReader lines_;
  std::string name_;
  std::string_view rest_;
  char comment_;
};

}  // namespace pliant

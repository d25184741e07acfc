// A study: runs a scene once for each combination of values, and writes a row for each into a table.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pliant::command {

/// A member of the scene, by its JSON pointer, and the values that it gets.
struct Varied {
  std::string pointer;
  std::vector<std::string> values;  ///< JSON, or text that stands for itself
};

/// Reads "POINTER=a,b,c". A comma within brackets, braces or quotes separates nothing. Throws an Error without a pointer or
/// a value.
Varied parse_varied(const std::string& text);

/// A combination of values: "pointer=value" for each member that is varied.
using Variant = std::vector<std::string>;

/// All combinations; those of the last member change fastest. Throws an Error if there are more than 100 000, or if a member
/// is varied twice.
std::vector<Variant> combinations(const std::vector<Varied>& varied);

/// The fields of a line of CSV (RFC 4180).
std::vector<std::string> csv_fields(const std::string& line);

/// A table in CSV that is complete after each row. Rows of an earlier table with the same columns are kept, so that a study
/// goes on where it was stopped.
class StudyTable {
 public:
  /// The first `keys` columns say which variant a row is of. Throws an Error if the file has other columns.
  StudyTable(std::string path, std::vector<std::string> columns, std::size_t keys, std::size_t rows);

  /// Takes over the row of a variant from the earlier table, if it is there.
  bool take_over(std::size_t row, const std::vector<std::string>& key);
  /// Sets a row and writes the table.
  void set(std::size_t row, std::vector<std::string> fields);
  void write() const;

 private:
  std::string path_;
  std::vector<std::string> columns_;
  std::size_t keys_;
  std::vector<std::vector<std::string>> rows_;     ///< empty: not there yet
  std::vector<std::vector<std::string>> earlier_;  ///< rows of the file as it was
};

}  // namespace pliant::command

// A study: runs a scene once for each combination of values, and writes a row for each into a table.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pliant::command {

/// A member of the scene, by its JSON pointer, and the values that it gets.
struct Varied {
  std::string pointer;
  std::vector<std::string> values;  ///< JSON, or text that stands for itself
};

/// Reads "POINTER=a,b,c". A comma within brackets, braces or quotes separates nothing. Throws an Error without a
/// pointer or a value.
Varied parse_varied(const std::string& text);

/// A combination of values: "pointer=value" for each member that is varied.
using Variant = std::vector<std::string>;

/// All combinations; those of the last member change fastest. Throws an Error if there are more than 100 000, or if a
/// member is varied twice.
std::vector<Variant> combinations(const std::vector<Varied>& varied);

/// The fields of a line of CSV (RFC 4180).
std::vector<std::string> csv_fields(const std::string& line);

/// A table in CSV, whose file is complete at any time. Rows of an earlier table with the same columns are kept, so that
/// a study goes on where it was stopped, and others of the same members stand in one table.
class StudyTable {
 public:
  /// The first `keys` columns are the values of a variant; the next two say what it was made of, and if it went well
  /// ("true"). Throws an Error if the file has other columns.
  StudyTable(std::string path, std::vector<std::string> columns, std::size_t keys, std::size_t rows);

  /// Takes over the row of a variant from the earlier table, if it is there and went well. `start`: its first fields.
  bool take_over(std::size_t row, const std::vector<std::string>& start);
  /// Sets a row, and writes the table if that was not done within the last second.
  void set(std::size_t row, std::vector<std::string> fields);
  void write();

 private:
  std::string key_of(const std::vector<std::string>& fields) const;

  std::string path_;
  std::vector<std::string> columns_;
  std::size_t keys_;
  std::vector<std::vector<std::string>> rows_;  ///< empty: not there yet
  /// Rows of the file that no row replaces, by their values.
  std::map<std::string, std::vector<std::string>> earlier_{};
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace pliant::command

// The variants of a study, and the table of their results.
#include <algorithm>
#include <filesystem>

#include "atomic_file.h"
#include "gauge_table.h"
#include "io/file_bytes.h"
#include "pliant/error.h"
#include "study.h"

namespace pliant::command {

Varied parse_varied(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == 0 || sign == std::string::npos || sign + 1 == text.size())
    throw Error({}, "'" + text + "' varies nothing", "write POINTER=a,b,c, such as --vary /settings/substeps=10,20,40");
  Varied varied{text.substr(0, sign), {""}};
  int depth = 0;
  bool is_quoted = false;
  for (std::size_t i = sign + 1; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && text[i - 1] != '\\') is_quoted = !is_quoted;
    if (!is_quoted) depth += (c == '[' || c == '{') - (c == ']' || c == '}');
    if (c == ',' && depth == 0 && !is_quoted)
      varied.values.emplace_back();
    else
      varied.values.back() += c;
  }
  if (std::any_of(varied.values.begin(), varied.values.end(), [](const std::string& value) { return value.empty(); }))
    throw Error({}, "'" + text + "' has an empty value", "write a value before and after each comma");
  return varied;
}

std::vector<Variant> combinations(const std::vector<Varied>& varied) {
  constexpr std::size_t most = 100000;
  std::vector<Variant> all{{}};
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const Varied& member = varied[i];
    if (std::any_of(varied.begin(), varied.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const Varied& other) { return other.pointer == member.pointer; }))
      throw Error({}, "'" + member.pointer + "' is varied twice", "give all its values to one --vary");
    if (all.size() * member.values.size() > most)
      throw Error({}, "there are more than " + std::to_string(most) + " combinations", "vary fewer values");
    std::vector<Variant> longer;
    longer.reserve(all.size() * member.values.size());
    for (const Variant& one : all)
      for (const std::string& value : member.values) {
        longer.push_back(one);
        longer.back().push_back(member.pointer + "=" + value);
      }
    all = std::move(longer);
  }
  return all;
}

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields{""};
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[++i];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

namespace {

/// The lines of a text; those within quotes are one.
std::vector<std::string> csv_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == '\n' && !is_quoted) {
      lines.push_back(std::move(line));
      line.clear();
    } else if (c != '\r' || is_quoted) {
      line += c;
    }
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) line += (i == 0 ? "" : ",") + csv_field(fields[i]);
  return line + "\n";
}

}  // namespace

StudyTable::StudyTable(std::string path, std::vector<std::string> columns, std::size_t keys, std::size_t rows)
    : path_(std::move(path)), columns_(std::move(columns)), keys_(keys), rows_(rows) {
  if (!std::filesystem::exists(path_)) return;
  const std::vector<std::string> lines = csv_lines(read_file_bytes(path_));
  if (lines.empty()) return;
  if (csv_fields(lines[0]) != columns_) {
    Location where;
    where.file = path_;
    throw Error(where, "is no table of this study: its columns differ", "name another file, or remove it");
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::vector<std::string> fields = csv_fields(lines[i]);
    if (fields.size() == columns_.size()) earlier_[key_of(fields)] = std::move(fields);
  }
}

std::string StudyTable::key_of(const std::vector<std::string>& fields) const {
  return csv_line({fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(keys_)});
}

bool StudyTable::take_over(std::size_t row, const std::vector<std::string>& start) {
  const auto found = earlier_.find(key_of(start));
  if (found == earlier_.end()) return false;
  const std::vector<std::string>& fields = found->second;
  if (!std::equal(start.begin(), start.end(), fields.begin()) || fields[keys_ + 1] != "true") return false;
  rows_[row] = fields;
  earlier_.erase(found);
  return true;
}

void StudyTable::set(std::size_t row, std::vector<std::string> fields) {
  earlier_.erase(key_of(fields));
  rows_[row] = std::move(fields);
  if (std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) write();
}

void StudyTable::write() {
  AtomicFile file(path_);
  file.write(csv_line(columns_));
  for (const std::vector<std::string>& fields : rows_)
    if (!fields.empty()) file.write(csv_line(fields));
  for (const auto& [key, fields] : earlier_) file.write(csv_line(fields));
  file.commit();
  written_ = std::chrono::steady_clock::now();
}

}  // namespace pliant::command

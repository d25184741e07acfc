// Builds a tree with positions in the source from the events of nlohmann's parser.
//
// The events have no positions. But the text before an event is valid, so a token starts after the previous one and
// after blanks, commas and colons. A Scanner follows the text in step with the events.
#include "scene_json.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace pliant::scene_file {

namespace {

/// Finds the tokens of a text that is valid up to the current one.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  /// Skips the next token, and returns the offset of its first byte.
  std::uint32_t next() {
    end_ = std::min(text_.find_first_not_of(" \t\r\n,:", end_), text_.size());
    const std::size_t start = end_;
    if (start < text_.size()) end_ = past_token(start);
    return static_cast<std::uint32_t>(start);
  }

 private:
  std::size_t past_token(std::size_t start) const {
    const char first = text_[start];
    if (first == '"') return past_string(start);
    if (first == '{' || first == '}' || first == '[' || first == ']') return start + 1;
    return std::min(text_.find_first_of(" \t\r\n,:]}", start), text_.size());
  }

  std::size_t past_string(std::size_t start) const {
    for (std::size_t i = start + 1; i < text_.size(); ++i) {
      if (text_[i] == '\\')
        ++i;
      else if (text_[i] == '"')
        return i + 1;
    }
    return text_.size();
  }

  const std::string& text_;
  std::size_t end_ = 0;
};

/// A message of the parser without "parse error at line 3, column 7", which the Error has already.
std::string without_preamble(const std::string& message) {
  const std::size_t column = message.find(", column ");
  const std::size_t bracket = message.find("] ");
  if (column != std::string::npos) {
    const std::size_t colon = message.find(": ", column);
    if (colon != std::string::npos) return message.substr(colon + 2);
  }
  return bracket == std::string::npos ? message : message.substr(bracket + 2);
}

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// The word that contains byte `at`; empty if there is none.
std::string word_around(const std::string& text, std::size_t at) {
  std::size_t begin = at, end = at;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  while (end < text.size() && is_word(text[end])) ++end;
  return text.substr(begin, end - begin);
}

/// Advice for a word that JSON does not have.
std::string word_advice(std::string word) {
  for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const char* number : {"nan", "-nan", "inf", "-inf", "infinity", "-infinity"})
    if (word == number) return "scenes contain only finite numbers";
  for (const char* literal : {"true", "false", "null"})
    if (word == literal) return std::string("write ") + literal;
  const bool is_name = !word.empty() && (word[0] == '_' || (word[0] >= 'a' && word[0] <= 'z'));
  return is_name ? "write names and text in double quotes" : "";
}

/// Advice for syntax of other languages. `last` is the byte at which parsing stopped.
std::string syntax_advice(const std::string& text, std::size_t last, const std::string& problem) {
  const auto says = [&](const char* words) { return problem.find(words) != std::string::npos; };
  if (says("unexpected end of input"))
    return text.empty() ? "the file is empty" : "the file is truncated, or a bracket is not closed";
  if (last >= text.size()) return {};
  const char c = text[last];
  const std::size_t before = last == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", last - 1);
  const std::string word = word_around(text, last);
  const bool literal = says("invalid literal");
  if ((c == '}' || c == ']') && before != std::string::npos && text[before] == ',') return "remove the comma before it";
  if (literal && (c == '/' || c == '#')) return "JSON has no comments: remove this one";
  if (literal && c == '\'') return "write names and text in double quotes";
  if (literal && (c == '.' || c == '+')) return "a number starts with a digit or a minus, such as 0.5";
  if (says("expected end of input")) return "nothing may follow the last bracket";
  if (word.size() > 1 && word[0] == '0' && word[1] >= '0' && word[1] <= '9') return "a number has no leading zeros";
  if (literal || says("after '-'")) return word_advice(word);
  if (says("expected '}'") || says("expected ']'")) return "a comma is missing before it";
  return {};
}

class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit TreeBuilder(JsonDocument& document) : document_(document), scanner_(document.text) {}

  bool null() override { return add(JsonValue::Kind::null), true; }
  bool boolean(bool value) override { return add(JsonValue::Kind::boolean).truth = value, true; }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override { return add(JsonValue::Kind::string).text = std::move(value), true; }
  bool binary(binary_t&) override { return false; }  // never called for JSON texts
  bool start_object(std::size_t) override { return open(JsonValue::Kind::object); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_offset_ = scanner_.next();
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& exception) override {
    if (exception.id == 406) {  // the number is valid JSON, but out of the range of double
      const JsonValue& value = add(JsonValue::Kind::number);
      document_.fail(value, "this number is too large", "the largest that a 32-bit float holds is about 3.4e38");
    }
    const std::string problem = printable(without_preamble(exception.what()));
    const std::size_t last = position > 0 ? position - 1 : 0;
    throw Error(document_.locate_byte(last), "not valid JSON: " + problem,
                syntax_advice(document_.text, last, problem));
  }

 private:
  JsonValue& add(JsonValue::Kind kind) {
    JsonValue* value = &document_.root;
    if (!open_.empty()) value = &open_.back()->items.emplace_back();
    value->kind = kind;
    value->offset = scanner_.next();
    value->key_offset = std::exchange(key_offset_, value->offset);
    value->key = std::exchange(key_, {});
    return *value;
  }

  bool number(double value) { return add(JsonValue::Kind::number).number = value, true; }

  bool open(JsonValue::Kind kind) {
    JsonValue& value = add(kind);
    if (static_cast<int>(open_.size()) == deepest_nesting)
      throw Error(document_.locate_byte(value.offset), "nested more than " + std::to_string(deepest_nesting) + " deep",
                  "scenes never need so many levels");
    open_.push_back(&value);
    return true;
  }

  bool close() {
    scanner_.next();
    open_.pop_back();
    return true;
  }

  JsonDocument& document_;
  Scanner scanner_;
  std::vector<JsonValue*> open_;  // from the root down; pointers stay valid, since only the innermost value grows
  std::string key_;
  std::uint32_t key_offset_ = 0;
};

std::string escaped(const std::string& key) {
  std::string text;
  for (const char c : key) text += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
  return printable(text);
}

/// Appends the path from `from` to `to`. Returns false if `to` is not below `from`.
bool append_path(const JsonValue& from, const JsonValue& to, std::string& path) {
  if (&from == &to) return true;
  for (std::size_t i = 0; i < from.items.size(); ++i) {
    const std::size_t before = path.size();
    path += "/" + (from.kind == JsonValue::Kind::object ? escaped(from.items[i].key) : std::to_string(i));
    if (append_path(from.items[i], to, path)) return true;
    path.resize(before);
  }
  return false;
}

/// Length of the UTF-8 sequence that begins at byte i; 0: invalid.
std::size_t sequence_length(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(i);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t k = 1; k < length; ++k)
    if (byte(i + k) < 0x80 || byte(i + k) > 0xBF) return 0;
  return length;
}

}  // namespace

void JsonValue::ignore() const {
  for (const JsonValue& item : items) {
    item.used = true;
    item.ignore();
  }
}

const JsonValue* JsonValue::find(const char* name) const {
  for (const JsonValue& item : items)
    if (item.key == name) return item.used = true, &item;
  return nullptr;
}

Location JsonDocument::locate_byte(std::size_t offset) const {
  offset = std::min(offset, text.size());
  const std::string_view before(text.data(), offset);
  const std::size_t line_start = before.find_last_of('\n') + 1;  // npos + 1 is 0, the start of the first line
  Location place;
  place.file = name;
  place.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  place.column = 1 + static_cast<int>(offset - line_start);
  return place;
}

Location JsonDocument::locate(const JsonValue& at) const {
  Location place = locate_byte(at.offset);
  append_path(root, at, place.element);
  if (place.element.empty()) place.element = "/";
  return place;
}

void JsonDocument::fail(const JsonValue& at, const std::string& problem, const std::string& advice) const {
  throw Error(locate(at), problem, advice);
}

void JsonDocument::fail_key(const JsonValue& at, const std::string& problem, const std::string& advice) const {
  Location place = locate_byte(at.key_offset);
  place.element = locate(at).element;
  throw Error(place, problem, advice);
}

JsonDocument parse_json(std::string text, std::string name, std::size_t most) {
  if (text.size() > most)
    throw Error({name, 0, {}, {}}, "longer than " + std::to_string(most >> 20) + " MiB",
                "put geometry into mesh files beside the scene");
  constexpr const char* mark = "\xEF\xBB\xBF";
  if (text.compare(0, 3, mark) == 0) text.erase(0, 3);
  JsonDocument document{std::move(name), std::move(text), {}};
  const std::size_t zero = document.text.find('\0');  // the parser would take it for the end of the text
  if (zero != std::string::npos) throw Error(document.locate_byte(zero), "not valid JSON: a zero byte");
  if (document.text.compare(0, 3, mark) == 0)  // once only, because the parser skips another mark
    throw Error(document.locate_byte(0), "not valid JSON: two byte order marks");
  TreeBuilder builder(document);
  nlohmann::json::sax_parse(document.text, &builder);
  return document;
}

std::string printable(const std::string& text) {
  constexpr std::size_t longest = 120;
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (result.size() > longest) return result + "...";
    const std::size_t length = sequence_length(text, i);
    const unsigned byte = static_cast<unsigned char>(text[i]);
    if (length == 0 || byte < 0x20 || byte == 0x7F) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02X", byte);
      result += code;
    } else {
      result.append(text, i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

}  // namespace pliant::scene_file

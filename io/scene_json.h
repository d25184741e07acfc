// Strict JSON that knows the position of every value, so that errors can name line, column and path.
//
// nlohmann::json parses the grammar of RFC 8259. Its own tree has no positions and merges repeated members, so the tree
// is built here, from the parser's events. A value stores only its first byte; lines and paths are computed when an
// error is reported.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/error.h"

namespace pliant::scene_file {

/// A JSON value. The members of an object are `items` with a `key`, in the order of the text; repeated names are kept.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
  Kind kind = Kind::null;
  bool truth = false;            ///< value of a boolean
  mutable bool used = false;     ///< true once a reader asked for the member; others are errors
  std::uint32_t offset = 0;      ///< first byte of the value
  std::uint32_t key_offset = 0;  ///< first byte of the member's name
  double number = 0;
  std::string key;               ///< name of a member of an object
  std::string text;              ///< value of a string
  std::vector<JsonValue> items;  ///< elements of an array or members of an object

  /// Returns the first member of that name and marks it as used; null if there is none.
  const JsonValue* find(const char* name) const;
  /// Marks all members below this value as used.
  void ignore() const;
};

/// A JSON text and its tree.
struct JsonDocument {
  std::string name;  ///< name of the file in errors
  std::string text;
  JsonValue root;

  /// Throws an Error at a value: "NAME:LINE:COLUMN: /path: problem; advice".
  [[noreturn]] void fail(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// Throws an Error at the name of a member instead of its value.
  [[noreturn]] void fail_key(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// The position of a value; Location::element is its JSON pointer (RFC 6901; "/" for the root).
  Location locate(const JsonValue& at) const;
  Location locate_byte(std::size_t offset) const;
};

/// Largest size [bytes]; the tree of a hostile text takes about 60 times as much memory.
constexpr std::size_t largest_text = std::size_t{16} << 20;
constexpr int deepest_nesting = 64;

/// Parses RFC 8259 strictly, after an optional byte order mark: no comments or trailing commas, valid UTF-8, numbers in
/// the range of double, at most `deepest_nesting` nested values and `most` bytes. Repeated member names are
/// kept, as the standard allows. Throws an Error with line and column.
JsonDocument parse_json(std::string text, std::string name, std::size_t most = largest_text);

/// Sets the value that a JSON pointer (RFC 6901) names; "-" appends to an array, and members that are not there are
/// added. `value` is JSON, or text that is none and stands for itself. Throws an Error if the pointer is none, or leads
/// through a value that has no members or to an item that is not there.
void set_value(JsonDocument& document, const std::string& pointer, const std::string& value);

/// Makes text from a file safe for messages: control characters and invalid bytes are escaped, long text is shortened.
std::string printable(const std::string& text);

}  // namespace pliant::scene_file

// Strict JSON with the source position of every value, so that errors can name line, column and path.
//
// nlohmann::json parses the grammar of RFC 8259. Its own tree drops positions and
// merges repeated members, so the tree is built here from parser events. A value
// stores only its start byte; lines and paths are computed when an error is reported.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/error.h"

namespace pliant::scene_file {

/// A JSON value. Members of an object are `items` with a `key`, in text order, with repeated names kept.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
  Kind kind = Kind::null;
  bool truth = false;            ///< value of a boolean
  mutable bool used = false;     ///< set when a reader requests the member; unrequested members are errors
  std::uint32_t offset = 0;      ///< first byte of the value
  std::uint32_t key_offset = 0;  ///< first byte of the member's name
  double number = 0;
  std::string key;               ///< name of a member of an object
  std::string text;              ///< value of a string
  std::vector<JsonValue> items;  ///< elements of an array or members of an object

  /// Returns the first member of that name and marks it as used; null if there is none.
  const JsonValue* find(const char* name) const;
  /// Marks all members below as used.
  void ignore() const;
};

/// A text and its tree.
struct JsonDocument {
  std::string name;  ///< stands for the file in errors
  std::string text;
  JsonValue root;

  /// Throws an Error at a value: "NAME:LINE:COLUMN: /path: problem; advice".
  [[noreturn]] void fail(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// The same, at the member's name.
  [[noreturn]] void fail_key(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// The position of a value; its element is the JSON pointer (RFC 6901; "/" alone for the root).
  Location locate(const JsonValue& at) const;
  Location locate_byte(std::size_t offset) const;
};

constexpr std::size_t largest_text = std::size_t{16}
                                     << 20;  ///< [bytes]: the tree of a hostile text takes about 60 times its size
constexpr int deepest_nesting = 64;

/// Parses RFC 8259 strictly (after an optional byte order mark): no comments or trailing commas, valid UTF-8, numbers in
/// double's range, at most `deepest_nesting` nested values and `largest_text` bytes. Repeated member names are kept, as the
/// standard permits. Throws an Error with line and column.
JsonDocument parse_json(std::string text, std::string name);

/// Text from a file made safe for messages: control characters and invalid bytes escaped, long text shortened.
std::string printable(const std::string& text);

}  // namespace pliant::scene_file

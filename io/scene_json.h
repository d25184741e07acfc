// Strict JSON with the place of every value, so that an error can name line, column and path.
//
// The library nlohmann::json reads the grammar of RFC 8259; its own tree forgets where a value stood and merges members of
// one name, so the tree is built here from its events. Paths and lines are worked out only when an error is reported: a
// value stores nothing but the byte that it starts at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/error.h"

namespace pliant::scene_file {

/// A JSON value. Members of an object are `items` with a `key`, in the order of the text, repeated names included.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
  Kind kind = Kind::null;
  bool truth = false;            ///< of a boolean
  mutable bool used = false;     ///< set when a reader asked for this member: what nobody asked for is refused
  std::uint32_t offset = 0;      ///< first byte of the value in the text
  std::uint32_t key_offset = 0;  ///< first byte of the member's name
  double number = 0;
  std::string key;               ///< name of a member of an object
  std::string text;              ///< of a string
  std::vector<JsonValue> items;  ///< elements of an array or members of an object

  /// The first member of that name, marked as used, or null.
  const JsonValue* find(const char* name) const;
  /// Marks all members below as used.
  void ignore() const;
};

/// A whole text with its tree.
struct JsonDocument {
  std::string name;  ///< stands for the file in errors
  std::string text;
  JsonValue root;

  /// Throws Error at a value: "NAME:LINE:COLUMN: /path: problem; advice".
  [[noreturn]] void fail(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// The same, pointing at the member's name.
  [[noreturn]] void fail_key(const JsonValue& at, const std::string& problem, const std::string& advice = {}) const;
  /// Where a value stands, with its JSON pointer (RFC 6901; "/" alone for the root) as element.
  Location locate(const JsonValue& at) const;
  Location locate_byte(std::size_t offset) const;
};

constexpr std::size_t largest_text = std::size_t{16}
                                     << 20;  ///< [bytes]: a hostile text takes some 60 times its size as a tree
constexpr int deepest_nesting = 64;

/// Reads RFC 8259 and nothing more (a byte order mark before it is skipped): no comments, no trailing commas, valid UTF-8,
/// numbers that a double can hold, at most `deepest_nesting` arrays and objects within each other and `largest_text` bytes.
/// Repeated member names are kept, as the standard allows them. Throws Error with line and column.
JsonDocument parse_json(std::string text, std::string name);

/// Text from a file, fit for an error message: control characters and invalid bytes escaped, shortened when long.
std::string printable(const std::string& text);

}  // namespace pliant::scene_file

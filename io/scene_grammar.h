// The scene format as one table.
//
// Validation (scene_check), the JSON Schema and docs/reference/scene-format.md
// (scene_schema) derive from it. So each field is described once: name, type, unit,
// range, default and meaning. Defaults come from the structures of the public headers.
#pragma once

#include <string>
#include <vector>

namespace pliant::scene_file {

struct Record;

/// The type of a JSON value.
struct Type {
  enum class Kind { boolean, integer, number, string, choice, vector, list, record, any_of };
  Kind kind = Kind::boolean;
  double minimum = 0, maximum = 0;   ///< of an integer, a number or each part of a vector
  bool above_minimum = false;        ///< excludes the minimum itself
  std::string unit;                  ///< of a number or vector; "-" for a ratio
  std::vector<std::string> choices;  ///< permitted words of a choice
  std::vector<std::string> (*choices_now)() =
      nullptr;                     ///< of a choice that can grow at run time, read at each use instead of `choices`
  std::string choices_documented;  ///< replaces a list that can grow in the reference, which must not change with it
  bool single_line = true;         ///< excludes control characters in a string
  std::size_t minimum_items = 0;   ///< minimum number of items of a list
  std::size_t maximum_items = 0;   ///< maximum number of items of a list; 0: unlimited
  const Record* record = nullptr;
  std::vector<Type> parts;  ///< the item of a list, or the alternatives of any_of, which must differ in JSON kind
};

/// The permitted words of a choice.
inline std::vector<std::string> choices_of(const Type& type) {
  return type.choices_now != nullptr ? type.choices_now() : type.choices;
}

/// A member of a JSON object.
struct Field {
  std::string name;
  Type type;
  std::string fallback;  ///< default as text; empty: required, unless in a group `exactly_one`
  std::string meaning;
  bool required = false;
};

/// An object with known members.
struct Record {
  std::string name;
  std::string meaning;
  std::vector<Field> fields;
  std::vector<std::string> exactly_one;  ///< names of which exactly one must be present; empty: no such rule

  const Field* find(const std::string& field) const;
};

/// The record of a whole scene, with static lifetime.
const Record& scene_record();

/// Every record of the format, the scene first, each before those that it is the first to use.
std::vector<const Record*> all_records();

constexpr double largest_place = 1e6;   ///< coordinate [m], where adjacent floats are 6 cm apart
constexpr int largest_scene = 1 << 24;  ///< particles; larger scenes count as an attack on memory
constexpr int largest_grid = 2048;      ///< vertices along one side of a generated mesh

}  // namespace pliant::scene_file

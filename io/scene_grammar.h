// The scene format as one table.
//
// The checks (scene_check), the JSON Schema and docs/reference/scene-format.md (scene_schema) are derived from it, so
// each field is described once: name, type, unit, range, default and meaning. Defaults come from the structs of the
// public headers.
#pragma once

#include <string>
#include <vector>

namespace pliant::scene_file {

struct Record;

/// The type of a JSON value in the scene format.
struct Type {
  enum class Kind { boolean, integer, number, string, choice, vector, list, record, any_of };
  Kind kind = Kind::boolean;
  double minimum = 0, maximum = 0;   ///< range of an integer, a number or each part of a vector
  bool above_minimum = false;        ///< true: the minimum itself is not allowed
  std::string unit;                  ///< unit of a number or vector; "-" for a ratio
  std::vector<std::string> choices;  ///< allowed words of a choice
  std::vector<std::string> (*choices_now)() =
      nullptr;  ///< returns the words of a choice that can grow at run time; read at each use instead of `choices`
  std::string choices_documented;  ///< replaces, in the reference, a list of words that can grow
  bool single_line = true;         ///< true: a string may have no control characters
  std::size_t minimum_items = 0;   ///< smallest number of items of a list
  std::size_t maximum_items = 0;   ///< largest number of items of a list; 0: no limit
  const Record* record = nullptr;
  std::vector<Type> parts;  ///< the item of a list, or the alternatives of any_of, which must differ in JSON kind
};

/// The allowed words of a choice.
inline std::vector<std::string> choices_of(const Type& type) {
  return type.choices_now != nullptr ? type.choices_now() : type.choices;
}

/// A member of a JSON object.
struct Field {
  std::string name;
  Type type;
  std::string fallback;  ///< default as text; empty: required, unless in `exactly_one`
  std::string meaning;
  bool required = false;
};

/// A JSON object with known members.
struct Record {
  std::string name;
  std::string meaning;
  std::vector<Field> fields;
  std::vector<std::string> exactly_one;  ///< names of which exactly one must be present; empty: no such rule

  const Field* find(const std::string& field) const;
};

/// The record of a whole scene. It exists as long as the program runs.
const Record& scene_record();

/// The records of an item of "objects" and of "colliders".
const Record& object_record();
const Record& collider_record();

/// All records of the format, the scene first; each before the records that it is the first to use.
std::vector<const Record*> all_records();

constexpr double largest_place = 1e6;   ///< largest coordinate [m]; there, adjacent floats are 6 cm apart
constexpr int largest_scene = 1 << 24;  ///< largest number of particles; more count as an attack on memory
constexpr int largest_grid = 2048;      ///< largest number of vertices along a side of a generated mesh

}  // namespace pliant::scene_file

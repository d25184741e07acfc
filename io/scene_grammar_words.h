// Functions in which scene_grammar.cpp writes the table: one for each type of value and each kind of field.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "pliant/vec3.h"
#include "scene_grammar.h"
#include "shortest_number.h"

namespace pliant::scene_file {

constexpr double largest_velocity = 1e5;   // largest velocity [m/s]
constexpr double largest_quantity = 1e30;  // limit of other quantities; products of two still fit a double

/// The names of presets, for a choice.
template <class Preset>
std::vector<std::string> names_of(const std::vector<Preset>& presets) {
  std::vector<std::string> names;
  names.reserve(presets.size());
  for (const Preset& one : presets) names.push_back(one.name);
  return names;
}

// ------------------------------------------------------------------------------------------------ types

inline Type boolean() { return {}; }

inline Type integer(double minimum, double maximum) {
  Type type;
  type.kind = Type::Kind::integer;
  type.minimum = minimum, type.maximum = maximum;
  return type;
}

inline Type number(const char* unit, double minimum, double maximum = largest_quantity) {
  Type type = integer(minimum, maximum);
  type.kind = Type::Kind::number;
  type.unit = unit;
  return type;
}

inline Type positive(const char* unit, double maximum = largest_quantity) {
  Type type = number(unit, 0, maximum);
  type.above_minimum = true;
  return type;
}

inline Type share() { return number("-", 0, 1); }

inline Type vector(const char* unit, double minimum, double maximum) {
  Type type = number(unit, minimum, maximum);
  type.kind = Type::Kind::vector;
  return type;
}

inline Type vector(const char* unit, double largest) { return vector(unit, -largest, largest); }

inline Type positive_vector(const char* unit, double maximum) {
  Type type = vector(unit, 0, maximum);
  type.above_minimum = true;
  return type;
}

inline Type place() { return vector("m", largest_place); }
inline Type colour() { return vector("-", 0, 1); }

inline Type string() {
  Type type;
  type.kind = Type::Kind::string;
  return type;
}

inline Type text() {
  Type type = string();
  type.single_line = false;
  return type;
}

inline Type choice(std::vector<std::string> choices, std::string documented = {}) {
  Type type;
  type.kind = Type::Kind::choice;
  type.choices = std::move(choices);
  type.choices_documented = std::move(documented);
  return type;
}

/// A choice whose list of words can grow at run time.
inline Type choice(std::vector<std::string> (*choices)(), std::string documented) {
  Type type = choice(std::vector<std::string>{}, std::move(documented));
  type.choices_now = choices;
  return type;
}

inline Type list(Type item, std::size_t minimum = 0, std::size_t maximum = 0) {
  Type type;
  type.kind = Type::Kind::list;
  type.minimum_items = minimum, type.maximum_items = maximum;
  type.parts = {std::move(item)};
  return type;
}

inline Type record(const Record& fields) {
  Type type;
  type.kind = Type::Kind::record;
  type.record = &fields;
  return type;
}

inline Type any_of(std::vector<Type> alternatives) {
  Type type;
  type.kind = Type::Kind::any_of;
  type.parts = std::move(alternatives);
  return type;
}

/// The type of groups and masks: a list of the indices of set bits.
inline Type bits() { return list(integer(0, 31), 0, 32); }

inline Type particle_index() { return integer(0, 2147483647); }

// ------------------------------------------------------------------------------------------------ defaults, in words

inline std::string words(float value) {
  std::array<char, 32> digits{};  // shortest digits that read back as the same float
  return {digits.data(), write_shortest(digits.data(), digits.data() + digits.size(), value)};
}
inline std::string words(int value) { return std::to_string(value); }
inline std::string words(bool value) { return value ? "true" : "false"; }
inline std::string words(const Vec3f& v) { return "[" + words(v.x) + ", " + words(v.y) + ", " + words(v.z) + "]"; }
inline std::string words(const char* value) { return value; }

template <class T>
inline Field field(const char* name, Type type, const T& fallback, const char* meaning) {
  return {name, std::move(type), words(fallback), meaning, false};
}

inline Field needed(const char* name, Type type, const char* meaning) {
  return {name, std::move(type), {}, meaning, true};
}

/// A member of a group of which exactly one must be present.
inline Field either(const char* name, Type type, const char* meaning) {
  return {name, std::move(type), {}, meaning, false};
}

}  // namespace pliant::scene_file

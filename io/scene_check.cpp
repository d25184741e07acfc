// Checks a JSON tree against the table in scene_grammar.
#include "scene_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "scene_hints.h"

namespace pliant::scene_file {

namespace {

using JsonKind = JsonValue::Kind;
using Kind = Type::Kind;

std::string nine_digits(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.9g", value);
  return digits;
}

std::string joined(const std::vector<std::string>& names, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + ("'" + names[i] + "'");
  return text;
}

const char* found(const JsonValue& value) {
  switch (value.kind) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return value.truth ? "true" : "false";
    case JsonKind::number:
      return "a number";
    case JsonKind::string:
      return "a string";
    case JsonKind::array:
      return "an array";
    case JsonKind::object:
      return "an object";
  }
  return "something else";
}

std::string range_in_words(const Type& type) {
  return (type.above_minimum ? "above " : "from ") + nine_digits(type.minimum) +
         (type.above_minimum ? ", up to " : " to ") + nine_digits(type.maximum);
}

/// The names that identify a record in messages: its required members, or all if none is required.
std::string members(const Record& record) {
  std::vector<std::string> names;
  for (const Field& field : record.fields)
    if (field.required) names.push_back(field.name);
  if (!names.empty() || !record.exactly_one.empty())
    return joined(names, " and ") + (names.empty() || record.exactly_one.empty() ? "" : " and ") +
           joined(record.exactly_one, " or ");
  for (const Field& field : record.fields) names.push_back(field.name);
  return joined(names, ", ");
}

std::string expected_object(const Record& record) {
  const std::string inside = members(record);
  return "an object (" + record.name + (inside.empty() ? "" : ", with " + inside) + ")";
}

std::string expected(const Type& type) {
  const std::string unit = type.unit.empty() || type.unit == "-" ? "" : " [" + type.unit + "]";
  switch (type.kind) {
    case Kind::boolean:
      return "true or false";
    case Kind::integer:
      return "an integer " + range_in_words(type);
    case Kind::number:
      return "a number " + range_in_words(type) + unit;
    case Kind::string:
      return "a string";
    case Kind::choice:
      return joined(choices_of(type), " or ");
    case Kind::vector:
      return "an array of three numbers" + unit;
    case Kind::list:
      return "an array";
    case Kind::record:
      return expected_object(*type.record);
    case Kind::any_of:
      break;
  }
  std::string text;
  for (std::size_t i = 0; i < type.parts.size(); ++i) text += (i == 0 ? "" : ", or ") + expected(type.parts[i]);
  return text;
}

bool fits(const Type& type, JsonKind kind) {
  switch (type.kind) {
    case Kind::boolean:
      return kind == JsonKind::boolean;
    case Kind::integer:
    case Kind::number:
      return kind == JsonKind::number;
    case Kind::string:
    case Kind::choice:
      return kind == JsonKind::string;
    case Kind::vector:
    case Kind::list:
      return kind == JsonKind::array;
    case Kind::record:
      return kind == JsonKind::object;
    case Kind::any_of:
      break;
  }
  return std::any_of(type.parts.begin(), type.parts.end(), [&](const Type& part) { return fits(part, kind); });
}

class Checker {
 public:
  explicit Checker(const JsonDocument& document) : document_(document) {}

  void value(const JsonValue& at, const Type& type) const {
    if (!fits(type, at.kind)) document_.fail(at, "expected " + expected(type) + ", found " + found(at));
    switch (type.kind) {
      case Kind::boolean:
        return;
      case Kind::integer:
      case Kind::number:
        return number(at, type);
      case Kind::string:
        return string(at, type);
      case Kind::choice:
        return choice(at, type, type);
      case Kind::vector:
        return vector(at, type);
      case Kind::list:
        return list(at, type);
      case Kind::record:
        return record(at, *type.record);
      case Kind::any_of:
        break;
    }
    for (const Type& part : type.parts)
      if (fits(part, at.kind)) return part.kind == Kind::choice ? choice(at, part, type) : value(at, part);
  }

  void record(const JsonValue& at, const Record& record) const {
    if (at.kind != JsonKind::object) document_.fail(at, "expected " + expected_object(record) + ", found " + found(at));
    for (std::size_t i = 0; i < at.items.size(); ++i) {
      const JsonValue& member = at.items[i];
      const Field* field = record.find(member.key);
      if (field == nullptr) unknown(member, record);
      for (std::size_t k = 0; k < i; ++k)  // earlier members are known and distinct: no more than there are fields
        if (at.items[k].key == member.key)
          document_.fail_key(member, "'" + member.key + "' occurs twice", "keep one of the two");
      value(member, field->type);
    }
    presence(at, record);
  }

 private:
  void number(const JsonValue& at, const Type& type) const {
    if (type.kind == Kind::integer && at.number != std::floor(at.number))
      document_.fail(at, "expected " + expected(type) + ", found " + nine_digits(at.number));
    if (!inside(at.number, type))
      document_.fail(at, nine_digits(at.number) + " is out of range", "expected " + expected(type));
  }

  /// True if a number is in the range of a type as a float: a positive double may become zero.
  static bool inside(double number, const Type& type) {
    if (!(number >= type.minimum && number <= type.maximum)) return false;
    return !type.above_minimum || static_cast<float>(number) > static_cast<float>(type.minimum);
  }

  void string(const JsonValue& at, const Type& type) const {
    if (at.text.empty()) document_.fail(at, "this string is empty");
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (type.single_line && std::any_of(at.text.begin(), at.text.end(), control))
      document_.fail(at, "this string contains control characters", "write it on one line");
  }

  void choice(const JsonValue& at, const Type& type, const Type& all) const {
    const std::vector<std::string> choices = choices_of(type);
    if (std::find(choices.begin(), choices.end(), at.text) != choices.end()) return;
    const std::string near = nearest_name(at.text, choices);
    document_.fail(at, "there is no '" + printable(at.text) + "' here",
                   (near.empty() ? "" : "did you mean '" + near + "'? ") + ("expected " + expected(all)));
  }

  void vector(const JsonValue& at, const Type& type) const {
    if (at.items.size() != 3)
      document_.fail(at, "expected " + expected(type) + ", found " + std::to_string(at.items.size()) + " elements");
    for (const JsonValue& item : at.items) {
      if (item.kind == JsonKind::number && inside(item.number, type)) continue;
      Type part = type;
      part.kind = Kind::number;
      value(item, part);
    }
  }

  void list(const JsonValue& at, const Type& type) const {
    const std::size_t size = at.items.size();
    if (size < type.minimum_items || (type.maximum_items > 0 && size > type.maximum_items))
      document_.fail(at, "expected " + std::string(type.maximum_items > 0 ? "" : "at least ") +
                             std::to_string(type.minimum_items) + " elements, found " + std::to_string(size));
    for (const JsonValue& item : at.items) value(item, type.parts.front());
  }

  void presence(const JsonValue& at, const Record& record) const {
    const auto there = [&](const std::string& name) {
      return std::any_of(at.items.begin(), at.items.end(), [&](const JsonValue& item) { return item.key == name; });
    };
    for (const Field& field : record.fields)
      if (field.required && !there(field.name))
        document_.fail(at, "'" + field.name + "' is missing", "expected " + expected(field.type));
    const auto given = std::count_if(record.exactly_one.begin(), record.exactly_one.end(), there);
    if (record.exactly_one.empty() || given == 1) return;
    document_.fail(at, given == 0 ? "the kind of this " + record.name + " is missing" : "more than one kind is given",
                   "give exactly one of " + joined(record.exactly_one, " and "));
  }

  [[noreturn]] void unknown(const JsonValue& member, const Record& record) const {
    document_.fail_key(member, "'" + printable(member.key) + "' is unknown in " + record.name,
                       hint_for(member.key, record));
  }

  const JsonDocument& document_;
};

void check_used_below(const JsonDocument& document, const JsonValue& at) {
  for (const JsonValue& item : at.items) {
    if (at.kind == JsonKind::object && !item.used)
      document.fail_key(item, "'" + item.key + "' has no meaning here", "remove it");
    check_used_below(document, item);
  }
}

}  // namespace

void check(const JsonDocument& document, const Record& record) { Checker(document).record(document.root, record); }

void check_all_used(const JsonDocument& document) { check_used_below(document, document.root); }

}  // namespace pliant::scene_file

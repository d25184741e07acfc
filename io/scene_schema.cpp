// Writes the JSON Schema and the reference of the scene format. The schema has everything in the table; it cannot
// express relations between values (friction, times of keyframes, existing particles).
#include "scene_schema.h"

#include <array>
#include <nlohmann/json.hpp>

#include "pliant/io.h"
#include "scene_grammar.h"
#include "shortest_number.h"

namespace pliant::scene_file {

namespace {

using Kind = Type::Kind;
using Json = nlohmann::ordered_json;

std::string shortest_digits(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), write_shortest(digits.data(), digits.data() + digits.size(), value)};
}

/// The key of a record in "$defs".
std::string key_of(const Record& record) {
  std::string key = record.name;
  for (char& c : key)
    if (c == ' ') c = '_';
  return key;
}

/// A JSON number; integers have no fraction.
Json json_number(double value) {
  const bool whole = value > -1e15 && value < 1e15 && value == static_cast<double>(static_cast<long long>(value));
  return whole ? Json(static_cast<long long>(value)) : Json(value);
}

Json bounded(const char* type, const Type& of) {
  return {{"type", type},
          {of.above_minimum ? "exclusiveMinimum" : "minimum", json_number(of.minimum)},
          {"maximum", json_number(of.maximum)}};
}

Json list_schema(const Type& type, Json item) {
  Json schema{{"type", "array"}, {"items", std::move(item)}};
  if (type.minimum_items > 0) schema["minItems"] = type.minimum_items;
  if (type.maximum_items > 0) schema["maxItems"] = type.maximum_items;
  return schema;
}

Json schema_of(const Type& type) {
  switch (type.kind) {
    case Kind::boolean:
      return {{"type", "boolean"}};
    case Kind::integer:
      return bounded("integer", type);
    case Kind::number:
      return bounded("number", type);
    case Kind::string:
      break;
    case Kind::choice:
      return {{"enum", choices_of(type)}};
    case Kind::vector:
      return {{"type", "array"}, {"items", bounded("number", type)}, {"minItems", 3}, {"maxItems", 3}};
    case Kind::list:
      return list_schema(type, schema_of(type.parts.front()));
    case Kind::record:
      return {{"$ref", "#/$defs/" + key_of(*type.record)}};
    case Kind::any_of: {
      Json parts = Json::array();
      for (const Type& part : type.parts) parts.push_back(schema_of(part));
      return {{"anyOf", parts}};
    }
  }
  Json schema{{"type", "string"}, {"minLength", 1}};
  if (type.single_line) schema["pattern"] = "^[^\\u0000-\\u001f]*$";
  return schema;
}

Json schema_of(const Record& record) {
  Json properties = Json::object(), required = Json::array(), one = Json::array();
  for (const Field& field : record.fields) {
    Json schema = schema_of(field.type);
    const bool measured = !field.type.unit.empty() && field.type.unit != "-";
    std::string description = field.meaning + (measured ? " [" + field.type.unit + "]" : "");
    if (!field.fallback.empty()) description += " Default: " + field.fallback + ".";
    schema["description"] = description;
    properties[field.name] = schema;
    if (field.required) required.push_back(field.name);
  }
  for (const std::string& name : record.exactly_one) one.push_back({{"required", {name}}});
  Json schema{{"description", record.meaning}, {"type", "object"}, {"properties", properties}};
  if (!required.empty()) schema["required"] = required;
  if (!one.empty()) schema["oneOf"] = one;
  schema["additionalProperties"] = false;
  return schema;
}

// ------------------------------------------------------------------------------------------------ Markdown

std::string anchor(const Record& record) {
  std::string text = record.name;
  for (char& c : text)
    if (c == ' ') c = '-';
  return "[" + record.name + "](#" + text + ")";
}

std::string range_suffix(const Type& type) {
  if (type.maximum >= 1e29 && type.minimum <= -1e29) return {};
  if (type.maximum >= 1e29) return (type.above_minimum ? " > " : " >= ") + shortest_digits(type.minimum);
  if (type.above_minimum) return " > " + shortest_digits(type.minimum) + ", <= " + shortest_digits(type.maximum);
  return " " + shortest_digits(type.minimum) + " to " + shortest_digits(type.maximum);
}

std::string type_words(const Type& type) {
  std::string text;
  switch (type.kind) {
    case Kind::boolean:
      return "boolean";
    case Kind::integer:
      return "integer" + range_suffix(type);
    case Kind::number:
      return "number" + range_suffix(type);
    case Kind::string:
      return "string";
    case Kind::vector:
      return "[x, y, z]" + (type.maximum <= 1 ? ", each" + range_suffix(type) : std::string());
    case Kind::list:
      return "list of " + type_words(type.parts.front());
    case Kind::record:
      return anchor(*type.record);
    case Kind::choice:
      if (!type.choices_documented.empty()) return type.choices_documented;
      for (const std::string& choice : choices_of(type)) text += (text.empty() ? "`\"" : " or `\"") + choice + "\"`";
      return text;
    case Kind::any_of:
      break;
  }
  for (const Type& part : type.parts) text += (text.empty() ? "" : ", or ") + type_words(part);
  return text;
}

std::string unit_of(const Type& type) {
  if (!type.unit.empty()) return type.unit;
  for (const Type& part : type.parts)
    if (!unit_of(part).empty()) return unit_of(part);
  return {};
}

std::string row(const Field& field, bool one_of_several) {
  const std::string fallback = field.required ? "**required**" : one_of_several ? "one of these" : field.fallback;
  return "| `" + field.name + "` | " + type_words(field.type) + " | " + unit_of(field.type) + " | " + fallback + " | " +
         field.meaning + " |\n";
}

std::string section(const Record& record) {
  std::string text = "### " + record.name + "\n\n" + record.meaning + "\n\n";
  if (record.fields.empty()) return text + "It has no members: `{}`.\n\n";
  text += "| member | value | unit | default | meaning |\n|---|---|---|---|---|\n";
  for (const Field& field : record.fields) {
    bool one_of_several = false;
    for (const std::string& name : record.exactly_one) one_of_several = one_of_several || name == field.name;
    text += row(field, one_of_several);
  }
  return text + "\n";
}

}  // namespace

std::string scene_reference() {
  std::string text;
  for (const Record* record : all_records()) text += section(*record);
  return text;
}

std::string schema_text() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "A scene of Pliant"}};
  Json definitions = Json::object();
  for (const Record* record : all_records()) definitions[key_of(*record)] = schema_of(*record);
  schema["$ref"] = "#/$defs/" + key_of(scene_record());
  schema["$defs"] = definitions;
  return schema.dump(2) + "\n";
}

}  // namespace pliant::scene_file

namespace pliant {

std::string scene_schema() { return scene_file::schema_text(); }

}  // namespace pliant

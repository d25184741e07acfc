// Sets members of a scene's tree by JSON pointer (RFC 6901), before it is checked.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene_json.h"

namespace pliant::scene_file {

namespace {

/// The names on the way of a pointer, with ~1 for '/' and ~0 for '~'.
std::vector<std::string> steps_of(const std::string& pointer) {
  if (pointer.empty() || pointer[0] != '/')
    throw Error({}, "'" + printable(pointer) + "' is no JSON pointer", "begin with '/', as in /settings/substeps");
  std::vector<std::string> steps;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/')
      steps.emplace_back();
    else if (pointer[i] == '~' && i + 1 < pointer.size() && (pointer[i + 1] == '0' || pointer[i + 1] == '1'))
      steps.back() += pointer[++i] == '0' ? '~' : '/';
    else
      steps.back() += pointer[i];
  }
  if (static_cast<int>(steps.size()) > deepest_nesting)
    throw Error({}, "'" + printable(pointer) + "' leads more than " + std::to_string(deepest_nesting) + " levels deep",
                "scenes never need so many levels");
  return steps;
}

/// Where a member is added, errors name the record that it is added to.
JsonValue& add_item(JsonValue& to, const std::string& key) {
  JsonValue& item = to.items.emplace_back();
  item.kind = JsonValue::Kind::object;
  item.offset = item.key_offset = to.offset;
  item.key = key;
  return item;
}

JsonValue& item_of(const JsonDocument& document, JsonValue& array, const std::string& step) {
  if (step == "-") return add_item(array, {});
  const bool is_number = !step.empty() && step.size() < 9 &&
                         std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; });
  const std::size_t count = array.items.size();
  if (!is_number || std::stoul(step) >= count)
    document.fail(
        array, "there is no item '" + printable(step) + "' to set",
        count == 0 ? "it has none; '-' adds one" : "give 0 to " + std::to_string(count - 1) + ", or '-' to add one");
  return array.items[std::stoul(step)];
}

/// What a pointer adds is a record, or a list where its next step appends.
JsonValue& below(const JsonDocument& document, JsonValue& at, const std::string& step) {
  if (at.kind == JsonValue::Kind::object && at.items.empty() && step == "-") at.kind = JsonValue::Kind::array;
  if (at.kind == JsonValue::Kind::array) return item_of(document, at, step);
  if (at.kind != JsonValue::Kind::object)
    document.fail(at, "this has no member '" + printable(step) + "' to set", "it is neither an object nor an array");
  const auto found =
      std::find_if(at.items.begin(), at.items.end(), [&](const JsonValue& item) { return item.key == step; });
  return found != at.items.end() ? *found : add_item(at, step);
}

void place_at(std::uint32_t offset, JsonValue& value) {
  value.offset = value.key_offset = offset;
  for (JsonValue& item : value.items) place_at(offset, item);
}

}  // namespace

void set_value(JsonDocument& document, const std::string& pointer, const std::string& value) {
  JsonValue* at = &document.root;
  for (const std::string& step : steps_of(pointer)) at = &below(document, *at, step);
  const std::string json = nlohmann::json::accept(value)
                               ? value
                               : nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  JsonValue given = parse_json(json, "value of " + printable(pointer)).root;
  place_at(at->offset, given);
  given.key = at->key;
  *at = std::move(given);
}

}  // namespace pliant::scene_file

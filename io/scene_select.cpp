// Finds the particles that a selection denotes.
#include <algorithm>
#include <string>

#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

std::vector<int> corners(const JsonDocument& document, const JsonValue& at, const BuiltObject& built) {
  if (built.columns == 0)
    document.fail(at, "only a grid has corners", "select particles by index, by a box, or as nearest to a point");
  const int last_row = (built.rows - 1) * built.columns;
  return {0, built.columns - 1, last_row, last_row + built.columns - 1};
}

std::vector<int> by_word(const JsonDocument& document, const JsonValue& at, const BuiltObject& built) {
  if (at.text == "corners") return corners(document, at, built);
  const int count = static_cast<int>(built.object.positions.size());
  if (at.text == "ends") return count == 1 ? std::vector<int>{0} : std::vector<int>{0, count - 1};
  std::vector<int> all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = i;
  return all;
}

std::vector<int> by_index(const JsonDocument& document, const JsonValue& at, const BuiltObject& built) {
  const std::size_t count = built.object.positions.size();
  std::vector<bool> taken(count, false);
  std::vector<int> result;
  for (const JsonValue& item : at.items) {
    if (item.number >= static_cast<double>(count))
      document.fail(item, "there is no particle " + std::to_string(static_cast<long long>(item.number)),
                    "the object has " + std::to_string(count) + ", counted from 0");
    const auto index = static_cast<std::size_t>(item.number);
    if (taken[index]) document.fail(item, "particle " + std::to_string(index) + " occurs twice", "name it once");
    taken[index] = true;
    result.push_back(static_cast<int>(index));
  }
  return result;
}

/// The particle nearest to a point, of equally near ones the first.
int nearest(const Vec3f& point, const std::vector<Vec3f>& positions) {
  const auto distance = [&](const Vec3f& p) { return length_squared(p - point); };
  const auto nearer = [&](const Vec3f& a, const Vec3f& b) { return distance(a) < distance(b); };
  return static_cast<int>(std::min_element(positions.begin(), positions.end(), nearer) - positions.begin());
}

std::vector<int> by_box(const JsonDocument& document, const JsonValue& at, const std::vector<Vec3f>& positions) {
  Vec3f low, high;
  set(at, "min", low);
  set(at, "max", high);
  if (low.x > high.x || low.y > high.y || low.z > high.z)
    document.fail(at, "the box is empty", "each coordinate of min must be at most that of max");
  const auto inside = [](float x, float a, float b) { return x >= a && x <= b; };
  std::vector<int> result;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3f& p = positions[i];
    if (inside(p.x, low.x, high.x) && inside(p.y, low.y, high.y) && inside(p.z, low.z, high.z))
      result.push_back(static_cast<int>(i));
  }
  if (!result.empty()) return result;
  const int near = nearest(0.5f * (low + high), positions);
  const Vec3f& p = positions[static_cast<std::size_t>(near)];
  document.fail(at, "there is no particle in this box",
                "the one nearest to its centre is " + std::to_string(near) + " at " + std::to_string(p.x) + ", " +
                    std::to_string(p.y) + ", " + std::to_string(p.z));
}

}  // namespace

std::vector<int> selected(const JsonDocument& document, const JsonValue& at, const BuiltObject& built) {
  if (at.kind == JsonValue::Kind::string) return by_word(document, at, built);
  if (at.kind == JsonValue::Kind::array) return by_index(document, at, built);
  if (const JsonValue* box = at.find("box")) return by_box(document, *box, built.object.positions);
  return {nearest(vector_of(*at.find("nearest")), built.object.positions)};
}

}  // namespace pliant::scene_file

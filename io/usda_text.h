// Values as text of USD, for its writers.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pliant/vec3.h"
#include "write_text.h"

namespace pliant::output {

template <class List, class Item>
std::string listed(const List& items, Item item) {
  std::string text = "[";
  for (const auto& i : items) {
    if (text.size() > 1) text += ", ";
    item(text, i);
  }
  return text + "]";
}

inline void tuple(std::string& text, const Vec3f& v) {
  append(text += '(', v, ", ");
  text += ')';
}

inline std::string usda_string(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return text + "\"";
}

inline std::string extent(const std::vector<Vec3f>& points, float margin) {
  if (points.empty()) return "[(0, 0, 0), (0, 0, 0)]";
  Vec3f low = points[0], high = points[0];
  for (const Vec3f& p : points) {
    low = {std::fmin(low.x, p.x), std::fmin(low.y, p.y), std::fmin(low.z, p.z)};
    high = {std::fmax(high.x, p.x), std::fmax(high.y, p.y), std::fmax(high.z, p.z)};
  }
  const Vec3f around{margin, margin, margin};
  return listed(std::vector<Vec3f>{low - around, high + around}, tuple);
}

}  // namespace pliant::output

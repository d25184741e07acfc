// Functions that both writers of .obj text use.
#pragma once

#include <string>
#include <vector>

#include "write_frames.h"
#include "write_text.h"

namespace pliant::output {

/// Returns a `v` line for each position.
inline std::string obj_vertices(const std::vector<Vec3f>& positions) {
  std::string text;
  for (const Vec3f& position : positions) {
    append(text += "v ", position);
    text += '\n';
  }
  return text;
}

/// Returns an object's `f` lines, else its `l` lines, else its `p` lines. `first` is the index of its first vertex,
/// from 1.
inline std::string obj_elements(const FrameObject& object, int first) {
  std::string text;
  const auto line = [&](const char* kind, const auto& indices) {
    text += kind;
    for (const int i : indices) append(text += ' ', first + i);
    text += '\n';
  };
  for (const auto& triangle : object.triangles) line("f", triangle);
  if (!object.triangles.empty()) return text;
  for (const auto& indices : object.lines) line("l", indices);
  if (!object.lines.empty()) return text;
  for (int i = 0; i < object.particles; ++i) line("p", std::array<int, 1>{i});
  return text;
}

}  // namespace pliant::output

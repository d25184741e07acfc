// What rods look like: tubes through their segments, which are bodies.
#pragma once

#include <cstddef>
#include <vector>

#include "io/write_frames.h"
#include "render.h"

namespace pliant::render {

/// For each body of an object: 1 if it is a segment of a rod, else 0.
std::vector<char> rod_segments(const Object& object);

/// A part of a rod that hangs together.
struct RodPart {
  std::size_t first = 0;  ///< its first segment, an index in Object::bodies
  std::size_t rod = 0;    ///< number of the rod in the object
  RenderTube tube;        ///< without its colour
};

std::vector<RodPart> rod_parts(const Object& object, const ObjectView& view,
                               const std::vector<output::BodyMotion>& motions, const std::vector<char>& segments);

}  // namespace pliant::render

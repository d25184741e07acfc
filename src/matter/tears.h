// What comes apart in one edit of an object, and where it is stretched too far.
#pragma once

#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "constraints/registry.h"
#include "math/vector.h"
#include "matter/cut_edges.h"
#include "matter/cut_faces.h"

namespace pliant {

/// What comes apart in one Edit.
struct Breaks {
  std::set<EdgeEnds> edges;             ///< of triangles
  std::set<Face> faces;                 ///< of tetrahedra
  std::set<std::pair<int, int>> links;  ///< constraints that are removed: group, and number in it

  bool any() const { return !edges.empty() || !faces.empty() || !links.empty(); }
};

/// An object without some of its constraints, given by group and number in it, and without the limits of the lengths
/// that go.
Object without_constraints(const Object& object, const std::set<std::pair<int, int>>& constraints);

/// Where edges and links of a surface or rope are too long (Object::tearing) at these positions.
Breaks tears_of_surface(const Object& object, std::span<const Vec3f> positions);
/// The faces along which tetrahedra come apart that are.
std::set<Face> faces_that_tear(const Object& object, std::span<const Vec3f> positions);

/// Particles that must not be split, because both copies would be held at the same place; 1 for each of them.
std::vector<char> held_particles(const Object& object);

/// Calls body(group, number, a, b) for each distance constraint.
template <class Body>
void for_each_pair(const Object& object, Body&& body) {
  for (std::size_t g = 0; g < object.constraints.size(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    if (!is_length(group.type)) continue;
    for (std::size_t c = 0; 2 * c + 1 < group.particles.size(); ++c)
      body(static_cast<int>(g), static_cast<int>(c), group.particles[2 * c], group.particles[2 * c + 1]);
  }
}

/// Calls body(group, number, a, b, rest length) for each distance constraint.
template <class Body>
void for_each_link(const Object& object, Body&& body) {
  for_each_pair(object, [&](int g, int c, int a, int b) {
    const std::vector<float>& lengths = object.constraints[static_cast<std::size_t>(g)].rest;
    const Vec3d d = convert<double>(object.positions[static_cast<std::size_t>(b)]) -
                    convert<double>(object.positions[static_cast<std::size_t>(a)]);
    body(g, c, a, b,
         lengths.empty() ? std::sqrt(dot(d, d)) : static_cast<double>(lengths[static_cast<std::size_t>(c)]));
  });
}

}  // namespace pliant

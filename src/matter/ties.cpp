// Ties particles of an object to its triangles and tetrahedra.
#include <algorithm>
#include <string>
#include <utility>

#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "geometry/triangle.h"
#include "matter/cut_faces.h"
#include "matter/tetrahedron_query.h"
#include "pliant/body.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Throws an Error unless there are particles, and each is one of the object.
void require_particles(const Object& object, const std::vector<int>& particles) {
  if (particles.empty()) throw Error({.object = object.name}, "ties no particles", "give at least one");
  for (const int p : particles)
    if (p < 0 || static_cast<std::size_t>(p) >= object.positions.size())
      throw Error({.object = object.name, .element = "particle " + std::to_string(p)},
                  "does not exist; there are " + std::to_string(object.positions.size()), "indices count from 0");
}

ConstraintGroup ties_of(const char* type, const Stiffness& stiffness) {
  ConstraintGroup group;
  group.type = type;
  group.stiffness = stiffness;
  return group;
}

/// The triangle that is nearest to a particle, of those that do not have it as a corner; -1: there is none.
int nearest_triangle(const Object& object, int particle) {
  const auto at = [&](int p) { return convert<double>(object.positions[static_cast<std::size_t>(p)]); };
  int nearest = -1;
  double distance = 0;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const auto& [a, b, c] = object.triangles[t];
    if (a == particle || b == particle || c == particle) continue;
    const double squared = closest_on_triangle(at(particle), at(a), at(b), at(c)).distance_squared;
    if (nearest >= 0 && !(squared < distance)) continue;
    nearest = static_cast<int>(t);
    distance = squared;
  }
  return nearest;
}

}  // namespace

void attach_to_surface(Object& object, const std::vector<int>& particles, const Stiffness& stiffness) {
  require_particles(object, particles);
  ConstraintGroup group = ties_of(PointOnTriangle::name, stiffness);
  for (const int p : particles) {
    const int t = nearest_triangle(object, p);
    if (t < 0)
      throw Error({.object = object.name, .element = "particle " + std::to_string(p)},
                  "finds no triangle of other particles", "append the surface to the object first");
    const auto& [a, b, c] = object.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int i) { return convert<double>(object.positions[static_cast<std::size_t>(i)]); };
    const Vec3d weights = closest_on_triangle(at(p), at(a), at(b), at(c)).weights;
    group.particles.insert(group.particles.end(), {p, a, b, c});
    group.rest.insert(group.rest.end(), {static_cast<float>(weights.y), static_cast<float>(weights.z)});
  }
  object.constraints.push_back(std::move(group));
}

void attach_inside(Object& object, const std::vector<int>& particles, const Stiffness& stiffness) {
  require_particles(object, particles);
  const std::vector<std::array<int, 4>> all = required_tetrahedra(object);
  ConstraintGroup group = ties_of(PointInTetrahedron::name, stiffness);
  const TetrahedronQuery query(object.positions, all);
  for (const int p : particles) {
    const bool is_corner = std::any_of(
        all.begin(), all.end(), [&](const std::array<int, 4>& t) { return std::find(t.begin(), t.end(), p) != t.end(); });
    if (is_corner)
      throw Error({.object = object.name, .element = "particle " + std::to_string(p)},
                  "is a corner of a tetrahedron itself", "tie particles of other matter");
    const PlaceInTetrahedron found = query.nearest(object.positions[static_cast<std::size_t>(p)]);
    const std::array<int, 4>& corners = query.tetrahedron(found.tetrahedron);
    group.particles.push_back(p);
    group.particles.insert(group.particles.end(), corners.begin(), corners.end());
    for (std::size_t i = 1; i < 4; ++i) group.rest.push_back(static_cast<float>(found.weights[i]));
  }
  object.constraints.push_back(std::move(group));
}

}  // namespace pliant

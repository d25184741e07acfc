// Ties particles of an object to its triangles and tetrahedra.
#include <cmath>
#include <string>
#include <utility>

#include "collision/broad/tree.h"
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
  for (std::size_t i = 0; i < object.positions.size(); ++i)
    if (const Vec3f& p = object.positions[i]; !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error({.object = object.name, .element = "particle " + std::to_string(i)},
                  "has a position that is not finite", "give finite coordinates in metres");
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

/// Finds the triangle of an object that is nearest to a particle.
class TriangleSearch {
 public:
  explicit TriangleSearch(const Object& object) : object_(object) {
    std::vector<BoxBounds> boxes;
    boxes.reserve(object.triangles.size());
    for (const auto& triangle : object.triangles) {
      Vec3f corners[3];
      for (std::size_t i = 0; i < 3; ++i) {
        if (triangle[i] < 0 || static_cast<std::size_t>(triangle[i]) >= object.positions.size())
          throw Error({.object = object.name, .element = "triangle " + std::to_string(boxes.size())},
                      "uses a particle that does not exist", "indices count from 0");
        corners[i] = object.positions[static_cast<std::size_t>(triangle[i])];
      }
      boxes.push_back(BoxBounds::of(corners, 3));
    }
    if (!boxes.empty()) tree_.build(boxes);
  }

  /// The first of equally near ones, of those that do not have the particle as a corner; -1: there is none.
  int nearest(int particle) const {
    constexpr float far = 3e38f;
    if (object_.triangles.empty()) return -1;
    const auto distance = [&](int t) {
      const auto& [a, b, c] = object_.triangles[static_cast<std::size_t>(t)];
      if (a == particle || b == particle || c == particle) return far;
      return static_cast<float>(std::sqrt(closest_on_triangle(at(particle), at(a), at(b), at(c)).distance_squared));
    };
    return tree_.closest(object_.positions[static_cast<std::size_t>(particle)], far, distance).first;
  }

 private:
  Vec3d at(int p) const { return convert<double>(object_.positions[static_cast<std::size_t>(p)]); }

  const Object& object_;
  Tree<BoxBounds> tree_;
};

}  // namespace

void attach_to_surface(Object& object, const std::vector<int>& particles, const Stiffness& stiffness) {
  require_particles(object, particles);
  ConstraintGroup group = ties_of(PointOnTriangle::name, stiffness);
  const TriangleSearch search(object);
  for (const int p : particles) {
    const int t = search.nearest(p);
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
  const std::vector<std::array<int, 4>> all = required_tetrahedra(object, "append a soft body to the object first");
  ConstraintGroup group = ties_of(PointInTetrahedron::name, stiffness);
  const TetrahedronQuery query(object.positions, all);
  std::vector<char> is_corner(object.positions.size());
  for (const auto& t : all)
    for (const int corner : t) is_corner[static_cast<std::size_t>(corner)] = 1;
  for (const int p : particles) {
    if (is_corner[static_cast<std::size_t>(p)] != 0)
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

// Warnings about constraints on tetrahedra and triangles that have no volume or area, or no rest data.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "inspect/problems.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// The product of the edges times this is the least volume or area with which constraint types measure a rest shape.
constexpr double least_share = 1e-6;

/// A constraint type on the corners of a tetrahedron or triangle.
struct ElementType {
  std::string_view name;
  std::size_t corners;
  std::size_t first;  ///< rest field from which on zeros have no effect
  bool needs_shape;   ///< true: it has no effect on a flat element; false: it acts on an edge of that
};
constexpr std::array<ElementType, 8> element_types{{{"tetrahedron_shear", 4, 0, true},
                                                    {"corotational_strain", 4, 0, true},
                                                    {"green_strain", 4, 0, true},
                                                    {"green_trace", 4, 0, true},
                                                    {"tetrahedron_volume", 4, 0, true},
                                                    {"fibre", 4, 1, false},
                                                    {"triangle_stretch", 3, 1, false},
                                                    {"triangle_shear", 3, 0, true}}};

bool is_flat_element(const Object& object, const int* corners, std::size_t count) {
  const auto at = [&](std::size_t i) {
    return convert<double>(object.positions[static_cast<std::size_t>(corners[i])]);
  };
  const Vec3d a = at(1) - at(0), b = at(2) - at(0);
  if (count == 3)
    return length_squared(cross(a, b)) <= least_share * least_share * length_squared(a) * length_squared(b);
  const Vec3d c = at(3) - at(0);
  const double edges = std::sqrt(length_squared(a)) * std::sqrt(length_squared(b)) * std::sqrt(length_squared(c));
  return std::fabs(dot(cross(a, b), c)) <= least_share * edges;
}

void doubt_flat(Problems& problems, const Object& object, const ConstraintGroup& group, const ElementType& type,
                const std::string& kind) {
  Tally flat;
  for (std::size_t c = 0; c < group.particles.size() / type.corners; ++c)
    if (is_flat_element(object, &group.particles[c * type.corners], type.corners))
      flat.add(static_cast<std::int64_t>(c));
  const bool is_solid = type.corners == 4;
  const std::string where = is_solid ? "has its corners in one plane at rest" : "has its corners on one line at rest";
  problems.doubtful(flat, kind,
                    where + (type.needs_shape ? ", so it has no effect"
                             : is_solid       ? ", so it has no volume"
                                              : ", so it has no area"),
                    "remove it, or mesh the object again; a distance constraint keeps the length of an edge");
}

void doubt_zero_rest(Problems& problems, const ConstraintGroup& group, const ElementType& type, std::size_t fields,
                     const std::string& kind) {
  Tally zero;
  for (std::size_t c = 0; c < group.rest.size() / fields; ++c) {
    const auto begin = group.rest.begin() + static_cast<std::ptrdiff_t>(c * fields);
    if (std::all_of(begin + static_cast<std::ptrdiff_t>(type.first), begin + static_cast<std::ptrdiff_t>(fields),
                    [](float value) { return value == 0; }))
      zero.add(static_cast<std::int64_t>(c));
  }
  problems.doubtful(zero, kind, "has rest data of 0, so it has no effect",
                    "leave `rest` empty to have it measured from the positions, or remove the constraint");
}

}  // namespace

void doubt_elements(Problems& problems, const Object& object) {
  for (std::size_t g = 0; g < object.constraints.size(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    const auto type = std::find_if(element_types.begin(), element_types.end(),
                                   [&](const ElementType& one) { return one.name == group.type; });
    if (type == element_types.end()) continue;
    const std::string kind = "constraint group " + std::to_string(g) + ", " + group.type + " constraint";
    if (group.rest.empty())
      doubt_flat(problems, object, group, *type, kind);
    else
      doubt_zero_rest(problems, group, *type, group.rest.size() * type->corners / group.particles.size(), kind);
  }
}

}  // namespace pliant

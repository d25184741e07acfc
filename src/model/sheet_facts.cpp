// Which sheets bend as a whole, and what their hinges say of the material (model/sheet_bending.h,
// model/sheet_choice.h).
#include <algorithm>
#include <cmath>

#include "constraints/registry.h"
#include "core/at.h"
#include "math/disjoint_sets.h"
#include "math/vector.h"
#include "model/sheet_bending.h"
#include "model/sheet_choice.h"
#include "topology/edges.h"

namespace pliant {

namespace {

/// B / (rho g e^3) below which the edges of a sheet are long.
constexpr double least_self_support = 11;
/// Hinges at a vertex that differ by more in their stiffness are a crease, or a seam of another material.
constexpr double largest_ratio = 4;
/// A rest shape is flat if no hinge is folded by more [rad]; or by no more than the second, which rounding in a mesh
/// file makes, where each piece lies in a plane up to this share of an edge.
constexpr double largest_fold = 1e-3, largest_rounded_fold = 0.05, largest_offset = 0.02;

Vec3d rest_position(const Object& object, int particle) { return convert<double>(object.positions[at(particle)]); }

/// The flexural rigidity B that the compliance of a hinge stands for (matter/cloth.cpp) [N m].
double rigidity_of(const std::array<Vec3d, 4>& x, double compliance, bool isometric) {
  if (isometric) return 3 / compliance;
  const Vec3d e = x[1] - x[0];
  const double areas = (length(cross(e, x[2] - x[0])) + length(cross(e, x[3] - x[0]))) / 2;
  return areas / (length_squared(e) * compliance);
}

std::array<Vec3d, 4> hinge_at(const Object& object, const ConstraintGroup& group, std::size_t hinge) {
  std::array<Vec3d, 4> x;
  for (std::size_t slot = 0; slot < 4; ++slot) x[slot] = rest_position(object, group.particles[4 * hinge + slot]);
  return x;
}

/// By how much a hinge of an object is folded at rest, at most [rad].
double largest_fold_of(const Object& object) {
  double most = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    if (!is_flat_hinge(group.type))
      for (const float angle : group.rest) most = std::max(most, std::fabs(double(angle)));
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const std::array<Vec3d, 4> x = hinge_at(object, group, i);
      most = std::max(most, std::fabs(fold_angle({x[0], x[1], x[2], x[3]})));
    }
  }
  return most;
}

/// Sums over a piece of a sheet.
struct PieceSums {
  Vec3d positions{}, normals{};
  double vertices = 0;
};

/// How far each vertex lies from the plane of its piece, and the mean edge [m].
struct PlaneOffsets {
  std::vector<double> of_vertex;
  double edge = 0;
};

PlaneOffsets offsets_from_planes(const Object& object) {
  DisjointSets pieces(object.positions.size());
  for (const auto& [a, b, c] : object.triangles) pieces.join(at(a), at(b)), pieces.join(at(b), at(c));
  std::vector<PieceSums> sums(object.positions.size());
  PlaneOffsets out;
  for (const auto& [a, b, c] : object.triangles) {
    const Vec3d x = rest_position(object, a), y = rest_position(object, b), z = rest_position(object, c);
    const Vec3d normal = cross(y - x, z - x);
    Vec3d& sum = sums[pieces.root(at(a))].normals;
    sum += dot(sum, normal) < 0 ? -normal : normal;  // triangles need not be wound alike
    out.edge += length(y - x) / static_cast<double>(object.triangles.size());
  }
  for (std::size_t v = 0; v < object.positions.size(); ++v) {
    PieceSums& piece = sums[pieces.root(v)];
    piece.positions += rest_position(object, static_cast<int>(v));
    piece.vertices += 1;
  }
  out.of_vertex.reserve(object.positions.size());
  for (std::size_t v = 0; v < object.positions.size(); ++v) {
    const PieceSums& piece = sums[pieces.root(v)];
    const Vec3d away = rest_position(object, static_cast<int>(v)) - piece.positions * (1 / piece.vertices);
    out.of_vertex.push_back(dot(away, piece.normals) / std::max(length(piece.normals), 1e-300));
  }
  return out;
}

/// True if the vertices of each piece lie in one plane, up to a share of the mean edge.
bool lies_in_planes(const Object& object) {
  const PlaneOffsets offsets = offsets_from_planes(object);
  return std::all_of(offsets.of_vertex.begin(), offsets.of_vertex.end(),
                     [&](double offset) { return std::fabs(offset) <= largest_offset * offsets.edge; });
}

bool is_flat(const Object& object) {
  const double fold = largest_fold_of(object);
  return fold <= largest_fold || (fold <= largest_rounded_fold && lies_in_planes(object));
}

/// True if every edge of two triangles has one hinge, and none has three or more triangles. A seam or crease without
/// hinges bends freely.
bool has_hinges_everywhere(const Object& object) {
  std::vector<std::array<int, 2>> hinges;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const auto [a, b] = std::minmax(group.particles[4 * i], group.particles[4 * i + 1]);
      hinges.push_back({a, b});
    }
  }
  std::sort(hinges.begin(), hinges.end());
  std::size_t inner = 0;
  for (const Edge& edge : find_edges(object.triangles, static_cast<int>(object.positions.size()))) {
    if (edge.triangle_count > 2) return false;
    if (!edge.is_inner()) continue;
    const std::array<int, 2> ends{std::min(edge.a, edge.b), std::max(edge.a, edge.b)};
    const auto [first, last] = std::equal_range(hinges.begin(), hinges.end(), ends);
    if (last - first != 1) return false;
    ++inner;
  }
  return inner == hinges.size();
}

/// True if the initial positions are the rest shape, as they are not where pieces were welded.
bool is_at_rest(const Object& object) {
  constexpr double tolerated = 0.01;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.rest.empty()) continue;
    for (std::size_t i = 0; 2 * i + 1 < group.particles.size() && i < group.rest.size(); ++i) {
      const double rest = double(group.rest[i]);
      const double now =
          length(rest_position(object, group.particles[2 * i + 1]) - rest_position(object, group.particles[2 * i]));
      if (std::fabs(now - rest) > tolerated * std::max(now, rest)) return false;
    }
  }
  return true;
}

/// True if a group has the compliances of a material, which nothing changes.
bool is_of_material(const ConstraintGroup& group) {
  return !group.compliances.empty() && group.stiffness.kind == Stiffness::Kind::compliance && !group.plasticity &&
         group.keyframes.empty() && !(group.break_force > 0);
}

/// The rigidity at each particle: the mean of its hinges with compliances; 0 without one.
std::vector<double> rigidities(const Object& object) {
  std::vector<double> sum(object.positions.size(), 0), count(object.positions.size(), 0);
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; i < group.compliances.size() && 4 * i + 3 < group.particles.size(); ++i) {
      const double b = rigidity_of(hinge_at(object, group, i), double(group.compliances[i]), is_flat_hinge(group.type));
      for (std::size_t slot = 0; slot < 4; ++slot) {
        sum[at(group.particles[4 * i + slot])] += b;
        count[at(group.particles[4 * i + slot])] += 1;
      }
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = count[v] > 0 ? sum[v] / count[v] : 0;
  return sum;
}

/// True if the hinges at each vertex are much alike.
bool is_alike(const Object& object) {
  constexpr double none = 1e300;
  std::vector<double> least(object.positions.size(), none), most(object.positions.size(), 0);
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const double b = rigidity_of(hinge_at(object, group, i), double(group.compliances[i]), is_flat_hinge(group.type));
      for (std::size_t slot = 0; slot < 4; ++slot) {
        const std::size_t v = at(group.particles[4 * i + slot]);
        least[v] = std::min(least[v], b);
        most[v] = std::max(most[v], b);
      }
    }
  }
  for (std::size_t v = 0; v < least.size(); ++v)
    if (least[v] < none && !(most[v] <= largest_ratio * least[v])) return false;
  return true;
}

/// B / (rho e^4) of a sheet, e its mean edge [1/s^2]; 0 if it has no hinges with compliances, or no mass.
double sheet_stiffness(const Object& object) {
  double edges = 0, rigidity = 0, hinges = 0, area = 0, mass = 0, weighed = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; i < group.compliances.size() && 4 * i + 3 < group.particles.size(); ++i) {
      const std::array<Vec3d, 4> x = hinge_at(object, group, i);
      rigidity += rigidity_of(x, double(group.compliances[i]), is_flat_hinge(group.type));
      edges += length(x[1] - x[0]);
      hinges += 1;
    }
  }
  double vertices = 0;
  std::vector<char> has_triangle(object.positions.size(), 0);
  for (const auto& triangle : object.triangles) {
    const auto& [a, b, c] = triangle;
    area += length(cross(rest_position(object, b) - rest_position(object, a),
                         rest_position(object, c) - rest_position(object, a))) /
            2;
    for (const int v : triangle) has_triangle[at(v)] = 1;
  }
  for (std::size_t v = 0; v < has_triangle.size(); ++v) {
    if (has_triangle[v] == 0) continue;
    vertices += 1;
    if (!std::isfinite(object.masses[v])) continue;
    mass += double(object.masses[v]);
    weighed += 1;
  }
  if (!(hinges > 0 && weighed > 0 && area > 0)) return 0;
  const double density = mass / weighed * vertices / area, edge = edges / hinges;
  return rigidity / hinges / (density * edge * edge * edge * edge);
}

/// The mean length of the edges with hinges [m]; 0 of none.
double mean_hinge(const Object& object) {
  double edges = 0, hinges = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      edges +=
          length(rest_position(object, group.particles[4 * i + 1]) - rest_position(object, group.particles[4 * i]));
      hinges += 1;
    }
  }
  return hinges > 0 ? edges / hinges : 0;
}

/// Damping over stiffness of the hinges [s].
float damping_time(const Object& object) {
  float time = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type) || group.compliances.empty()) continue;
    std::vector<float> sorted = group.compliances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    time = std::max(time, group.stiffness.damping * *middle);
  }
  return time;
}

}  // namespace

bool bends_as_sheet(const Object& object, double h) {
  const double stiffness = sheet_stiffness(object);
  if (!(stiffness > 0 && h * h * stiffness < most_stiffness_of_sheets)) return false;
  const auto can_be_sheet = [&](const ConstraintGroup& group) {
    return !is_hinge(group.type) || group.particles.empty() || is_of_material(group);
  };
  return object.bodies.empty() && std::all_of(object.constraints.begin(), object.constraints.end(), can_be_sheet) &&
         is_flat(object) && has_hinges_everywhere(object) && is_at_rest(object) && is_alike(object);
}

double bow_of_sheet(const Object& object) {
  constexpr double least_share = 1e-3, least_shared = 0.5;
  const PlaneOffsets offsets = offsets_from_planes(object);
  double most = 0, own = 0, shared = 0;
  for (const double offset : offsets.of_vertex) most = std::max(most, std::fabs(offset));
  if (!(most > least_share * offsets.edge)) return 0;
  for (const Edge& edge : find_edges(object.triangles, static_cast<int>(object.positions.size()))) {
    const double a = offsets.of_vertex[at(edge.a)], b = offsets.of_vertex[at(edge.b)];
    own += (a * a + b * b) / 2;
    shared += a * b;
  }
  return shared > least_shared * own ? most : 0;
}

bool has_long_edges(const Object& object, double gravity) {
  constexpr double on_earth = 9.81;
  return sheet_stiffness(object) * mean_hinge(object) < least_self_support * std::max(gravity, on_earth);
}

double excess_of_hinges(const Object& object, double h) {
  constexpr double measured = 2.3;
  if (bends_as_sheet(object, h)) return 0;
  return measured * h * h * sheet_stiffness(object);
}

SheetFacts facts_of_sheet(const Object& object) {
  return {rigidities(object), sheet_stiffness(object), damping_time(object)};
}

}  // namespace pliant

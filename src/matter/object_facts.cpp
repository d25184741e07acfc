#include "matter/object_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "constraints/distance_limit.h"
#include "constraints/registry.h"
#include "math/vector.h"
#include "model/attachments.h"
#include "model/object_sets.h"

namespace pliant {

namespace {

/// A sheet whose bending length exceeds this share of its size supports itself; sweeps that correct only stretch
/// converge slowly.
constexpr double stiff_share = 0.25;
/// A spring continues straight at an end if another one leaves there within 10 degrees of its direction.
constexpr double straight_cosine = -0.985;
/// A mesh with more of its ends so is regular. Of a grid of 6 x 6 three quarters are, of irregular meshes a third.
constexpr double straight_share = 0.6;
/// Particles with more springs, such as the hub of a wheel, are left out of that count, which compares each with each.
constexpr std::size_t most_neighbours = 64;

/// The position of a particle; zero if it does not exist, because this runs before the scene is validated.
Vec3d position(const Object& object, int particle) {
  const auto i = static_cast<std::size_t>(particle);
  return i < object.positions.size() ? convert<double>(object.positions[i]) : Vec3d{};
}

std::size_t springs_of(const Object& object) {
  std::size_t count = 0;
  for (const ConstraintGroup& group : object.constraints)
    if (is_length(group.type) && group.stiffness.kind == Stiffness::Kind::compliance)
      count += group.particles.size() / 2;
  return count;
}

/// Collects the flexural rigidity of each hinge [N m] (see hinge_compliance in cloth.cpp) and the sum of the areas of
/// hinges [m^2], in which a triangle occurs up to three times.
struct Bending {
  std::vector<double> rigidities;
  double area = 0;

  void add(const std::array<Vec3d, 4>& x, bool isometric, double compliance) {
    const Vec3d edge = x[1] - x[0];
    const double twice =
        std::sqrt(length_squared(cross(edge, x[2] - x[0]))) + std::sqrt(length_squared(cross(edge, x[3] - x[0])));
    const double beside = twice / 2;
    if (!(beside > 0)) return;  // a degenerate hinge says nothing about the sheet
    rigidities.push_back(isometric ? 3 / compliance : beside / (length_squared(edge) * compliance));
    area += beside;
  }

  /// The median rigidity, so that a few stiff hinges, such as a seam, do not make a stiff sheet.
  double median() {
    if (rigidities.empty()) return 0;
    const auto middle = rigidities.begin() + static_cast<std::ptrdiff_t>(rigidities.size() / 2);
    std::nth_element(rigidities.begin(), middle, rigidities.end());
    return *middle;
  }
};

/// Measures the hinges of an object. PBD stiffness counts as rigid if positive, because its effect depends on mesh and
/// step.
Bending bending_of(const Object& object) {
  Bending bending;
  std::size_t hinges = 0;
  for (const ConstraintGroup& group : object.constraints) hinges += group.particles.size() / 4;
  bending.rigidities.reserve(hinges);
  for (const ConstraintGroup& group : object.constraints) {
    const bool isometric = group.type == "isometric_bending", is_pbd = group.stiffness.kind == Stiffness::Kind::pbd;
    if (!isometric && group.type != "dihedral_bending") continue;
    if (is_pbd && !(group.stiffness.value > 0)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      std::array<Vec3d, 4> x;
      for (std::size_t slot = 0; slot < 4; ++slot) x[slot] = position(object, group.particles[4 * i + slot]);
      const float compliance = i < group.compliances.size() ? group.compliances[i] : group.stiffness.value;
      bending.add(x, isometric, is_pbd ? 0 : static_cast<double>(compliance));
    }
  }
  return bending;
}

double area_of(const Object& object) {
  double area = 0;
  for (const auto& triangle : object.triangles) {
    const Vec3d origin = position(object, triangle[0]);
    const Vec3d a = position(object, triangle[1]) - origin, b = position(object, triangle[2]) - origin;
    area += std::sqrt(length_squared(cross(a, b))) / 2;
  }
  return area;
}

bool have_same_motion(const Motion& a, const Motion& b) {
  const auto same_place = [](const Vec3f& p, const Vec3f& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
  const auto same = [&](const Keyframe& k, const Keyframe& l) {
    return k.time == l.time && same_place(k.position, l.position) && k.rotation.x == l.rotation.x &&
           k.rotation.y == l.rotation.y && k.rotation.z == l.rotation.z && k.rotation.w == l.rotation.w;
  };
  return a.repeat == b.repeat && same_place(a.pivot, b.pivot) &&
         std::equal(a.keyframes.begin(), a.keyframes.end(), b.keyframes.begin(), b.keyframes.end(), same);
}

/// Each particle's neighbours along springs that multigrid and chains correct. Those of particle p are numbers first[p]
/// to first[p + 1] of `all`.
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<int> all;
};

/// Calls visit(a, b) for the two particles of each spring. Particles that do not exist are left out.
template <class Visit>
void for_springs(const Object& object, const Visit& visit) {
  const auto exists = [&](int p) { return p >= 0 && static_cast<std::size_t>(p) < object.positions.size(); };
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    for (std::size_t i = 0; i + 1 < group.particles.size(); i += 2)
      if (exists(group.particles[i]) && exists(group.particles[i + 1]))
        visit(group.particles[i], group.particles[i + 1]);
  }
}

Neighbours neighbours_of(const Object& object) {
  Neighbours found;
  found.first.assign(object.positions.size() + 2, 0);  // counts of particle p at p + 2, then starts at p + 1, then at p
  for_springs(object, [&](int a, int b) {
    ++found.first[static_cast<std::size_t>(a) + 2];
    ++found.first[static_cast<std::size_t>(b) + 2];
  });
  std::partial_sum(found.first.begin(), found.first.end(), found.first.begin());
  found.all.resize(found.first.back());
  for_springs(object, [&](int a, int b) {
    found.all[found.first[static_cast<std::size_t>(a) + 1]++] = b;
    found.all[found.first[static_cast<std::size_t>(b) + 1]++] = a;
  });
  return found;
}

/// Directions of the springs at one particle.
struct Ways {
  std::array<Vec3d, most_neighbours> way;
  std::size_t count = 0;

  void add(const Vec3d& along) {
    const double squared = length_squared(along);
    if (squared > 0) way[count++] = along * (1 / std::sqrt(squared));
  }
  /// The number of springs that another one continues straight.
  std::size_t straight() const {
    const auto end = way.begin() + static_cast<std::ptrdiff_t>(count);
    return static_cast<std::size_t>(std::count_if(way.begin(), end, [&](const Vec3d& one) {
      return std::any_of(way.begin(), end, [&](const Vec3d& other) { return dot(one, other) < straight_cosine; });
    }));
  }
};

/// True if it has pins, or attachments that act like pins, whose distances stay the same: none moves, or all have one
/// motion.
bool hangs(const Object& object, double gravity) {
  if (object.pins.empty() && object.attachments.empty()) return false;
  const Motion& one = object.pins.empty() ? object.attachments.front().motion : object.pins.front().motion;
  const auto moves_alike = [&](const auto& other) { return have_same_motion(other.motion, one); };
  const AttachmentTest test(object, gravity);
  const auto holds = [&](const Attachment& other) { return test.is_like_pin(other) && moves_alike(other); };
  return std::all_of(object.pins.begin(), object.pins.end(), moves_alike) &&
         std::all_of(object.attachments.begin(), object.attachments.end(), holds);
}

}  // namespace

std::size_t linked_particles(const Object& object) {
  const std::size_t springs = springs_of(object);
  return springs == 0 ? 0 : std::min(object.positions.size(), springs + 1);
}

bool is_stiff_sheet(const Object& object, double gravity) {
  Bending bending = bending_of(object);
  const double rigidity = bending.median(), drawn = area_of(object), area = drawn > 0 ? drawn : bending.area / 3;
  if (!(rigidity > 0) || !(area > 0)) return false;
  const double weight = std::max(finite_mass(object) / area * std::max(gravity, least_acceleration), 1e-30);
  const double allowed = stiff_share * largest_extent(object.positions);
  return !(rigidity / weight <= allowed * allowed * allowed);
}

bool is_regular(const Object& object) {
  const Neighbours neighbours = neighbours_of(object);
  std::size_t straight = 0, ends = 0;
  Ways ways;
  for (std::size_t p = 0; p < object.positions.size(); ++p) {
    if (neighbours.first[p + 1] - neighbours.first[p] > most_neighbours) continue;
    ways.count = 0;
    const Vec3d here = convert<double>(object.positions[p]);
    for (std::size_t i = neighbours.first[p]; i < neighbours.first[p + 1]; ++i)
      ways.add(position(object, neighbours.all[i]) - here);
    straight += ways.straight();
    ends += ways.count;
  }
  return static_cast<double>(straight) > straight_share * static_cast<double>(ends);
}

bool may_be_tethered(const Object& object, double gravity) {
  return hangs(object, gravity) && !is_meant_to_stretch(object, gravity);
}

bool lies_on_pins(const Object& object) {
  return 10 * (object.pins.size() + object.attachments.size()) > object.positions.size();
}

bool has_changing_lengths(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return !group.keyframes.empty() && is_length(group.type); });
}

bool is_sewn(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(), [](const ConstraintGroup& group) {
    const bool is_rigid = group.stiffness.kind == Stiffness::Kind::compliance && group.stiffness.value == 0;
    return group.type == DistanceLimit::name && !group.keyframes.empty() && !group.particles.empty() && is_rigid;
  });
}

bool has_ties(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(), [](const ConstraintGroup& group) {
    const int type = find_constraint_type(group.type);
    return type >= 0 && constraint_type(type).is_tie && !group.particles.empty();
  });
}

bool has_fixed(const Object& object) {
  return !object.pins.empty() || !object.attachments.empty() ||
         std::any_of(object.masses.begin(), object.masses.end(), [](float mass) { return std::isinf(mass); });
}

}  // namespace pliant

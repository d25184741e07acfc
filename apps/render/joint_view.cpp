#include "joint_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "geometry.h"
#include "matrix.h"

namespace pliant::render {

namespace {

constexpr Vec3f thread_colour{0.2f, 0.2f, 0.22f}, rope_colour{0.42f, 0.33f, 0.2f}, spring_colour{0.34f, 0.36f, 0.4f};
constexpr float narrowest = 0.001f;      // radius of a tube [m]
constexpr float thread_share = 0.03f;    // radius of a thread or rope, as a share of the smaller body's
constexpr std::size_t most_coils = 200;  // of an object; more springs than that are drawn straight

/// A constraint of a joint, with the bodies' present places.
struct JointRow {
  const int* slots;   // a particle and a frame of each body
  const float* rest;  // anchors in the bodies' frames, then what the constraint adds
  const std::vector<Vec3f>* positions;
  const std::vector<Quatf>* turns;

  /// The `vector`-th vector of `rest`, a place in a body's frame, in the world.
  Vec3f place(int body, int vector) const {
    const float* const v = rest + std::ptrdiff_t{3} * vector;
    const auto point = static_cast<std::size_t>(slots[2 * body]), frame = static_cast<std::size_t>(slots[2 * body + 1]);
    return (*positions)[point] + rotate((*turns)[frame], {v[0], v[1], v[2]});
  }
};

/// The radius of the box around each body's solids [m]; infinite for fixed bodies and those without solids.
std::vector<float> radii_of_bodies(const Object& object, const output::FrameObject& shape) {
  std::vector<float> of_solids, radii;
  for (const TriangleMesh& solid : shape.solids) of_solids.push_back(bounds(solid.positions).radius());
  for (std::size_t b = 0; b < object.bodies.size(); ++b) {
    const bool is_fixed = !std::isfinite(object.masses[static_cast<std::size_t>(object.bodies[b].particle)]);
    const float radius = is_fixed ? 0 : of_solids[static_cast<std::size_t>(shape.bodies[b].solid)];
    radii.push_back(radius > 0 ? radius : std::numeric_limits<float>::infinity());
  }
  return radii;
}

/// The radius of the smaller of a joint's bodies [m]; 0 if neither has one.
float body_radius(const ObjectJoint& joint, const std::vector<float>& radii) {
  float least = std::numeric_limits<float>::infinity();
  for (const int body : {joint.a, joint.b})
    if (body >= 0) least = std::min(least, radii[static_cast<std::size_t>(body)]);
  return std::isfinite(least) ? least : 0;
}

RenderTube thread(std::vector<Vec3f> points, float body, const Vec3f& colour) {
  return {.points = std::move(points), .radius = std::max(narrowest, thread_share * body), .colour = colour};
}

/// A helix from a to b between two straight ends. Its turns follow from the length at rest.
RenderTube coil(const Vec3f& a, const Vec3f& b, float rest_length, float body) {
  constexpr float end_share = 0.1f, wire_share = 0.13f;
  constexpr int steps = 20;  // of a turn
  const float radius = std::min(0.3f * body, 0.25f * rest_length);
  const int turns = static_cast<int>(std::clamp(rest_length / (0.75f * radius), 6.f, 12.f));
  const ViewFrame frame = view_frame(b - a);
  std::vector<Vec3f> points{a};
  for (int i = 0; i <= turns * steps; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(turns * steps);
    const float angle = 2 * pi * static_cast<float>(i) / steps;
    // The first and last half turn widen from the axis.
    const float out = radius * std::clamp(2 * static_cast<float>(turns) * std::min(share, 1 - share), 0.f, 1.f);
    const Vec3f middle = a + (b - a) * (end_share + (1 - 2 * end_share) * share);
    points.push_back(middle + (frame.right * std::cos(angle) + frame.up * std::sin(angle)) * out);
  }
  points.push_back(b);
  return {.points = std::move(points), .radius = std::max(narrowest, wire_share * radius), .colour = spring_colour};
}

/// The tube of one constraint of a joint; without points if it is of another kind.
RenderTube tube_of(const ObjectJoint& joint, const ConstraintGroup& of, const JointRow& row, float body, bool coiled) {
  if (of.type == "pulley_joint")
    return thread({row.place(0, 0), row.place(2, 2), row.place(2, 3), row.place(1, 1)}, body, rope_colour);
  if (of.type != "joint_distance") return {.points = {}};
  const Vec3f a = row.place(0, 0), b = row.place(1, 1);
  const float rest_length = row.rest[6];
  if (joint.kind == "spring" && coiled && body > 0 && rest_length > 0) return coil(a, b, rest_length, body);
  return thread({a, b}, body, thread_colour);
}

}  // namespace

void add_joints(RenderScene& result, const Object& object, const output::FrameObject& shape, const ObjectView& view) {
  if (object.joints.empty()) return;
  const std::vector<Vec3f> positions = view.positions();
  const std::vector<Quatf> turns = view.orientations();
  const std::vector<float> radii = radii_of_bodies(object, shape);
  const bool coiled = object.joints.size() <= most_coils;
  for (std::size_t j = 0; j < object.joints.size(); ++j) {
    const ObjectJoint& joint = object.joints[j];
    if (view.joint_is_broken(static_cast<int>(j))) continue;
    for (const auto& [group, index] : joint.constraints) {
      const ConstraintGroup& of = object.constraints[static_cast<std::size_t>(group)];
      const std::size_t slots = of.type == "pulley_joint" ? 6 : 4, fields = of.type == "pulley_joint" ? 14 : 8;
      const auto at = static_cast<std::size_t>(index);
      if (of.rest.size() < fields * (at + 1) || of.particles.size() < slots * (at + 1)) continue;
      const JointRow row{&of.particles[slots * at], &of.rest[fields * at], &positions, &turns};
      RenderTube tube = tube_of(joint, of, row, body_radius(joint, radii), coiled);
      if (!tube.points.empty()) result.tubes.push_back(std::move(tube));
    }
  }
}

}  // namespace pliant::render

#include "rod_view.h"

#include <variant>

#include "matrix.h"

namespace pliant::render {

namespace {

/// The capsule of a body that has one solid, a capsule; else null.
const Capsule* capsule_of(const ObjectBody& body) {
  return body.solids.size() == 1 ? std::get_if<Capsule>(&body.solids.front().shape) : nullptr;
}

/// The centre of a capsule's first (-1) or second (+1) cap in the body's principal axes.
Vec3f cap(const ObjectBody& body, float side) {
  const Solid& solid = body.solids.front();
  return solid.position + rotate(solid.rotation, {0, side * capsule_of(body)->half_length, 0});
}

/// True if a joint joins a segment of a rod to the next one, which add_rod makes after it: at the end of its capsule,
/// as a body that holds a rod does not.
bool joins_segments(const Object& object, const ObjectJoint& joint) {
  if (joint.kind != "rod" || joint.a < 0 || joint.b != joint.a + 1) return false;
  const ObjectBody &a = object.bodies[static_cast<std::size_t>(joint.a)],
                   &b = object.bodies[static_cast<std::size_t>(joint.b)];
  const Capsule *const of_a = capsule_of(a), *const of_b = capsule_of(b);
  return of_a != nullptr && of_b != nullptr && length(cap(a, 1) - joint.anchor_a) < 0.1f * of_a->radius;
}

void add_segment(RenderTube& tube, const ObjectBody& body, const RigidPose& pose) {
  const Capsule& capsule = *capsule_of(body);
  const auto placed = [&](const Vec3f& p) { return pose.position + rotate(pose.rotation, p); };
  const Vec3f start = placed(cap(body, -1)), end = placed(cap(body, 1));
  if (tube.points.empty()) {
    tube.radius = capsule.radius;
    tube.points = {start};
    tube.radii = {capsule.radius};
  } else {
    tube.points.back() = (tube.points.back() + start) * 0.5f;
    tube.radii.back() = (tube.radii.back() + capsule.radius) * 0.5f;
  }
  tube.points.push_back(end);
  tube.radii.push_back(capsule.radius);
}

}  // namespace

std::vector<char> rod_segments(const Object& object) {
  std::vector<char> result(object.bodies.size(), 0);
  for (const ObjectJoint& joint : object.joints) {
    if (!joins_segments(object, joint)) continue;
    result[static_cast<std::size_t>(joint.a)] = result[static_cast<std::size_t>(joint.b)] = 1;
  }
  return result;
}

std::vector<RodPart> rod_parts(const Object& object, const ObjectView& view,
                               const std::vector<output::BodyMotion>& motions, const std::vector<char>& segments) {
  enum Link : char { none, whole, broken };
  std::vector<Link> before(object.bodies.size(), none);  // of each segment: how it is joined to the one before
  for (std::size_t j = 0; j < object.joints.size(); ++j)
    if (const ObjectJoint& joint = object.joints[j]; joins_segments(object, joint))
      before[static_cast<std::size_t>(joint.b)] = view.joint_is_broken(static_cast<int>(j)) ? broken : whole;
  std::vector<RodPart> parts;
  std::size_t rods = 0;
  for (std::size_t b = 0; b < segments.size(); ++b) {
    if (segments[b] == 0) continue;
    if (before[b] == none) ++rods;
    if (before[b] != whole) parts.push_back({.first = b, .rod = rods - 1, .tube = {.points = {}, .may_stray = true}});
    add_segment(parts.back().tube, object.bodies[b], motions[b].pose);
  }
  return parts;
}

}  // namespace pliant::render

// Warnings about the joints of an object: anchors far from what they hold, and gears whose bodies nothing else guides.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "constraints/joint_angle.h"
#include "inspect/problems.h"
#include "math/quat.h"

namespace pliant {

namespace {

/// Radii of gyration from a body's centre to an anchor above which units are probably wrong.
constexpr double far_anchor = 100;
/// Distance beyond which a joint turns bodies by rounding alone, whatever it may slide along [m].
constexpr double far_from_all = 1e4;

/// A body of a joint, with what its anchors are compared to.
struct JointedBody {
  const Object& object;
  const ObjectBody& body;

  const ObjectFrame& frame() const { return object.frames[static_cast<std::size_t>(body.frame)]; }
  double mass() const { return static_cast<double>(object.masses[static_cast<std::size_t>(body.particle)]); }
  bool is_fixed() const { return std::isinf(mass()); }
  Vec3f place() const { return object.positions[static_cast<std::size_t>(body.particle)]; }
  /// Root of the largest moment of inertia that is not locked over the mass; 0 if there is none [m].
  double radius_of_gyration() const {
    double most = 0;
    for (const float moment : {frame().inertia.x, frame().inertia.y, frame().inertia.z})
      if (std::isfinite(moment)) most = std::max(most, static_cast<double>(moment));
    return is_fixed() ? 0 : std::sqrt(most / mass());
  }
};

bool has_body(const Object& object, int body) {
  return body >= 0 && static_cast<std::size_t>(body) < object.bodies.size();
}

/// True if keyframes move or turn a body.
bool is_driven(const Object& object, const ObjectBody& body) {
  return std::any_of(object.pins.begin(), object.pins.end(),
                     [&](const Pin& pin) { return pin.particle == body.particle && pin.motion.moves(); });
}

JointedBody jointed(const Object& object, int body) { return {object, object.bodies[static_cast<std::size_t>(body)]}; }

/// True of joints whose anchor may lie anywhere on an axis or in a plane.
bool slides(const ObjectJoint& joint) {
  return joint.kind == "slider" || joint.kind == "cylindrical" || joint.kind == "planar";
}

bool joins_angles(const ObjectJoint& joint) { return joint.kind == "gear" || joint.kind == "rack"; }

/// True of joints with two anchors, of which ObjectJoint has only that of body b.
bool has_two_anchors(const ObjectJoint& joint) {
  return joint.kind == "distance" || joint.kind == "spring" || joint.kind == "pulley";
}

/// How far the anchor is from a body, in its radii of gyration; infinity for a body that can't be compared to.
double remoteness(const Vec3f& anchor, const JointedBody& body) {
  const double radius = body.radius_of_gyration();
  const double distance = std::sqrt(static_cast<double>(length_squared(anchor - body.place())));
  return radius > 0 ? distance / radius : std::numeric_limits<double>::infinity();
}

void doubt_anchor(Problems& problems, const Object& object, const ObjectJoint& joint) {
  const JointedBody a = jointed(object, joint.a), b = jointed(object, joint.b);
  const Vec3f anchor = b.place() + rotate(b.frame().orientation, joint.anchor);
  double nearest = remoteness(anchor, b);
  if (!has_two_anchors(joint)) nearest = std::min(nearest, remoteness(anchor, a));
  if (!std::isfinite(nearest) || nearest <= far_anchor) return;
  const JointedBody& near = remoteness(anchor, b) == nearest ? b : a;
  const double distance = nearest * near.radius_of_gyration();
  if (slides(joint) && distance <= far_from_all) return;
  problems.doubtful("joint '" + joint.name + "'",
                    "has its anchor " + words(distance) + " m from the centre of body '" + near.body.name + "', " +
                        words(std::round(nearest)) + " times its radius of gyration",
                    "anchors are in world coordinates at time 0, in metres");
}

/// A gear or a rack couples motions, but holds no body in its place.
void doubt_bearings(Problems& problems, const Object& object, const ObjectJoint& joint) {
  for (const int body : {joint.a, joint.b}) {
    const auto guides = [&](const ObjectJoint& other) {
      return !joins_angles(other) && (other.a == body || other.b == body);
    };
    if (jointed(object, body).is_fixed() || is_driven(object, object.bodies[static_cast<std::size_t>(body)]) ||
        std::any_of(object.joints.begin(), object.joints.end(), guides))
      continue;
    problems.doubtful("joint '" + joint.name + "'",
                      "couples body '" + jointed(object, body).body.name + "', which no other joint guides",
                      joint.kind == "gear" || body == joint.a ? "add the hinge on which it turns"
                                                              : "add the slider along which it moves");
  }
}

/// The joint between two bodies, by their particles; null if there is none.
const ObjectJoint* joint_between(const Object& object, int a, int b) {
  const auto joins = [&](const ObjectJoint& joint) {
    return has_body(object, joint.a) && has_body(object, joint.b) && jointed(object, joint.a).body.particle == a &&
           jointed(object, joint.b).body.particle == b;
  };
  const auto found = std::find_if(object.joints.begin(), object.joints.end(), joins);
  return found != object.joints.end() ? &*found : nullptr;
}

/// Angles are known up to full turns, so where hardly any are forbidden a body passes them between two substeps.
void doubt_wide_limits(Problems& problems, const Object& object) {
  constexpr double pi = 3.14159265358979323846, widest = 340 * pi / 180;
  constexpr std::size_t fields = JointAngle::fields.size(), half_width = fields - 2;
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != JointAngle::name) continue;
    for (std::size_t i = 0; (i + 1) * fields <= group.rest.size() && (i + 1) * 4 <= group.particles.size(); ++i) {
      const double range = 2 * static_cast<double>(group.rest[i * fields + half_width]);
      const ObjectJoint* const joint = joint_between(object, group.particles[4 * i], group.particles[4 * i + 2]);
      if (!(range > widest) || joint == nullptr) continue;
      problems.doubtful("joint '" + joint->name + "'",
                        "has a range of " + words(std::round(range * 180 / pi)) +
                            " degrees, of which a body that passes both ends in one substep sees nothing",
                        "give less than 340 degrees, or no limit");
    }
  }
}

}  // namespace

void doubt_joints(Problems& problems, const Object& object) {
  doubt_wide_limits(problems, object);
  for (const ObjectJoint& joint : object.joints) {
    if (!has_body(object, joint.a) || !has_body(object, joint.b)) continue;
    if (joins_angles(joint))
      doubt_bearings(problems, object, joint);
    else
      doubt_anchor(problems, object, joint);
  }
}

}  // namespace pliant

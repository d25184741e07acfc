// Makes an elastic rod of rigid segments, and the joints between them.
#include "pliant/rod.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "math/functions.h"
#include "matter/joint_draft.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/joint.h"

namespace pliant {

namespace {

/// Caps reach a radius beyond the ends of a segment, so two segments with one of this length between them do not touch.
constexpr double least_length_in_radii = 2.25;
/// The moment of inertia about the axis is that of a cylinder of at least this radius, as a share of the segment's
/// length: contact would spin thinner ones by radians in a substep. It only slows waves of torsion, which are far
/// faster than anything seen.
constexpr double least_turning_radius = 0.1;
constexpr double shear_factor = 0.9;  // Timoshenko's, of a round section

[[noreturn]] void refuse(const RodOptions& options, const std::string& element, const std::string& problem,
                         const std::string& advice) {
  throw Error({"", 0, options.name, element}, problem, advice);
}

void require_positive(const RodOptions& options, float value, const char* name, const char* unit) {
  if (!(value > 0) || !std::isfinite(value))
    refuse(options, name, "is " + std::to_string(value), std::string("give a positive, finite number [") + unit + "]");
}

void require_not_negative(const RodOptions& options, float value, const char* name, const char* unit) {
  if (!(value >= 0) || !std::isfinite(value))
    refuse(options, name, "is " + std::to_string(value),
           std::string("give a finite number of at least 0 [") + unit + "]");
}

/// 0 is no limit.
void require_limit(const RodOptions& options, float value, const char* name, const char* unit) {
  if (value != 0 && !(value >= 1e-20f && std::isfinite(value)))
    refuse(options, name, "is " + std::to_string(value),
           std::string("give a positive, finite number [") + unit + "], or 0 for no limit");
}

void check(const RodOptions& options) {
  require_positive(options, options.radius, "radius", "m");
  require_not_negative(options, options.end_radius, "end_radius", "m");
  if (options.end_radius > 0 && options.stiffness)
    refuse(options, "end_radius", "is of a rod that tapers, but its stiffness is that of one cross-section",
           "leave out the stiffness, or the end_radius");
  require_positive(options, options.material.density, "density", "kg/m^3");
  require_positive(options, options.material.youngs_modulus, "youngs_modulus", "Pa");
  require_positive(options, options.material.shear_modulus, "shear_modulus", "Pa");
  require_positive(options, options.material.bending_share, "bending_share", "of a solid rod");
  if (options.material.bending_share > 1)
    throw Error({.object = options.name, .element = "bending_share"}, "is above 1, that of a solid rod",
                "give more than 0, up to 1");
  require_not_negative(options, options.material.damping, "damping", "s");
  require_limit(options, options.break_force, "break_force", "N");
  require_limit(options, options.break_torque, "break_torque", "N m");
  if (!options.stiffness) return;
  require_positive(options, options.stiffness->stretch, "stiffness.stretch", "N");
  require_positive(options, options.stiffness->shear, "stiffness.shear", "N");
  require_positive(options, options.stiffness->bending, "stiffness.bending", "N m^2");
  require_not_negative(options, options.stiffness->bending_2, "stiffness.bending_2", "N m^2");
  require_positive(options, options.stiffness->twist, "stiffness.twist", "N m^2");
}

void check_end(const Object& object, const RodEnd& end, const RodOptions& options) {
  if (end.body >= -1 && end.body < static_cast<int>(object.bodies.size())) return;
  refuse(options, "",
         "is held by body " + std::to_string(end.body) + "; there are " + std::to_string(object.bodies.size()),
         "give an index in Object::bodies, or -1 for the world");
}

/// A part of a rod between two points.
struct Segment {
  double length = 0;                        ///< [m]
  double start_radius = 0, end_radius = 0;  ///< [m]
  Vec3d tangent{};                          ///< unit
  Vec3d across{};                           ///< unit, perpendicular to the tangent
  double radius() const { return (start_radius + end_radius) / 2; }

  /// From the frame whose x-axis is the tangent and whose y-axis is `across`, to the world.
  Quatd frame() const { return rotation_from_xy(tangent, across); }
};

std::string between(std::size_t i) { return "points " + std::to_string(i) + " and " + std::to_string(i + 1); }

/// Radii change with the length along the points.
void set_radii(std::vector<Segment>& segments, const RodOptions& options) {
  const double first = static_cast<double>(options.radius),
               last = options.end_radius > 0 ? static_cast<double>(options.end_radius) : first;
  double whole = 0, along = 0;
  for (const Segment& segment : segments) whole += segment.length;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    segments[i].start_radius = first + (last - first) * (along / whole);
    along += segments[i].length;
    segments[i].end_radius = i + 1 == segments.size() ? last : first + (last - first) * (along / whole);
    if (segments[i].length < least_length_in_radii * segments[i].radius())
      refuse(options, between(i), "are " + std::to_string(segments[i].length) + " m apart, less than 2.25 radii",
             "use fewer points, or a smaller radius");
  }
}

std::vector<Segment> segments_between(const std::vector<Vec3f>& points, const RodOptions& options) {
  if (points.size() < 3)
    refuse(options, "", "a rod through " + std::to_string(points.size()) + " points cannot bend",
           "give three points or more");
  std::vector<Segment> segments(points.size() - 1);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Vec3d along = convert<double>(points[i + 1]) - convert<double>(points[i]);
    const double length = std::sqrt(length_squared(along));
    if (!std::isfinite(length)) refuse(options, between(i), "are not both finite", "give finite coordinates in metres");
    if (!(length > 0)) refuse(options, between(i), "are in one place", "leave one of them out");
    segments[i].length = length;
    segments[i].tangent = along * (1 / length);
    if (i > 0 && dot(segments[i - 1].tangent, segments[i].tangent) < -0.9)
      refuse(options, "point " + std::to_string(i), "is where the rod turns back on itself",
             "use more points for the bend");
  }
  set_radii(segments, options);
  return segments;
}

/// The part of v across a unit vector, as a unit vector; zero if there is none.
Vec3d across(const Vec3d& v, const Vec3d& axis) {
  const Vec3d part = v - axis * dot(v, axis);
  const double size = std::sqrt(length_squared(part));
  return size > 1e-6 * std::sqrt(length_squared(v)) ? part * (1 / size) : Vec3d{};
}

Vec3d first_across(const Vec3d& tangent, const RodOptions& options) {
  if (!options.across) return rotate(rotation_from_x(tangent), Vec3d{0, 1, 0});
  const Vec3d found = across(convert<double>(*options.across), tangent);
  if (!(length_squared(found) > 0.5))
    refuse(options, "across", "has no direction across the rod", "give one perpendicular to the first segment");
  return found;
}

/// Gives each segment the direction across that follows without twist: rotated by the shortest rotation from tangent to
/// tangent (Bishop's frame).
void carry_across(std::vector<Segment>& segments, const RodOptions& options) {
  segments[0].across = first_across(segments[0].tangent, options);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Vec3d &from = segments[i - 1].tangent, &to = segments[i].tangent;
    const Vec3d axis = cross(from, to);
    const Quatd turn = normalise(Quatd{axis.x, axis.y, axis.z, 1 + dot(from, to)});
    segments[i].across = across(rotate(turn, segments[i - 1].across), to);
  }
}

/// A frustum; its moments of inertia are those of a cylinder of its mass and mean radius.
BodyOptions body_of(const Segment& segment, const Vec3d& middle, const RodOptions& options, std::size_t number) {
  const double radius = segment.radius(), a = segment.start_radius, b = segment.end_radius;
  const double squares = (a * a + a * b + b * b) / 3;
  const double mass = static_cast<double>(options.material.density) * std::numbers::pi * squares * segment.length;
  const double centre = segment.length * (b * b - a * a) / (12 * squares);  // from the middle
  const double turning = std::max(radius, least_turning_radius * segment.length);
  const auto about_axis = static_cast<float>(mass * turning * turning / 2),
             about_across = static_cast<float>(mass * (radius * radius / 4 + segment.length * segment.length / 12));
  BodyOptions body;
  body.name = options.name + " " + std::to_string(number);
  body.position = convert<float>(middle);
  body.rotation = convert<float>(segment.frame());
  body.velocity = options.velocity;
  body.inertia = BodyInertia{
      static_cast<float>(mass), {static_cast<float>(centre), 0, 0}, {about_axis, about_across, about_across}, {}};
  return body;
}

/// A capsule along the segment's x-axis, whose caps reach over its ends, but not over one that is held.
Solid solid_of(const Segment& segment, const RodOptions& options, bool start_is_held, bool end_is_held) {
  const double radius = segment.radius();
  const double before = start_is_held ? 0 : radius, after = end_is_held ? 0 : radius;
  const float root = std::sqrt(0.5f);
  Solid solid;
  solid.shape = Capsule{static_cast<float>(radius),
                        static_cast<float>(std::max((segment.length + before + after) / 2 - radius, 1e-3 * radius))};
  solid.position = {static_cast<float>((after - before) / 2), 0, 0};
  solid.rotation = {0, 0, -root, root};  // y to x
  solid.density = options.material.density;
  return solid;
}

/// Adds a rod with its joints to an object. What is wrong is found before the object is changed.
class RodBuilder {
 public:
  RodBuilder(Object& object, const std::vector<Vec3f>& points, const RodOptions& options)
      : object_(object), points_(points), options_(options), segments_(segments_between(points, options)) {
    carry_across(segments_, options);
  }

  int build() {
    for (std::size_t i = 0; i < segments_.size(); ++i) add_segment(i);
    for (std::size_t i = 1; i < segments_.size(); ++i) join(i);
    hold(options_.start, 0, points_.front());
    hold(options_.end, segments_.size() - 1, points_.back());
    return first_;
  }

 private:
  int body(std::size_t segment) const { return first_ + static_cast<int>(segment); }

  void add_segment(std::size_t i) {
    const Vec3d middle = (convert<double>(points_[i]) + convert<double>(points_[i + 1])) * 0.5;
    const auto is_held = [](const RodEnd& end) { return end.kind != RodEnd::Kind::free; };
    const Solid solid = solid_of(segments_[i], options_, i == 0 && is_held(options_.start),
                                 i + 1 == segments_.size() && is_held(options_.end));
    const int added = add_body(object_, {solid}, body_of(segments_[i], middle, options_, i));
    if (i == 0) first_ = added;
  }

  JointOptions joint_options() const {
    JointOptions joint;
    if (options_.break_force > 0) joint.break_force = options_.break_force;
    if (options_.break_torque > 0) joint.break_torque = options_.break_torque;
    return joint;
  }

  /// Two segments, where they meet.
  void join(std::size_t i) {
    const Segment &before = segments_[i - 1], &after = segments_[i];
    JointDraft draft(object_, "rod", body(i - 1), body(i), joint_options());
    const Quatd of_after = options_.straight ? after.frame() : before.frame();
    add_rows(draft, points_[i], before.frame(), of_after, (before.length + after.length) / 2, after.start_radius);
    name(draft.finish(), std::to_string(i - 1) + "-" + std::to_string(i));
  }

  /// One end. A clamp bends over half of the segment that it holds.
  void hold(const RodEnd& end, std::size_t segment, const Vec3f& at) {
    const std::string called = segment == 0 ? "start" : "end";
    if (end.kind == RodEnd::Kind::free) return;
    if (end.kind == RodEnd::Kind::ball) {
      BallJoint joint;
      joint.a = end.body;
      joint.b = body(segment);
      joint.anchor = at;
      joint.options = joint_options();
      name(add_joint(object_, joint), called);
      return;
    }
    JointDraft draft(object_, "rod", end.body, body(segment), joint_options());
    const Segment& held = segments_[segment];
    const double radius_held = segment == 0 ? held.start_radius : held.end_radius;
    add_rows(draft, at, held.frame(), held.frame(), held.length / 2, (radius_held + held.radius()) / 2);
    name(draft.finish(), called);
  }

  RodStiffness stiffness_at(double radius) const {
    RodStiffness found = options_.stiffness.value_or(stiffness_of(options_.material, static_cast<float>(radius)));
    if (found.bending_2 == 0) found.bending_2 = found.bending;
    return found;
  }

  /// A rod_joint over `length` of the rod where it has a radius, between frames that are the same without load.
  void add_rows(JointDraft& draft, const Vec3f& at, const Quatd& frame_a, const Quatd& frame_b, double length,
                double radius) const {
    const RodStiffness stiffness = stiffness_at(radius);
    const Vec3d anchor = draft.place(at, "anchor");
    draft.set_frame(anchor, frame_a);
    std::vector<float> rest;
    const auto put = [&](std::initializer_list<double> numbers) {
      for (const double x : numbers) rest.push_back(static_cast<float>(x));
    };
    for (const JointBody* of : {&draft.a(), &draft.b()}) {
      const Vec3d local = of->local(anchor);
      put({local.x, local.y, local.z});
    }
    for (const Quatd& q : {draft.a().local(frame_a), draft.b().local(frame_b)}) put({q.x, q.y, q.z, q.w});
    for (const float of :
         {stiffness.stretch, stiffness.shear, stiffness.shear, stiffness.twist, stiffness.bending, stiffness.bending_2})
      put({std::sqrt(static_cast<double>(of) / length)});
    put({radius / length});
    draft.add_raw("rod_joint", {draft.a().point, draft.a().frame, draft.b().point, draft.b().frame}, rest, 1,
                  options_.material.damping, options_.material.plasticity);
  }

  void name(int joint, const std::string& called) {
    object_.joints[static_cast<std::size_t>(joint)].name = options_.name + " " + called;
  }

  Object& object_;
  const std::vector<Vec3f>& points_;
  const RodOptions& options_;
  std::vector<Segment> segments_;
  int first_ = 0;
};

}  // namespace

RodStiffness stiffness_of(const RodMaterial& material, float radius) {
  const double r2 = static_cast<double>(radius) * static_cast<double>(radius), area = std::numbers::pi * r2,
               second = area * r2 / 4;
  const double e = static_cast<double>(material.youngs_modulus), g = static_cast<double>(material.shear_modulus);
  RodStiffness found;
  found.stretch = static_cast<float>(e * area);
  found.shear = static_cast<float>(shear_factor * g * area);
  const auto share = static_cast<double>(material.bending_share);
  found.bending = found.bending_2 = static_cast<float>(share * e * second);
  found.twist = static_cast<float>(share * g * 2 * second);
  return found;
}

int add_rod(Object& object, const std::vector<Vec3f>& points, const RodOptions& options) {
  check(options);
  const std::string first = options.name + " 0";
  const bool is_taken = std::any_of(object.bodies.begin(), object.bodies.end(),
                                    [&](const ObjectBody& body) { return body.name == first; });
  if (is_taken) refuse(options, "", "has a name that is taken", "give each rod of an object a name of its own");
  for (const RodEnd* end : {&options.start, &options.end}) check_end(object, *end, options);
  return RodBuilder(object, points, options).build();
}

Object make_rod(const std::vector<Vec3f>& points, const RodOptions& options) {
  Object object;
  object.name = options.name;
  object.static_friction = options.material.static_friction;
  object.kinetic_friction = options.material.kinetic_friction;
  add_rod(object, points, options);
  return object;
}

std::vector<Vec3f> helix(float radius, float height, float turns, int segments) {
  const bool is_right = radius > 0 && std::isfinite(radius) && std::isfinite(height) && std::isfinite(turns) &&
                        segments >= 2 && segments <= 1 << 20;
  if (!is_right)
    throw Error({}, "a helix of radius " + std::to_string(radius) + " m and " + std::to_string(segments) + " segments",
                "give a positive radius, finite sizes, and 2 to 1048576 segments");
  std::vector<Vec3f> points;
  for (int i = 0; i <= segments; ++i) {
    const double share = static_cast<double>(i) / segments,
                 angle = 2 * std::numbers::pi * static_cast<double>(turns) * share;
    points.push_back({radius * static_cast<float>(cos(angle)), height * static_cast<float>(share),
                      radius * static_cast<float>(sin(angle))});
  }
  return points;
}

}  // namespace pliant

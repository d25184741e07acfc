// Makes a rigid body of solids: its mass, centre and principal axes.
#include "pliant/body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "pliant/error.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const std::string& body, std::size_t solid, const std::string& what,
                         const std::string& advice) {
  throw Error({"", 0, body, "solid " + std::to_string(solid)}, what, advice);
}

/// Refuses a rotation that has no direction: one of zero, or not finite. Others are normalised.
Quatd checked_rotation(const Quatf& rotation, const Location& of) {
  const Quatd q = convert<double>(rotation);
  const double squared = dot(q, q);
  if (!(squared > 1e-12) || !std::isfinite(squared))
    throw Error(of, "has a rotation that is " + std::string(squared == 0 ? "zero" : "not a unit quaternion"),
                "give a unit quaternion: x = y = z = 0 and w = 1 is no rotation");
  return normalise(q);
}

Posed pose_of_solid(const Solid& solid, const std::string& body, std::size_t number) {
  return {convert<double>(solid.position),
          checked_rotation(solid.rotation, {"", 0, body, "solid " + std::to_string(number)})};
}

/// Refuses a size that is not positive and finite.
struct SizeCheck {
  const std::string& body;
  std::size_t solid;

  double operator()(float size, const char* name) const {
    if (!(size > 0) || !std::isfinite(size))
      refuse(body, solid, std::string(name) + " is " + std::to_string(size),
             "give a positive, finite number in metres");
    return static_cast<double>(size);
  }
};

Moments moments_of_hull(const Hull& hull, const SizeCheck& check) {
  const auto found = convex_hull(hull.points);
  if (!found)
    refuse(check.body, check.solid, "has " + std::to_string(hull.points.size()) + " points, all in one plane",
           "give points that enclose a volume");
  std::vector<Vec3d> corners;
  corners.reserve(found->corners.size());
  for (const Vec3f& corner : found->corners) corners.push_back(convert<double>(corner));
  return moments_of_mesh(corners, found->triangles());
}

/// Moments of a solid of density 1 in its own frame. A hull's margin has no mass.
struct MomentsOf {
  SizeCheck check;

  Moments operator()(const Sphere& s) const { return moments_of_sphere(check(s.radius, "radius")); }
  Moments operator()(const Capsule& s) const {
    return moments_of_capsule(check(s.radius, "radius"), check(s.half_length, "half_length"));
  }
  Moments operator()(const Box& s) const {
    return moments_of_box({check(s.half_extents.x, "half_extents"), check(s.half_extents.y, "half_extents"),
                           check(s.half_extents.z, "half_extents")});
  }
  Moments operator()(const Cylinder& s) const {
    return moments_of_cylinder(check(s.radius, "radius"), check(s.half_length, "half_length"));
  }
  Moments operator()(const Cone& s) const {
    return moments_of_cone(check(s.radius, "radius"), check(s.half_length, "half_length"));
  }
  Moments operator()(const Hull& s) const { return moments_of_hull(s, check); }
};

Moments moments_of(const Solid& solid, const std::string& body, std::size_t number) {
  if (!(solid.density > 0) || !std::isfinite(solid.density))
    refuse(body, number, "has a density of " + std::to_string(solid.density),
           "give a positive, finite density [kg/m^3]");
  const Moments own = std::visit(MomentsOf{{body, number}}, solid.shape);
  return moved(times(own, static_cast<double>(solid.density)), pose_of_solid(solid, body, number));
}

}  // namespace

namespace {

/// Moments that give the same mass, centre and inertia. The integral of x x^T about the centre is tr(I) / 2 - I.
Moments moments_of(const BodyInertia& inertia, const std::string& body) {
  const Vec3d own = convert<double>(inertia.moments), off = convert<double>(inertia.products),
              c = convert<double>(inertia.centre);
  const double m = static_cast<double>(inertia.mass), half = (own.x + own.y + own.z) / 2;
  const bool is_positive = m > 0 && own.x > 0 && own.y > 0 && own.z > 0;
  if (!is_positive || !std::isfinite(m + half + length_squared(off) + length_squared(c)))
    throw Error({"", 0, body, "inertia"}, "has a mass or a moment of inertia that is not positive and finite",
                "give positive numbers in kg and kg m^2");
  return {m,
          m * c,
          {half - own.x + m * c.x * c.x, half - own.y + m * c.y * c.y, half - own.z + m * c.z * c.z,
           m * c.y * c.z - off.x, m * c.z * c.x - off.y, m * c.x * c.y - off.z}};
}

/// Refuses an inertia tensor that is not positive definite, or that no distribution of mass has: with x^2 + y^2 and so
/// on integrated, no moment exceeds the sum of the others. Thin plates reach it, hence the margin for rounding.
MassProperties checked(const MassProperties& own, const std::string& body) {
  const Vec3d& i = own.inertia;
  if (!(i.x > 0 && i.y > 0 && i.z > 0))
    throw Error({"", 0, body, "inertia"}, "has a principal moment of inertia that is not positive",
                "make the products of inertia smaller than the moments");
  const double sum = i.x + i.y + i.z, largest = std::max({i.x, i.y, i.z});
  if (largest > 0.5 * (1 + 1e-4) * sum)
    throw Error({"", 0, body, "inertia"},
                "has a principal moment of " + std::to_string(largest) + " kg m^2, more than the sum of the others, " +
                    std::to_string(sum - largest) + ", which no body has",
                "check the moments; a thin rod has two that are equal, a thin plate one that is the sum of the others");
  return own;
}

/// Moments of all solids in the frame in which they are described, with the mass that the options give.
Moments moments_of_all(const std::vector<Solid>& solids, const BodyOptions& options) {
  if (options.inertia) return moments_of(*options.inertia, options.name);
  if (solids.empty()) throw Error({"", 0, options.name, ""}, "is a body of no solid", "give it one at least");
  Moments all;
  for (std::size_t i = 0; i < solids.size(); ++i) all += moments_of(solids[i], options.name, i);
  if (options.mass == 0 || std::isinf(options.mass)) return all;
  if (!(options.mass > 0))
    throw Error({"", 0, options.name, "mass"}, "is " + std::to_string(options.mass),
                "give a positive mass [kg], or infinity for a fixed body");
  return times(all, static_cast<double>(options.mass) / all.mass);
}

/// The body's solids in its principal axes, about its centre of mass.
std::vector<Solid> in_principal_axes(std::vector<Solid> solids, const MassProperties& own, const std::string& body) {
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Solid& solid = solids[i];
    const Posed pose = pose_of_solid(solid, body, i);
    solid.position = convert<float>(rotate(conjugate(own.axes), pose.position - own.centre));
    solid.rotation = convert<float>(normalise(multiply(conjugate(own.axes), pose.rotation)));
  }
  return solids;
}

/// Velocities are empty if all are zero.
void append_velocity(Object& object, const Vec3f& velocity) {
  if (object.velocities.empty() && velocity == Vec3f{}) return;
  object.velocities.resize(object.positions.size());
  object.velocities.back() = velocity;
}

}  // namespace

int add_body(Object& object, const std::vector<Solid>& solids, const BodyOptions& options) {
  if (options.motion.moves() && !options.kinematic)
    throw Error({"", 0, options.name, "motion"}, "is given to a body that is not kinematic",
                "make it kinematic, or move the body by joints and forces");
  const MassProperties own = checked(mass_properties(moments_of_all(solids, options)), options.name);
  const Posed pose{convert<double>(options.position), checked_rotation(options.rotation, {"", 0, options.name, ""})};
  const bool is_fixed = options.kinematic || std::isinf(options.mass);
  const float infinity = std::numeric_limits<float>::infinity();
  object.positions.push_back(convert<float>(to_world(pose, own.centre)));
  append_velocity(object, is_fixed ? Vec3f{} : options.velocity);
  object.masses.push_back(is_fixed ? infinity : static_cast<float>(own.mass));
  ObjectFrame frame;
  frame.orientation = convert<float>(multiply(pose.rotation, own.axes));
  frame.angular_velocity = is_fixed ? Vec3f{} : options.angular_velocity;
  frame.inertia = is_fixed ? Vec3f{infinity, infinity, infinity} : convert<float>(own.inertia);
  object.frames.push_back(frame);
  ObjectBody body;
  body.name = options.name;
  body.particle = static_cast<int>(object.positions.size()) - 1;
  body.frame = static_cast<int>(object.frames.size()) - 1;
  body.solids = in_principal_axes(solids, own, options.name);
  body.origin = convert<float>(rotate(conjugate(own.axes), -own.centre));
  body.axes = convert<float>(conjugate(own.axes));
  body.surface_velocity = options.surface_velocity;
  if (options.motion.moves()) object.pins.push_back({body.particle, options.motion});
  object.bodies.push_back(std::move(body));
  object.collides = object.self_collision = true;
  return static_cast<int>(object.bodies.size()) - 1;
}

Object make_body(const std::vector<Solid>& solids, const BodyOptions& options) {
  Object object;
  object.name = options.name;
  add_body(object, solids, options);
  return object;
}

RigidPose pose_of(const Object& object, int body) {
  if (body < 0 || static_cast<std::size_t>(body) >= object.bodies.size())
    throw Error({"", 0, object.name, "body " + std::to_string(body)},
                "does not exist; there are " + std::to_string(object.bodies.size()) + " bodies",
                "indices count from 0");
  const ObjectBody& of = object.bodies[static_cast<std::size_t>(body)];
  const Quatd axes = convert<double>(object.frames.at(static_cast<std::size_t>(of.frame)).orientation);
  const Posed pose{convert<double>(object.positions.at(static_cast<std::size_t>(of.particle))), normalise(axes)};
  return {convert<float>(to_world(pose, convert<double>(of.origin))),
          convert<float>(normalise(multiply(pose.rotation, convert<double>(of.axes))))};
}

}  // namespace pliant

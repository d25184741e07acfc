// Makes a rigid body of solids: its mass, centre and principal axes.
#include "pliant/body.h"

#include <cmath>
#include <string>

#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "pliant/error.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const std::string& body, std::size_t solid, const std::string& what, const std::string& advice) {
  throw Error({"", 0, body, "solid " + std::to_string(solid)}, what, advice);
}

/// Refuses a size that is not positive and finite.
struct SizeCheck {
  const std::string& body;
  std::size_t solid;

  double operator()(float size, const char* name) const {
    if (!(size > 0) || !std::isfinite(size))
      refuse(body, solid, std::string(name) + " is " + std::to_string(size), "give a positive, finite number in metres");
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
    refuse(body, number, "has a density of " + std::to_string(solid.density), "give a positive, finite density [kg/m^3]");
  const Moments own = std::visit(MomentsOf{{body, number}}, solid.shape);
  const Posed pose{convert<double>(solid.position), normalise(convert<double>(solid.rotation))};
  return moved(times(own, static_cast<double>(solid.density)), pose);
}

}  // namespace

Object make_body(const std::vector<Solid>& solids, const BodyOptions& options) {
  if (solids.empty()) throw Error({"", 0, options.name, ""}, "is a body of no solid", "give it one at least");
  Moments all;
  for (std::size_t i = 0; i < solids.size(); ++i) all += moments_of(solids[i], options.name, i);
  if (options.mass != 0) {
    if (!(options.mass > 0) || !std::isfinite(options.mass))
      throw Error({"", 0, options.name, "mass"}, "is " + std::to_string(options.mass), "give a positive, finite mass [kg]");
    all = times(all, static_cast<double>(options.mass) / all.mass);
  }
  const MassProperties own = mass_properties(all);
  const Posed pose{convert<double>(options.position), normalise(convert<double>(options.rotation))};
  Object body;
  body.name = options.name;
  body.positions = {convert<float>(to_world(pose, own.centre))};
  body.velocities = {options.velocity};
  body.masses = {static_cast<float>(own.mass)};
  ObjectFrame frame;
  frame.orientation = convert<float>(multiply(pose.rotation, own.axes));
  frame.angular_velocity = options.angular_velocity;
  frame.inertia = convert<float>(own.inertia);
  body.frames = {frame};
  return body;
}

}  // namespace pliant

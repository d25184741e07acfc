// Errors in the rigid bodies of an object for which a World rejects it, and doubts about them.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "geometry/convex_hull.h"
#include "inspect/problems.h"
#include "math/vector.h"
#include "model/body_names.h"

namespace pliant {

namespace {

/// Bounds of the size of a solid [m]; as floats, so that 1e-6f is within.
constexpr double largest_size = 1e6, smallest_size = static_cast<double>(1e-6f);

struct SolidCheck {
  Problems& problems;
  const std::string& element;

  void size(const char* name, float value) const {
    require_range(problems, element + ": " + name, static_cast<double>(value), smallest_size, largest_size);
  }
  void operator()(const Sphere& s) const { size("radius", s.radius); }
  void operator()(const Box& s) const {
    size("half_extents", s.half_extents.x);
    size("half_extents", s.half_extents.y);
    size("half_extents", s.half_extents.z);
  }
  void operator()(const Hull& s) const {
    require_range(problems, element + ": margin", static_cast<double>(s.margin), 0, largest_size);
    for (const Vec3f& p : s.points)
      if (!is_finite(p) ||
          !(std::fabs(p.x) < largest_size && std::fabs(p.y) < largest_size && std::fabs(p.z) < largest_size))
        return problems.grave(element, "has a point that is not finite or beyond 1e6 m",
                              "give finite coordinates in metres");
    if (!convex_hull(s.points))
      problems.grave(element, "has points that lie in one plane", "give points that enclose a volume");
  }
  template <class Round>
  void operator()(const Round& s) const {
    size("radius", s.radius);
    size("half_length", s.half_length);
  }
};

/// Reports a particle or frame that does not exist or belongs to two bodies.
void check_place(Problems& problems, const std::string& element, const char* kind, int index,
                 std::vector<char>& taken) {
  if (index < 0 || static_cast<std::size_t>(index) >= taken.size())
    return problems.grave(element, std::string("has ") + kind + ' ' + std::to_string(index) + ", which does not exist",
                          "make bodies by add_body");
  if (taken[static_cast<std::size_t>(index)] != 0)
    problems.grave(element, std::string("has the ") + kind + " of another body", "give each body its own");
  taken[static_cast<std::size_t>(index)] = 1;
}

/// Reports bodies with the name of another one, by which ObjectView::pose could not find them.
void check_names(Problems& problems, const Object& object) {
  std::map<std::string, std::size_t> first;
  for (std::size_t b = 0; b < object.bodies.size(); ++b) {
    const std::string& name = object.bodies[b].name;
    if (!has_own_name(name)) continue;
    const auto [known, is_new] = first.emplace(name, b);
    if (!is_new)
      problems.grave("body " + std::to_string(b) + " '" + name + "'",
                     "has the name of body " + std::to_string(known->second),
                     "give each body of an object its own name, or none");
  }
}

/// True if keyframes move a body, but do not turn it. Of two pins of a particle the later one counts.
bool is_only_moved(const Object& object, const ObjectBody& body) {
  const auto holds = [&](const Pin& pin) { return pin.particle == body.particle && pin.motion.moves(); };
  const auto last = std::find_if(object.pins.rbegin(), object.pins.rend(), holds);
  return last != object.pins.rend() && std::none_of(last->motion.keyframes.begin(), last->motion.keyframes.end(),
                                                    [](const Keyframe& key) { return key.rotation != Quatf{}; });
}

/// True if what lies on a body may tip it: it has a shape that a rotation changes, and neither spins nor is in a joint,
/// which may hold it.
bool may_tip(const Object& object, std::size_t index) {
  const ObjectBody& body = object.bodies[index];
  const ObjectFrame& frame = object.frames[static_cast<std::size_t>(body.frame)];
  const bool is_ball = body.solids.size() == 1 && std::holds_alternative<Sphere>(body.solids[0].shape);
  const bool is_locked = std::isinf(frame.inertia.x) && std::isinf(frame.inertia.y) && std::isinf(frame.inertia.z);
  if (!object.collides || body.solids.empty() || is_ball || is_locked || frame.angular_velocity != Vec3f{})
    return false;
  const int number = static_cast<int>(index);
  return std::none_of(object.joints.begin(), object.joints.end(),
                      [&](const ObjectJoint& joint) { return joint.a == number || joint.b == number; });
}

}  // namespace

void doubt_bodies(Problems& problems, const Object& object) {
  for (std::size_t b = 0; b < object.bodies.size(); ++b) {
    const ObjectBody& body = object.bodies[b];
    if (!is_only_moved(object, body) || !may_tip(object, b)) continue;
    problems.doubtful("body " + std::to_string(b) + (body.name.empty() ? "" : " '" + body.name + "'"),
                      "is moved by a pin, which holds its centre of mass but not its rotation, so a load tips it",
                      "remove the pin, and give the body \"kinematic\": true and the motion");
  }
}

void check_bodies(Problems& problems, const Object& object) {
  check_names(problems, object);
  std::vector<char> particles(object.positions.size()), frames(object.frames.size());
  for (std::size_t b = 0; b < object.bodies.size(); ++b) {
    const ObjectBody& body = object.bodies[b];
    const std::string element = "body " + std::to_string(b) + (body.name.empty() ? "" : " '" + body.name + "'");
    check_place(problems, element, "particle", body.particle, particles);
    check_place(problems, element, "frame", body.frame, frames);
    check_rotation(problems, element, body.axes);
    require_place(problems, element, body.origin);
    check_surface_velocity(problems, element + ", surface_velocity", body.surface_velocity);
    for (std::size_t i = 0; i < body.solids.size(); ++i) {
      const std::string solid = element + ", solid " + std::to_string(i);
      require_place(problems, solid, body.solids[i].position);
      check_rotation(problems, solid, body.solids[i].rotation);
      std::visit(SolidCheck{problems, solid}, body.solids[i].shape);
    }
  }
}

}  // namespace pliant

#include "model/compiled_bodies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "geometry/convex_hull.h"
#include "math/quat.h"
#include "model/body_names.h"

namespace pliant {

namespace {

/// What makes the polyhedron of a shape: half extents of a box, the points of a hull. Empty for round shapes.
struct PolyhedronKey {
  std::vector<float> operator()(const Box& box) const {
    return {box.half_extents.x, box.half_extents.y, box.half_extents.z};
  }
  std::vector<float> operator()(const Hull& hull) const {
    std::vector<float> key;
    for (const Vec3f& p : hull.points) key.insert(key.end(), {p.x, p.y, p.z});
    return key;
  }
  template <class Round>
  std::vector<float> operator()(const Round&) const {
    return {};
  }
};

/// Makes convex shapes; `polyhedra` has room for what it adds.
struct MakeShape {
  std::vector<Polyhedron>& polyhedra;

  ConvexShape operator()(const Sphere& s) const { return {ConvexShape::Kind::point, s.radius, 0, 0, nullptr}; }
  ConvexShape operator()(const Capsule& s) const {
    return {ConvexShape::Kind::segment, s.radius, 0, s.half_length, nullptr};
  }
  ConvexShape operator()(const Cylinder& s) const {
    return {ConvexShape::Kind::cylinder, 0, s.radius, s.half_length, nullptr};
  }
  ConvexShape operator()(const Cone& s) const { return {ConvexShape::Kind::cone, 0, s.radius, s.half_length, nullptr}; }
  ConvexShape operator()(const Box& s) const {
    polyhedra.push_back(polyhedron_of_box(s.half_extents));
    return {ConvexShape::Kind::polyhedron, 0, 0, 0, &polyhedra.back()};
  }
  ConvexShape operator()(const Hull& s) const {
    const auto hull = convex_hull(s.points);
    polyhedra.push_back(hull ? polyhedron_of(*hull) : polyhedron_of_box({1, 1, 1}));  // inspect() rejects flat hulls
    return {ConvexShape::Kind::polyhedron, s.margin, 0, 0, &polyhedra.back()};
  }
};

void sort_once(std::vector<std::pair<int, int>>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Notes which bodies, and which particles and bodies, the slots of one constraint tie together.
void note_ties(const ConstraintDefinition& type, const int* slots, const std::vector<int>& body_of_frame,
               const std::vector<int>& place, CompiledBodies& out) {
  std::vector<int> bodies;
  for (std::size_t slot = 0; slot < type.slots.size(); ++slot)
    if (type.slots[slot] == SlotKind::frame) bodies.push_back(body_of_frame[static_cast<std::size_t>(slots[slot])]);
  bodies.erase(std::remove(bodies.begin(), bodies.end(), -1), bodies.end());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (bodies[i] != bodies[j]) out.jointed.emplace_back(std::minmax(bodies[i], bodies[j]));
  for (std::size_t slot = 0; slot < type.slots.size() && !bodies.empty(); ++slot) {
    if (type.slots[slot] == SlotKind::frame) continue;
    const int particle = place[static_cast<std::size_t>(slots[slot])];
    for (const int body : bodies)
      if (!out.has_centre(particle)) out.attached.emplace_back(particle, body);
  }
}

void find_ties(const Object& object, const std::vector<int>& place, CompiledBodies& out) {
  std::vector<int> body_of_frame(object.frames.size(), -1);
  for (std::size_t b = 0; b < object.bodies.size(); ++b)
    body_of_frame[static_cast<std::size_t>(object.bodies[b].frame)] = static_cast<int>(b);
  for (const ConstraintGroup& group : object.constraints) {
    const int number = find_constraint_type(group.type);
    if (number < 0) continue;  // compile() names it
    const ConstraintDefinition& type = constraint_type(number);
    for (std::size_t first = 0; first + type.slots.size() <= group.particles.size(); first += type.slots.size())
      note_ties(type, &group.particles[first], body_of_frame, place, out);
  }
  // A joint may act on a body's particle alone, as a rack and pinion does on the rack.
  const auto exists = [&](int body) { return body >= 0 && static_cast<std::size_t>(body) < object.bodies.size(); };
  for (const ObjectJoint& joint : object.joints)
    if (exists(joint.a) && exists(joint.b) && joint.a != joint.b)
      out.jointed.emplace_back(std::minmax(joint.a, joint.b));
  sort_once(out.jointed);
  sort_once(out.attached);
}

/// The mean length of the edges at each attached particle, from the positions at the start.
std::vector<double> edge_lengths_of(const Object& object, const std::vector<int>& place, const CompiledBodies& bodies) {
  std::vector<double> sums(bodies.is_centre.size(), 0), counts(bodies.is_centre.size(), 0);
  const auto add = [&](int a, int b) {
    const double edge = length(convert<double>(object.positions[static_cast<std::size_t>(b)]) -
                               convert<double>(object.positions[static_cast<std::size_t>(a)]));
    for (const int end : {a, b}) {
      sums[static_cast<std::size_t>(place[static_cast<std::size_t>(end)])] += edge;
      counts[static_cast<std::size_t>(place[static_cast<std::size_t>(end)])] += 1;
    }
  };
  for (const ConstraintGroup& group : object.constraints) {
    const std::size_t corners = is_length(group.type) ? 2 : gives_shape(group.type) ? 4 : 0;
    if (bodies.attached.empty() || corners == 0) continue;
    for (std::size_t first = 0; first + corners <= group.particles.size(); first += corners)
      for (std::size_t i = 1; i < corners; ++i)
        for (std::size_t k = 0; k < i; ++k) add(group.particles[first + i], group.particles[first + k]);
  }
  std::vector<double> lengths;
  for (const auto& [particle, body] : bodies.attached) {
    const auto at = static_cast<std::size_t>(particle);
    lengths.push_back(counts[at] > 0 ? sums[at] / counts[at] : 0);
  }
  return lengths;
}

bool turns(const Motion& motion) {
  return std::any_of(motion.keyframes.begin(), motion.keyframes.end(), [](const Keyframe& key) {
    return key.rotation.x != 0 || key.rotation.y != 0 || key.rotation.z != 0;
  });
}

void find_surface_velocities(const Object& object, CompiledBodies& out) {
  const auto has_one = [](const ObjectBody& body) { return body.surface_velocity != Vec3f{}; };
  if (std::none_of(object.bodies.begin(), object.bodies.end(), has_one)) return;
  out.surface_velocities.reserve(object.bodies.size());
  for (const ObjectBody& body : object.bodies)
    out.surface_velocities.push_back(rotate(normalise(body.axes), body.surface_velocity));
}

bool is_locked(const ObjectFrame& frame) {
  return std::isinf(frame.inertia.x) && std::isinf(frame.inertia.y) && std::isinf(frame.inertia.z);
}

/// Of two pins of a body the later one wins, as for its particle.
void find_driven(const Object& object, CompiledBodies& out) {
  std::map<int, const Pin*> pin_of;
  for (const Pin& pin : object.pins)
    if (pin.motion.moves()) pin_of[pin.particle] = &pin;
  for (const ObjectBody& body : object.bodies) {
    const auto found = pin_of.find(body.particle);
    const Pin* const pin = found == pin_of.end() ? nullptr : found->second;
    const ObjectFrame& frame = object.frames[static_cast<std::size_t>(body.frame)];
    if (pin == nullptr || (!turns(pin->motion) && !is_locked(frame))) continue;
    out.driven.push_back({body.frame, normalise(convert<double>(frame.orientation)), pin->motion});
  }
}

}  // namespace

std::string words_of_body(const CompiledBodies& bodies, int body, const std::string& object) {
  const std::string& name = bodies.labels[static_cast<std::size_t>(body)].name;
  return "body " + std::to_string(body) + (has_own_name(name) ? " ('" + name + "')" : "") + " of '" + object + "'";
}

ConvexShape convex_shape_of(const SolidShape& shape, std::vector<Polyhedron>& polyhedra) {
  return std::visit(MakeShape{polyhedra}, shape);
}

CompiledBodies compile_bodies(const Object& object, const std::vector<int>& place, int particles) {
  CompiledBodies out;
  if (object.bodies.empty()) return out;
  out.is_centre.assign(static_cast<std::size_t>(particles), 0);
  std::size_t solids = 0;
  for (const ObjectBody& body : object.bodies) solids += body.solids.size();
  auto polyhedra = std::make_shared<std::vector<Polyhedron>>();
  polyhedra->reserve(solids);  // shapes point into it
  std::map<std::vector<float>, ConvexShape> known;
  for (const ObjectBody& body : object.bodies) {
    const int number = static_cast<int>(out.bodies.size()), particle = place[static_cast<std::size_t>(body.particle)];
    out.bodies.push_back({particle, body.frame});
    out.labels.push_back({body.name, {convert<double>(body.origin), normalise(convert<double>(body.axes))}});
    out.is_centre[static_cast<std::size_t>(particle)] = 1;
    for (const Solid& solid : body.solids) {
      std::vector<float> key = std::visit(PolyhedronKey{}, solid.shape);
      const auto found = key.empty() ? known.end() : known.find(key);
      ConvexShape shape = found != known.end() ? found->second : convex_shape_of(solid.shape, *polyhedra);
      if (const Hull* hull = std::get_if<Hull>(&solid.shape)) shape.radius = hull->margin;
      if (!key.empty() && found == known.end()) known.emplace(std::move(key), shape);
      out.solids.push_back(
          {number, shape, {convert<double>(solid.position), normalise(convert<double>(solid.rotation))}, {}});
      if (const Box* box = std::get_if<Box>(&solid.shape)) out.solids.back().half_extents = box->half_extents;
    }
  }
  find_surface_velocities(object, out);
  find_driven(object, out);
  find_ties(object, place, out);
  out.edge_lengths = edge_lengths_of(object, place, out);
  out.polyhedra = std::move(polyhedra);
  return out;
}

}  // namespace pliant

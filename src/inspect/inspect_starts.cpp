// What starts inside of rigid bodies and soft bodies. Contact is between surfaces: it moves out what is inside of a
// rigid body, and leaves in a soft body what does not touch its surface.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/broad/tree.h"
#include "inspect/problems.h"
#include "matter/closed_query.h"
#include "matter/leave_out.h"
#include "model/body_names.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// What is less deep than this touches by rounding [m].
constexpr float depth_by_rounding = 1e-4f;

/// A solid of a body.
struct PlacedBody {
  int object = 0, body = 0;
  PlacedSolid solid;
};

bool can_touch(const Object& a, const Object& b) {
  return a.collides && b.collides && (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
}

/// An object whose particles are looked at.
class Looked {
 public:
  explicit Looked(const Object& object) : object_(object), body_(object.positions.size(), -1) {
    for (std::size_t b = 0; b < object.bodies.size(); ++b)
      body_[static_cast<std::size_t>(object.bodies[b].particle)] = static_cast<int>(b);
    is_held_.reserve(object.masses.size());
    for (const float mass : object.masses) is_held_.push_back(std::isinf(mass) ? 1 : 0);
    for (const Pin& pin : object.pins) is_held_[static_cast<std::size_t>(pin.particle)] = 1;
    for (const Attachment& attached : object.attachments) is_held_[static_cast<std::size_t>(attached.particle)] = 1;
  }

  /// The body whose centre a particle is; -1: none.
  int body(std::size_t particle) const { return body_[particle]; }
  bool is_held(std::size_t particle) const { return is_held_[particle] != 0; }

  bool are_jointed(int a, int b) const {
    return std::any_of(object_.joints.begin(), object_.joints.end(),
                       [&](const ObjectJoint& joint) { return std::minmax(joint.a, joint.b) == std::minmax(a, b); });
  }

 private:
  const Object& object_;
  std::vector<int> body_;
  std::vector<char> is_held_;
};

/// Liquids, gases and grains have findings of their own.
bool is_looked_at(const Object& object) { return !object.fluid && !object.grains && !object.tracers; }

class Bodies {
 public:
  explicit Bodies(const Scene& scene) : scene_(scene) {
    std::vector<BoxBounds> boxes;
    for (std::size_t o = 0; o < scene.objects.size(); ++o)
      for (std::size_t b = 0; b < scene.objects[o].bodies.size(); ++b) {
        std::vector<PlacedSolid> solids;
        add_solids_of_body(scene.objects[o], scene.objects[o].bodies[b], -depth_by_rounding, solids);
        for (PlacedSolid& solid : solids) {
          boxes.push_back(*solid.box);
          bodies_.push_back({static_cast<int>(o), static_cast<int>(b), std::move(solid)});
        }
      }
    if (!boxes.empty()) tree_.build(boxes);
  }

  bool empty() const { return bodies_.empty(); }

  /// The body inside of which a particle is: its object, and its index there; -1: none.
  std::pair<int, int> around(int object, const Looked& looked, std::size_t particle) const {
    const Object& of = scene_.objects[static_cast<std::size_t>(object)];
    const Vec3f& p = of.positions[particle];
    std::pair<int, int> found{-1, -1};
    tree_.query(BoxBounds{p, p}, [&](int i) {
      const PlacedBody& by = bodies_[static_cast<std::size_t>(i)];
      if (found.first < 0 && may_touch(object, looked, particle, by) && by.solid.overlaps(p))
        found = {by.object, by.body};
    });
    return found;
  }

  std::string name(const std::pair<int, int>& of) const {
    const Object& object = scene_.objects[static_cast<std::size_t>(of.first)];
    const std::string& name = object.bodies[static_cast<std::size_t>(of.second)].name;
    return "body " + std::to_string(of.second) + (has_own_name(name) ? " ('" + name + "')" : "") + " of '" +
           object.name + "'";
  }

 private:
  bool may_touch(int object, const Looked& looked, std::size_t particle, const PlacedBody& by) const {
    const Object &of = scene_.objects[static_cast<std::size_t>(object)],
                 &other = scene_.objects[static_cast<std::size_t>(by.object)];
    const int body = looked.body(particle);
    if (looked.is_held(particle) && body < 0) return false;
    if (object != by.object) return can_touch(of, other) && !(looked.is_held(particle) && is_fixed(other, by.body));
    return of.self_collision && body >= 0 && body != by.body && !looked.are_jointed(body, by.body);
  }

  static bool is_fixed(const Object& object, int body) {
    const int particle = object.bodies[static_cast<std::size_t>(body)].particle;
    return std::isinf(object.masses[static_cast<std::size_t>(particle)]) ||
           std::any_of(object.pins.begin(), object.pins.end(),
                       [&](const Pin& pin) { return pin.particle == particle; });
  }

  const Scene& scene_;
  std::vector<PlacedBody> bodies_;
  Tree<BoxBounds> tree_;
};

void doubt_in_bodies(Problems& problems, const Scene& scene, const Bodies& bodies) {
  for (std::size_t o = 0; o < scene.objects.size() && !bodies.empty(); ++o) {
    const Object& object = scene.objects[o];
    if (!is_looked_at(object)) continue;
    const Looked looked(object);
    std::map<std::pair<std::pair<int, int>, bool>, Tally> found;  // by the body around, and whether bodies are inside
    for (std::size_t i = 0; i < object.positions.size(); ++i)
      if (const auto in = bodies.around(static_cast<int>(o), looked, i); in.first >= 0)
        found[{in, looked.body(i) >= 0}].add(looked.body(i) >= 0 ? looked.body(i) : static_cast<std::int64_t>(i));
    problems.at(object.name);
    for (const auto& [which, inside] : found)
      problems.doubtful(inside, which.second ? "body" : "particle", "starts inside of " + bodies.name(which.first),
                        which.second ? "they are moved apart at 0.25 m/s at most: start them apart"
                                     : "contact moves it out, which may strain it: start them apart");
  }
}

/// True if all particles of an object, and the boxes around its bodies, are inside of a closed surface.
bool is_wholly_inside(const Object& object, const MeshQuery& query) {
  const auto is_inside = [&](const Vec3f& p) { return overlap(BoxBounds{p, p}, query.bounds()) && query.is_inside(p); };
  if (!std::all_of(object.positions.begin(), object.positions.end(), is_inside)) return false;
  std::vector<PlacedSolid> solids;
  for (const ObjectBody& body : object.bodies) add_solids_of_body(object, body, 0, solids);
  return std::all_of(solids.begin(), solids.end(), [&](const PlacedSolid& solid) {
    const auto& [low, high] = *solid.box;
    for (unsigned i = 0; i < 8; ++i)
      if (!is_inside({(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z}))
        return false;
    return true;
  });
}

void doubt_in_soft_bodies(Problems& problems, const Scene& scene) {
  for (const Object& soft : scene.objects) {
    if (!is_soft_body(soft)) continue;
    std::unique_ptr<const MeshQuery> query;
    try {
      query = std::make_unique<const MeshQuery>(query_of_closed({soft.positions, soft.triangles}));
    } catch (const Error&) {
      continue;  // it is open
    }
    for (const Object& object : scene.objects) {
      if (&object == &soft || !is_looked_at(object) || object.positions.empty() || !can_touch(object, soft)) continue;
      if (!is_wholly_inside(object, *query)) continue;
      problems.at(object.name);
      problems.doubtful("", "starts inside of '" + soft.name + "'",
                        "contact is between surfaces, and does not move it out: start them apart");
    }
  }
}

}  // namespace

void doubt_starts_in_bodies(Problems& problems, const Scene& scene) {
  doubt_in_bodies(problems, scene, Bodies(scene));
  doubt_in_soft_bodies(problems, scene);
  problems.at("");
}

}  // namespace pliant

#include "solver/bodies/body_islands.h"

#include <algorithm>
#include <cstddef>

#include "solver/bodies/body_math.h"
#include "solver/bodies/body_points.h"
#include "solver/substep.h"

namespace pliant {

namespace {

bool is_zero(const Vec3f& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

bool differ(const Quatd& a, const Quatd& b) { return a.x != b.x || a.y != b.y || a.z != b.z || a.w != b.w; }

bool has_moved(const std::pair<Posed, Posed>& poses) {
  const auto& [before, after] = poses;
  const Vec3d path = after.position - before.position;
  return path.x != 0 || path.y != 0 || path.z != 0 || differ(before.rotation, after.rotation);
}

/// True if a primitive collider moves in the substep.
bool has_moved(const MovingCollider& collider) {
  return collider.moves && has_moved({convert<double>(collider.before), convert<double>(collider.after)});
}

/// True if a body of infinite mass moves in the substep.
bool is_carried(const Substep& s, const BodyPlace& place) {
  return !is_zero(xyz(s.work.displacements[at(place.particle)]) - xyz(s.state.remainders[at(place.particle)])) ||
         !is_zero(xyz(s.work.frames.predicted[at(place.frame)]));
}

/// True if a point of a contact between surfaces belongs to a mesh collider that moves.
bool is_carried(const Substep& s, const Contact& c) {
  if (!is_zero(c.surface_motion)) return true;  // its surface slides
  for (std::size_t i = 0; i < c.point.size(); ++i) {
    if (c.weight[i] == 0 || s.state.positions[at(c.point[i])].w > 0) continue;
    if (!is_zero(xyz(s.work.displacements[at(c.point[i])]) - xyz(s.state.remainders[at(c.point[i])]))) return true;
  }
  return false;
}

}  // namespace

BodyIslands::BodyIslands(const Model& model, const ContactBodies& bodies)
    : bodies_(bodies.dynamic()), objects_(static_cast<int>(model.objects.size())) {
  for (int place = 0; place < bodies_; ++place) {
    const BodyPlace& body = bodies.places()[at(place)];
    if (body.body == 0) add_links(model, body.object, place, node_of_points(body.object), links_);
  }
}

void BodyIslands::find(const Substep& s, const ContactBodies& bodies, const Contacts& contacts) {
  islands_.reset(nodes());
  is_driven_.assign(at(nodes()), 0);
  find_movers(s, bodies, contacts.states);
  join_bodies(contacts.pressing);
  join_points(s, contacts.points);
  join_links(s);
  mark_driven_points(s);
  island_.resize(at(nodes()));
  for (int node = 0; node < nodes(); ++node) {
    const int island = island_[at(node)] = islands_.find(node);
    if (is_driven_[at(node)] != 0) drive(island);
  }
}

void BodyIslands::find_movers(const Substep& s, const ContactBodies& bodies, std::span<const BodyState> states) {
  is_fixed_.assign(at(nodes()), 0);
  moves_.assign(bodies.places().size(), 0);
  for (int place = 0; place < static_cast<int>(moves_.size()); ++place) {
    const BodyPlace& of = bodies.places()[at(place)];
    const BodyState& state = states[at(place)];
    const bool slides = !is_zero(state.surface_velocity);
    if (of.is_body() && !state.is_fixed) {
      if (slides) drive(place);
      continue;
    }
    if (of.is_body()) is_fixed_[at(place)] = 1;
    const bool moves =
        of.is_body() ? is_carried(s, of) : state.deforms || has_moved(bodies.poses_of_collider(s, place));
    moves_[at(place)] = moves || slides ? 1 : 0;
  }
}

/// Joins two nodes. What is fixed joins nothing, but drives the other if it moves.
void BodyIslands::join(int a, int b) {
  if (is_fixed_[at(a)] == 0 && is_fixed_[at(b)] == 0) return islands_.unite(a, b);
  if (is_fixed_[at(a)] != 0 && moves_[at(a)] != 0) drive(b);
  if (is_fixed_[at(b)] != 0 && moves_[at(b)] != 0) drive(a);
}

void BodyIslands::join_bodies(std::span<const std::pair<int, int>> pressing) {
  for (const auto& [a, b] : pressing) {
    if (a < bodies_ && b < bodies_) {
      join(a, b);
    } else if (moves_[at(std::max(a, b))] != 0) {  // colliders come after bodies
      drive(std::min(a, b));
    }
  }
}

void BodyIslands::join_points(const Substep& s, const BodyPoints& points) {
  for (const Contact& c : points.impulses().contacts())
    if (c.push > 0) join(points.solids().number_of(c), node_of_points(s.model.object_of(c.point[0])));
}

void BodyIslands::join_links(const Substep& s) {
  for (const BodyLink& link : links_) {
    const std::vector<int>& broken = s.work.joints[at(link.object)].broken;
    if (link.joint >= 0 && std::binary_search(broken.begin(), broken.end(), link.joint)) continue;
    join(link.a, link.b);
    if (!link.does_work) continue;
    drive(link.a);
    drive(link.b);
  }
}

void BodyIslands::mark_driven_points(const Substep& s) {
  const auto drives = [&](const Contact& c) {
    const MovingCollider& collider = s.own->colliders[at(c.collider)];
    return c.push > 0 && (has_moved(collider) || collider.slides());
  };
  for_each_tile(s, [&](int task) {
    const std::vector<Contact>& contacts = s.work.tiles[at(task)].contacts;
    if (std::any_of(contacts.begin(), contacts.end(), drives)) drive(node_of_points(s.model.tiles()[at(task)].object));
  });
  for (const Contact& c : s.own->shape_contacts)
    if (drives(c)) drive(node_of_points(s.model.object_of(c.point[0])));
  for_objects(s, [&](int object) {
    if (s.model.objects[at(object)].has_volume) drive(node_of_points(object));
  });
  if (!s.has_pairs()) return;
  for (const Contact& c : s.pairs->contacts()) {
    if (!(c.push > 0) || !is_carried(s, c)) continue;
    for (std::size_t i = 0; i < c.point.size(); ++i)
      if (c.weight[i] != 0) drive(node_of_points(s.model.object_of(c.point[i])));
  }
}

}  // namespace pliant

#include "solver/bodies/pinched_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Both normals are opposite if their product is below this.
constexpr float opposite = -0.8f;
/// The weight from which a contact is one of a single vertex.
constexpr float whole_weight = 0.999f;
constexpr int rounds_of_pinches = 4;
/// Vertices that slide along the ground more slowly lie still [m/s].
constexpr float pulled = 0.05f;

bool has_single_vertex(const Contact& c) { return c.weight[0] > whole_weight; }

/// One side of a pinched vertex.
struct PinchSide {
  Contact* contact = nullptr;
  float sign = 1;         ///< of the contact's normal and motion
  Vec3f normal{}, arm{};  ///< from the side to the vertex; from the body's centre to the vertex
  Vec3f moved{}, slip{};  ///< of the vertex against the side in the substep; less what is no motion [m]
  Vec3f predicted{};      ///< of a body, whose contacts have their gap after it; else of its surface along itself [m]
  BodyMotion motion{};    ///< without mass and inertia if it is no body
  BodyProgress* progress = nullptr;
};

/// `displacements`: those that the contact's points are indices of.
PinchSide side_of(Contact& c, float sign, const Record* displacements) {
  PinchSide out;
  out.contact = &c;
  out.sign = sign;
  out.normal = c.normal * sign;
  out.moved = relative(c, displacements) * sign;
  out.predicted = c.surface_motion * sign;
  out.slip = out.moved - (c.carried + c.surface_motion) * sign;
  return out;
}

PinchSide side_of_body(const Substep& s, const PinchedPoints::Parts& parts, Contact& c) {
  const Record *positions = s.state.positions.data(), *displacements = s.work.displacements.data();
  PinchSide out = side_of(c, 1, displacements);
  const int number = parts.solids.number_of(c);
  BodyProgress& p = parts.progress[at(number)];
  out.progress = &p;
  out.motion = parts.motions[at(number)];
  const Vec3f centre = (xyz(positions[parts.solids.bodies()[at(number)].particle]) + p.displacement) + p.moved;
  out.arm = (relative(c, positions) + relative(c, displacements)) - centre;
  const Vec3f of_body = p.moved + cross(p.turned, out.arm);
  out.moved -= of_body;
  out.slip -= of_body;
  return out;
}

/// The contact of a vertex with a collider in the list of its tile, which is ordered by collider, then by particle;
/// null if there is none. `particle`: its number in its object.
Contact* contact_in_tile(std::vector<Contact>& contacts, int collider, int particle) {
  const auto place = [](const Contact& c) { return std::pair{c.collider, c.point[0]}; };
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), std::pair{collider, particle},
                                      [&](const Contact& c, const auto& wanted) { return place(c) < wanted; });
  return found != contacts.end() && place(*found) == std::pair{collider, particle} ? &*found : nullptr;
}

/// The displacement of a side's place by an impulse on it.
Vec3f response(const PinchSide& side, const Vec3f& impulse) {
  if (!(side.motion.inverse_mass > 0)) return {};
  return impulse * side.motion.inverse_mass +
         cross(times(side.motion.inverse_inertia, cross(side.arm, impulse)), side.arm);
}

/// The distance of the vertex from a side less their thickness after motion against it [m].
float room_at(const PinchSide& side, const Vec3f& motion) { return side.contact->gap + dot(side.normal, motion); }

/// The impulse on `b`, and against `a`, that moves b's place against a's by `change`.
Vec3f impulse_between(const PinchSide& a, const PinchSide& b, const Vec3f& change) {
  Vec3f column[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3f unit{axis == 0 ? 1.f : 0.f, axis == 1 ? 1.f : 0.f, axis == 2 ? 1.f : 0.f};
    column[axis] = response(a, unit) + response(b, unit);
  }
  const Vec3f x = cross(column[1], column[2]), y = cross(column[2], column[0]), z = cross(column[0], column[1]);
  const float determinant = dot(column[0], x);
  if (!(determinant > 0)) return {};
  return Vec3f{dot(x, change), dot(y, change), dot(z, change)} * (1 / determinant);
}

/// The share of `added` that the cone of a contact leaves beside its present friction.
float share_in_cone(const Contact& c, const Vec3f& added) {
  const float square = dot(added, added);
  if (!(square > 0)) return 0;
  const float all = length(c.friction + added);
  if (all <= c.static_friction * c.push) return 1;
  const float most = c.kinetic_friction * c.push, along = dot(c.friction, added);
  const float root = along * along + square * (most * most - dot(c.friction, c.friction));
  return root > 0 ? min(max((sqrt(root) - along) / square, 0.f), 1.f) : 0.f;
}

/// Gives a side the impulse on the vertex, which is `along` a direction near its normal and `across` it. `scale` is the
/// inverse mass of its contact.
void answer(const PinchSide& side, float along, const Vec3f& direction, const Vec3f& across, float scale) {
  side.contact->push += along * scale;
  side.contact->friction += across * (scale * side.sign);
  if (side.progress == nullptr) return;
  const Vec3f impulse = direction * along + across;
  side.progress->moved -= impulse * side.motion.inverse_mass;
  side.progress->turned -= times(side.motion.inverse_inertia, cross(side.arm, impulse));
}

/// By how much the room between both sides has shrunk below what it was at the substep's start, or below 0 [m].
float lost_room(const PinchSide& a, const PinchSide& b) {
  const float at_start = room_at(a, a.predicted) + room_at(b, b.predicted);
  return max(min(at_start, 0.f) - (room_at(a, a.moved) + room_at(b, b.moved)), 0.f);
}

/// True if the vertex is pulled along between both sides, as that of a rug is beneath a load. Each side then has its own
/// friction with the vertex, and none with the other side. `is_held`: something fixed is in its object, whose forces reach
/// the vertex; so the load rides on it if it slides along the ground, the side that yields less, more than beneath the
/// load. Else it is pulled only if it slides against both sides in one direction.
bool is_pulled(const PinchSide& a, const PinchSide& b, const Vec3f& n, float h, bool is_held) {
  const bool a_yields = a.motion.inverse_mass > b.motion.inverse_mass;
  const PinchSide &ground = a_yields ? b : a, &load = a_yields ? a : b;
  const Vec3f along_ground = ground.slip - n * dot(n, ground.slip), beneath_load = load.slip - n * dot(n, load.slip);
  const float on_ground = length_squared(along_ground), on_load = length_squared(beneath_load);
  if (!(on_ground > (pulled * h) * (pulled * h))) return false;
  if (is_held && on_ground > on_load) return true;
  const float least = min(on_ground, on_load);
  return dot(along_ground, beneath_load) > 0.5f * least && least > (pulled * h) * (pulled * h);
}

/// Gives a body the friction of a vertex that its object holds, as if that could not move otherwise: so light a vertex
/// passes little of what the fixed particles bear on to a body. That they bear it is left out. Returns the motion of
/// the body's place.
Vec3f hold(const PinchSide& side, float scale) {
  if (!(side.motion.inverse_mass > 0)) return {};
  const Vec3f along = side.slip - side.normal * dot(side.normal, side.slip);
  const Vec3f impulse = -impulse_between({}, side, along), across = impulse - side.normal * dot(side.normal, impulse);
  const Vec3f given = across * share_in_cone(*side.contact, across * (scale * side.sign));
  answer(side, 0, {}, given, scale);
  return -response(side, given);
}

/// Gives both sides of a vertex of inverse mass `w` their impulses, across the normal only if the vertex sticks to both.
/// Returns that along the normal [N s^2].
float join(const PinchSide& a, const PinchSide& b, float w, float h, bool is_held, bool sticks) {
  const float lost = lost_room(a, b);
  if (!(lost > 0) && !(a.contact->push > 0 && b.contact->push > 0)) return 0;
  const Vec3f n = unit_or(a.normal - b.normal, a.normal);
  Vec3f slip = b.slip - a.slip;
  Vec3f impulse = impulse_between(a, b, (slip - n * dot(n, slip)) + n * lost);
  const float along = lost > 0 ? max(dot(n, impulse), 0.f) : 0;
  const float scale_a = w + dot(n, response(a, n)), scale_b = w + dot(n, response(b, n));
  answer(a, along, n, {}, scale_a);  // opposite ones, also where normals are not: momentum is kept
  answer(b, along, -n, {}, scale_b);
  if (is_held) {
    slip += hold(a, scale_a) - hold(b, scale_b);
    impulse = impulse_between(a, b, slip - n * dot(n, slip));
  }
  if (!sticks || is_pulled(a, b, n, h, is_held)) return along;
  const Vec3f sticking = impulse - n * dot(n, impulse);
  const Vec3f across = sticking * min(share_in_cone(*a.contact, sticking * (scale_a * a.sign)),
                                      share_in_cone(*b.contact, sticking * (-scale_b * b.sign)));
  answer(a, 0, n, across, scale_a);
  answer(b, 0, -n, -across, scale_b);
  return along;
}

}  // namespace

std::vector<PinchedPoints::Touch>::const_iterator PinchedPoints::first_touch_from(int vertex) const {
  return std::lower_bound(touches_.begin(), touches_.end(), vertex,
                          [](const Touch& touch, int v) { return touch.vertex < v; });
}

void PinchedPoints::find_between_bodies(const BodySolids& solids, const std::vector<Contact>& contacts) {
  for (std::size_t i = 0; i < touches_.size(); ++i)
    for (std::size_t j = i + 1; j < touches_.size() && touches_[j].vertex == touches_[i].vertex; ++j) {
      const Contact &a = contacts[at(touches_[i].contact)], &b = contacts[at(touches_[j].contact)];
      if (solids.number_of(a) != solids.number_of(b) && dot(a.normal, b.normal) < opposite)
        pinches_.push_back({touches_[i].contact, touches_[j].contact});
    }
}

/// Only vertices of matter at faces of meshes.
void PinchedPoints::find_at_meshes(const Substep& s, const std::vector<Contact>& contacts) {
  const std::vector<Contact>& all = s.pairs->contacts();
  const Record* const positions = s.state.positions.data();
  for (std::size_t n = 0; n < all.size(); ++n) {
    int vertex = -1, movable = 0;
    float weight = 0;
    for (std::size_t i = 0; i < all[n].point.size(); ++i) {
      if (all[n].weight[i] == 0 || !(positions[all[n].point[i]].w > 0)) continue;
      vertex = all[n].point[i];
      weight = all[n].weight[i];
      ++movable;
    }
    if (movable != 1 || !(std::abs(weight) > whole_weight)) continue;
    const float side = weight > 0 ? 1.f : -1.f;
    auto touch = first_touch_from(vertex);
    for (; touch != touches_.end() && touch->vertex == vertex; ++touch)
      if (side * dot(contacts[at(touch->contact)].normal, all[n].normal) < opposite)
        pinches_.push_back({touch->contact, static_cast<int>(n), Other::mesh, side});
  }
}

/// At primitive colliders, distance grids and heightfields, whose contacts each tile has.
void PinchedPoints::find_at_colliders(const Substep& s, const std::vector<Contact>& contacts) {
  std::vector<int> colliders;
  for_each_tile(s, [&](int task) {
    std::vector<Contact>& of_tile = s.work.tiles[at(task)].contacts;
    const int first = s.model.first[at(s.model.tiles()[at(task)].object)];
    const int end = first + tile_of(s, task).last_particle;
    auto touch = first_touch_from(first + tile_of(s, task).first_particle);
    if (of_tile.empty() || touch == touches_.end() || touch->vertex >= end) return;
    colliders.clear();
    for (const Contact& c : of_tile)
      if (colliders.empty() || colliders.back() != c.collider) colliders.push_back(c.collider);
    for (; touch != touches_.end() && touch->vertex < end; ++touch)
      for (const int c : colliders) {
        const Contact* const other = contact_in_tile(of_tile, c, touch->vertex - first);
        if (other != nullptr && dot(contacts[at(touch->contact)].normal, other->normal) < opposite)
          pinches_.push_back({touch->contact, c, Other::collider, 1, task});
      }
  });
}

/// Which objects of pinched vertices have particles that are fixed, or follow pins.
void PinchedPoints::find_held(const Substep& s) {
  is_held_.assign(s.model.objects.size(), 0);
  int last = -1;
  for (const Touch& touch : touches_) {
    const int object = s.model.object_of(touch.vertex);
    if (object == std::exchange(last, object)) continue;
    const auto all = s.state.positions.begin();
    const auto is_fixed = [](const Record& position) { return !(position.w > 0); };
    is_held_[at(object)] = std::any_of(all + s.model.first[at(object)], all + s.model.end_of(object), is_fixed) ? 1 : 0;
  }
}

void PinchedPoints::find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts) {
  pinches_.clear();
  touches_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (has_single_vertex(contacts[i]) && s.state.positions[at(contacts[i].point[0])].w > 0)
      touches_.push_back({contacts[i].point[0], static_cast<int>(i)});
  std::stable_sort(touches_.begin(), touches_.end(),
                   [](const Touch& a, const Touch& b) { return a.vertex < b.vertex; });
  find_between_bodies(solids, contacts);
  if (touches_.empty()) return;
  if (s.has_pairs()) find_at_meshes(s, contacts);
  if (!s.own->colliders.empty()) find_at_colliders(s, contacts);
  find_held(s);
}

void PinchedPoints::project(Substep& s, const Parts& parts, const Pinch& pinch) const {
  Contact& first = parts.contacts[at(pinch.contact)];
  const int vertex = first.point[0];
  const PinchSide a = side_of_body(s, parts, first);
  PinchSide b;
  if (pinch.kind == Other::body) {
    b = side_of_body(s, parts, parts.contacts[at(pinch.other)]);
  } else if (pinch.kind == Other::mesh) {
    b = side_of(s.pairs->contacts()[at(pinch.other)], pinch.side, s.work.displacements.data());
  } else {
    const int begin = s.model.first[at(s.model.object_of(vertex))];
    Contact* const other = contact_in_tile(s.work.tiles[at(pinch.task)].contacts, pinch.other, vertex - begin);
    if (other == nullptr) return;
    b = side_of(*other, pinch.side, s.work.displacements.data() + begin);
  }
  const bool is_held = is_held_[at(s.model.object_of(vertex))] != 0;
  // Contacts of tiles are solved with the chains that pull at what is held, those of surfaces only after them.
  const bool sticks = !is_held || pinch.kind != Other::collider;
  const float along = join(a, b, s.state.positions[at(vertex)].w, s.h, is_held, sticks) / s.h;
  parts.impulses[at(pinch.contact)] += along;
  if (pinch.kind == Other::body) parts.impulses[at(pinch.other)] += along;
}

void PinchedPoints::project(Substep& s, const Parts& parts, const std::vector<char>* of) const {
  const auto is_of = [&](const Pinch& pinch) {
    return of == nullptr || (*of)[at(s.model.object_of(parts.contacts[at(pinch.contact)].point[0]))] != 0;
  };
  for (int round = 0; round < rounds_of_pinches; ++round)
    for (const Pinch& pinch : pinches_)
      if (is_of(pinch)) project(s, parts, pinch);
}

}  // namespace pliant

#include "collision/narrow/contact.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "collision/narrow/axes.h"
#include "collision/narrow/near_points.h"
#include "math/motion.h"
#include "model/surface_velocity.h"

namespace pliant {

namespace {

bool overlap(const PointBounds& a, const BoundingBox<float>& b, float margin) {
  return a.low.x - margin <= b.high.x && a.low.y - margin <= b.high.y && a.low.z - margin <= b.high.z &&
         b.low.x <= a.high.x + margin && b.low.y <= a.high.y + margin && b.low.z <= a.high.z + margin;
}

/// Returns false if a path cannot reach a solid, because its end is farther away than the path is long. For terrain it
/// returns true, because the distance to terrain is discontinuous.
bool may_meet(const LocalShape&, const SurfaceDistance<float>& end, float thickness, float path) {
  return end.distance < thickness + path;
}
bool may_meet(const SolidField&, const SurfaceDistance<float>&, float, float) { return true; }

bool stays_beyond(const LocalShape&, float margin, const SurfaceDistance<float>& end, const Vec3f& to,
                  const Vec3f& path) {
  return stays_beyond(margin, end, to, path);
}
bool stays_beyond(const SolidField&, float, const SurfaceDistance<float>&, const Vec3f&, const Vec3f&) { return false; }

SurfaceDistance<float> signed_distance(const SolidField& field, const Vec3f& p) { return field.distance(p); }

/// The distance to a solid at a path's start. The distance to terrain is discontinuous at its open sides and between
/// columns, so it is limited by the distance at the end. Otherwise a particle that enters deep below would seem to have
/// just crossed the surface.
float distance_before(const LocalShape& shape, const Vec3f& a, const SurfaceDistance<float>&, float) {
  return signed_distance(shape, a).distance;
}
float distance_before(const SolidField& field, const Vec3f& a, const SurfaceDistance<float>& end, float path) {
  return field.is_ground() ? min(field.distance(a).distance, end.distance + path) : field.distance(a).distance;
}
FirstHit<float> first_hit(const SolidField& field, const Vec3f& a, const Vec3f& b, float margin) {
  return field.first_hit(a, b, margin);
}

/// Returns the contact plane of a particle that moves from a to b, in the collider's frame, if there is one. On a long
/// path (continuous) it is the plane at the entry point, or at the start if the start is inside or within the
/// thickness, because a particle stays on its side. On a short path (static) it is the plane at the closest surface
/// point.
template <class Solid>
std::optional<SurfacePlane<float>> surface_plane(const Solid& solid, const Vec3f& a, const Vec3f& b, float thickness,
                                                 float h) {
  const SurfaceDistance<float> end = signed_distance(solid, b);
  const Vec3f moved = b - a;
  const float path = length(moved), margin = share_of_first_hit * thickness;
  if (!may_meet(solid, end, thickness, path)) return {};
  if (path > share_of_short_path * thickness && !stays_beyond(solid, margin, end, b, moved)) {
    const FirstHit<float> hit = first_hit(solid, a, b, margin);
    const float height = hit.t > 0 ? thickness : height_after(hit.distance, thickness, h);
    if (hit.hit) return plane_at_end<float>({hit.distance, hit.normal}, hit.point, height);
  }
  if (!(end.distance < thickness + path)) return {};
  return plane_at_end(end, b, height_after(distance_before(solid, a, end, path), thickness, h));
}

}  // namespace

namespace {

/// The bounding box of a field's box in a pose, grown by a margin.
BoundingBox<float> bounding_box(const SolidField& field, const Pose<float>& pose, float margin) {
  const BoxBounds box = field.bounds();
  Vec3f low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f};
  for (int i = 0; i < 8; ++i) {
    const Vec3f corner =
        to_world(pose, Vec3f{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                             (i & 4) != 0 ? box.high.z : box.low.z});
    low = min(low, corner);
    high = max(high, corner);
  }
  const float grown = margin + 1e-6f * (largest(low) + largest(high));
  return {low - Vec3f{grown, grown, grown}, high + Vec3f{grown, grown, grown}};
}

/// Sets a collider's poses at the start and the end of a substep, and whether the collider moves.
template <class From, class MotionPose>
void move(const From& from, const PoseDrive* drive, const MotionPose& motion_pose, double time_before,
          double time_after, MovingCollider& to) {
  const auto pose = [&](double time) { return convert<float>(drive != nullptr ? drive->at(time) : motion_pose(time)); };
  to.before = pose(time_before);
  to.moves = drive != nullptr ? drive->moves() : from.motion.moves();
  to.after = to.moves ? pose(time_after) : to.before;
  to.thickness = from.thickness;
  to.static_friction = from.static_friction;
  to.kinetic_friction = from.kinetic_friction;
  to.restitution = from.restitution;
}

/// `velocity` is in world axes.
void set_slide(const Vec3f& velocity, double seconds, MovingCollider& to) {
  if (velocity != Vec3f{}) to.slide = velocity * static_cast<float>(seconds);
}

}  // namespace

PairMaterial material_of(const CompiledObject& object, const MovingCollider& collider) {
  PairMaterial material{object.thickness + collider.thickness, sqrt(object.static_friction * collider.static_friction),
                        sqrt(object.kinetic_friction * collider.kinetic_friction),
                        max(object.restitution, collider.restitution)};
  if (collider.named != nullptr)
    for (const NamedPair& pair : *collider.named)
      if (pair.object == object.name) apply(pair.said, material);
  return material;
}

float thickness_of(const CompiledObject& object, const MovingCollider& collider) {
  return collider.named == nullptr ? object.thickness : material_of(object, collider).thickness - collider.thickness;
}

void add_slide(const MovingCollider& collider, Contact& contact) {
  if (collider.slides())
    contact.surface_motion += collider.slide - contact.normal * dot(contact.normal, collider.slide);
}

void move_colliders(const Model& model, const Control& control, double time_before, double time_after,
                    std::vector<MovingCollider>& colliders) {
  colliders.resize(model.colliders.size() + model.fields.size());
  MovingCollider* to = colliders.data();
  for (int c = 0; c < static_cast<int>(model.colliders.size()); ++c, ++to) {
    const Collider& from = model.colliders[c];
    *to = {};
    to->shape = local_shape(from.shape);
    const auto by_motion = [&](double time) { return collider_pose(from, time); };
    move(from, control.collider(c), by_motion, time_before, time_after, *to);
    set_slide(rotate(to->after.rotation, surface_velocity_of_collider(model, control, c)), time_after - time_before,
              *to);
    to->swept =
        merge(bounding_box(to->shape, to->before, to->thickness), bounding_box(to->shape, to->after, to->thickness));
  }
  for (const FieldCollider& from : model.fields) {
    *to = {};
    to->field = from.field.get();
    to->groups = from.groups;
    to->mask = from.mask;
    const auto by_motion = [&](double time) { return pose_at(from.motion, time); };
    move(from, control.mesh(from.object), by_motion, time_before, time_after, *to);
    set_slide(surface_velocity_of_mesh(model, control, from.object, time_after), time_after - time_before, *to);
    to->swept =
        merge(bounding_box(*to->field, to->before, to->thickness), bounding_box(*to->field, to->after, to->thickness));
    ++to;
  }
}

namespace {

/// An object and a collider, with the parameters that all their contacts share.
struct ColliderQuery {
  const ContactSearch& search;
  const MovingCollider& collider;
  int number;       ///< index of the collider
  float thickness;  ///< sum of both thicknesses [m]
  Vec3f gravity;    ///< added to a velocity, gives the velocity before this substep's gravity [m/s]
  float static_friction, kinetic_friction, restitution;

  /// With a material whose thickness is that of the contacts.
  ColliderQuery(const ContactSearch& in, int of, const PairMaterial& both)
      : search(in),
        collider(in.colliders[static_cast<std::size_t>(of)]),
        number(of),
        thickness(both.thickness),
        gravity(in.particles.gravity_begun - in.particles.gravity_step),
        static_friction(both.static_friction),
        kinetic_friction(both.kinetic_friction),
        restitution(both.restitution) {}
};

/// Appends a contact of particle i with a collider, if there is one.
void find_contact(const ColliderQuery& m, int i, std::vector<Contact>& contacts) {
  const MovingCollider& collider = m.collider;
  const AdvanceArguments& a = m.search.particles;
  const Record &x = a.positions[i], &d = a.displacements[i], &v = a.velocities[i], &r = a.remainders[i];
  if (x.w == 0) return;
  const Vec3f position{x.x, x.y, x.z};
  const Vec3f to = to_local(collider.after, position + Vec3f{d.x, d.y, d.z});
  const Vec3f from = to_local(collider.before, position);
  const std::optional<SurfacePlane<float>> plane = collider.field != nullptr
                                                       ? surface_plane(*collider.field, from, to, m.thickness, a.h)
                                                       : surface_plane(collider.shape, from, to, m.thickness, a.h);
  if (!plane) return;
  const Vec3f velocity = Vec3f{v.x, v.y, v.z} + m.gravity;
  const PointContact<float> found =
      contact_at_plane(*plane, collider.before, collider.after, collider.moves, position, velocity, a.inverse_h);
  Contact& contact = contacts.emplace_back();
  contact.point = {i, i, i, i};
  contact.weight = contact.share = {1, 0, 0, 0};
  contact.thickness = m.thickness;
  contact.collider = m.number;
  contact.normal = found.normal;
  contact.gap = found.gap;
  contact.surface_motion = found.surface_motion;
  contact.static_friction = m.static_friction;
  contact.kinetic_friction = m.kinetic_friction;
  contact.restitution = m.restitution;
  contact.carried = {r.x, r.y, r.z};
  contact.approach = found.approach;
  add_slide(collider, contact);
}

/// Appends the contacts of particles with a primitive collider, sixteen at a time. `near` has room for a whole last
/// batch.
void find_contacts_in_lanes(const ColliderQuery& m, std::vector<std::int32_t>& near, int count,
                            std::vector<Contact>& contacts) {
  const MovingCollider& collider = m.collider;
  const PointContactQuery query{m.search.particles, collider.shape,     collider.before, collider.after,
                                collider.moves,     m.number,           m.thickness,     m.gravity,
                                m.static_friction,  m.kinetic_friction, m.restitution};
  std::array<Contact, batch_width> lanes;
  for (int i = 0; i < count; i += batch_width) {
    const int valid = std::min(batch_width, count - i);
    std::fill_n(near.begin() + i + valid, batch_width - valid, near[i]);
    const auto [found, unclear] = m.search.make_contacts(query, &near[i], lanes.data());
    for (unsigned left = (found | unclear) & ((1U << valid) - 1); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
      if ((found >> lane & 1U) != 0) {
        contacts.push_back(lanes[lane]);
        add_slide(collider, contacts.back());
      } else {
        find_contact(m, near[static_cast<std::size_t>(i) + lane], contacts);
      }
    }
  }
}

/// Removes centres of rigid bodies from the first `count` of a list, because only a body's solids touch. Returns how
/// many remain.
int without_centres(const CompiledObject& object, int count, std::vector<std::int32_t>& near) {
  if (object.bodies.empty()) return count;
  const auto end =
      std::remove_if(near.begin(), near.begin() + count, [&](int i) { return object.bodies.has_centre(i); });
  return static_cast<int>(end - near.begin());
}

/// How far the points of a solid move in a substep.
struct SolidMotion {
  float path = 0;   ///< of its origin [m]
  float chord = 0;  ///< of a point at a distance of 1 m from it, by rotation [m]

  explicit SolidMotion(const MovingCollider& of) : path(length(of.after.position - of.before.position)) {
    const Quatf turn = multiply(conjugate(of.before.rotation), of.after.rotation);
    chord = 2 * length(Vec3f{turn.x, turn.y, turn.z});
  }
};

/// The distance from a solid's box within which a particle that is displaced by `moved` can have a contact [m];
/// infinite for solids that turn fast. No particle farther away ends within the thickness and its own path, measured in
/// the solid's frame.
float reach_of(const MovingCollider& collider, const SolidMotion& motion, float thickness, float moved) {
  if (!(motion.chord < 0.5f)) return 3e38f;
  Vec3f corner = collider.shape.kind == ShapeKind::plane ? Vec3f{} : half_sides<float>(collider.shape);
  if (collider.field != nullptr) corner = max(abs(collider.field->bounds().low), abs(collider.field->bounds().high));
  const float travelled = moved + motion.path;
  return 1.01f * ((thickness + travelled + moved) + motion.chord * (length(corner) + travelled)) / (1 - motion.chord);
}

/// Lists of near particles hold for the motion of about so many substeps, and for this share of the solid's box.
constexpr float substeps_of_lists = 8, share_of_box = 0.05f;

/// The particles near a collider that moves, and the box that those in contact are in.
struct NearMoving {
  SolidMotion motion;
  BoxBounds box{};
  NearPoints::List* list = nullptr;

  NearMoving(const ContactSearch& search, int number, float thickness)
      : motion(search.colliders[static_cast<std::size_t>(number)]) {
    const MovingCollider& collider = search.colliders[static_cast<std::size_t>(number)];
    const float reach = reach_of(collider, motion, thickness, search.largest_displacement);
    const Vec3f by{reach, reach, reach};
    box = {collider.swept.low - by, collider.swept.high + by};
    const float slack = substeps_of_lists * (search.largest_displacement + motion.path) +
                        share_of_box * largest(collider.swept.high - collider.swept.low);
    list = &search.near_points->near(number, box, slack);
  }

  bool has(const Record& p) const {
    return (p.x >= box.low.x) & (p.y >= box.low.y) & (p.z >= box.low.z) & (p.x <= box.high.x) & (p.y <= box.high.y) &
           (p.z <= box.high.z);
  }
};

/// Finds the particles near a collider that moves, ascending.
int find_near_moving(const ContactSearch& search, int number, float thickness, std::vector<std::int32_t>& near) {
  const NearMoving moving(search, number, thickness);
  const std::vector<std::int32_t>& points = moving.list->points;
  near.resize(points.size() + batch_width);
  int inside = 0;
  for (const std::int32_t point : points) {
    const std::int32_t i = point - search.first_of_object;
    near[static_cast<std::size_t>(inside)] = i;
    inside += moving.has(search.particles.positions[i]) ? 1 : 0;
  }
  near.resize(static_cast<std::size_t>(inside) + batch_width);
  return inside;
}

/// True if a path of this length to a place in a grid's frame stays farther than the thickness from the grid's solid,
/// by a distance known elsewhere. A trilinear distance grows by at most one along each axis. `rounding` is that of
/// positions in the world [m].
bool stays_clear(const NearPoints::Known& known, const Vec3f& to, float path, float thickness, float rounding) {
  constexpr float steepest = 1.7321f;
  const float rounded = rounding + 1e-5f * ((largest(to) + largest(known.place)) + (abs(known.distance) + path));
  return known.distance - steepest * length(to - known.place) > thickness + steepest * path + rounded;
}

/// Finds contacts of the particles near a collider that moves and is given by a grid. Distances are sampled only where
/// those known from earlier substeps leave a contact possible.
void find_contacts_in_grid(const ColliderQuery& m, std::vector<Contact>& contacts) {
  const NearMoving moving(m.search, m.number, m.thickness);
  const MovingCollider& collider = m.collider;
  const AdvanceArguments& a = m.search.particles;
  NearPoints::List& list = *moving.list;
  const Axes frame(collider.after);
  const float moving_by = m.search.largest_displacement + moving.motion.path,
              rounding = 1e-6f * (largest(collider.swept.low) + largest(collider.swept.high));
  for (std::size_t k = 0; k < list.points.size(); ++k) {
    const int i = list.points[k] - m.search.first_of_object;
    const Record &x = a.positions[i], &d = a.displacements[i];
    if (!moving.has(x) || m.search.object.bodies.has_centre(i)) continue;
    const Vec3f to = frame.to_local(Vec3f{x.x, x.y, x.z} + Vec3f{d.x, d.y, d.z});
    NearPoints::Known& known = list.known[k];
    const float path = 1.001f * (moving_by + moving.motion.chord * length(to));
    if (stays_clear(known, to, path, m.thickness, rounding)) continue;
    known = {to, collider.field->distance(to).distance};
    if (stays_clear(known, to, path, m.thickness, rounding)) continue;
    find_contact(m, i, contacts);
  }
}

/// Finds the particles to test against a collider. Without lists these are all particles of the tile if the collider
/// moves, because the kernel measures displacements of particles only.
int find_near(const ContactSearch& search, int number, float thickness, std::vector<std::int32_t>& near) {
  const AdvanceArguments& a = search.particles;
  const MovingCollider& collider = search.colliders[static_cast<std::size_t>(number)];
  if (search.near_points != nullptr && collider.field == nullptr)
    return find_near_moving(search, number, thickness, near);
  near.resize(a.last - a.first + batch_width);
  if (collider.moves || collider.field != nullptr) {
    for (int i = a.first; i < a.last; ++i) near[i - a.first] = i;
    return a.last - a.first;
  }
  // The margin exceeds the rounding difference between the kernel's distance and the one computed later.
  const PointBounds& b = search.bounds;
  const float reach = max(largest(Vec3f{b.low.x, b.low.y, b.low.z}), largest(Vec3f{b.high.x, b.high.y, b.high.z}));
  const float slack = 1e-6f + 1e-5f * (reach + largest(collider.after.position) + thickness);
  return search.find_near(
      {a.positions, a.displacements, a.first, a.last, collider.shape, collider.after, thickness + slack}, near.data());
}

}  // namespace

bool meet(const CompiledObject& object, const MovingCollider& collider) {
  if (object.is_collider) return false;
  return collider.field == nullptr || ((object.groups & collider.mask) != 0 && (collider.groups & object.mask) != 0);
}

namespace {

void find_contacts_with(const ContactSearch& search, int c, std::vector<std::int32_t>& near,
                        std::vector<Contact>& contacts) {
  const MovingCollider& collider = search.colliders[c];
  const PairMaterial material = material_of(search.object, collider);
  const float thickness = material.thickness;
  if (!overlap(search.bounds, collider.swept, max(search.object.thickness, thickness)) ||
      !meet(search.object, collider))
    return;
  const ColliderQuery query(search, c, material);
  if (search.near_points != nullptr && collider.field != nullptr && !collider.field->is_ground())
    return find_contacts_in_grid(query, contacts);
  const int count = without_centres(search.object, find_near(search, c, thickness, near), near);
  if (search.make_contacts != nullptr && collider.field == nullptr) {
    find_contacts_in_lanes(query, near, count, contacts);
  } else {
    for (int k = 0; k < count; ++k) find_contact(query, near[k], contacts);
  }
}

}  // namespace

void find_contacts(const ContactSearch& search, std::vector<std::int32_t>& near, std::vector<Contact>& contacts) {
  if (search.near_colliders != nullptr) {
    for (const int c : *search.near_colliders) find_contacts_with(search, c, near, contacts);
    return;
  }
  for (int c = 0; c < static_cast<int>(search.colliders.size()); ++c) find_contacts_with(search, c, near, contacts);
}

namespace {

/// How far above a solid the particles of a liquid are held that would enter it, over the thickness: rounding must not
/// put them inside.
constexpr float share_of_held_height = 0.1f;

bool is_near(const MovingCollider& collider, const Record& x, const Record& d, float margin) {
  const Vec3f from{x.x, x.y, x.z}, to = from + Vec3f{d.x, d.y, d.z}, by{margin, margin, margin};
  const Vec3f low = min(from, to) - by, high = max(from, to) + by;
  return low.x <= collider.swept.high.x && low.y <= collider.swept.high.y && low.z <= collider.swept.high.z &&
         high.x >= collider.swept.low.x && high.y >= collider.swept.low.y && high.z >= collider.swept.low.z;
}

/// Appends contacts of the particles of a liquid whose displacements enter a collider. The density may have moved them
/// far from where their contacts were predicted, so these count for nothing here.
void find_breaches_of_liquid(const ContactSearch& search, int c, std::vector<Contact>& contacts) {
  const MovingCollider& collider = search.colliders[static_cast<std::size_t>(c)];
  PairMaterial material = material_of(search.object, collider);
  material.thickness *= share_of_held_height;
  const ColliderQuery query(search, c, material);
  const AdvanceArguments& a = search.particles;
  for (int i = a.first; i < a.last; ++i) {
    const Record& d = a.displacements[i];
    if (!is_near(collider, a.positions[i], d, query.thickness)) continue;
    const std::size_t before = contacts.size();
    find_contact(query, i, contacts);
    if (contacts.size() == before) continue;
    const Contact& found = contacts.back();
    if (!(found.gap + dot(found.normal, Vec3f{d.x, d.y, d.z}) < 0)) contacts.pop_back();
  }
}

}  // namespace

void find_breaches(const ContactSearch& search, const std::vector<Contact>& known, std::vector<std::int32_t>& near,
                   std::vector<Contact>& contacts) {
  // Margin of the cull: constraints rarely move particles farther than this beyond the bounds of the prediction.
  const PointBounds& b = search.bounds;
  const float margin =
      search.object.thickness + 0.1f * largest(Vec3f{b.high.x - b.low.x, b.high.y - b.low.y, b.high.z - b.low.z});
  const AdvanceArguments& a = search.particles;
  near.resize(a.last - a.first + batch_width);
  auto next = known.begin();
  const auto is_known = [&](int c, int particle) {
    const auto is_before = [&](const Contact& k) {
      return k.collider < c || (k.collider == c && k.point[0] < particle);
    };
    while (next != known.end() && is_before(*next)) ++next;
    return next != known.end() && next->collider == c && next->point[0] == particle;
  };
  for (int c = 0; c < static_cast<int>(search.colliders.size()); ++c) {
    const MovingCollider& collider = search.colliders[c];
    if (!overlap(b, collider.swept, margin) || !meet(search.object, collider)) continue;
    if (collider.field != nullptr || collider.shape.kind != ShapeKind::plane) {
      if (search.object.fluid) find_breaches_of_liquid(search, c, contacts);
      continue;
    }
    const int found = search.find_near(
        {a.positions, a.displacements, a.first, a.last, collider.shape, collider.after, 0}, near.data());
    const int count = without_centres(search.object, found, near);
    PairMaterial material = material_of(search.object, collider);
    material.thickness = 0;
    const ColliderQuery query(search, c, material);
    for (int k = 0; k < count; ++k) {
      if (is_known(c, near[k])) continue;
      const Record &x = a.positions[near[k]], &d = a.displacements[near[k]];
      const Vec3f end = to_local(collider.after, Vec3f{x.x + d.x, x.y + d.y, x.z + d.z});
      if (signed_distance(collider.shape, end).distance < 0) find_contact(query, near[k], contacts);
    }
  }
}

void merge_contacts(const std::vector<Contact>& first, const std::vector<Contact>& second, std::vector<Contact>& all) {
  all.clear();
  const auto place = [](const Contact& c) { return std::make_pair(c.collider, c.point[0]); };
  std::set_union(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(all),
                 [&](const Contact& a, const Contact& b) { return place(a) < place(b); });
}

void project_contacts(std::vector<Contact>& contacts, const SweepArguments& a) {
  for (Contact& contact : contacts) project_point_contact(contact, a.displacements);
}

void respond(const std::vector<Contact>& contacts, const Vec3f& gravity, const AdvanceArguments& a) {
  const float slow = 2 * length(a.gravity_step);
  for (const Contact& contact : contacts) {
    if (!(contact.push > 0)) continue;
    Record& v = a.velocities[contact.point[0]];
    const Vec3f relative = Vec3f{v.x, v.y, v.z} + gravity - contact.surface_motion * a.inverse_h;
    const float separating = dot(contact.normal, relative);
    const float wanted = separation_after(separating, contact.approach, contact.restitution, slow, true);
    const Vec3f change = contact.normal * (wanted - separating);
    v = {v.x + change.x, v.y + change.y, v.z + change.z, 0};
  }
}

}  // namespace pliant

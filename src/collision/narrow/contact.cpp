#include "collision/narrow/contact.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "math/motion.h"

namespace pliant {

namespace {

/// What overlaps at the start separates at this speed at most, so that it neither explodes nor tears its own constraints
/// [m/s].
constexpr float largest_separation_speed = 2;

BoundingBox<float> merge(const BoundingBox<float>& a, const BoundingBox<float>& b) {
  return {min(a.low, b.low), max(a.high, b.high)};
}

bool overlap(const PointBounds& a, const BoundingBox<float>& b, float margin) {
  return a.low.x - margin <= b.high.x && a.low.y - margin <= b.high.y && a.low.z - margin <= b.high.z &&
         b.low.x <= a.high.x + margin && b.low.y <= a.high.y + margin && b.low.z <= a.high.z + margin;
}

/// A plane that a particle must stay above.
struct SurfacePlane {
  bool found = false;
  Vec3f normal{};  // in the collider's frame, like the point
  Vec3f point{};   // of the surface
  float offset = 0;
};

/// A path that meets a solid ends no farther from it than it is long; ground is measured along its columns, which may end anywhere.
bool may_meet(const LocalShape&, const SurfaceDistance<float>& end, float thickness, float path) {
  return end.distance < thickness + path;
}
bool may_meet(const SolidField&, const SurfaceDistance<float>&, float, float) { return true; }

SurfaceDistance<float> signed_distance(const SolidField& field, const Vec3f& p) { return field.distance(p); }

/// How far from a solid a path began: of ground, whose distance jumps at its open sides and from column to column, no farther than
/// its end allows. Else what comes in deep below would be taken for something that has just crossed the surface, and thrown up.
float distance_before(const LocalShape& shape, const Vec3f& a, const SurfaceDistance<float>&, float) {
  return signed_distance(shape, a).distance;
}
float distance_before(const SolidField& field, const Vec3f& a, const SurfaceDistance<float>& end, float path) {
  return field.is_ground() ? min(field.distance(a).distance, end.distance + path) : field.distance(a).distance;
}
FirstHit<float> first_hit(const SolidField& field, const Vec3f& a, const Vec3f& b, float margin) {
  return field.first_hit(a, b, margin);
}

/// The plane for a particle on its way from a to b, in the collider's frame. Continuous where the path is long: the surface
/// where it enters, or where it begins if that is within the thickness or inside, since the side that a particle is on is
/// the side it stays on. Else static: the closest point of the surface.
template <class Solid>
SurfacePlane surface_plane(const Solid& solid, const Vec3f& a, const Vec3f& b, float thickness, float h) {
  const SurfaceDistance<float> end = signed_distance(solid, b);
  const float path = length(b - a);
  if (!may_meet(solid, end, thickness, path)) return {};
  // From inside, out no faster than the cap; from outside, this is the thickness itself.
  const auto kept = [&](float start) { return min(thickness, start + largest_separation_speed * h); };
  if (path > 0.25f * thickness) {
    const FirstHit<float> hit = first_hit(solid, a, b, 0.5f * thickness);
    if (hit.hit) {
      const float height = hit.t > 0 ? thickness : kept(hit.distance);
      return {true, hit.normal, hit.point - hit.normal * hit.distance, dot(hit.normal, hit.point) - hit.distance + height};
    }
  }
  if (!(end.distance < thickness + path)) return {};
  const float height = kept(distance_before(solid, a, end, path));
  return {true, end.normal, b - end.normal * end.distance, dot(end.normal, b) - end.distance + height};
}

}  // namespace

namespace {

/// A box in a pose, grown.
BoundingBox<float> bounding_box(const SolidField& field, const Pose<float>& pose, float margin) {
  const BoxBounds box = field.bounds();
  Vec3f low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f};
  for (int i = 0; i < 8; ++i) {
    const Vec3f corner = to_world(pose, Vec3f{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                                              (i & 4) != 0 ? box.high.z : box.low.z});
    low = min(low, corner);
    high = max(high, corner);
  }
  const float grown = margin + 1e-6f * (largest(low) + largest(high));
  return {low - Vec3f{grown, grown, grown}, high + Vec3f{grown, grown, grown}};
}

/// Where a collider is at a time, and whether it moves at all.
template <class From, class MotionPose>
void move(const From& from, const PoseDrive* drive, const MotionPose& motion_pose, double time_before, double time_after,
          MovingCollider& to) {
  const auto pose = [&](double time) { return convert<float>(drive != nullptr ? drive->at(time) : motion_pose(time)); };
  to.before = pose(time_before);
  to.moves = drive != nullptr ? drive->moves() : from.motion.moves();
  to.after = to.moves ? pose(time_after) : to.before;
  to.thickness = from.thickness;
  to.static_friction = from.static_friction;
  to.kinetic_friction = from.kinetic_friction;
  to.restitution = from.restitution;
}

}  // namespace

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
    to->swept =
        merge(bounding_box(*to->field, to->before, to->thickness), bounding_box(*to->field, to->after, to->thickness));
    ++to;
  }
}

namespace {

/// A contact of particle i, appended where there is one.
void find_contact(const ContactSearch& search, int i, int number, float thickness, std::vector<Contact>& contacts) {
  const MovingCollider& collider = search.colliders[number];
  const AdvanceArguments& a = search.particles;
  const Record &x = a.positions[i], &d = a.displacements[i], &v = a.velocities[i];
  if (x.w == 0) return;
  const Vec3f position{x.x, x.y, x.z};
  const Vec3f to = to_local(collider.after, position + Vec3f{d.x, d.y, d.z});
  const Vec3f from = to_local(collider.before, position);
  const SurfacePlane plane = collider.field != nullptr ? surface_plane(*collider.field, from, to, thickness, a.h)
                                                       : surface_plane(collider.shape, from, to, thickness, a.h);
  if (!plane.found) return;
  Contact contact;
  contact.point = {i, i, i, i};
  contact.weight = contact.share = {1, 0, 0, 0};
  contact.thickness = thickness;
  contact.collider = number;
  contact.normal = rotate(collider.after.rotation, plane.normal);
  // The plane in the world: through the same point, at the same distance from it.
  const float above = plane.offset - dot(plane.normal, plane.point);
  contact.gap = dot(contact.normal, position - to_world(collider.after, plane.point)) - above;
  if (collider.moves)
    contact.surface_motion = to_world(collider.after, plane.point) - to_world(collider.before, plane.point);
  contact.static_friction = sqrt(search.object.static_friction * collider.static_friction);
  contact.kinetic_friction = sqrt(search.object.kinetic_friction * collider.kinetic_friction);
  contact.restitution = max(search.object.restitution, collider.restitution);
  const Record& r = a.remainders[i];
  contact.carried = {r.x, r.y, r.z};
  const Vec3f velocity = Vec3f{v.x, v.y, v.z} + (a.gravity_begun - a.gravity_step);  // before this substep's gravity
  contact.approach = dot(contact.normal, velocity - contact.surface_motion * a.inverse_h);
  contacts.push_back(contact);
}

/// Particles that need a closer look at a collider: all of the tile's where the collider moves, since its motion counts
/// too.
int find_near(const ContactSearch& search, const MovingCollider& collider, float thickness,
              std::vector<std::int32_t>& near) {
  const AdvanceArguments& a = search.particles;
  near.resize(a.last - a.first + batch_width);
  if (collider.moves || collider.field != nullptr) {
    for (int i = a.first; i < a.last; ++i) near[i - a.first] = i;
    return a.last - a.first;
  }
  // More than the rounding by which the two ways to a distance differ.
  const PointBounds& b = search.bounds;
  const float reach = max(largest(Vec3f{b.low.x, b.low.y, b.low.z}), largest(Vec3f{b.high.x, b.high.y, b.high.z}));
  const float slack = 1e-6f + 1e-5f * (reach + largest(collider.after.position) + thickness);
  return search.find_near(
      {a.positions, a.displacements, a.first, a.last, collider.shape, collider.after, thickness + slack}, near.data());
}

}  // namespace

namespace {

/// Primitives are met by everything.
bool meet(const CompiledObject& object, const MovingCollider& collider) {
  if (object.is_collider) return false;
  return collider.field == nullptr || ((object.groups & collider.mask) != 0 && (collider.groups & object.mask) != 0);
}

}  // namespace

void find_contacts(const ContactSearch& search, std::vector<std::int32_t>& near, std::vector<Contact>& contacts) {
  for (int c = 0; c < static_cast<int>(search.colliders.size()); ++c) {
    const MovingCollider& collider = search.colliders[c];
    if (!overlap(search.bounds, collider.swept, search.object.thickness) || !meet(search.object, collider)) continue;
    const float thickness = search.object.thickness + collider.thickness;
    const int count = find_near(search, collider, thickness, near);
    for (int k = 0; k < count; ++k) find_contact(search, near[k], c, thickness, contacts);
  }
}

void find_breaches(const ContactSearch& search, const std::vector<Contact>& known, std::vector<std::int32_t>& near,
                   std::vector<Contact>& contacts) {
  // Constraints move what they move by less than this beyond the bounds of the prediction.
  const PointBounds& b = search.bounds;
  const float margin =
      search.object.thickness + 0.1f * largest(Vec3f{b.high.x - b.low.x, b.high.y - b.low.y, b.high.z - b.low.z});
  const AdvanceArguments& a = search.particles;
  near.resize(a.last - a.first + batch_width);
  auto next = known.begin();
  const auto is_known = [&](int c, int particle) {
    const auto is_before = [&](const Contact& k) { return k.collider < c || (k.collider == c && k.point[0] < particle); };
    while (next != known.end() && is_before(*next)) ++next;
    return next != known.end() && next->collider == c && next->point[0] == particle;
  };
  for (int c = 0; c < static_cast<int>(search.colliders.size()); ++c) {
    const MovingCollider& collider = search.colliders[c];
    if (collider.field != nullptr || collider.shape.kind != ShapeKind::plane) continue;
    if (!overlap(b, collider.swept, margin) || !meet(search.object, collider)) continue;
    const int count =
        search.find_near({a.positions, a.displacements, a.first, a.last, collider.shape, collider.after, 0}, near.data());
    for (int k = 0; k < count; ++k) {
      if (is_known(c, near[k])) continue;
      const Record &x = a.positions[near[k]], &d = a.displacements[near[k]];
      const Vec3f end = to_local(collider.after, Vec3f{x.x + d.x, x.y + d.y, x.z + d.z});
      if (signed_distance(collider.shape, end).distance < 0) find_contact(search, near[k], c, 0, contacts);
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

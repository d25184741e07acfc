#include "solver/bodies/body_points.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "constraints/contact.h"
#include "geometry/convex_hull.h"
#include "math/functions.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

using namespace bodies;

/// The impulse at an arm from a body's centre that changes the velocity of its point against points of inverse mass `w` by `change`.
Vec3f impulse_for(const Vec3f& change, const BodyMotion& body, const Vec3f& arm, float w) {
  const float mass = w + body.inverse_mass;
  Vec3f column[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3f unit{axis == 0 ? 1.f : 0.f, axis == 1 ? 1.f : 0.f, axis == 2 ? 1.f : 0.f};
    column[axis] = unit * mass + cross(times(body.inverse_inertia, cross(arm, unit)), arm);
  }
  const Vec3f x = cross(column[1], column[2]), y = cross(column[2], column[0]), z = cross(column[0], column[1]);
  const float determinant = dot(column[0], x);
  if (!(determinant > 0)) return {};
  return Vec3f{dot(x, change), dot(y, change), dot(z, change)} * (1 / determinant);
}

/// The weighted place of a contact's points after the displacements so far.
Vec3f place_of(const Contact& c, const Record* positions, const Record* displacements) {
  return relative(c, positions) + relative(c, displacements);
}

constexpr int sides_of_round_solids = 32;

/// A closed mesh of a solid that is no primitive: its polyhedron, or a prism or pyramid of many sides.
TriangleMesh mesh_of(const ConvexShape& shape) {
  std::vector<Vec3f> points;
  if (shape.kind == ConvexShape::Kind::polyhedron) {
    points = shape.polyhedron->corners;
  } else {
    for (int i = 0; i < sides_of_round_solids; ++i) {
      const double angle = 6.283185307179586 * i / sides_of_round_solids;
      const auto x = shape.core_radius * static_cast<float>(cos(angle)),
                 z = shape.core_radius * static_cast<float>(sin(angle));
      points.push_back({x, -shape.half_length, z});
      if (shape.kind == ConvexShape::Kind::cylinder) points.push_back({x, shape.half_length, z});
    }
    if (shape.kind == ConvexShape::Kind::cone) points.push_back({0, shape.half_length, 0});
  }
  const auto hull = convex_hull(points);
  return hull ? TriangleMesh{hull->corners, hull->triangles()} : TriangleMesh{};
}

/// True if two solids are of one shape, so that they can share a distance grid.
bool are_alike(const ConvexShape& a, const ConvexShape& b) {
  return a.kind == b.kind && a.core_radius == b.core_radius && a.half_length == b.half_length &&
         a.polyhedron == b.polyhedron;
}

/// Boxes, balls and capsules as primitives; others are a plane, which no body is.
LocalShape primitive_of(const CompiledSolid& solid) {
  const ConvexShape& shape = solid.shape;
  if (solid.half_extents.x > 0) return {ShapeKind::box, solid.half_extents.x, solid.half_extents.y, solid.half_extents.z};
  if (shape.kind == ConvexShape::Kind::point) return {ShapeKind::sphere, shape.radius};
  if (shape.kind == ConvexShape::Kind::segment) return {ShapeKind::capsule, shape.radius, shape.half_length};
  return {};
}

/// A distance grid of a solid; null where it is too thin for one.
std::shared_ptr<const SolidField> field_of(const ConvexShape& shape) {
  try {
    return std::make_shared<SolidField>(DistanceGrid(measure_distances(mesh_of(shape), 0)));
  } catch (const Error&) {
    return nullptr;
  }
}

/// A primitive in the place of a solid that is too thin for a distance grid: a capsule if it is long, else the box around it.
LocalShape primitive_around(const ConvexShape& shape) {
  const float radius = shape.core_radius, half = shape.half_length;
  if (shape.kind != ConvexShape::Kind::polyhedron)
    return half > radius ? LocalShape{ShapeKind::capsule, radius, half - radius}
                         : LocalShape{ShapeKind::box, radius, half, radius};
  Vec3f reach{};
  for (const Vec3f& corner : shape.polyhedron->corners) reach = max(reach, abs(corner));
  return {ShapeKind::box, reach.x, reach.y, reach.z};
}

BoundingBox<float> box_around(const BoxBounds& box, const Posef& pose) {
  const Vec3f centre = to_world(pose, (box.low + box.high) * 0.5f), half = (box.high - box.low) * 0.5f;
  const Vec3f reach = abs(rotate(pose.rotation, Vec3f{half.x, 0, 0})) + abs(rotate(pose.rotation, Vec3f{0, half.y, 0})) +
                      abs(rotate(pose.rotation, Vec3f{0, 0, half.z}));
  const Vec3f grown = reach + reach * 1e-5f;
  return {centre - grown, centre + grown};
}

BoundingBox<float> merged(const BoundingBox<float>& a, const BoundingBox<float>& b) {
  return {min(a.low, b.low), max(a.high, b.high)};
}

Posef pose_of(const Record& position, const Record& orientation) { return {xyz(position), quaternion(orientation)}; }

}  // namespace

BodyPoints::BodyPoints(const Model& model, const std::vector<int>& objects, const std::vector<TouchedBody>& bodies,
                       const ContactRules& rules)
    : rules_(&rules), bodies_(bodies) {
  for (const int o : objects)
    if (!model.objects[at(o)].is_collider &&
        model.objects[at(o)].particles > static_cast<int>(model.objects[at(o)].bodies.bodies.size()))
      objects_.push_back(o);
  if (objects_.empty()) return;
  for (int task = 0; task < static_cast<int>(model.tiles().size()); ++task)
    if (std::binary_search(objects_.begin(), objects_.end(), model.tiles()[at(task)].object)) tasks_.push_back(task);
  of_task_.resize(tasks_.size());
  add_solids(model);
  for (const Solid& solid : solids_) body_of_solid_.push_back(solid.body);
  surfaces_ = SurfaceTiles(model, tasks_);
  loads_ = PointLoads(model, bodies_);
  std::vector<ConvexShape> shapes;
  for (const Solid& solid : solids_) shapes.push_back(solid.convex);
  passing_ = PassingFilter(shapes);
  std::vector<LocalShape> primitives;
  for (const Solid& solid : solids_)
    if (solid.field == nullptr) primitives.push_back(solid.shape);
  for (const int o : objects_) shapes_.prepare(model, o, primitives);
}

void BodyPoints::add_solids(const Model& model) {
  struct Known {
    ConvexShape shape;
    std::shared_ptr<const SolidField> field;
  };
  std::vector<Known> known;
  std::size_t next = 0;  // solids of an object are in the order of its bodies
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    const std::vector<CompiledSolid>& all = model.objects[at(bodies_[at(b)].object)].bodies.solids;
    if (bodies_[at(b)].body == 0) next = 0;
    for (; next < all.size() && all[next].body == bodies_[at(b)].body; ++next) {
      const CompiledSolid& from = all[next];
      Solid solid{b, primitive_of(from), convert<float>(from.pose), nullptr, 0, from.shape};
      if (solid.shape.kind == ShapeKind::plane) {
        auto same =
            std::find_if(known.begin(), known.end(), [&](const Known& k) { return are_alike(k.shape, from.shape); });
        if (same == known.end()) {
          same = known.insert(same, {from.shape, field_of(from.shape)});
        }
        solid.field = same->field;
        if (solid.field == nullptr) solid.shape = primitive_around(from.shape);
        solid.margin = from.shape.radius;
      }
      solids_.push_back(solid);
    }
  }
}

bool BodyPoints::meets(const Model& model, const Contact& contact) const {
  const TouchedBody& body = bodies_[at(solids_[at(contact.collider)].body)];
  const int object = model.object_of(contact.point[0]);
  if (!rules_->meet(object, body.object)) return false;
  if (object != body.object) return true;
  const std::vector<std::pair<int, int>>& attached = model.objects[at(object)].bodies.attached;
  return std::none_of(contact.point.begin(), contact.point.end(), [&](int point) {
    return std::binary_search(attached.begin(), attached.end(), std::pair{point - model.first[at(object)], body.body});
  });
}

void BodyPoints::begin_frame(const Substep& s) {
  contacts_.clear();
  impulses_.clear();
  passing_.begin_frame();
  surfaces_.begin_frame();
  keep_poses(s);
}

void BodyPoints::keep_poses(const Substep& s) {
  if (!has_any()) return;
  poses_.clear();
  for (const TouchedBody& body : bodies_)
    poses_.push_back(pose_of(s.state.positions[at(body.particle)], s.state.frames.orientations[at(body.frame)]));
}

void BodyPoints::place_solids(const Substep& s) {
  moving_.clear();
  for (const Solid& solid : solids_) {
    const TouchedBody& body = bodies_[at(solid.body)];
    const CompiledObject& object = s.model.objects[at(body.object)];
    const Record to = plus(s.state.positions[at(body.particle)], xyz(s.work.displacements[at(body.particle)]));
    MovingCollider& moving = moving_.emplace_back();
    moving.shape = solid.shape;
    moving.field = solid.field.get();
    moving.groups = object.groups;
    moving.mask = object.mask;
    moving.before = compose(poses_[at(solid.body)], solid.pose);
    moving.after = compose(pose_of(to, s.state.frames.orientations[at(body.frame)]), solid.pose);
    moving.moves = true;
    moving.thickness = solid.margin;
    moving.static_friction = object.static_friction;
    moving.kinetic_friction = object.kinetic_friction;
    moving.restitution = object.restitution;
    const auto box = [&](const Posef& pose) {
      return solid.field == nullptr ? bounding_box(solid.shape, pose, solid.margin)
                                    : box_around(solid.field->bounds(), pose);
    };
    moving.swept = merged(box(moving.before), box(moving.after));
  }
}

void BodyPoints::detect(Substep& s) {
  place_solids(s);
  loads_.note_pressed(s, {contacts_, impulses_, body_of_solid_});
  {
    const Stopwatch stopwatch(s.context.executor.timings(), "bodies: points");
    surfaces_.update(s, moving_, true);
  }
  near_.clear();
  for (const SurfaceTile& tile : surfaces_.tiles()) near_.push_back(&tile.solids);
  s.context.executor.parallel_for("bodies: points", static_cast<int>(tasks_.size()), [&](int i) {
    const int task = tasks_[at(i)], number = s.model.tiles()[at(task)].object;
    std::vector<Contact>& found = of_task_[at(i)];
    found.clear();
    const AdvanceArguments a = particles(s, task);
    TileScratch& scratch = s.work.tiles[at(task)];
    const SurfaceTile& tile = surfaces_.tiles()[at(i)];
    find_contacts(
        {object_of(s, task), a, scratch.bounds, moving_, s.kernels.find_near, s.kernels.contacts.make_point_contacts,
         &tile.solids, &tile.cells, s.model.first[at(number)], tile.fastest},
        scratch.near, found);
    for (Contact& contact : found)
      for (std::int32_t& point : contact.point) point += s.model.first[at(number)];
  });
  contacts_.clear();
  for (const std::vector<Contact>& found : of_task_) contacts_.insert(contacts_.end(), found.begin(), found.end());
  shapes_.detect(s.context.executor,
                 {s.model, moving_, [&](int task) { return particles(s, task); },
                  [&](int task) -> const PointBounds& { return s.work.tiles[at(task)].bounds; }, &tasks_, &near_},
                 of_shapes_);
  contacts_.insert(contacts_.end(), of_shapes_.begin(), of_shapes_.end());
  find_swept(s, contacts_);
  std::erase_if(contacts_, [&](const Contact& c) { return !meets(s.model, c); });
  impulses_.assign(contacts_.size(), 0.f);
  note_progress(s);
}

void BodyPoints::note_progress(const Substep& s) {
  progress_.assign(bodies_.size(), {});
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    progress_[b].displacement = xyz(s.work.displacements[at(bodies_[b].particle)]);
    const std::size_t frame = at(bodies_[b].frame);
    progress_[b].rotation = xyz(s.work.frames.predicted[frame]) + xyz(s.work.frames.corrections[frame]);
  }
}

void BodyPoints::find_swept(const Substep& s, std::vector<Contact>& contacts) {
  swept_.detect(
      s, surfaces_, moving_, [&](const Contact& c) { return meets(s.model, c); }, contacts);
}

void BodyPoints::begin_pass(const Substep& s) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Progress& p = progress_[b];
    const std::size_t frame = at(bodies_[b].frame);
    p.moved = p.moved_before = xyz(s.work.displacements[at(bodies_[b].particle)]) - p.displacement;
    p.turned = p.turned_before = (xyz(s.work.frames.predicted[frame]) + xyz(s.work.frames.corrections[frame])) - p.rotation;
  }
}

void BodyPoints::end_pass(Substep& s) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Progress& p = progress_[b];
    const Vec3f turned = p.turned - p.turned_before;
    Record& d = s.work.displacements[at(bodies_[b].particle)];
    d = plus(d, p.moved - p.moved_before);
    if (turned == Vec3f{}) continue;
    const std::size_t frame = at(bodies_[b].frame);
    s.work.frames.corrections[frame] = plus(s.work.frames.corrections[frame], turned);
    turn(turned, s.state.frames.orientations[frame]);
  }
}

/// `yields`: the points move too; else only a body that is not fixed.
void BodyPoints::project(Substep& s, const BodyMotion& motion, Contact& c, bool yields) {
  const int number = solids_[at(c.collider)].body;
  const Record *positions = s.state.positions.data(), *displacements = s.work.displacements.data();
  Progress& p = progress_[at(number)];
  const Vec3f centre = (xyz(positions[bodies_[at(number)].particle]) + p.displacement) + p.moved;
  const Vec3f arm = place_of(c, positions, displacements) - centre;
  ContactSums<float> sums{c.friction, c.push};
  const Vec3f moved = relative(c, displacements) - (p.moved + cross(p.turned, arm));
  const auto [along, across] = project_contact(values_of(c), moved, sums);
  if (!(sums.push > 0)) return;
  c.friction = sums.friction;
  c.push = sums.push;
  const float w = yields || !(motion.inverse_mass > 0) ? inverse_mass_of(c, positions) : 0;
  const Vec3f impulse = impulse_for(along + across, motion, arm, w);
  move_sides(c, impulse * w, s.work.displacements.data());
  impulses_[static_cast<std::size_t>(&c - contacts_.data())] += dot(c.normal, impulse) / s.h;
  p.moved -= impulse * motion.inverse_mass;
  p.turned -= times(motion.inverse_inertia, cross(arm, impulse));
}

void BodyPoints::project(Substep& s, const std::vector<BodyMotion>& motions, const std::vector<char>* of) {
  if (contacts_.empty()) return;
  const Stopwatch stopwatch(s.context.executor.timings(), "solve: bodies and points");
  begin_pass(s);
  for (Contact& contact : contacts_)
    if (of == nullptr || (*of)[at(s.model.object_of(contact.point[0]))] != 0)
      project(s, motions[at(solids_[at(contact.collider)].body)], contact);
  end_pass(s);
}

void BodyPoints::respond(Substep& s, const std::vector<BodyMotion>& motions, FunctionRef<Vec3f(int object)> gravity) {
  const float slow = 2 * length(s.model.gravity) * s.h;
  Record* velocities = s.state.velocities.data();
  for (const Contact& c : contacts_) {
    if (!(c.push > 0)) continue;
    const int number = solids_[at(c.collider)].body;
    const TouchedBody& body = bodies_[at(number)];
    const BodyMotion& motion = motions[at(number)];
    Record& spin = s.state.frames.angular_velocities[at(body.frame)];
    const Quatf q = quaternion(s.state.frames.orientations[at(body.frame)]);
    const Vec3f arm = relative(c, s.state.positions.data()) - xyz(s.state.positions[at(body.particle)]);
    const Vec3f missing = gravity(s.model.object_of(c.point[0])),
                own_missing = motion.inverse_mass > 0 ? gravity(body.object) : Vec3f{};
    const Vec3f of_body = (xyz(velocities[body.particle]) + own_missing) + cross(rotate(q, xyz(spin)), arm);
    const float separating = dot(c.normal, (relative(c, velocities) + missing) - of_body);
    const float wanted = separation_after(separating, c.approach, c.restitution, slow, true);
    const float w = inverse_mass_of(c, s.state.positions.data());
    const Vec3f turning = cross(arm, c.normal);
    const float mass = w + motion.inverse_mass + dot(turning, times(motion.inverse_inertia, turning));
    if (!(mass > 0)) continue;
    const Vec3f impulse = c.normal * ((wanted - separating) / mass);
    move_sides(c, impulse * w, velocities);
    velocities[body.particle] = plus(velocities[body.particle], -impulse * motion.inverse_mass);
    spin = plus(spin, rotate(conjugate(q), -times(motion.inverse_inertia, cross(arm, impulse))));
  }
}

void BodyPoints::log_contacts(const Substep& s, ContactLog& log) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    if (!(c.push > 0) || !(impulses_[i] > 0)) continue;
    const Vec3d place = convert<double>(relative(c, s.state.positions.data()));
    add_push({s.model.object_of(c.point[0]), bodies_[at(solids_[at(c.collider)].body)].object,
              static_cast<double>(impulses_[i]), c.normal, place},
             log);
  }
}

int BodyPoints::contacts_that_press() const {
  return static_cast<int>(std::count_if(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.push > 0; }));
}

}  // namespace pliant

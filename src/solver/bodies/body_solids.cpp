#include "solver/bodies/body_solids.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "geometry/convex_hull.h"
#include "math/functions.h"
#include "model/surface_velocity.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

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
  if (solid.half_extents.x > 0)
    return {ShapeKind::box, solid.half_extents.x, solid.half_extents.y, solid.half_extents.z};
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

/// A primitive in the place of a solid that is too thin for a distance grid: a capsule if it is long, else the box
/// around it.
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
  const Vec3f reach = abs(rotate(pose.rotation, Vec3f{half.x, 0, 0})) +
                      abs(rotate(pose.rotation, Vec3f{0, half.y, 0})) + abs(rotate(pose.rotation, Vec3f{0, 0, half.z}));
  const Vec3f grown = reach + reach * 1e-5f;
  return {centre - grown, centre + grown};
}

/// What the scene says of the pairs of an object of bodies with others; distances are measured from a field inside a
/// margin.
std::vector<NamedPair> named_with(const Model& model, const std::string& object, float margin) {
  std::vector<NamedPair> named;
  for (const PairProperties& pair : model.pairs) {
    if (pair.first != object && pair.second != object) continue;
    NamedPair& one = named.emplace_back(NamedPair{pair.first == object ? pair.second : pair.first, pair});
    if (pair.thickness) one.said.thickness = *pair.thickness + margin;
  }
  return named;
}

Posef pose_of(const Record& position, const Record& orientation) { return {xyz(position), quaternion(orientation)}; }

}  // namespace

std::vector<ConvexShape> BodySolids::convex_shapes() const {
  std::vector<ConvexShape> shapes;
  for (const Solid& solid : solids_) shapes.push_back(solid.convex);
  return shapes;
}

std::vector<LocalShape> BodySolids::primitives() const {
  std::vector<LocalShape> primitives;
  for (const Solid& solid : solids_)
    if (solid.field == nullptr) primitives.push_back(solid.shape);
  return primitives;
}

void BodySolids::add_solids(const Model& model) {
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
      solid.named = named_with(model, model.objects[at(bodies_[at(b)].object)].name, solid.margin);
      solids_.push_back(solid);
      body_of_solid_.push_back(b);
    }
  }
}

bool BodySolids::meets(const Model& model, const Contact& contact) const {
  const TouchedBody& body = body_of(contact);
  const int object = model.object_of(contact.point[0]);
  if (!rules_->meet(object, body.object)) return false;
  if (object != body.object) return true;
  const std::vector<std::pair<int, int>>& attached = model.objects[at(object)].bodies.attached;
  return std::none_of(contact.point.begin(), contact.point.end(), [&](int point) {
    return std::binary_search(attached.begin(), attached.end(), std::pair{point - model.first[at(object)], body.body});
  });
}

void BodySolids::keep_poses(const Substep& s) {
  poses_.clear();
  for (const TouchedBody& body : bodies_)
    poses_.push_back(pose_of(s.state.positions[at(body.particle)], s.state.frames.orientations[at(body.frame)]));
}

void BodySolids::place(const Substep& s) {
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
    moving.named = solid.named.empty() ? nullptr : &solid.named;
    const Vec3f sliding = surface_velocity_of_body(s.model, s.work.control, body.object, body.body);
    if (sliding != Vec3f{})
      moving.slide = rotate(quaternion(s.state.frames.orientations[at(body.frame)]), sliding) * s.h;
    const auto box = [&](const Posef& pose) {
      return solid.field == nullptr ? bounding_box(solid.shape, pose, solid.margin)
                                    : box_around(solid.field->bounds(), pose);
    };
    moving.swept = merge(box(moving.before), box(moving.after));
  }
}

}  // namespace pliant

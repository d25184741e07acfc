// Leaves out the places of a fill that lie in what is solid in a scene.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "collision/broad/tree.h"
#include "collision/fields/collider_pose.h"
#include "collision/fields/solid_fields.h"
#include "geometry/convex_distance.h"
#include "math/motion.h"
#include "matter/closed_query.h"
#include "matter/leave_out.h"
#include "model/compiled_bodies.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"
#include "pliant/liquid.h"

namespace pliant {

namespace {

/// A lattice that touches a wall overlaps it by rounding: by less than this share of the radius.
constexpr float touching = 0.01f;

float reach_of(const LeaveOutOptions& by) { return by.radius * (1 - touching); }

/// A box, ball, capsule or half-space, `margin` thicker [m].
PlacedSolid placed_solid(const std::string& name, const LocalShape& shape, const Posed& pose, float margin,
                         float reach) {
  PlacedSolid solid{&name, {}, [=](const Vec3f& p) {
                      const Vec3d local = to_local(pose, convert<double>(p));
                      return signed_distance(shape, local).distance < static_cast<double>(margin + reach);
                    }};
  if (shape.kind == ShapeKind::plane) return solid;
  const BoundingBox<float> box = bounding_box(shape, convert<float>(pose), margin);
  solid.box = BoxBounds{box.low, box.high};
  return solid;
}

/// A cylinder, cone or hull.
PlacedSolid placed_solid(const std::string& name, const SolidShape& shape, const Posed& pose, float reach) {
  auto polyhedra = std::make_shared<std::vector<Polyhedron>>();
  polyhedra->reserve(1);  // the shape points into it
  const ConvexShape convex = convex_shape_of(shape, *polyhedra);
  Vec3d low{}, high{};
  const Quatd back = conjugate(pose.rotation);
  const auto farthest = [&](const Vec3d& axis) {
    return dot(axis, to_world(pose, support(convex, rotate(back, axis)))) + static_cast<double>(convex.radius);
  };
  high = {farthest({1, 0, 0}), farthest({0, 1, 0}), farthest({0, 0, 1})};
  low = {-farthest({-1, 0, 0}), -farthest({0, -1, 0}), -farthest({0, 0, -1})};
  const auto overlaps = [=](const Vec3f& p) {
    const Posed at{to_local(pose, convert<double>(p)), {}};
    const auto most = static_cast<double>(reach);
    return polyhedra != nullptr && convex_distance(convex, ConvexShape{}, at, most).separation < most;
  };
  return {&name, BoxBounds{convert<float>(low), convert<float>(high)}, overlaps};
}

}  // namespace

void add_solids_of_body(const Object& object, const ObjectBody& body, float reach, std::vector<PlacedSolid>& solids) {
  const Posed centre{convert<double>(object.positions[static_cast<std::size_t>(body.particle)]),
                     normalise(convert<double>(object.frames[static_cast<std::size_t>(body.frame)].orientation))};
  for (const Solid& solid : body.solids) {
    const Posed pose =
        compose(centre, Posed{convert<double>(solid.position), normalise(convert<double>(solid.rotation))});
    if (const auto* ball = std::get_if<Sphere>(&solid.shape))
      solids.push_back(placed_solid(object.name, local_shape(*ball), pose, 0, reach));
    else if (const auto* capsule = std::get_if<Capsule>(&solid.shape))
      solids.push_back(placed_solid(object.name, local_shape(*capsule), pose, 0, reach));
    else if (const auto* box = std::get_if<Box>(&solid.shape))
      solids.push_back(placed_solid(object.name, local_shape(*box), pose, 0, reach));
    else
      solids.push_back(placed_solid(object.name, solid.shape, pose, reach));
  }
}

namespace {

void add_bodies(const Object& object, float reach, std::vector<PlacedSolid>& solids) {
  for (const ObjectBody& body : object.bodies) add_solids_of_body(object, body, reach, solids);
}

/// What a closed mesh encloses; nothing if it is open or damaged.
std::shared_ptr<const MeshQuery> closed_mesh(const std::vector<Vec3f>& positions,
                                             const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return nullptr;
  try {
    return std::make_shared<MeshQuery>(query_of_closed({positions, triangles}));
  } catch (const Error&) {
    return nullptr;
  }
}

/// Whether a closed surface may hold particles: one that has all places of a fill inside is their vessel.
enum class Closed { solid, vessel_if_all_are_inside };

void add_closed(const std::string& name, const std::shared_ptr<const MeshQuery>& mesh, Closed kind, float reach,
                const std::vector<Vec3f>& places, std::vector<PlacedSolid>& solids) {
  if (mesh == nullptr) return;
  const auto is_inside = [&](const Vec3f& p) { return mesh->is_inside(p); };
  if (kind == Closed::vessel_if_all_are_inside && std::all_of(places.begin(), places.end(), is_inside)) return;
  solids.push_back({&name, mesh->bounds(), [mesh, reach](const Vec3f& p) {
                      return mesh->is_inside(p) || mesh->closest(p, reach).triangle >= 0;
                    }});
}

/// Terrain; nothing if the mesh is none, which a World says.
std::shared_ptr<const SolidField> terrain_of(const MeshCollider& collider) {
  try {
    return solid_field_of(collider);
  } catch (const Error&) {
    return nullptr;
  }
}

void add_mesh(const MeshCollider& collider, float reach, const std::vector<Vec3f>& places,
              std::vector<PlacedSolid>& solids) {
  const Posed pose = pose_at(collider.motion, 0);
  const float far = reach + collider.thickness;
  if (collider.as == MeshCollider::As::heightfield) {
    const std::shared_ptr<const SolidField> field = terrain_of(collider);
    if (field == nullptr) return;
    solids.push_back({&collider.name, {}, [=](const Vec3f& p) {
                        return field->distance(convert<float>(to_local(pose, convert<double>(p)))).distance < far;
                      }});
    return;
  }
  std::vector<Vec3f> positions = collider.frames.empty() ? collider.mesh.positions : collider.frames.front().positions;
  for (Vec3f& p : positions) p = convert<float>(to_world(pose, convert<double>(p)));
  const Closed kind = collider.as == MeshCollider::As::distance_grid ? Closed::solid : Closed::vessel_if_all_are_inside;
  add_closed(collider.name, closed_mesh(positions, collider.mesh.triangles), kind, far, places, solids);
}

bool can_overlap(const LeaveOutOptions& a, std::uint32_t groups, std::uint32_t mask) {
  return (a.groups & mask) != 0 && (groups & a.mask) != 0;
}

std::vector<PlacedSolid> solids_of(const Scene& scene, const LeaveOutOptions& by, const std::vector<Vec3f>& places,
                                   MeshesToo meshes) {
  const float reach = reach_of(by);
  std::vector<PlacedSolid> solids;
  for (const Collider& collider : scene.colliders)
    solids.push_back(placed_solid(collider.name, local_shape(collider.shape), collider_pose(collider, 0),
                                  collider.thickness, reach));
  for (const MeshCollider& collider : scene.mesh_colliders)
    if (meshes == MeshesToo::yes && can_overlap(by, collider.groups, collider.mask))
      add_mesh(collider, reach, places, solids);
  for (const Object& object : scene.objects) {
    if (!by.collides || !object.collides || !can_overlap(by, object.groups, object.mask)) continue;
    add_bodies(object, reach, solids);
    if (meshes == MeshesToo::no) continue;
    const Closed kind = is_soft_body(object) ? Closed::solid : Closed::vessel_if_all_are_inside;
    add_closed(object.name, closed_mesh(object.positions, object.triangles), kind, reach, places, solids);
  }
  return solids;
}

/// Finds the first solid that a place overlaps.
class SolidSearch {
 public:
  SolidSearch(std::vector<PlacedSolid> solids, float reach) : solids_(std::move(solids)), reach_(reach) {
    std::vector<BoxBounds> boxes;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if (solids_[i].box) boxes.push_back(*solids_[i].box);
      (solids_[i].box ? boxed_ : endless_).push_back(i);
    }
    if (!boxes.empty()) tree_.build(boxes);
  }

  /// The name of a solid that a place overlaps; null if there is none.
  const std::string* at(const Vec3f& p) const {
    for (const std::size_t i : endless_)
      if (solids_[i].overlaps(p)) return solids_[i].name;
    std::size_t found = solids_.size();
    const auto visit = [&](int box) {
      const std::size_t i = boxed_[static_cast<std::size_t>(box)];
      if (i < found && solids_[i].overlaps(p)) found = i;
    };
    if (!boxed_.empty()) tree_.query(BoxBounds::of(&p, 1).grown(reach_ + rounding(p)), visit);
    return found < solids_.size() ? solids_[found].name : nullptr;
  }

 private:
  /// Boxes of solids are in float.
  static float rounding(const Vec3f& p) { return 1e-5f * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + 1); }

  std::vector<PlacedSolid> solids_;
  float reach_;
  std::vector<std::size_t> boxed_, endless_;
  Tree<BoxBounds> tree_;
};

}  // namespace

namespace {

void require_radius(const LeaveOutOptions& options) {
  if (!(options.radius > 0) || !std::isfinite(options.radius))
    throw Error({.element = "radius"}, "is " + std::to_string(options.radius), "give a positive, finite radius [m]");
}

void count(const std::string& name, std::vector<PlacesInSolid>& counts) {
  const auto known =
      std::find_if(counts.begin(), counts.end(), [&](const PlacesInSolid& one) { return one.in == name; });
  if (known == counts.end())
    counts.push_back({name, 1});
  else
    ++known->places;
}

}  // namespace

std::vector<PlacesInSolid> find_in_solids(const std::vector<Vec3f>& places, const Scene& scene,
                                          const LeaveOutOptions& options, MeshesToo meshes) {
  require_radius(options);
  const SolidSearch search(solids_of(scene, options, places, meshes), reach_of(options));
  std::vector<PlacesInSolid> found;
  for (const Vec3f& p : places)
    if (const std::string* const name = search.at(p)) count(*name, found);
  return found;
}

std::vector<PlacesInSolid> leave_out_solids(std::vector<Vec3f>& places, const Scene& scene,
                                            const LeaveOutOptions& options) {
  require_radius(options);
  const SolidSearch search(solids_of(scene, options, places, MeshesToo::yes), reach_of(options));
  std::vector<PlacesInSolid> left_out;
  std::erase_if(places, [&](const Vec3f& p) {
    const std::string* const name = search.at(p);
    if (name != nullptr) count(*name, left_out);
    return name != nullptr;
  });
  return left_out;
}

}  // namespace pliant

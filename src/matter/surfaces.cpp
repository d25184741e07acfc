#include "matter/surfaces.h"

#include <algorithm>

#include "model/carrier.h"

namespace pliant {

namespace {

void add(Surfaces& all, Surfaces::Part part, const std::vector<Vec3f>& places, const std::vector<Triangle>& faces) {
  const int first = part.first = static_cast<int>(all.positions.size());
  part.first_triangle = static_cast<int>(all.triangles.size());
  all.parts.push_back(std::move(part));
  all.positions.insert(all.positions.end(), places.begin(), places.end());
  for (const auto& [a, b, c] : faces) all.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

int Surfaces::part_of(int vertex) const {
  const auto after =
      std::upper_bound(parts.begin(), parts.end(), vertex, [](int v, const Part& part) { return v < part.first; });
  return static_cast<int>(after - parts.begin()) - 1;
}

int Surfaces::end_of(int part) const {
  const auto next = static_cast<std::size_t>(part) + 1;
  return next < parts.size() ? parts[next].first : static_cast<int>(positions.size());
}

bool Surfaces::meet(int a, int b) const {
  const Part &p = parts[a], &q = parts[b];
  if (a == b) return p.self;
  const bool masks = (p.groups & q.mask) != 0 && (q.groups & p.mask) != 0;
  return masks && !(p.is_collider && q.is_collider) && ((p.collides && q.collides) || p.is_collider || q.is_collider);
}

std::string Surfaces::name(int part) const {
  return (parts[part].is_collider ? "collider '" : "object '") + parts[part].name + "'";
}

std::vector<Triangle> Surfaces::triangles_of(int part) const {
  const auto next = static_cast<std::size_t>(part) + 1;
  const int first = parts[part].first,
            end = next < parts.size() ? parts[next].first_triangle : static_cast<int>(triangles.size());
  std::vector<Triangle> out;
  for (int t = parts[part].first_triangle; t < end; ++t) {
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(t)];
    out.push_back({a - first, b - first, c - first});
  }
  return out;
}

std::vector<Vec3f> positions_at_start(const MeshCollider& collider) {
  if (collider.frames.empty() && !collider.motion.moves()) return collider.mesh.positions;
  Carrier carrier{collider.motion, collider.mesh.positions, {}, {}, collider.repeat_frames};
  for (const MeshFrame& frame : collider.frames) {
    carrier.times.push_back(frame.time);
    carrier.frames.push_back(frame.positions);
  }
  const CarrierPose pose(carrier, 0);
  std::vector<Vec3f> places;
  for (std::size_t i = 0; i < carrier.rest.size(); ++i)
    places.push_back(convert<float>(pose.place(static_cast<int>(i))));
  return places;
}

Surfaces surfaces_of(const Scene& scene) {
  Surfaces all;
  for (const Object& o : scene.objects)
    add(all, {o.name, o.self_collision, o.collides, false, o.groups, o.mask}, o.positions, o.triangles);
  for (const MeshCollider& c : scene.mesh_colliders)
    if (c.as == MeshCollider::As::triangles)
      add(all, {c.name, false, true, true, c.groups, c.mask}, positions_at_start(c), c.mesh.triangles);
  return all;
}

}  // namespace pliant

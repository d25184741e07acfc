#include "collision/narrow/shape_contacts.h"

#include <algorithm>
#include <cstring>

#include "collision/narrow/axes.h"
#include "geometry/shape_closest.h"
#include "math/record.h"
#include "math/wide.h"

namespace pliant {

namespace {

// ---------------------------------------------------------------- four numbers at a time

Quad least(const Quad& a, const Quad& b) { return a < b ? a : b; }
Quad most(const Quad& a, const Quad& b) { return a > b ? a : b; }
Quad quad(const Vec3f& v) { return Quad{v.x, v.y, v.z, 0}; }

/// A particle's position and predicted displacement, from velocities: constraints may have changed displacements
/// already.
struct Prediction {
  Quad position, displacement;
  Prediction(const AdvanceArguments& a, const Quad& gravity, int i) : position(load_quad(&a.positions[i])) {
    const Quad gained = position[3] > 0 ? gravity : Quad{};
    displacement = load_quad(&a.remainders[i]) + (load_quad(&a.velocities[i]) + gained) * a.h;
  }
};

// ---------------------------------------------------------------- culling of elements

/// Returns false if all vertices of an element are beyond one side of the collider, or over the same face of a box;
/// there the vertices are closest.
template <std::size_t n>
bool may_meet(const std::array<int, n>& vertex, const std::uint16_t* codes) {
  int common = codes[vertex[0]];
  for (std::size_t i = 1; i < n; ++i) common &= codes[vertex[i]];
  return common == 0;
}

// ---------------------------------------------------------------- clusters

using SweptBox = BoundingBox<float>;

bool overlap(const SweptBox& a, const SweptBox& b, float margin) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z) <= margin;
}

SweptBox box_of(const PointBounds& bounds) { return {xyz(bounds.low), xyz(bounds.high)}; }

/// Loads the beginning of an array that is read soon; the processor foresees the rest.
template <class T>
void prefetch(const std::vector<T>& array) {
  constexpr std::size_t lines = 3, line = 64;
  for (std::size_t i = 0; i < lines; ++i) __builtin_prefetch(reinterpret_cast<const char*>(array.data()) + i * line);
}

/// Computes the swept box of each cluster.
void measure_clusters(const TileElements& tile, const AdvanceArguments& a, ShapeContactScratch& scratch) {
  scratch.boxes.clear();
  scratch.paths.clear();
  const Quad gravity = quad(a.gravity_begun), none{};
  for (const ElementCluster& cluster : tile.clusters) {
    Quad low = none + 3e38f, high = -low, down = none, up = none;
    if (&cluster != &tile.clusters.back()) prefetch((&cluster + 1)->vertices);
    for (const int v : cluster.vertices) {
      const Prediction p(a, gravity, v);
      const Quad to = p.position + p.displacement;
      low = least(low, least(p.position, to));
      high = most(high, most(p.position, to));
      down = least(down, p.displacement);
      up = most(up, p.displacement);
    }
    const Quad farthest = most(-down, up);
    scratch.boxes.push_back({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}});
    scratch.paths.push_back(farthest[0] + farthest[1] + farthest[2]);
  }
}

/// A collider with its frames at the substep's start and end.
struct ColliderFrames {
  const MovingCollider& collider;
  Axes before, after;

  explicit ColliderFrames(const MovingCollider& of) : collider(of), before(of.before), after(of.after) {}

  /// Returns false if the elements in a box cannot come within `margin`, or if they lie over a single face of a box
  /// collider.
  bool may_meet(const SweptBox& box, float margin) const {
    if (!overlap(box, collider.swept, margin)) return false;
    if (collider.moves) return true;
    const LocalShape& shape = collider.shape;
    const Vec3f e = (box.high - box.low) * 0.5f, centre = after.to_local(box.low + e);
    if (shape.kind != ShapeKind::box) return signed_distance(shape, centre).distance - length(e) <= margin;
    const Vec3f half = half_sides<float>(shape), extent = after.extent(e);
    const Vec3f nearest = abs(centre) - extent, farthest = abs(centre) + extent, outside = nearest - half;
    if (max(max(outside.x, outside.y), outside.z) > margin) return false;
    const bool in_x = farthest.x <= half.x, in_y = farthest.y <= half.y, in_z = farthest.z <= half.z;
    return !((in_y && in_z && nearest.x > 0) || (in_x && in_z && nearest.y > 0) || (in_x && in_y && nearest.z > 0));
  }
};

/// The matrix of Axes, stored by columns; to_local does the same products and sums in the same order.
struct Columns {
  Quad x, y, z, origin;
  explicit Columns(const Axes& a)
      : x{a.x.x, a.y.x, a.z.x, 0}, y{a.x.y, a.y.y, a.z.y, 0}, z{a.x.z, a.y.z, a.z.z, 0}, origin(quad(a.origin)) {}

  Quad to_local(const Quad& p) const {
    const Quad d = p - origin;
    return x * d[0] + y * d[1] + z * d[2];
  }
};

/// Four lane masks: a lane is true if all its bits are set.
typedef std::int32_t QuadMask __attribute__((vector_size(16)));

/// Bits 0 to 5: the sides of a box that a point is beyond. `above` and `below` hold one lane for each axis.
int sides_of(const QuadMask& above, const QuadMask& below) {
  const QuadMask bits = (above & QuadMask{1, 4, 16, 0}) | (below & QuadMask{2, 8, 32, 0});
  return bits[0] | bits[1] | bits[2];
}

/// Computes outcodes of vertices. Bits 0 to 5: the sides of the collider's grown box that the vertex is beyond on its
/// whole path. Bits 6 to 11: the face of a box collider that the whole path is over.
struct Outcoder {
  Quad half;
  float thickness;
  bool is_box;

  std::uint16_t operator()(const Quad& from, const Quad& to) const {
    const Quad path = most(to - from, from - to), grown = half + (thickness + max(path[0], max(path[1], path[2])));
    int code = sides_of((from > grown) & (to > grown), (from < -grown) & (to < -grown));
    if (is_box) {
      const int over = sides_of(from > half, from < -half);
      const bool is_one = over != 0 && (over & (over - 1)) == 0;
      if (is_one && over == sides_of(to > half, to < -half)) code |= over << 6;
    }
    return static_cast<std::uint16_t>(code);
  }
};

/// Bounds over the paths of a cluster's vertices: a box around them, and the largest length [m].
struct ClusterWays {
  SweptBox box;
  float longest;
};

/// Computes the paths and outcodes of a cluster's vertices in the collider's frame. Returns the bounds of the paths.
ClusterWays enter_frame(const Meeting& m, const ColliderFrames& frames, ShapeContactScratch& scratch) {
  const LocalShape& shape = m.collider.shape;
  const Outcoder outcode{quad(half_sides<float>(shape)), m.thickness, shape.kind == ShapeKind::box};
  const Columns before(frames.before), after(frames.after);
  const Quad gravity = quad(m.particles.gravity_begun);
  Quad low = Quad{} + 3e38f, high = -low, paths{};
  const std::size_t count = m.cluster.vertices.size();
  scratch.ways.resize(count);
  scratch.outcodes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Prediction p(m.particles, gravity, m.cluster.vertices[i]);
    const Quad from = before.to_local(p.position), to = after.to_local(p.position + p.displacement);
    low = least(low, least(from, to));
    high = most(high, most(from, to));
    paths = most(paths, most(to - from, from - to));
    const Quad way[2] = {from, to};
    static_assert(sizeof way == sizeof(VertexWay));
    std::memcpy(static_cast<void*>(&scratch.ways[i]), way, sizeof way);
    scratch.outcodes[i] = outcode(from, to);
  }
  return {{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, length(Vec3f{paths[0], paths[1], paths[2]})};
}

void find_cluster_contacts(const Meeting& m, const ColliderFrames& frames, ShapeContactScratch& scratch) {
  prefetch(m.cluster.edges);
  prefetch(m.cluster.triangles);
  const ClusterWays ways = enter_frame(m, frames, scratch);
  const std::uint16_t* codes = scratch.outcodes.data();
  for (const auto& edge : m.cluster.edges)
    if (may_meet(edge, codes)) find_edge_contacts(m, edge, scratch.contacts);
  const Features features = features_of(m.collider.shape).near(ways.box, reach_of(m, ways.longest));
  if (features.count == 0) return;
  for (const auto& triangle : m.cluster.triangles)
    if (may_meet(triangle, codes)) find_triangle_contacts(m, features, triangle, scratch.contacts);
}

}  // namespace

void ShapeContacts::prepare(const Model& model, int object) {
  elements_.resize(model.objects.size());
  scratch_.resize(model.tiles().size());
  ShapeElements& elements = elements_[static_cast<std::size_t>(object)];
  elements = {};
  const CompiledObject& of = model.objects[static_cast<std::size_t>(object)];
  const auto is_met = [](const Collider& collider) { return local_shape(collider.shape).kind != ShapeKind::plane; };
  if (of.is_collider || std::none_of(model.colliders.begin(), model.colliders.end(), is_met)) return;
  elements = make_shape_elements(of);
  const auto dips = [&](const Collider& collider) {
    return may_dip(elements.radius, local_shape(collider.shape), of.thickness + collider.thickness);
  };
  if (std::none_of(model.colliders.begin(), model.colliders.end(), dips)) elements = {};
}

void ShapeContacts::prepare(const Model& model, int object, std::span<const LocalShape> shapes) {
  elements_.resize(model.objects.size());
  scratch_.resize(model.tiles().size());
  const CompiledObject& of = model.objects[static_cast<std::size_t>(object)];
  ShapeElements& elements = elements_[static_cast<std::size_t>(object)];
  elements = {};
  if (shapes.empty()) return;
  elements = make_shape_elements(of);
  if (!model.pairs.empty()) return;  // whose thickness detect_tile takes
  const auto dips = [&](const LocalShape& shape) { return may_dip(elements.radius, shape, of.thickness); };
  if (std::none_of(shapes.begin(), shapes.end(), dips)) elements = {};
}

void ShapeContacts::detect_tile(const ShapeContactSearch& search, int task, const std::vector<int>* near) {
  const Task& of = search.model.tiles()[static_cast<std::size_t>(task)];
  const ShapeElements& elements = elements_[static_cast<std::size_t>(of.object)];
  ShapeContactScratch& scratch = scratch_[static_cast<std::size_t>(task)];
  scratch.contacts.clear();
  if (elements.tiles.empty()) return;
  const TileElements& tile = elements.tiles[static_cast<std::size_t>(of.item)];
  const CompiledObject& object = search.model.objects[static_cast<std::size_t>(of.object)];
  const AdvanceArguments particles = search.particles(task);
  SweptBox bounds = box_of(search.bounds(task));
  for (const int neighbour : tile.neighbours) bounds = merge(bounds, box_of(search.bounds(task - of.item + neighbour)));
  bool is_measured = false;
  const std::size_t count = near == nullptr ? search.colliders.size() : near->size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t c = near == nullptr ? i : static_cast<std::size_t>((*near)[i]);
    const MovingCollider& collider = search.colliders[c];
    const PairMaterial material = material_of(object, collider);
    const float thickness = material.thickness;
    if (collider.field != nullptr || !overlap(bounds, collider.swept, max(object.thickness, thickness)) ||
        !may_dip(elements.radius, collider.shape, thickness))
      continue;
    if (!is_measured) measure_clusters(tile, particles, scratch);
    is_measured = true;
    const ColliderFrames frames(collider);
    const float shortest = shortest_dipping(collider.shape, thickness);
    for (std::size_t k = 0; k < tile.clusters.size(); ++k)
      if (frames.may_meet(scratch.boxes[k], thickness + scratch.paths[k]))
        find_cluster_contacts(
            {object, particles, search.model.first[static_cast<std::size_t>(of.object)], tile.clusters[k], scratch.ways,
             collider, static_cast<int>(c), material, thickness, shortest},
            frames, scratch);
  }
}

void ShapeContacts::detect(Executor& executor, const ShapeContactSearch& search, std::vector<Contact>& found) {
  found.clear();
  const auto has_elements = [](const ShapeElements& elements) { return !elements.tiles.empty(); };
  if (std::none_of(elements_.begin(), elements_.end(), has_elements)) return;
  const std::size_t tasks = search.tasks == nullptr ? scratch_.size() : search.tasks->size();
  const auto task_of = [&](std::size_t i) {
    return search.tasks == nullptr ? static_cast<int>(i) : (*search.tasks)[i];
  };
  executor.parallel_for("detect contacts", static_cast<int>(tasks), [&](int i) {
    const auto of = static_cast<std::size_t>(i);
    detect_tile(search, task_of(of), search.near_colliders == nullptr ? nullptr : (*search.near_colliders)[of]);
  });
  for (std::size_t i = 0; i < tasks; ++i) {
    const std::vector<Contact>& of_tile = scratch_[static_cast<std::size_t>(task_of(i))].contacts;
    found.insert(found.end(), of_tile.begin(), of_tile.end());
  }
}

void respond_to_shape_contact(const Contact& c, Record* velocities, const Vec3f& missing, float slow, float inverse_h) {
  if (!(c.push > 0)) return;
  const float separating = dot(c.normal, relative(c, velocities) + missing - c.surface_motion * inverse_h);
  const float wanted = separation_after(separating, c.approach, c.restitution, slow, true);
  move_sides(c, c.normal * (wanted - separating), velocities);
}

}  // namespace pliant

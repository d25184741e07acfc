#include "collision/narrow/shape_contacts.h"

#include <algorithm>
#include <cstring>

#include "geometry/shape_closest.h"
#include "geometry/triangle.h"

namespace pliant {

namespace {

/// Limit of the depenetration speed of initial overlaps, as for vertices [m/s].
constexpr float largest_separation_speed = 2;
/// Points with a smaller barycentric weight lie on an edge, which has a contact of its own.
constexpr float least_weight = 1e-4f;
/// A triangle meets a box's corner if its normal is within the corner's normal cone, up to this.
constexpr float cone_slack = 1e-3f;

Vec3f vector_of(const Record& r) { return {r.x, r.y, r.z}; }

Vec3f gravity_on(const Record& x, const Vec3f& gravity) { return x.w > 0 ? gravity : Vec3f{}; }

/// A cluster of an object and a collider.
struct Meeting {
  const CompiledObject& object;
  const AdvanceArguments& particles;
  int first = 0;  ///< the object's first particle in the State
  const ElementCluster& cluster;
  const std::vector<VertexWay>& ways;  ///< of its vertices
  const MovingCollider& collider;
  int number = 0;  ///< index of the collider
  float thickness = 0;
  float shortest_squared =
      0;  ///< sides of elements shorter than this cannot come nearer than their ends by least_dip [m^2]
};

/// For a circle of radius r around a round solid with its thickness: a chord above 2 sqrt(dip (2 r - dip)) dips by more.
float shortest_dipping(const LocalShape& shape, float thickness) {
  if (shape.kind == ShapeKind::box) return 0;
  const float dip = least_dip(0, thickness), chord = dip * (2 * (shape.a + thickness) - dip);
  return 4 * chord;
}

/// The closest point of an element to a solid at share `s` of the substep.
struct ElementContact {
  Vec3f weights;       ///< of its vertices
  Vec3f normal;        ///< outward, in the solid's frame
  float distance = 0;  ///< [m]
  float dip = 0;       ///< how much nearer it is than the closest vertex [m]
  float s = 1;
};

// ---------------------------------------------------------------- four numbers at a time

/// Four numbers that compilers keep in one register.
typedef float Four __attribute__((vector_size(16)));

Four load(const Record& r) {
  Four out;
  std::memcpy(&out, &r, sizeof out);
  return out;
}
Four least(const Four& a, const Four& b) { return a < b ? a : b; }
Four most(const Four& a, const Four& b) { return a > b ? a : b; }
Four four(const Vec3f& v) { return Four{v.x, v.y, v.z, 0}; }

/// A particle's position and its displacement predicted from velocities, because constraints may have changed displacements already.
struct Prediction {
  Four position, displacement;
  Prediction(const AdvanceArguments& a, const Four& gravity, int i) : position(load(a.positions[i])) {
    const Four gained = position[3] > 0 ? gravity : Four{};
    displacement = load(a.remainders[i]) + (load(a.velocities[i]) + gained) * a.h;
  }
};

// ---------------------------------------------------------------- culling of elements

/// False if an element lies wholly beyond one side, or over one face, where its vertices are closest.
template <std::size_t n>
bool may_meet(const std::array<int, n>& vertex, const std::uint16_t* codes) {
  int common = codes[vertex[0]];
  for (std::size_t i = 1; i < n; ++i) common &= codes[vertex[i]];
  return common == 0;
}

// ---------------------------------------------------------------- contacts

/// The share of the substep at which an element is tested: where it first comes within half the thickness, so that its side
/// is known; the end if its path is short or stays clear. Conservative advancement: no point approaches faster than `path`.
template <class Distance>
float time_of_contact(const Distance& distance, float path, float thickness) {
  constexpr int most_steps = 12;
  if (!(path > 0.25f * thickness)) return 1;
  float s = 0;
  for (int step = 0; step < most_steps; ++step) {
    const float gap = distance(s) - 0.5f * thickness;
    if (gap <= 0.02f * path) return s;
    s += gap / path;
    if (!(s < 1)) return 1;
  }
  return s;
}

const VertexWay& way_of(const Meeting& m, int vertex) { return m.ways[static_cast<std::size_t>(vertex)]; }

template <std::size_t n>
float longest(const std::array<VertexWay, n>& ways) {
  float path = 0;
  for (const VertexWay& way : ways) path = max(path, length(way.to - way.from));
  return path;
}

template <std::size_t n>
void add_contact(const Meeting& m, const std::array<int, n>& vertex, const std::array<VertexWay, n>& ways, float radius,
                 const ElementContact& at, std::vector<Contact>& contacts) {
  const AdvanceArguments& a = m.particles;
  const float weights[3] = {at.weights.x, at.weights.y, at.weights.z};
  Contact c;
  Vec3f start{}, place{}, position{}, velocity{};
  float inverse_mass = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int p = m.cluster.vertices[static_cast<std::size_t>(vertex[i])];
    c.point[i] = p;
    c.weight[i] = weights[i];
    inverse_mass += a.positions[p].w * weights[i] * weights[i];
    start += ways[i].from * weights[i];
    place += ways[i].at(at.s) * weights[i];
    position += vector_of(a.positions[p]) * weights[i];
    velocity += (vector_of(a.velocities[p]) + gravity_on(a.positions[p], a.gravity_begun - a.gravity_step)) * weights[i];
  }
  if (!(inverse_mass > 0)) return;
  for (std::size_t i = n; i < 4; ++i) c.point[i] = c.point[0];
  complete_contact(c, a.positions, a.remainders);
  for (std::int32_t& point : c.point) point += m.first;
  const Vec3f surface = place - at.normal * at.distance;
  const float ramp = max(2 * least_dip(radius, m.thickness) - at.dip, 0.f);
  const float kept = min(m.thickness - ramp, dot(at.normal, start - surface) + largest_separation_speed * a.h);
  c.thickness = m.thickness;
  c.collider = m.number;
  c.normal = rotate(m.collider.after.rotation, at.normal);
  c.gap = dot(c.normal, position - to_world(m.collider.after, surface)) - kept;
  if (m.collider.moves) c.surface_motion = to_world(m.collider.after, surface) - to_world(m.collider.before, surface);
  c.static_friction = sqrt(m.object.static_friction * m.collider.static_friction);
  c.kinetic_friction = sqrt(m.object.kinetic_friction * m.collider.kinetic_friction);
  c.restitution = max(m.object.restitution, m.collider.restitution);
  c.approach = dot(c.normal, velocity - c.surface_motion * a.inverse_h);
  contacts.push_back(c);
}

// ---------------------------------------------------------------- edges

using Segment3 = SegmentNearShape<float>;

float nearest_end(const Segment3& segment) { return min(segment.at_a.distance, segment.at_b.distance); }

/// True if the tangents do not exclude that the interior is closer than the ends.
bool may_dip(const Segment3& segment, float thickness) {
  return segment.dips() && nearest_end(segment) - segment.lower_bound() > least_dip(0.5f * length(segment.edge), thickness);
}

/// The share of the substep at which an edge is tested; < 0 if it needs no contact.
float time_of_edge(const Meeting& m, const std::array<VertexWay, 2>& ways, float path, const Segment3& after) {
  if (!(path > 0.25f * m.thickness)) return 1;
  const auto segment_at = [&](float s) { return Segment3(m.collider.shape, ways[0].at(s), ways[1].at(s)); };
  const Segment3 before = segment_at(0);
  if (!may_dip(before, m.thickness) && !may_dip(after, m.thickness)) return -1;
  if ((before.dips() ? before.lower_bound() : nearest_end(before)) > m.thickness + path) return -1;
  const auto distance_at = [&](float s) {
    const Segment3 segment = segment_at(s);
    return segment.dips() ? closest_between(segment).distance : nearest_end(segment);
  };
  return time_of_contact(distance_at, path, m.thickness);
}

void find_edge_contacts(const Meeting& m, const std::array<int, 2>& edge, std::vector<Contact>& contacts) {
  const std::array<VertexWay, 2> ways{way_of(m, edge[0]), way_of(m, edge[1])};
  if (length_squared(ways[1].to - ways[0].to) <= m.shortest_squared) return;
  const float path = longest(ways);
  Segment3 segment(m.collider.shape, ways[0].to, ways[1].to);
  const float s = time_of_edge(m, ways, path, segment);
  if (s < 0) return;
  if (s < 1) segment = Segment3(m.collider.shape, ways[0].at(s), ways[1].at(s));
  if (!may_dip(segment, m.thickness) || segment.lower_bound() > m.thickness + path) return;
  const float radius = 0.5f * length(segment.edge), least = least_dip(radius, m.thickness);
  const ClosestStretch<float> stretch = closest_stretch(segment);
  for (int i = 0; i < stretch.places; ++i) {
    const ClosestToShape<float>& place = stretch.place[i];
    const ElementContact at{
        {1 - place.t, place.t, 0}, place.normal, place.distance, nearest_end(segment) - place.distance, s};
    if (at.dip > least && at.distance < m.thickness + path) add_contact(m, edge, ways, radius, at, contacts);
  }
}

// ---------------------------------------------------------------- triangles

/// Features of a solid that can enter a triangle's interior: points with a radius.
struct Features {
  std::array<Vec3f, 8> point;
  int count = 0;
  float radius = 0;

  /// Those within `reach` of a box, along each axis.
  Features near(const BoundingBox<float>& box, float reach) const {
    Features out;
    out.radius = radius;
    for (int i = 0; i < count; ++i) {
      const Vec3f& p = point[static_cast<std::size_t>(i)];
      const Vec3f outside = max(box.low - p, p - box.high);
      if (max(max(outside.x, outside.y), outside.z) <= reach) out.point[static_cast<std::size_t>(out.count++)] = p;
    }
    return out;
  }
};

/// How near a triangle whose vertices move by `path` must be to a feature point to meet the solid [m].
float reach_of(const Meeting& m, float path) {
  const LocalShape& shape = m.collider.shape;
  return m.thickness + path + (shape.kind == ShapeKind::box ? min(shape.a, min(shape.b, shape.c)) : shape.a);
}

Features features_of(const LocalShape& shape) {
  Features f;
  if (shape.kind == ShapeKind::box) {
    for (const float x : {-shape.a, shape.a})
      for (const float y : {-shape.b, shape.b})
        for (const float z : {-shape.c, shape.c}) f.point[static_cast<std::size_t>(f.count++)] = {x, y, z};
    return f;
  }
  f.radius = shape.a;
  f.count = shape.kind == ShapeKind::capsule ? 2 : 1;
  if (f.count == 2) f.point[0].y = -shape.b;
  if (f.count == 2) f.point[1].y = shape.b;
  return f;
}

/// A triangle and a feature point of a solid. The box whose corner enters a triangle is wholly on the side of its centre.
struct Face {
  const Meeting& m;
  const std::array<VertexWay, 3>& ways;
  const Vec3f& point;
  float radius = 0;

  bool is_box() const { return m.collider.shape.kind == ShapeKind::box; }

  ElementContact at(float s) const {
    const Vec3f a = ways[0].at(s), b = ways[1].at(s), c = ways[2].at(s);
    const ClosestOnTriangle<float> closest = closest_on_triangle(point, a, b, c);
    ElementContact found;
    found.s = s;
    found.weights = closest.weights;
    found.distance = sqrt(closest.distance_squared) - radius;
    const float least = min(min(closest.weights.x, closest.weights.y), closest.weights.z);
    if (!(least > least_weight)) return found;
    const Vec3f normal = triangle_normal(a, b, c);
    const float side = is_box() ? dot(normal, a) : dot(normal, a - point);
    found.normal = side < 0 ? -normal : normal;
    found.distance = dot(found.normal, a - point) - radius;
    return found;
  }

  /// True if a contact with the feature point is one with the solid.
  bool is_met(const ElementContact& found) const {
    const Vec3f& n = found.normal;
    if (!(length_squared(n) > 0)) return false;
    const auto turns_out = [](float normal, float corner) {
      return corner < 0 ? normal <= cone_slack : normal >= -cone_slack;
    };
    return !is_box() || (turns_out(n.x, point.x) && turns_out(n.y, point.y) && turns_out(n.z, point.z));
  }

  float nearest_vertex(float s) const {
    float nearest = signed_distance(m.collider.shape, ways[0].at(s)).distance;
    for (std::size_t i = 1; i < 3; ++i) nearest = min(nearest, signed_distance(m.collider.shape, ways[i].at(s)).distance);
    return nearest;
  }
};

void find_face_contact(const Face& face, const std::array<int, 3>& triangle, float path, std::vector<Contact>& contacts) {
  const Meeting& m = face.m;
  if (face.at(0).distance > m.thickness + path) return;
  const float s = time_of_contact([&](float share) { return face.at(share).distance; }, path, m.thickness);
  ElementContact at = face.at(s);
  if (!face.is_met(at) || at.distance > m.thickness + path) return;
  const Vec3f a = face.ways[0].at(s), b = face.ways[1].at(s), c = face.ways[2].at(s);
  const float radius = 0.5f * max(length(b - a), max(length(c - b), length(a - c)));
  at.dip = face.nearest_vertex(s) - at.distance;
  if (at.dip > least_dip(radius, m.thickness)) add_contact(m, triangle, face.ways, radius, at, contacts);
}

/// The swept box of a triangle's vertices.
BoundingBox<float> swept_box(const std::array<VertexWay, 3>& ways) {
  BoundingBox<float> box{ways[0].from, ways[0].from};
  for (const VertexWay& way : ways) box = {min(box.low, min(way.from, way.to)), max(box.high, max(way.from, way.to))};
  return box;
}

void find_triangle_contacts(const Meeting& m, const Features& features, const std::array<int, 3>& triangle,
                            std::vector<Contact>& contacts) {
  const std::array<VertexWay, 3> ways{way_of(m, triangle[0]), way_of(m, triangle[1]), way_of(m, triangle[2])};
  // The circumscribed circle is at most that of an equilateral triangle with the longest side.
  const float side = max(length_squared(ways[1].to - ways[0].to),
                         max(length_squared(ways[2].to - ways[1].to), length_squared(ways[0].to - ways[2].to)));
  if (side <= 0.75f * m.shortest_squared) return;
  const float path = longest(ways);
  const Features near = features.near(swept_box(ways), reach_of(m, path));
  for (int i = 0; i < near.count; ++i)
    find_face_contact({m, ways, near.point[static_cast<std::size_t>(i)], near.radius}, triangle, path, contacts);
}

// ---------------------------------------------------------------- clusters

using SweptBox = BoundingBox<float>;

bool overlap(const SweptBox& a, const SweptBox& b, float margin) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z) <= margin;
}

SweptBox box_of(const PointBounds& bounds) { return {vector_of(bounds.low), vector_of(bounds.high)}; }

SweptBox merge(const SweptBox& a, const SweptBox& b) { return {min(a.low, b.low), max(a.high, b.high)}; }

/// Computes the swept box of each cluster.
void measure_clusters(const TileElements& tile, const AdvanceArguments& a, ShapeContactScratch& scratch) {
  scratch.boxes.clear();
  scratch.paths.clear();
  const Four gravity = four(a.gravity_begun), none{};
  for (const ElementCluster& cluster : tile.clusters) {
    Four low = none + 3e38f, high = -low, down = none, up = none;
    for (const int v : cluster.vertices) {
      const Prediction p(a, gravity, v);
      const Four to = p.position + p.displacement;
      low = least(low, least(p.position, to));
      high = most(high, most(p.position, to));
      down = least(down, p.displacement);
      up = most(up, p.displacement);
    }
    const Four farthest = most(-down, up);
    scratch.boxes.push_back({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}});
    scratch.paths.push_back(farthest[0] + farthest[1] + farthest[2]);
  }
}

/// The frame of a collider as its axes in world coordinates: three products instead of a rotation.
struct Axes {
  Vec3f x, y, z, origin;

  explicit Axes(const Pose<float>& pose)
      : x(rotate(pose.rotation, Vec3f{1, 0, 0})),
        y(rotate(pose.rotation, Vec3f{0, 1, 0})),
        z(rotate(pose.rotation, Vec3f{0, 0, 1})),
        origin(pose.position) {}

  Vec3f to_local(const Vec3f& p) const {
    const Vec3f d = p - origin;
    return {dot(x, d), dot(y, d), dot(z, d)};
  }
  /// Half extents of a box in this frame around a box with world half extents `e`.
  Vec3f extent(const Vec3f& e) const { return {dot(abs(x), e), dot(abs(y), e), dot(abs(z), e)}; }
};

/// A collider in the substep.
struct ColliderFrames {
  const MovingCollider& collider;
  Axes before, after;

  explicit ColliderFrames(const MovingCollider& of) : collider(of), before(of.before), after(of.after) {}

  /// True if the content of a box may come within `margin`, and not over a single face of a box collider only.
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

/// Axes as columns: the products and sums of Axes::to_local, in its order.
struct Columns {
  Four x, y, z, origin;
  explicit Columns(const Axes& a)
      : x{a.x.x, a.y.x, a.z.x, 0}, y{a.x.y, a.y.y, a.z.y, 0}, z{a.x.z, a.y.z, a.z.z, 0}, origin(four(a.origin)) {}

  Four to_local(const Four& p) const {
    const Four d = p - origin;
    return x * d[0] + y * d[1] + z * d[2];
  }
};

/// Four masks: all bits set means true.
typedef std::int32_t FourMask __attribute__((vector_size(16)));

/// Bits 0 to 5: the sides of a box that a point is beyond, by masks of those above and below.
int sides_of(const FourMask& above, const FourMask& below) {
  const FourMask bits = (above & FourMask{1, 4, 16, 0}) | (below & FourMask{2, 8, 32, 0});
  return bits[0] | bits[1] | bits[2];
}

/// Outcodes of the vertices of a cluster. Bits 0 to 5: the sides of the collider's grown box that the whole path is beyond.
/// Bits 6 to 11: the face of a box that the path is over.
struct Outcoder {
  Four half;
  float thickness;
  bool is_box;

  std::uint16_t operator()(const Four& from, const Four& to) const {
    const Four path = most(to - from, from - to), grown = half + (thickness + most(path[0], most(path[1], path[2])));
    int code = sides_of((from > grown) & (to > grown), (from < -grown) & (to < -grown));
    if (is_box) {
      const int over = sides_of(from > half, from < -half);
      const bool is_one = over != 0 && (over & (over - 1)) == 0;
      if (is_one && over == sides_of(to > half, to < -half)) code |= over << 6;
    }
    return static_cast<std::uint16_t>(code);
  }
  static float most(float a, float b) { return a > b ? a : b; }
  static Four most(const Four& a, const Four& b) { return a > b ? a : b; }
};

/// What the ways of a cluster's vertices have in common.
struct ClusterWays {
  SweptBox box;
  float longest;
};

/// The ways and outcodes of a cluster's vertices. Returns the box around all ways in the collider's frame, and a bound of their lengths.
ClusterWays enter_frame(const Meeting& m, const ColliderFrames& frames, ShapeContactScratch& scratch) {
  const LocalShape& shape = m.collider.shape;
  const Outcoder outcode{four(half_sides<float>(shape)), m.thickness, shape.kind == ShapeKind::box};
  const Columns before(frames.before), after(frames.after);
  const Four gravity = four(m.particles.gravity_begun);
  Four low = Four{} + 3e38f, high = -low, paths{};
  const std::size_t count = m.cluster.vertices.size();
  scratch.ways.resize(count);
  scratch.outcodes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Prediction p(m.particles, gravity, m.cluster.vertices[i]);
    const Four from = before.to_local(p.position), to = after.to_local(p.position + p.displacement);
    low = least(low, least(from, to));
    high = most(high, most(from, to));
    paths = most(paths, most(to - from, from - to));
    const Four way[2] = {from, to};
    static_assert(sizeof way == sizeof(VertexWay));
    std::memcpy(static_cast<void*>(&scratch.ways[i]), way, sizeof way);
    scratch.outcodes[i] = outcode(from, to);
  }
  return {{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, length(Vec3f{paths[0], paths[1], paths[2]})};
}

void find_cluster_contacts(const Meeting& m, const ColliderFrames& frames, ShapeContactScratch& scratch) {
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

void ShapeContacts::detect_tile(const ShapeContactSearch& search, int task) {
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
  for (std::size_t c = 0; c < search.colliders.size(); ++c) {
    const MovingCollider& collider = search.colliders[c];
    const float thickness = object.thickness + collider.thickness;
    if (collider.field != nullptr || !overlap(bounds, collider.swept, object.thickness) ||
        !may_dip(elements.radius, collider.shape, thickness))
      continue;
    if (!is_measured) measure_clusters(tile, particles, scratch);
    is_measured = true;
    const ColliderFrames frames(collider);
    const float shortest = shortest_dipping(collider.shape, thickness);
    for (std::size_t k = 0; k < tile.clusters.size(); ++k)
      if (frames.may_meet(scratch.boxes[k], thickness + scratch.paths[k]))
        find_cluster_contacts({object, particles, search.model.first[static_cast<std::size_t>(of.object)], tile.clusters[k],
                               scratch.ways, collider, static_cast<int>(c), thickness, shortest},
                              frames, scratch);
  }
}

void ShapeContacts::detect(Executor& executor, const ShapeContactSearch& search) {
  contacts_.clear();
  const auto has_elements = [](const ShapeElements& elements) { return !elements.tiles.empty(); };
  if (std::none_of(elements_.begin(), elements_.end(), has_elements)) return;
  scratch_.resize(search.model.tiles().size());
  const std::size_t tasks = search.tasks == nullptr ? scratch_.size() : search.tasks->size();
  const auto task_of = [&](std::size_t i) { return search.tasks == nullptr ? static_cast<int>(i) : (*search.tasks)[i]; };
  executor.parallel_for("detect contacts", static_cast<int>(tasks),
                        [&](int i) { detect_tile(search, task_of(static_cast<std::size_t>(i))); });
  for (std::size_t i = 0; i < tasks; ++i) {
    const std::vector<Contact>& found = scratch_[static_cast<std::size_t>(task_of(i))].contacts;
    contacts_.insert(contacts_.end(), found.begin(), found.end());
  }
}

void respond_to_shape_contact(const Contact& c, Record* velocities, const Vec3f& missing, float slow, float inverse_h) {
  if (!(c.push > 0)) return;
  const float separating = dot(c.normal, relative(c, velocities) + missing - c.surface_motion * inverse_h);
  const float wanted = separation_after(separating, c.approach, c.restitution, slow, true);
  move_sides(c, c.normal * (wanted - separating), velocities);
}

}  // namespace pliant

#include "collision/narrow/shape_element_contacts.h"

#include "geometry/shape_closest.h"
#include "geometry/triangle.h"
#include "math/record.h"

namespace pliant {

namespace {

/// Limit of the speed at which initial overlaps are resolved, as for vertices [m/s].
constexpr float largest_separation_speed = 2;
/// Points with a smaller barycentric weight lie on an edge, which has a contact of its own.
constexpr float least_barycentric_weight = 1e-4f;
/// Tolerance of the test whether a triangle's normal lies in the normal cone of a box's corner.
constexpr float cone_slack = 1e-3f;

Vec3f gravity_on(const Record& x, const Vec3f& gravity) { return x.w > 0 ? gravity : Vec3f{}; }

/// The closest point of an element to a solid at time `s`, a share of the substep.
struct ElementContact {
  Vec3f weights;       ///< weights of the element's vertices
  Vec3f normal;        ///< outward unit normal in the solid's frame
  float distance = 0;  ///< distance between element and solid [m]
  float dip = 0;       ///< how much nearer the point is than the closest vertex [m]
  float s = 1;
};

// ---------------------------------------------------------------- contacts

/// The time, as a share of the substep, at which an element is tested: when it first comes within half the thickness,
/// so that its side is known, or the end if its path is short or stays clear. Conservative advancement: no point
/// approaches faster than `path`.
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
    position += xyz(a.positions[p]) * weights[i];
    velocity += (xyz(a.velocities[p]) + gravity_on(a.positions[p], a.gravity_begun - a.gravity_step)) * weights[i];
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
  c.static_friction = m.material.static_friction;
  c.kinetic_friction = m.material.kinetic_friction;
  c.restitution = m.material.restitution;
  c.approach = dot(c.normal, velocity - c.surface_motion * a.inverse_h);
  add_slide(m.collider, c);
  contacts.push_back(c);
}

// ---------------------------------------------------------------- edges

using Segment3 = SegmentNearShape<float>;

float nearest_end(const Segment3& segment) { return min(segment.at_a.distance, segment.at_b.distance); }

/// Returns false if the tangent planes at both ends prove that the interior of an edge is not closer than the ends.
bool may_dip(const Segment3& segment, float thickness) {
  return segment.dips() &&
         nearest_end(segment) - segment.lower_bound() > least_dip(0.5f * length(segment.edge), thickness);
}

/// The time, as a share of the substep, at which an edge is tested; < 0 if the edge needs no contact.
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

// ---------------------------------------------------------------- triangles

/// A triangle and a feature point of a solid: a sphere's centre, an axis end of a capsule, or a corner of a box.
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
    if (!(least > least_barycentric_weight)) return found;
    const Vec3f normal = triangle_normal(a, b, c);
    const float side = is_box() ? dot(normal, a) : dot(normal, a - point);
    found.normal = side < 0 ? -normal : normal;
    found.distance = dot(found.normal, a - point) - radius;
    return found;
  }

  /// True if a contact with the feature point is a contact with the solid.
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
    for (std::size_t i = 1; i < 3; ++i)
      nearest = min(nearest, signed_distance(m.collider.shape, ways[i].at(s)).distance);
    return nearest;
  }
};

void find_face_contact(const Face& face, const std::array<int, 3>& triangle, float path,
                       std::vector<Contact>& contacts) {
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

/// The box that a triangle sweeps.
BoundingBox<float> swept_box(const std::array<VertexWay, 3>& ways) {
  BoundingBox<float> box{ways[0].from, ways[0].from};
  for (const VertexWay& way : ways) box = {min(box.low, min(way.from, way.to)), max(box.high, max(way.from, way.to))};
  return box;
}

}  // namespace

float shortest_dipping(const LocalShape& shape, float thickness) {
  if (shape.kind == ShapeKind::box) return 0;
  const float dip = least_dip(0, thickness), chord = dip * (2 * (shape.a + thickness) - dip);
  return 4 * chord;
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

Features Features::near(const BoundingBox<float>& box, float reach) const {
  Features out;
  out.radius = radius;
  for (int i = 0; i < count; ++i) {
    const Vec3f& p = point[static_cast<std::size_t>(i)];
    const Vec3f outside = max(box.low - p, p - box.high);
    if (max(max(outside.x, outside.y), outside.z) <= reach) out.point[static_cast<std::size_t>(out.count++)] = p;
  }
  return out;
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

float reach_of(const Meeting& m, float path) {
  const LocalShape& shape = m.collider.shape;
  return m.thickness + path + (shape.kind == ShapeKind::box ? min(shape.a, min(shape.b, shape.c)) : shape.a);
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

}  // namespace pliant

#include "geometry/polyhedron_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/convex_distance.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// An axis must be better by this share of the smaller polyhedron's size to replace one of a preferred kind.
constexpr float preference = 1e-3f;
/// Edges more parallel than this have no axis [sine].
constexpr float parallel = 1e-3f;
/// Faces beside edges that touch are clipped if one of them faces along the normal by this at least [cosine].
constexpr float least_facing_of_edges = 0.9f;
/// The same if edges overlap by no more than this share of the smaller polyhedron's size.
constexpr float shallow = 0.1f;

float lowest(const Polyhedron& p, const Vec3f& normal) {
  float least = dot(normal, p.corners.front());
  for (const Vec3f& corner : p.corners) least = std::min(least, dot(normal, corner));
  return least;
}

struct FaceAxis {
  int face = -1;
  float separation = 0;
};

/// The face of `one` in front of which `other` is farthest.
FaceAxis best_face(const Polyhedron& one, const Polyhedron& other) {
  FaceAxis best;
  for (int f = 0; f < one.faces(); ++f) {
    const Vec3f& on =
        one.corners[static_cast<std::size_t>(one.face_corners[static_cast<std::size_t>(one.first_of_face[f])])];
    const float separation = lowest(other, one.normals[static_cast<std::size_t>(f)]) - dot(one.normals[f], on);
    if (best.face < 0 || separation > best.separation) best = {f, separation};
  }
  return best;
}

/// An arc of the unit sphere between the normals of an edge's faces.
struct Arc {
  Vec3f from{}, to{}, across{};
};

Arc arc_of(const Polyhedron& p, const PolyhedronEdge& edge, float sign) {
  const Vec3f from = p.normals[static_cast<std::size_t>(edge.left)] * sign,
              to = p.normals[static_cast<std::size_t>(edge.right)] * sign;
  return {from, to, cross(to, from)};
}

bool arcs_cross(const Arc& one, const Arc& other) {
  const auto& [a, b, ba] = one;
  const auto& [c, d, dc] = other;
  const float cba = dot(c, ba), dba = dot(d, ba), adc = dot(a, dc), bdc = dot(b, dc);
  return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

struct EdgeAxis {
  int a = -1, b = -1;
  float separation = 0;
  Vec3f normal{};
};

/// The axis of two edges, which build a face of the Minkowski difference.
std::optional<EdgeAxis> axis_of(const Polyhedron& a, int i, const Polyhedron& b, int j) {
  const PolyhedronEdge &e = a.edges[static_cast<std::size_t>(i)], &f = b.edges[static_cast<std::size_t>(j)];
  const Vec3f along_a = a.corners[e.b] - a.corners[e.a], along_b = b.corners[f.b] - b.corners[f.a];
  const Vec3f across = cross(along_a, along_b);
  const float squared = length_squared(across);
  if (squared <= parallel * parallel * length_squared(along_a) * length_squared(along_b)) return std::nullopt;
  Vec3f normal = across * (1 / std::sqrt(squared));
  if (dot(normal, a.corners[e.a] - a.centre) < 0) normal = -normal;
  return EdgeAxis{i, j, dot(normal, b.corners[f.a] - a.corners[e.a]), normal};
}

EdgeAxis best_edges(const Polyhedron& a, const Polyhedron& b) {
  EdgeAxis best;
  thread_local std::vector<Arc> arcs;  // to allocate nothing
  arcs.clear();
  arcs.reserve(b.edges.size());
  for (const PolyhedronEdge& edge : b.edges) arcs.push_back(arc_of(b, edge, -1));
  for (int i = 0; i < static_cast<int>(a.edges.size()); ++i) {
    const Arc arc = arc_of(a, a.edges[static_cast<std::size_t>(i)], 1);
    for (int j = 0; j < static_cast<int>(b.edges.size()); ++j) {
      if (!arcs_cross(arc, arcs[static_cast<std::size_t>(j)])) continue;
      const auto axis = axis_of(a, i, b, j);
      if (axis && (best.a < 0 || axis->separation > best.separation)) best = *axis;
    }
  }
  return best;
}

float size_of(const Polyhedron& p) { return largest(p.corners.front() - p.centre); }

// ------------------------------------------------------------------------------------------------ points

/// Of the faces of `p` that have its lowest corner along a normal the one that faces it most.
int incident_face(const Polyhedron& p, const Vec3f& normal) {
  const float least = lowest(p, normal);
  int best = -1;
  for (int f = 0; f < p.faces(); ++f) {
    const auto first = p.face_corners.begin() + p.first_of_face[f], last = first + p.corners_of(f);
    if (std::none_of(first, last, [&](int corner) { return dot(normal, p.corners[corner]) <= least; })) continue;
    if (best < 0 || dot(p.normals[f], normal) < dot(p.normals[best], normal)) best = f;
  }
  return best;
}

/// The nearest places of two polyhedra, as one point.
Touch nearest_touch(const Polyhedron& a, const Polyhedron& b) {
  using Kind = ConvexShape::Kind;
  const ConvexDistance nearest = convex_distance({Kind::polyhedron, 0, 0, 0, &a}, {Kind::polyhedron, 0, 0, 0, &b}, {});
  Touch out;
  out.normal = nearest.normal;
  out.count = 1;
  out.points[0] = {nearest.on_a, nearest.on_b, nearest.separation, 0x10000000u};
  return out;
}

/// The points of the face of `incident` that is turned to face `face` of `reference`.
Touch face_touch(const Polyhedron& reference, const Polyhedron& incident, int face, bool swapped, float margin) {
  const Vec3f outward = reference.normals[static_cast<std::size_t>(face)];
  const Vec3d normal = convert<double>(swapped ? -outward : outward);
  const Feature polygon = face_of(reference, face), other = face_of(incident, incident_face(incident, outward));
  return four_of(points_over(polygon, other, normal, swapped, static_cast<double>(margin)), normal);
}

/// The nearest points of two lines that are not parallel.
TouchPoint nearest_on_edges(const Polyhedron& a, const Polyhedron& b, const SeparatingAxis& axis) {
  const PolyhedronEdge &e = a.edges[static_cast<std::size_t>(axis.a)], &f = b.edges[static_cast<std::size_t>(axis.b)];
  const Vec3f p = a.corners[e.a], q = b.corners[f.a], u = a.corners[e.b] - p, v = b.corners[f.b] - q, w = q - p;
  const float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const float determinant = uu * vv - uv * uv;
  const float s = std::min(std::max((uw * vv - uv * vw) / determinant, 0.f), 1.f);
  const float t = std::min(std::max((uv * s - vw) / vv, 0.f), 1.f);
  const Vec3d middle = convert<double>((p + u * s) + (q + v * t)) * 0.5;
  const double separation = static_cast<double>(axis.separation);
  const Vec3d half = convert<double>(axis.normal) * (0.5 * separation);
  return {middle - half, middle + half, separation,
          0x20000000u ^ static_cast<std::uint32_t>(axis.a) << 12 ^ static_cast<std::uint32_t>(axis.b)};
}

/// Of the two faces of an edge the one that faces a direction most, and the cosine of the angle between.
std::pair<int, float> facing_of(const Polyhedron& p, int edge, const Vec3f& direction) {
  const PolyhedronEdge& e = p.edges[static_cast<std::size_t>(edge)];
  const float left = dot(p.normals[static_cast<std::size_t>(e.left)], direction),
              right = dot(p.normals[static_cast<std::size_t>(e.right)], direction);
  return left >= right ? std::pair{e.left, left} : std::pair{e.right, right};
}

/// The points of one face over another along a normal that is neither one's: both lie on their faces.
std::vector<TouchPoint> points_along(const Feature& reference, const Feature& incident, const Vec3d& normal,
                                     bool swapped, double margin) {
  constexpr double any_height = 1e30;
  Feature across = reference;  // as seen along the normal
  across.normal = swapped ? -normal : normal;
  for (int i = 0; i < across.count; ++i) {
    Vec3d& point = across.points[static_cast<std::size_t>(i)];
    point -= normal * dot(normal, point - reference.points[0]);
  }
  std::vector<TouchPoint> points = points_over(across, incident, normal, swapped, any_height);
  for (TouchPoint& point : points) {
    const Vec3d& on_incident = swapped ? point.on_a : point.on_b;
    const double along = dot(reference.normal, reference.points[0] - on_incident) / dot(reference.normal, normal);
    (swapped ? point.on_b : point.on_a) = on_incident + normal * along;
    point.separation = swapped ? along : -along;
  }
  points.erase(std::remove_if(points.begin(), points.end(), [&](const TouchPoint& p) { return p.separation > margin; }),
               points.end());
  return points;
}

/// The place where two edges cross, and what of the faces beside them is near: by turning, two slabs that cross at an
/// edge may come to touch anywhere before contacts are found again.
Touch edge_touch(const Polyhedron& a, const Polyhedron& b, const SeparatingAxis& axis, float margin) {
  const Vec3d normal = convert<double>(axis.normal);
  const auto [of_a, facing_a] = facing_of(a, axis.a, axis.normal);
  const auto [of_b, facing_b] = facing_of(b, axis.b, -axis.normal);
  std::vector<TouchPoint> points;
  const bool is_shallow = axis.separation > -shallow * std::min(size_of(a), size_of(b));
  if (is_shallow && std::max(facing_a, facing_b) >= least_facing_of_edges) {
    const Feature one = face_of(a, of_a), other = face_of(b, of_b);
    const double within = static_cast<double>(margin);
    points = facing_a >= facing_b ? points_along(one, other, normal, false, within)
                                  : points_along(other, one, normal, true, within);
  }
  points.push_back(nearest_on_edges(a, b, axis));
  return four_of(points, normal);
}

}  // namespace

SeparatingAxis separating_axis(const Polyhedron& a, const Polyhedron& b, float reach) {
  const FaceAxis of_a = best_face(a, b);
  SeparatingAxis best{SeparatingAxis::Kind::face_of_a, of_a.face, -1, of_a.separation,
                      a.normals[static_cast<std::size_t>(of_a.face)]};
  if (best.separation > reach) return best;
  const FaceAxis of_b = best_face(b, a);
  const float tolerance = preference * std::min(size_of(a), size_of(b));
  if (of_b.separation > best.separation + tolerance)
    best = {SeparatingAxis::Kind::face_of_b, -1, of_b.face, of_b.separation,
            -b.normals[static_cast<std::size_t>(of_b.face)]};
  if (best.separation > reach) return best;
  const EdgeAxis edges = best_edges(a, b);
  if (edges.a >= 0 && edges.separation > best.separation + tolerance)
    best = {SeparatingAxis::Kind::edges, edges.a, edges.b, edges.separation, edges.normal};
  return best;
}

Touch touch(const Polyhedron& a, const Polyhedron& b, float margin) {
  const SeparatingAxis axis = separating_axis(a, b, margin);
  if (axis.separation > margin) return {};
  if (axis.kind == SeparatingAxis::Kind::edges) return edge_touch(a, b, axis, margin);
  const bool by_a = axis.kind == SeparatingAxis::Kind::face_of_a;
  const Touch found = by_a ? face_touch(a, b, axis.a, false, margin) : face_touch(b, a, axis.b, true, margin);
  if (found.count > 0) return found;
  const Touch nearest = nearest_touch(a, b);  // slim ones may meet beside the face
  return nearest.points[0].separation <= static_cast<double>(margin) ? nearest : found;
}

}  // namespace pliant

#include "geometry/convex_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

constexpr int most_steps = 64;
/// The search ends at this relative error of the squared distance, or at this error of the distance [m].
constexpr double accuracy = 1e-11, close = 1e-8;
/// The polytope stops growing when that would move its nearest face by less than this share of the solids' size.
constexpr double growth = 1e-7;
/// Nor beyond so many faces: of solids whose faces are flush, rounding may let each step double them.
constexpr std::size_t most_faces = 2000;
/// A face of the polytope beyond which the origin is by more than this share of the solids' size has been turned over.
constexpr double turned_over = 1e-8;
/// Cores nearer than this, times a metre and their size, count as overlapping.
constexpr double contact = 1e-10;

/// Directions to try where nothing is known: of a cube's faces, which come first, and corners.
constexpr std::size_t first_corner_direction = 6;
constexpr std::array<std::array<double, 3>, 14> directions{{{1, 0, 0},
                                                            {-1, 0, 0},
                                                            {0, 1, 0},
                                                            {0, -1, 0},
                                                            {0, 0, 1},
                                                            {0, 0, -1},
                                                            {1, 1, 1},
                                                            {-1, 1, 1},
                                                            {1, -1, 1},
                                                            {1, 1, -1},
                                                            {-1, -1, 1},
                                                            {-1, 1, -1},
                                                            {1, -1, -1},
                                                            {-1, -1, -1}}};

/// A point of the difference a - b, and the points that it comes from.
struct Vertex {
  Vec3d w{}, on_a{}, on_b{};
};

class Difference {
 public:
  Difference(const ConvexShape& a, const ConvexShape& b, const Posed& pose) : a_(a), b_(b), pose_(pose) {}

  Vertex support(const Vec3d& direction) const {
    const Vec3d p = pliant::support(a_, direction);
    const Vec3d q = to_world(pose_, pliant::support(b_, rotate(conjugate(pose_.rotation), -direction)));
    return {p - q, p, q};
  }

 private:
  const ConvexShape &a_, &b_;
  const Posed& pose_;
};

/// The nearest point to the origin of a simplex, as shares of its corners. Corners stay in their places; which of them
/// belong to the simplex changes.
struct Simplex {
  std::array<Vertex, 4> places{};
  std::array<int, 4> corners{};  ///< places of its corners
  std::array<double, 4> shares{};
  int count = 0;

  const Vertex& corner(int i) const { return places[at(corners[at(i)])]; }
  Vec3d nearest() const { return sum_of(&Vertex::w); }
  Vec3d on_a() const { return sum_of(&Vertex::on_a); }
  Vec3d on_b() const { return sum_of(&Vertex::on_b); }

  /// Adds a corner in a place that is free, of which there is one up to three corners.
  void add(const Vertex& vertex) {
    int place = 0;
    while (std::find(corners.begin(), corners.begin() + count, place) != corners.begin() + count) ++place;
    places[at(place)] = vertex;
    corners[at(count++)] = place;
  }

 private:
  Vec3d sum_of(Vec3d Vertex::*of) const {
    Vec3d sum{};
    for (int i = 0; i < count; ++i) sum += corner(i).*of * shares[at(i)];
    return sum;
  }
};

/// The nearest point to the origin of some corners of a simplex.
struct Nearest {
  double squared = 0;            ///< its squared distance
  std::array<int, 4> corners{};  ///< numbers in the simplex
  std::array<double, 4> shares{};
  int count = 0;
};

/// Of two points the nearer one, the first of equally near ones.
const Nearest& nearer(const Nearest& a, const Nearest& b) { return b.squared < a.squared ? b : a; }

Nearest at_corner(const Simplex& s, int i) { return {length_squared(s.corner(i).w), {i}, {1}, 1}; }

Nearest nearest_of_segment(const Simplex& s, int i, int j) {
  const Vec3d a = s.corner(i).w, b = s.corner(j).w, along = b - a;
  const double squared = length_squared(along), t = squared > 0 ? -dot(a, along) / squared : 0;
  if (t <= 0) return at_corner(s, i);
  if (t >= 1) return at_corner(s, j);
  return {length_squared(a * (1 - t) + b * t), {i, j}, {1 - t, t}, 2};
}

Nearest nearest_of_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3d a = s.corner(i).w, b = s.corner(j).w, c = s.corner(k).w, normal = cross(b - a, c - a);
  const double squared = length_squared(normal);
  const double u = dot(cross(b, c), normal), v = dot(cross(c, a), normal), w = dot(cross(a, b), normal);
  if (squared > 0 && u > 0 && v > 0 && w > 0) {
    const double sum = u + v + w;
    const std::array<double, 4> shares{u / sum, v / sum, w / sum};
    return {length_squared(a * shares[0] + b * shares[1] + c * shares[2]), {i, j, k}, shares, 3};
  }
  return nearer(nearer(nearest_of_segment(s, i, j), nearest_of_segment(s, j, k)), nearest_of_segment(s, k, i));
}

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Of a tetrahedron that contains the origin all four corners stay. Else the nearest point is on a side that the origin
/// sees.
Nearest nearest_of_tetrahedron(const Simplex& s) {
  const Vec3d a = s.corner(0).w, b = s.corner(1).w, c = s.corner(2).w, d = s.corner(3).w, o{};
  const double whole = volume(a, b, c, d);
  const std::array<double, 4> parts{volume(o, b, c, d), volume(a, o, c, d), volume(a, b, o, d), volume(a, b, c, o)};
  if (whole != 0 && std::all_of(parts.begin(), parts.end(), [&](double v) { return v * whole > 0; })) {
    const std::array<double, 4> shares{parts[0] / whole, parts[1] / whole, parts[2] / whole, parts[3] / whole};
    return {0, {0, 1, 2, 3}, shares, 4};
  }
  constexpr std::array<std::array<int, 3>, 4> sides{{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
  Nearest best;
  best.squared = 1e300;
  for (std::size_t i = 0; i < 4; ++i)
    if (!(parts[3 - i] * whole > 0)) best = nearer(best, nearest_of_triangle(s, sides[i][0], sides[i][1], sides[i][2]));
  return best;
}

/// Keeps the corners that have the nearest point to the origin, with their shares.
void keep_nearest(Simplex& s) {
  const Nearest best = s.count == 4   ? nearest_of_tetrahedron(s)
                       : s.count == 3 ? nearest_of_triangle(s, 0, 1, 2)
                       : s.count == 2 ? nearest_of_segment(s, 0, 1)
                                      : at_corner(s, 0);
  const std::array<int, 4> before = s.corners;
  for (int i = 0; i < best.count; ++i) s.corners[at(i)] = before[at(best.corners[at(i)])];
  s.shares = best.shares;
  s.count = best.count;
}

/// The nearest point of the difference to the origin, or any if `beyond` becomes a distance above `reach` that
/// separates both.
Simplex nearest_simplex(const Difference& difference, const Vec3d& first, double reach, double& beyond) {
  Simplex s;
  s.add(difference.support(first));
  s.shares[0] = 1;
  Vec3d v = s.nearest();
  for (int step = 0; step < most_steps; ++step) {
    const double squared = length_squared(v);
    if (squared == 0 || s.count == 4) return s;
    const Vertex next = difference.support(-v);
    const double along = dot(v, next.w);
    if (along > 0 && along * along > reach * reach * squared) {
      beyond = along / std::sqrt(squared);
      return s;
    }
    if (squared - along <= std::max(accuracy * squared, close * std::sqrt(squared))) return s;
    for (int i = 0; i < s.count; ++i)
      if (s.corner(i).w.x == next.w.x && s.corner(i).w.y == next.w.y && s.corner(i).w.z == next.w.z) return s;
    const auto [corners, shares, count] = std::tuple{s.corners, s.shares, s.count};
    s.add(next);
    keep_nearest(s);
    v = s.nearest();
    if (s.count < 4 && length_squared(v) >= squared) {  // rounding: no more progress
      s.corners = corners, s.shares = shares, s.count = count;
      return s;
    }
  }
  return s;
}

// ------------------------------------------------------------------------------------------------ overlap

/// A face of the polytope, a triangle, counter-clockwise from outside.
struct PolytopeFace {
  std::array<int, 3> corners{};
  Vec3d normal{};
  double distance = 0;   ///< of its plane from the origin
  bool is_valid = true;  ///< it has an area
  bool is_seen = false;  ///< by the last point
};

class Polytope {
 public:
  Polytope(const Difference& difference, const Simplex& simplex) : difference_(difference), simplex_(simplex) {
    vertices_.reserve(32);
    faces_.reserve(64);
    for (int i = 0; i < simplex.count; ++i) vertices_.push_back(simplex.corner(i));
    complete();
  }

  /// The least way out of the difference. Empty volume, which flat cores make, gives a depth of zero.
  ConvexDistance depth() {
    int nearest = is_solid_ ? nearest_face() : -1;
    if (nearest < 0) return flat();
    for (int step = 0; step < most_steps && made_ < most_faces; ++step) {
      const PolytopeFace face = faces_[at(nearest)];
      const Vertex next = difference_.support(face.normal);
      if (dot(next.w, face.normal) - face.distance <= growth * size_ || !grow(next)) break;
      const int next_nearest = nearest_face();
      if (next_nearest < 0) return way_out(face);
      nearest = next_nearest;
    }
    return way_out(faces_[at(nearest)]);
  }

 private:
  const Vec3d& place(int i) const { return vertices_[at(i)].w; }
  Vertex support_along(std::size_t direction) const {
    const auto& [x, y, z] = directions[direction];
    return difference_.support({x, y, z});
  }

  /// Adds supports until there are four corners that span a volume.
  void complete() {
    for (std::size_t i = 0; i < first_corner_direction; ++i) size_ = std::max(size_, largest(support_along(i).w));
    if (vertices_.size() == 4 && spans(vertices_[0], vertices_[1], vertices_[2], vertices_[3])) return start();
    std::vector<Vertex> candidates = vertices_;
    for (const auto& [x, y, z] : directions) candidates.push_back(difference_.support({x, y, z}));
    enclose(candidates);
  }

  bool spans(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) const {
    return std::fabs(volume(a.w, b.w, c.w, d.w)) > 1e-12 * size_ * size_ * size_;
  }

  /// Starts from any four candidates that span a volume, and lets it grow by the others, so that the origin is inside
  /// or on it.
  void enclose(const std::vector<Vertex>& candidates) {
    for (std::size_t i = 1; i < candidates.size(); ++i)
      for (std::size_t j = i + 1; j < candidates.size(); ++j)
        for (std::size_t k = j + 1; k < candidates.size(); ++k) {
          if (!spans(candidates[0], candidates[i], candidates[j], candidates[k])) continue;
          vertices_ = {candidates[0], candidates[i], candidates[j], candidates[k]};
          start();
          for (const Vertex& more : candidates) grow(more);
          return;
        }
  }

  void start() {
    is_solid_ = true;
    if (volume(place(0), place(1), place(2), place(3)) > 0) std::swap(vertices_[1], vertices_[2]);
    for (const auto& corners : {std::array{0, 1, 2}, std::array{0, 3, 1}, std::array{1, 3, 2}, std::array{2, 3, 0}})
      add(corners);
  }

  void add(const std::array<int, 3>& corners) {
    const Vec3d a = place(corners[0]);
    const Vec3d normal = unit_or(cross(place(corners[1]) - a, place(corners[2]) - a), Vec3d{});
    faces_.push_back({corners, normal, dot(normal, a), length_squared(normal) > 0});
    ++made_;
  }

  /// The origin is inside or on the polytope: a face that it is outside of has been turned over by rounding.
  int nearest_face() const {
    int best = -1;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const PolytopeFace& face = faces_[i];
      if (!face.is_valid || face.distance < -turned_over * size_) continue;
      if (best < 0 || face.distance < faces_[at(best)].distance) best = static_cast<int>(i);
    }
    return best;
  }

  /// Of two faces that are seen, what they share is not on the border.
  void note_side(int from, int to) {
    const auto back = std::find(border_.begin(), border_.end(), std::pair{to, from});
    if (back != border_.end())
      border_.erase(back);
    else
      border_.emplace_back(from, to);
  }

  /// Replaces the faces that a point sees. False if it sees none.
  bool grow(const Vertex& next) {
    border_.clear();
    for (PolytopeFace& face : faces_) {
      face.is_seen = dot(face.normal, next.w) - face.distance > 1e-12 * size_;
      for (std::size_t e = 0; e < 3 && face.is_seen; ++e) note_side(face.corners[e], face.corners[(e + 1) % 3]);
    }
    if (border_.empty()) return false;
    const auto made = static_cast<int>(vertices_.size());
    vertices_.push_back(next);
    std::erase_if(faces_, [](const PolytopeFace& face) { return face.is_seen; });
    for (const auto& [from, to] : border_) add({from, to, made});
    return true;
  }

  ConvexDistance way_out(const PolytopeFace& face) const {
    const Vec3d p = face.normal * face.distance;
    const Vec3d a = place(face.corners[0]), b = place(face.corners[1]), c = place(face.corners[2]);
    const double whole = dot(cross(b - a, c - a), face.normal);
    const double u = dot(cross(b - p, c - p), face.normal) / whole, v = dot(cross(c - p, a - p), face.normal) / whole;
    const auto mix = [&](Vec3d Vertex::*of) {
      return vertices_[at(face.corners[0])].*of * u + vertices_[at(face.corners[1])].*of * v +
             vertices_[at(face.corners[2])].*of * (1 - u - v);
    };
    return {-face.distance, face.normal, mix(&Vertex::on_a), mix(&Vertex::on_b)};
  }

  /// Cores whose difference has no volume, such as two segments: the normal is that of the plane, or one of the line,
  /// in which it lies.
  ConvexDistance flat() const {
    const Vertex& first = vertices_.front();
    Vec3d along{}, normal{};
    for (const auto& [x, y, z] : directions) {
      const Vec3d away = difference_.support({x, y, z}).w - first.w;
      if (length_squared(away) > length_squared(along)) along = away;
    }
    for (const auto& [x, y, z] : directions) {
      const Vec3d across = cross(along, difference_.support({x, y, z}).w - first.w);
      if (length_squared(across) > length_squared(normal)) normal = across;
    }
    if (length(normal) <= 1e-12 * length_squared(along)) normal = perpendicular(along);
    return {0, unit_or(normal, Vec3d{0, 1, 0}), simplex_.on_a(), simplex_.on_b()};
  }

  /// A vector across another one; upward, if that is not long.
  static Vec3d perpendicular(const Vec3d& along) {
    const Vec3d size = abs(along);
    const Vec3d axis = size.y <= size.x && size.y <= size.z ? Vec3d{0, 1, 0}
                       : size.x <= size.z                   ? Vec3d{1, 0, 0}
                                                            : Vec3d{0, 0, 1};
    return axis - along * (dot(axis, along) / std::max(length_squared(along), 1e-300));
  }

  const Difference& difference_;
  Simplex simplex_;  ///< the nearest points of the cores, where these only touch
  std::vector<Vertex> vertices_;
  std::vector<PolytopeFace> faces_;
  std::vector<std::pair<int, int>> border_;  ///< of the faces that the last point saw
  std::size_t made_ = 0;                     ///< faces that were made
  double size_ = 0;
  bool is_solid_ = false;
};

}  // namespace

ConvexDistance convex_distance(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b, double reach) {
  const Difference difference(a, b, pose_of_b);
  const bool is_apart = length_squared(pose_of_b.position) > 0;
  const double radii = static_cast<double>(a.radius) + static_cast<double>(b.radius);
  double beyond = -1;
  const Simplex simplex =
      nearest_simplex(difference, is_apart ? pose_of_b.position : Vec3d{1, 0, 0}, reach + radii, beyond);
  if (beyond > 0) return {beyond - radii, {}, {}, {}};
  const Vec3d v = simplex.nearest();
  const double distance = length(v), size = 1 + largest(simplex.corner(0).w);
  ConvexDistance out;
  if (simplex.count < 4 && distance > contact * size)
    out = {distance, v * (-1 / distance), simplex.on_a(), simplex.on_b()};
  else
    out = Polytope(difference, simplex).depth();
  out.on_a += out.normal * static_cast<double>(a.radius);
  out.on_b -= out.normal * static_cast<double>(b.radius);
  out.separation -= radii;
  return out;
}

}  // namespace pliant

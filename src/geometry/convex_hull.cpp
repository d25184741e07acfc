#include "geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include "geometry/exact.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Neighbouring triangles are one face if the corner of one that the other lacks is nearer to the other's plane than
/// this share of the hull's size, which is some roundings of a float.
constexpr double flatness = 2e-6;

/// A triangle of the growing hull.
struct Facet {
  std::array<int, 3> corners{};     ///< counter-clockwise from outside
  std::array<int, 3> neighbours{};  ///< beyond the edge from corner i to corner i + 1
  std::vector<int> outside;         ///< points beyond its plane that no facet before it had
  bool alive = true;
};

/// An edge between a facet that a new point sees and one that it does not.
struct HorizonEdge {
  int from = 0, to = 0, beyond = 0;  ///< corners; the facet that stays
};

class Quickhull {
 public:
  explicit Quickhull(const std::vector<Vec3f>& points) : points_(points) {}

  /// False if all points lie in one plane.
  bool run() {
    if (!start()) return false;
    for (std::size_t f = 0; f < facets_.size(); ++f)  // facets that are made in the loop come at the end
      if (facets_[f].alive && !facets_[f].outside.empty()) add(farthest(facets_[f]), static_cast<int>(f));
    return true;
  }

  const std::vector<Facet>& facets() const { return facets_; }

 private:
  const Vec3f& at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Vec3d exact_at(int point) const { return convert<double>(at(point)); }

  bool sees(int point, const Facet& facet) const {
    return volume_sign(at(facet.corners[0]), at(facet.corners[1]), at(facet.corners[2]), at(point)) > 0;
  }

  /// Six times the volume over the facet, in double precision: only for comparing distances.
  double height(const Facet& facet, int point) const {
    const Vec3d a = exact_at(facet.corners[0]);
    return dot(cross(exact_at(facet.corners[1]) - a, exact_at(facet.corners[2]) - a), exact_at(point) - a);
  }

  int farthest(const Facet& facet) const {
    return *std::max_element(facet.outside.begin(), facet.outside.end(),
                             [&](int p, int q) { return height(facet, p) < height(facet, q); });
  }

  /// Makes the first tetrahedron, as large as is simple to find. False if there is none.
  bool start() {
    const std::array<int, 4> corners = first_corners();
    if (corners[3] < 0) return false;
    const auto& [a, b, c, d] = corners;
    for (const auto& t : {std::array{a, b, c}, std::array{a, d, b}, std::array{b, d, c}, std::array{c, d, a}})
      facets_.push_back({t, {}, {}, true});
    const std::array<std::array<int, 3>, 4> neighbours{{{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}}};
    for (std::size_t f = 0; f < 4; ++f) facets_[f].neighbours = neighbours[f];
    std::vector<int> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    share_out(all, 0);
    return true;
  }

  /// Points that span a volume, the last one below the plane of the others; -1 as the last: none.
  std::array<int, 4> first_corners() const {
    const auto count = static_cast<int>(points_.size());
    if (count < 4) return {0, 0, 0, -1};
    const auto farthest_by = [&](const auto& measure) {
      int best = 0;
      double most = -1;
      for (int p = 0; p < count; ++p) {
        const double value = measure(exact_at(p));
        if (value > most) best = p;
        most = std::max(most, value);
      }
      return best;
    };
    const int a = farthest_by([&](const Vec3d& p) { return length_squared(p - exact_at(0)); });
    const int b = farthest_by([&](const Vec3d& p) { return length_squared(p - exact_at(a)); });
    const Vec3d along = exact_at(b) - exact_at(a);
    int c = farthest_by([&](const Vec3d& p) { return length_squared(cross(along, p - exact_at(a))); });
    const Vec3d normal = cross(along, exact_at(c) - exact_at(a));
    int d = farthest_by([&](const Vec3d& p) { return std::fabs(dot(normal, p - exact_at(a))); });
    if (volume_sign(at(a), at(b), at(c), at(d)) == 0) std::tie(c, d) = any_volume(a, b);
    if (d < 0) return {a, b, c, -1};
    return volume_sign(at(a), at(b), at(c), at(d)) < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};
  }

  /// Where double precision finds no volume: any c and d that exactly span one with a and b.
  std::pair<int, int> any_volume(int a, int b) const {
    const auto count = static_cast<int>(points_.size());
    for (int c = 0; c < count; ++c)
      for (int d = c + 1; d < count; ++d)
        if (volume_sign(at(a), at(b), at(c), at(d)) != 0) return {c, d};
    return {0, -1};
  }

  /// Gives each point to the first facet from `first` on that it sees; the others are inside of the hull.
  void share_out(const std::vector<int>& points, std::size_t first) {
    for (const int point : points)
      for (std::size_t f = first; f < facets_.size(); ++f)
        if (sees(point, facets_[f])) {
          facets_[f].outside.push_back(point);
          break;
        }
  }

  /// Replaces the facets that a point sees, of which `seen` is one, by facets from the point to their border.
  void add(int point, int seen) {
    std::vector<int> visible{seen};
    facets_[static_cast<std::size_t>(seen)].alive = false;
    std::vector<HorizonEdge> horizon;
    for (std::size_t next = 0; next < visible.size(); ++next) {
      for (const int n : facets_[static_cast<std::size_t>(visible[next])].neighbours) {
        Facet& neighbour = facets_[static_cast<std::size_t>(n)];
        if (!neighbour.alive || !sees(point, neighbour)) continue;
        neighbour.alive = false;
        visible.push_back(n);
      }
    }
    for (const int v : visible) {
      const Facet& facet = facets_[static_cast<std::size_t>(v)];
      for (std::size_t e = 0; e < 3; ++e)
        if (facets_[static_cast<std::size_t>(facet.neighbours[e])].alive)
          horizon.push_back({facet.corners[e], facet.corners[(e + 1) % 3], facet.neighbours[e]});
    }
    const std::size_t first = facets_.size();
    close(point, horizon);
    std::vector<int> orphans;
    for (const int v : visible) {
      std::vector<int>& outside = facets_[static_cast<std::size_t>(v)].outside;
      orphans.insert(orphans.end(), outside.begin(), outside.end());
      outside = {};
    }
    share_out(orphans, first);
  }

  /// Makes the facets from a point to the horizon, which is one loop.
  void close(int point, const std::vector<HorizonEdge>& horizon) {
    std::map<int, int> starting;  // facet whose horizon edge starts at a corner
    const auto first = static_cast<int>(facets_.size());
    for (std::size_t h = 0; h < horizon.size(); ++h) {
      const HorizonEdge& edge = horizon[h];
      const int made = first + static_cast<int>(h);
      starting[edge.from] = made;
      facets_.push_back({{edge.from, edge.to, point}, {edge.beyond, 0, 0}, {}, true});
      Facet& beyond = facets_[static_cast<std::size_t>(edge.beyond)];
      for (std::size_t e = 0; e < 3; ++e)
        if (beyond.corners[e] == edge.to && beyond.corners[(e + 1) % 3] == edge.from) beyond.neighbours[e] = made;
    }
    for (std::size_t h = 0; h < horizon.size(); ++h) {
      const int made = first + static_cast<int>(h), next = starting[horizon[h].to];
      facets_[static_cast<std::size_t>(made)].neighbours[1] = next;
      facets_[static_cast<std::size_t>(next)].neighbours[2] = made;
    }
  }

  const std::vector<Vec3f>& points_;
  std::vector<Facet> facets_;
};

/// Merges the triangles of a closed convex surface into polygons.
class Polygons {
 public:
  Polygons(const std::vector<Vec3f>& points, const std::vector<Facet>& facets) : points_(points), facets_(facets) {
    size_ = largest_size();
    face_.assign(facets.size(), -1);
    std::vector<std::size_t> order;
    for (std::size_t f = 0; f < facets.size(); ++f)
      if (facets[f].alive) order.push_back(f);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t f, std::size_t g) { return area(f) > area(g); });
    for (const std::size_t f : order)
      if (face_[f] < 0) flood(f);
  }

  ConvexHull hull() const {
    ConvexHull out;
    std::vector<int> number(points_.size(), -1);
    out.normals = normals_;
    for (std::vector<int> loop : borders_) {
      for (int& corner : loop) {
        int& own = number[static_cast<std::size_t>(corner)];
        if (own < 0) {
          own = static_cast<int>(out.corners.size());
          out.corners.push_back(points_[static_cast<std::size_t>(corner)]);
        }
        corner = own;
      }
      out.faces.push_back(loop);
    }
    return out;
  }

 private:
  Vec3d at(int point) const { return convert<double>(points_[static_cast<std::size_t>(point)]); }

  Vec3d normal(std::size_t f) const {
    const auto& [a, b, c] = facets_[f].corners;
    return cross(at(b) - at(a), at(c) - at(a));
  }
  double area(std::size_t f) const { return length_squared(normal(f)); }

  double largest_size() const {
    double size = 0;
    for (const Vec3f& p : points_) size = std::max(size, largest(convert<double>(p) - at(0)));
    return size;
  }

  /// Makes a face of the triangle `seed` and of all others in its plane that are joined to it. If these had no simple
  /// border, which rounding might cause, the triangle stays alone.
  void flood(std::size_t seed) {
    const auto face = static_cast<int>(borders_.size());
    const Vec3d unit = unit_or(normal(seed), Vec3d{0, 1, 0}), origin = at(facets_[seed].corners[0]);
    const auto lies_in_plane = [&](std::size_t f) {
      return std::all_of(facets_[f].corners.begin(), facets_[f].corners.end(),
                         [&](int c) { return std::fabs(dot(unit, at(c) - origin)) <= flatness * size_; });
    };
    face_[seed] = face;
    std::vector<std::size_t> found{seed};
    for (std::size_t next = 0; next < found.size(); ++next)
      for (const int n : facets_[found[next]].neighbours) {
        const auto neighbour = static_cast<std::size_t>(n);
        if (face_[neighbour] >= 0 || dot(normal(neighbour), unit) < 0 || !lies_in_plane(neighbour)) continue;
        face_[neighbour] = face;
        found.push_back(neighbour);
      }
    std::vector<int> loop = border(found);
    if (loop.empty()) {
      for (const std::size_t f : found) face_[f] = f == seed ? face : -1;
      loop = border({seed});
    }
    borders_.push_back(loop);
    normals_.push_back(convert<float>(unit));
  }

  /// The corners around triangles of one face, from the smallest on; empty if they are not one simple loop.
  std::vector<int> border(const std::vector<std::size_t>& triangles) const {
    std::map<int, int> next;
    std::size_t edges = 0;
    for (const std::size_t f : triangles)
      for (std::size_t e = 0; e < 3; ++e) {
        if (face_[static_cast<std::size_t>(facets_[f].neighbours[e])] == face_[f]) continue;
        next[facets_[f].corners[e]] = facets_[f].corners[(e + 1) % 3];
        ++edges;
      }
    std::vector<int> loop;
    int corner = next.begin()->first;
    do {
      loop.push_back(corner);
      corner = next.at(corner);
    } while (corner != loop.front() && loop.size() < edges);
    return corner == loop.front() && loop.size() == edges ? loop : std::vector<int>{};
  }

  const std::vector<Vec3f>& points_;
  const std::vector<Facet>& facets_;
  double size_ = 0;
  std::vector<int> face_;                  ///< polygon of each facet
  std::vector<std::vector<int>> borders_;  ///< points around each polygon
  std::vector<Vec3f> normals_;
};

}  // namespace

std::vector<std::array<int, 3>> ConvexHull::triangles() const {
  std::vector<std::array<int, 3>> out;
  for (const std::vector<int>& face : faces)
    for (std::size_t i = 2; i < face.size(); ++i) out.push_back({face[0], face[i - 1], face[i]});
  return out;
}

std::optional<ConvexHull> convex_hull(const std::vector<Vec3f>& points) {
  Quickhull hull(points);
  if (!hull.run()) return std::nullopt;
  return Polygons(points, hull.facets()).hull();
}

}  // namespace pliant

// Tears surfaces where edges are too long, and removes links that are.
//
// A tear splits one end of an edge: the triangles around it part by the side of a plane through it, across the edge, on
// which they lie (Mueller et al. 2007, section 4.6). The mesh around it stays as it was, and the ends of the tear are
// the next to split.
#include <algorithm>

#include "matter/tears.h"

namespace pliant {

namespace {

/// A distance constraint that is too long.
struct LongLink {
  double stretch = 1;
  int group = 0, number = 0;
  int a = 0, b = 0;
};

/// The links that are too long, the longest first.
std::vector<LongLink> long_links(const Object& object, std::span<const Vec3f> positions) {
  std::vector<LongLink> found;
  for_each_link(object, [&](int group, int number, int a, int b, double rest) {
    const Vec3d d = convert<double>(positions[static_cast<std::size_t>(b)]) -
                    convert<double>(positions[static_cast<std::size_t>(a)]);
    const double stretch = rest > 0 ? std::sqrt(dot(d, d)) / rest : 0;
    if (stretch > static_cast<double>(object.tearing->stretch)) found.push_back({stretch, group, number, a, b});
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const LongLink& one, const LongLink& other) { return one.stretch > other.stretch; });
  return found;
}

/// Tears a surface.
class SurfaceTear {
 public:
  SurfaceTear(const Object& object, std::span<const Vec3f> positions)
      : object_(object),
        positions_(positions),
        around_(object.triangles, std::vector<char>(object.positions.size(), 1)),
        held_(held_particles(object)),
        touched_(object.positions.size()) {}

  Breaks find(const std::vector<LongLink>& links) {
    for (const LongLink& link : links) {
      if (touched(link.a) || touched(link.b)) continue;
      if (is_edge(link.a, link.b))
        tear(link.a, link.b);
      else
        remove(link);
    }
    return std::move(breaks_);
  }

 private:
  std::span<const int> around(int p) const { return around_[p]; }
  const std::array<int, 3>& triangle(int t) const { return object_.triangles[static_cast<std::size_t>(t)]; }
  Vec3d at(int p) const { return convert<double>(positions_[static_cast<std::size_t>(p)]); }
  bool touched(int p) const { return touched_[static_cast<std::size_t>(p)] != 0; }

  bool is_edge(int a, int b) const {
    return std::any_of(around(a).begin(), around(a).end(), [&](int t) { return has_corner(triangle(t), b); });
  }

  /// True if an edge at p belongs to one triangle alone.
  bool is_on_border(int p) const {
    for (const int t : around(p))
      for (const int other : triangle(t)) {
        if (other == p) continue;
        const auto count = std::count_if(around(p).begin(), around(p).end(),
                                         [&](int one) { return has_corner(triangle(one), other); });
        if (count == 1) return true;
      }
    return false;
  }

  /// The edges at p between triangles on both sides of the plane through p across the way to `toward`.
  std::set<EdgeEnds> edges_across(int p, int toward) const {
    const Vec3d way = at(toward) - at(p);
    const auto is_ahead = [&](int t) {
      const auto& [a, b, c] = triangle(t);
      return dot(at(a) + at(b) + at(c) - at(p) * 3., way) > 0;
    };
    std::set<EdgeEnds> found;
    for (const int one : around(p))
      for (const int two : around(p)) {
        if (!is_ahead(one) || is_ahead(two)) continue;
        for (const int corner : triangle(one))
          if (corner != p && has_corner(triangle(two), corner)) found.insert(edge_of(p, corner));
      }
    return found;
  }

  /// Splits one end of an edge: one that is not held, on the border before others, so that tears run on.
  void tear(int a, int b) {
    const bool b_first = held(a) || (!held(b) && is_on_border(b) && !is_on_border(a));
    if (!split(b_first ? b : a, b_first ? a : b)) split(b_first ? a : b, b_first ? b : a);
  }

  bool held(int p) const { return held_[static_cast<std::size_t>(p)] != 0; }

  bool split(int p, int toward) {
    if (held(p)) return false;
    const std::set<EdgeEnds> edges = edges_across(p, toward);
    if (edges.empty()) return false;
    breaks_.edges.insert(edges.begin(), edges.end());
    relieve(p);
    return true;
  }

  /// What lies within some edges of a tear holds for now: it relieves that.
  void relieve(int p) {
    constexpr int rings = 3;
    std::vector<int> reached{p};
    touched_[static_cast<std::size_t>(p)] = 1;
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t end = reached.size();
      for (; begin < end; ++begin)
        for (const int t : around(reached[begin]))
          for (const int corner : triangle(t)) reach(corner, reached);
    }
  }

  void reach(int p, std::vector<int>& reached) {
    if (touched(p)) return;
    touched_[static_cast<std::size_t>(p)] = 1;
    reached.push_back(p);
  }

  /// Removes a link. All links of its chain hold for now.
  void remove(const LongLink& link) {
    if (beside_.empty()) find_beside();
    breaks_.links.insert({link.group, link.number});
    std::vector<int> reached;
    reach(link.a, reached);
    reach(link.b, reached);
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const int next : beside_[static_cast<std::size_t>(reached[i])]) reach(next, reached);
  }

  void find_beside() {
    beside_.resize(object_.positions.size());
    for_each_pair(object_, [&](int, int, int a, int b) {
      if (is_edge(a, b)) return;
      beside_[static_cast<std::size_t>(a)].push_back(b);
      beside_[static_cast<std::size_t>(b)].push_back(a);
    });
  }

  const Object& object_;
  std::span<const Vec3f> positions_;
  Around around_;
  std::vector<char> held_, touched_;  ///< by particle
  /// By particle: those at the other ends of its links that belong to no triangle.
  std::vector<std::vector<int>> beside_;
  Breaks breaks_;
};

}  // namespace

Breaks tears_of_surface(const Object& object, std::span<const Vec3f> positions) {
  const std::vector<LongLink> links = long_links(object, positions);
  if (links.empty()) return {};
  require_triangles(object);
  return SurfaceTear(object, positions).find(links);
}

}  // namespace pliant

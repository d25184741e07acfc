// inspect() for a mesh without a scene: all findings, the worst first.
//
// A finding is grave if the mesh cannot be simulated: no triangles, missing vertices, or coordinates that are not
// finite or so large that squared areas overflow a float. All other findings say what effect they have on the
// simulation, because many good meshes have a sliver, and every cloth has a border.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/at.h"
#include "inspect/problems.h"
#include "math/disjoint_sets.h"
#include "pliant/mesh.h"
#include "topology/boundary.h"
#include "topology/edges.h"
#include "topology/folds.h"
#include "topology/self_intersection.h"

namespace pliant {

namespace {

/// Largest coordinate for which the square of a triangle's area fits a float [m].
constexpr float most_coordinate = 1e9f;
/// Coordinate above which adjacent floats are a millimetre apart [m].
constexpr float doubtful_coordinate = 1e4f;
/// Ratio of longest side to smallest height above which a triangle counts as a sliver.
constexpr double doubtful_aspect = 100;
/// Meshes with more triangles are not searched for self-intersections, because the cost grows faster than the mesh.
constexpr std::size_t most_triangles_to_intersect = 20000;

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string name_of(const Edge& edge) { return std::to_string(edge.a) + "-" + std::to_string(edge.b); }

class Inspector {
 public:
  explicit Inspector(const TriangleMesh& mesh) : mesh_(mesh) {}

  std::vector<Finding> inspect() {
    if (mesh_.triangles.empty()) grave("the mesh has no triangles", "give a mesh with faces");
    check_coordinates();
    check_indices();
    if (!findings_.empty() && findings_.front().grave) return std::move(findings_);
    edges_ = find_edges(mesh_.triangles, static_cast<int>(mesh_.positions.size()));
    check_shapes();
    check_places();
    check_repeated();
    check_isolated();
    check_edges();
    check_corners();
    check_folds();
    check_whole();
    check_self_intersections();
    return std::move(findings_);
  }

 private:
  void grave(std::string message, std::string advice) {
    findings_.push_back({true, std::move(message), std::move(advice)});
  }
  void tell(std::string message, std::string advice) {
    findings_.push_back({false, std::move(message), std::move(advice)});
  }

  Vec3d position_of(int vertex) const {
    const Vec3f& p = mesh_.positions[at(vertex)];
    return {p.x, p.y, p.z};
  }

  void check_coordinates() {
    Tally not_finite, huge, large;
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
      const Vec3f& p = mesh_.positions[i];
      const float most = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        not_finite.add(i);
      else if (most > most_coordinate)
        huge.add(i);
      else if (most > doubtful_coordinate)
        large.add(i);
    }
    if (not_finite.count > 0)
      grave(counted(not_finite.count, "vertex is", "vertices are") + " not finite, the first " +
                std::to_string(not_finite.first),
            "give finite coordinates");
    if (huge.count > 0)
      grave(counted(huge.count, "vertex lies", "vertices lie") + " more than 1e9 m from the origin, the first " +
                std::to_string(huge.first),
            "scale the mesh to metres and move it to the origin");
    if (large.count > 0)
      tell(counted(large.count, "vertex lies", "vertices lie") + " more than 10 km from the origin, the first " +
               std::to_string(large.first),
           "positions are rounded to a millimetre or more there; scale the mesh to metres or move it to the origin");
  }

  void check_indices() {
    Tally outside, twice;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      const auto is_outside = [&](int corner) { return corner < 0 || at(corner) >= mesh_.positions.size(); };
      if (std::any_of(t.begin(), t.end(), is_outside))
        outside.add(i);
      else if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        twice.add(i);
    }
    if (outside.count > 0)
      grave(counted(outside.count, "triangle uses", "triangles use") + " vertices that do not exist, the first " +
                std::to_string(outside.first),
            "correct the indices; there are " + counted(mesh_.positions.size(), "vertex", "vertices"));
    if (twice.count > 0)
      grave(counted(twice.count, "triangle uses", "triangles use") + " a vertex twice, the first " +
                std::to_string(twice.first),
            "remove them, as read_mesh does");
  }

  void check_shapes() {
    Tally flat, sliver;
    double worst = 0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      const Vec3d a = position_of(t[0]), b = position_of(t[1]), c = position_of(t[2]);
      const double twice_area = std::sqrt(length_squared(cross(b - a, c - a)));
      const double longest = std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
      const double aspect = longest / twice_area;
      if (!(twice_area > 0))
        flat.add(i);
      else if (aspect > doubtful_aspect)
        sliver.add(i);
      if (twice_area > 0) worst = std::max(worst, aspect);
    }
    if (flat.count > 0)
      tell(counted(flat.count, "triangle has", "triangles have") + " no area, the first " + std::to_string(flat.first),
           "they have no mass and catch no wind; remove them, as read_mesh does");
    if (sliver.count > 0)
      tell(counted(sliver.count, "sliver triangle", "sliver triangles") + ", the first " +
               std::to_string(sliver.first) +
               " (worst aspect 1:" + std::to_string(static_cast<long long>(std::min(worst, 1e15) + 0.5)) + ")",
           "they give their vertices little mass, which causes jitter; remesh there");
  }

  void check_folds() {
    const std::vector<int> folded = folded_edges(mesh_.positions, edges_);
    if (folded.empty()) return;
    tell(counted(folded.size(), "edge folds", "edges fold") + " the surface back on itself, the first " +
             name_of(edges_[at(folded.front())]),
         "the two triangles there lie on one another, so that contact has no side to push to; open the fold, or remove "
         "one "
         "of them");
  }

  void check_places() {
    std::vector<int> order(mesh_.positions.size());
    std::iota(order.begin(), order.end(), 0);
    const auto before = [&](int a, int b) {
      const Vec3f &p = mesh_.positions[at(a)], &q = mesh_.positions[at(b)];
      if (p.x != q.x) return p.x < q.x;
      if (p.y != q.y) return p.y < q.y;
      if (p.z != q.z) return p.z < q.z;
      return a < b;
    };
    std::sort(order.begin(), order.end(), before);
    Tally shared;
    for (std::size_t i = 1; i < order.size(); ++i)
      if (mesh_.positions[at(order[i])] == mesh_.positions[at(order[i - 1])]) {
        const std::int64_t vertex = order[i];
        ++shared.count;
        shared.first = shared.count == 1 ? vertex : std::min(shared.first, vertex);
      }
    if (shared.count > 0)
      tell(counted(shared.count, "vertex lies", "vertices lie") + " at the position of another, the first " +
               std::to_string(shared.first),
           "the surface is not connected there; merge them, as read_mesh does, unless the seam is meant to be open");
  }

  void check_repeated() {
    std::vector<std::pair<Triangle, std::size_t>> sorted(mesh_.triangles.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      sorted[i] = {mesh_.triangles[i], i};
      std::sort(sorted[i].first.begin(), sorted[i].first.end());
    }
    std::sort(sorted.begin(), sorted.end());
    Tally repeated;
    for (std::size_t i = 1; i < sorted.size(); ++i)
      if (sorted[i].first == sorted[i - 1].first) {
        const auto triangle = static_cast<std::int64_t>(sorted[i].second);
        ++repeated.count;
        repeated.first = repeated.count == 1 ? triangle : std::min(repeated.first, triangle);
      }
    if (repeated.count > 0)
      tell(counted(repeated.count, "triangle has", "triangles have") + " the vertices of another, the first " +
               std::to_string(repeated.first),
           "they count twice for mass and stiffness, and make_cloth rejects two triangles that are connected only to "
           "each "
           "other; remove one of each pair");
  }

  void check_isolated() {
    std::vector<bool> used(mesh_.positions.size(), false);
    for (const Triangle& t : mesh_.triangles)
      for (const int corner : t) used[at(corner)] = true;
    Tally isolated;
    for (std::size_t i = 0; i < used.size(); ++i)
      if (!used[i]) isolated.add(i);
    if (isolated.count > 0)
      tell(counted(isolated.count, "vertex belongs", "vertices belong") + " to no triangle, the first " +
               std::to_string(isolated.first),
           "they have no mass; remove them, as read_mesh does");
  }

  void check_edges() {
    Tally branching, turned;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].triangle_count > 2) branching.add(i);
      if (!edges_[i].is_wound_consistently()) turned.add(i);
    }
    if (branching.count > 0)
      tell(counted(branching.count, "edge has", "edges have") + " more than two triangles, the first " +
               name_of(edges_[branching.first]),
           "the surface is not a manifold: it gets no bending constraint there and encloses no volume; split it there");
    if (turned.count == 0) return;
    const Pieces pieces = find_pieces(edges_, static_cast<int>(mesh_.triangles.size()));
    tell(counted(turned.count, "edge joins", "edges join") + " triangles that are wound differently, the first " +
             name_of(edges_[turned.first]),
         pieces.one_sided_edges.empty()
             ? "turn " + counted(pieces.flipped.size(), "triangle", "triangles") + " over, the first " +
                   std::to_string(pieces.flipped.front())
             : "the surface is one-sided, like a Moebius band; it can be cloth, but not a balloon");
  }

  /// Finds non-manifold vertices: those whose triangles form several fans. Corners are nodes; edges join them.
  void check_corners() {
    DisjointSets corners(3 * mesh_.triangles.size());
    const auto node = [&](int triangle, int vertex) {
      const Triangle& t = mesh_.triangles[at(triangle)];
      return 3 * at(triangle) + static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
    };
    for (const Edge& edge : edges_) {
      if (edge.triangle_count > 2) return;  // reported already; fans are not defined there
      if (!edge.is_inner()) continue;
      for (const int vertex : {edge.a, edge.b})
        corners.join(node(edge.triangles[0], vertex), node(edge.triangles[1], vertex));
    }
    std::vector<std::size_t> fans(mesh_.positions.size(), 0);
    for (std::size_t i = 0; i < corners.count(); ++i)
      if (corners.root(i) == i) ++fans[at(mesh_.triangles[i / 3][i % 3])];
    Tally pinched;
    for (std::size_t i = 0; i < fans.size(); ++i)
      if (fans[i] > 1) pinched.add(i);
    if (pinched.count > 0)
      tell(counted(pinched.count, "vertex joins", "vertices join") +
               " parts of the surface in a single point, the first " + std::to_string(pinched.first),
           "the parts rotate freely about it; split the vertex or close the gap");
  }

  /// The number of parts of the mesh that share no vertex. Parts joined by non-manifold edges or in one vertex count as
  /// one: they cannot separate, and other findings report them.
  std::size_t pieces_apart() const {
    DisjointSets pieces(mesh_.positions.size());
    for (const Triangle& t : mesh_.triangles)
      for (const int corner : {t[1], t[2]}) pieces.join(at(corner), at(t[0]));
    std::vector<bool> seen(pieces.count(), false);
    for (const Triangle& t : mesh_.triangles) seen[pieces.root(at(t[0]))] = true;
    return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  }

  void check_whole() {
    const Pieces pieces = find_pieces(edges_, static_cast<int>(mesh_.triangles.size()));
    if (const std::size_t apart = pieces_apart(); apart > 1)
      tell("the surface consists of " + counted(apart, "piece", "pieces") + " that share no vertex",
           "each part moves separately; merge their vertices if they belong together");
    const std::size_t border = static_cast<std::size_t>(
        std::count_if(edges_.begin(), edges_.end(), [](const Edge& edge) { return edge.is_border(); }));
    if (border > 0) {
      const std::size_t loops = boundary_loops(edges_, static_cast<int>(mesh_.positions.size())).size();
      tell("open, with " + counted(loops, "border", "borders") + " of " + counted(border, "edge", "edges"),
           "this is fine for cloth, but a balloon needs a closed surface");
      return;
    }
    if (is_closed(edges_) && is_wound_consistently(edges_)) check_volume(pieces);
  }

  void check_volume(const Pieces& pieces) {
    // Volumes are computed relative to a vertex, so that a mesh far from the origin keeps its precision.
    std::vector<double> volume(at(pieces.count), 0);
    const Vec3d origin = position_of(mesh_.triangles.front()[0]);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      volume[at(pieces.of_triangle[i])] +=
          dot(position_of(t[0]) - origin, cross(position_of(t[1]) - origin, position_of(t[2]) - origin));
    }
    Tally inside_out;
    for (std::size_t i = 0; i < volume.size(); ++i)
      if (volume[i] < 0) inside_out.add(i);
    if (inside_out.count == 0) return;
    tell(counted(inside_out.count, "closed piece is", "closed pieces are") +
             " wound inside out, the first with triangle " +
             std::to_string(
                 std::find(pieces.of_triangle.begin(), pieces.of_triangle.end(), static_cast<int>(inside_out.first)) -
                 pieces.of_triangle.begin()),
         "swap two corners of every triangle, unless it encloses a cavity");
  }

  void check_self_intersections() {
    SelfIntersections found;
    if (mesh_.triangles.size() <= most_triangles_to_intersect)
      found = find_self_intersections(mesh_.positions, mesh_.triangles, edges_);
    if (!found.complete)
      tell("is too large for the search for self-intersections", "check it in the program that created it");
    else if (found.count > 0)
      tell("passes through itself: an edge pierces a triangle in " + counted(found.count, "place", "places") +
               ", the first edge " + std::to_string(found.edge[0]) + "-" + std::to_string(found.edge[1]) +
               " and triangle " + std::to_string(found.triangle),
           "self-collision cannot separate parts that intersect at the start; move them apart");
  }

  const TriangleMesh& mesh_;
  std::vector<Edge> edges_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> inspect(const TriangleMesh& mesh) {
  std::vector<Finding> findings = Inspector(mesh).inspect();
  std::stable_partition(findings.begin(), findings.end(), [](const Finding& finding) { return finding.grave; });
  return findings;
}

}  // namespace pliant

// Divides a closed mesh into convex pieces. The part whose hull fills the deepest hollow is divided, by the plane along
// an axis after which both halves fill least, until all are within the tolerance.
#include "pliant/decompose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "collision/fields/distance_grid.h"
#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "matter/mesh_part.h"
#include "pliant/error.h"
#include "topology/edges.h"

namespace pliant {

namespace {

constexpr float cells_along = 56;  ///< along the longest side
/// Nodes up to this share of a cell outside count as solid, so that thin walls do too.
constexpr float near_surface = 0.9f;
constexpr float automatic = 0.02f;       ///< tolerance, as a share of the longest side
constexpr int planes_per_axis = 12;      ///< that are tried, evenly spaced
constexpr std::size_t most_places = 24;  ///< up to which all places of vertices are tried as well

void require(bool is_right, const char* option, const std::string& advice) {
  if (!is_right) throw Error(Location{.element = option}, "is out of range", advice);
}

void require_options(const DecomposeOptions& options) {
  require(options.tolerance >= 0 && std::isfinite(options.tolerance), "tolerance", "give a length of at least 0 m");
  require(options.most_pieces >= 1 && options.most_pieces <= 1024, "most_pieces", "give 1 to 1024");
  require(options.most_corners >= 8 && options.most_corners <= 1024, "most_corners", "give 8 to 1024");
  require(options.density > 0 && std::isfinite(options.density), "density", "give a positive, finite density [kg/m^3]");
}

/// The directions to the points of an n x n grid on each side of a cube.
std::vector<Vec3f> directions(int n) {
  std::vector<Vec3f> all;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [&](int k) { return static_cast<float>(2 * k + 1 - n) / static_cast<float>(n); };
      const float u = at(i), v = at(j);
      for (const float side : {-1.f, 1.f}) {
        all.push_back({side, u, v});
        all.push_back({u, side, v});
        all.push_back({u, v, side});
      }
    }
  return all;
}

/// The corners that lie farthest in each direction, in the order of the corners.
std::vector<Vec3f> farthest(const std::vector<Vec3f>& corners, const std::vector<Vec3f>& ways) {
  std::vector<char> is_taken(corners.size(), 0);
  for (const Vec3f& way : ways) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (dot(corners[i], way) > dot(corners[best], way)) best = i;
    is_taken[best] = 1;
  }
  std::vector<Vec3f> taken;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (is_taken[i] != 0) taken.push_back(corners[i]);
  return taken;
}

/// A hull of some of the corners, at most as many as given.
std::optional<ConvexHull> reduced(std::optional<ConvexHull> hull, int most_corners) {
  for (int n = 12; hull && hull->corners.size() > static_cast<std::size_t>(most_corners) && n > 0; --n) {
    const std::vector<Vec3f> some = farthest(hull->corners, directions(n));
    if (some.size() <= static_cast<std::size_t>(most_corners)) hull = convex_hull(some);
  }
  return hull;
}

double volume_of(const ConvexHull& hull) {
  std::vector<Vec3d> corners;
  for (const Vec3f& corner : hull.corners) corners.push_back(convert<double>(corner));
  return moments_of_mesh(corners, hull.triangles()).mass;
}

/// A part and its hull; without one if it is flat.
struct HulledPart {
  MeshPart part;
  std::optional<ConvexHull> hull;
  float filled = 0;
};

/// Divides a mesh.
class Divider {
 public:
  Divider(const TriangleMesh& mesh, const DecomposeOptions& options) : options_(options) {
    const MeshQuery query(mesh.positions, mesh.triangles);
    const Vec3f size = query.bounds().high - query.bounds().low;
    const float longest = std::max({size.x, size.y, size.z});
    tolerance_ = options.tolerance > 0 ? options.tolerance : automatic * longest;
    Executor executor(0);
    const DistanceGrid grid(query, longest / cells_along, longest / cells_along, executor);
    field_ = grid.field();
    HulledPart whole;
    for (const Triangle& t : mesh.triangles)
      whole.part.triangles.push_back({mesh.positions[static_cast<std::size_t>(t[0])],
                                      mesh.positions[static_cast<std::size_t>(t[1])],
                                      mesh.positions[static_cast<std::size_t>(t[2])]});
    sort_nodes(whole.part);
    find_places(mesh);
    pieces_.push_back(std::move(whole));
    find_hull(pieces_.back());
  }

  void run() {
    while (static_cast<int>(pieces_.size()) < options_.most_pieces) {
      const auto deepest = std::max_element(
          pieces_.begin(), pieces_.end(), [](const HulledPart& a, const HulledPart& b) { return a.filled < b.filled; });
      if (!(deepest->filled > tolerance_)) return;
      const std::optional<AxisPlane> plane = best_plane(deepest->part);
      if (!plane) {
        deepest->filled = 0;  // it has no two layers of nodes along any axis
        continue;
      }
      std::array<MeshPart, 2> halves = deepest->part.divided(*plane);
      *deepest = {std::move(halves[0]), {}, 0};
      find_hull(*deepest);
      pieces_.push_back({std::move(halves[1]), {}, 0});
      find_hull(pieces_.back());
    }
  }

  const std::vector<HulledPart>& pieces() const { return pieces_; }

 private:
  Vec3f place_of(const GridNode& node) const {
    return field_->low +
           Vec3f{static_cast<float>(node.at[0]), static_cast<float>(node.at[1]), static_cast<float>(node.at[2])} *
               field_->spacing;
  }

  void sort_nodes(MeshPart& part) const {
    std::size_t i = 0;
    for (int z = 0; z < field_->nodes[2]; ++z)
      for (int y = 0; y < field_->nodes[1]; ++y)
        for (int x = 0; x < field_->nodes[0]; ++x, ++i) {
          const float distance = field_->distances[i];
          if (distance <= near_surface * field_->spacing)
            part.solid.push_back({{x, y, z}, distance});
          else if (distance > std::max(tolerance_, field_->spacing))
            part.hollow.push_back({{x, y, z}, distance});
        }
    part.drop_far_hollows();
  }

  /// The places of the mesh's vertices along each axis, where they are few: a shape of boxes is divided at its corners.
  void find_places(const TriangleMesh& mesh) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<float>& places = places_[static_cast<std::size_t>(axis)];
      for (const Vec3f& p : mesh.positions) places.push_back(coordinate(p, axis));
      std::sort(places.begin(), places.end());
      places.erase(std::unique(places.begin(), places.end()), places.end());
      if (places.size() > most_places) places.clear();
    }
  }

  AxisPlane plane_at(int axis, float place) const {
    const float cell = (place - coordinate(field_->low, axis)) / field_->spacing;
    return {axis, place, static_cast<std::int32_t>(std::floor(cell))};
  }

  std::vector<AxisPlane> planes_of(const MeshPart& part) const {
    std::vector<AxisPlane> planes;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const auto [low, high] =
          std::minmax_element(part.solid.begin(), part.solid.end(),
                              [k](const GridNode& a, const GridNode& b) { return a.at[k] < b.at[k]; });
      if (low == part.solid.end()) continue;
      const std::int32_t first = low->at[k], last = high->at[k];
      for (const float place : places_[k])
        if (const AxisPlane plane = plane_at(axis, place); plane.node > first && plane.node < last)
          planes.push_back(plane);
      for (int i = 1; i <= planes_per_axis; ++i) {
        const float cell = static_cast<float>(first) + static_cast<float>(last - first) * static_cast<float>(i) /
                                                           static_cast<float>(planes_per_axis + 1);
        const AxisPlane plane =
            plane_at(axis, coordinate(field_->low, axis) + (std::floor(cell) + 0.5f) * field_->spacing);
        if (plane.node >= first && plane.node < last) planes.push_back(plane);
      }
    }
    return planes;
  }

  /// The first of the best planes.
  std::optional<AxisPlane> best_plane(const MeshPart& part) const {
    std::optional<AxisPlane> best;
    double least = 0;
    for (const AxisPlane& plane : planes_of(part)) {
      const double cost = part.cost_of(plane);
      if (best && !(cost < least)) continue;
      best = plane;
      least = cost;
    }
    return best;
  }

  /// A part's hull is that of its triangles, and of its inner nodes, where planes meet inside of the mesh.
  void find_hull(HulledPart& piece) const {
    std::vector<Vec3f> points;
    for (const std::array<Vec3f, 3>& triangle : piece.part.triangles)
      points.insert(points.end(), triangle.begin(), triangle.end());
    for (const GridNode& node : piece.part.solid)
      if (node.distance < 0) points.push_back(place_of(node));
    piece.hull = reduced(convex_hull(points), options_.most_corners);
    if (!piece.hull) return;
    for (const GridNode& node : piece.part.hollow)
      if (node.distance > piece.filled && is_in(*piece.hull, place_of(node), 0.5f * field_->spacing))
        piece.filled = node.distance;
  }

  /// True if a point is in a hull or nearer to its faces than `near`: a hull may be thinner than a cell, and have nodes
  /// beside it alone.
  static bool is_in(const ConvexHull& hull, const Vec3f& p, float near) {
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
      if (dot(hull.normals[f], p - hull.corners[static_cast<std::size_t>(hull.faces[f][0])]) > near) return false;
    return true;
  }

  const DecomposeOptions& options_;
  float tolerance_ = 0;
  std::shared_ptr<const DistanceField> field_;
  std::array<std::vector<float>, 3> places_;
  std::vector<HulledPart> pieces_;
};

Moments moments_of(const TriangleMesh& mesh) {
  std::vector<Vec3d> corners;
  for (const Vec3f& p : mesh.positions) corners.push_back(convert<double>(p));
  const Moments found = moments_of_mesh(corners, mesh.triangles);
  return found.mass < 0 ? times(found, -1) : found;
}

BodyInertia inertia_of(const Moments& of) {
  const Vec3d c = of.first * (1 / of.mass);
  const auto& s = of.second;
  const Vec3d squares{s[0] - of.mass * c.x * c.x, s[1] - of.mass * c.y * c.y, s[2] - of.mass * c.z * c.z};
  return {static_cast<float>(of.mass), convert<float>(c),
          convert<float>(Vec3d{squares.y + squares.z, squares.z + squares.x, squares.x + squares.y}),
          convert<float>(Vec3d{of.mass * c.y * c.z - s[3], of.mass * c.z * c.x - s[4], of.mass * c.x * c.y - s[5]})};
}

/// One piece for a mesh that fills its hull, without measuring distances.
std::vector<HulledPart> pieces_of(const TriangleMesh& mesh, double volume, const DecomposeOptions& options) {
  constexpr double of_rounding = 1e-5;
  if (std::optional<ConvexHull> hull = convex_hull(mesh.positions); hull) {
    if (std::abs(volume_of(*hull) - volume) <= of_rounding * volume)
      return {{{}, reduced(hull, options.most_corners), 0}};
  }
  Divider divider(mesh, options);
  divider.run();
  return divider.pieces();
}

}  // namespace

Decomposition decompose(const TriangleMesh& mesh, const DecomposeOptions& options) {
  require_options(options);
  require_indices(mesh.triangles, static_cast<int>(mesh.positions.size()));
  require_closed(mesh.triangles, static_cast<int>(mesh.positions.size()));
  const Moments volume = moments_of(mesh);
  if (!(volume.mass > 0) || !std::isfinite(volume.mass))
    throw Error({}, "the mesh encloses no volume", "give a closed mesh of a solid");
  Decomposition out;
  out.inertia = inertia_of(times(volume, static_cast<double>(options.density)));
  double sum = 0;
  for (const HulledPart& piece : pieces_of(mesh, volume.mass, options)) {
    if (!piece.hull) continue;
    sum += volume_of(*piece.hull);
    out.filled = std::max(out.filled, piece.filled);
    out.solids.push_back({Hull{piece.hull->corners, 0}, {}, {}, options.density});
  }
  for (Solid& solid : out.solids)
    solid.density = static_cast<float>(static_cast<double>(options.density) * volume.mass / sum);
  return out;
}

}  // namespace pliant

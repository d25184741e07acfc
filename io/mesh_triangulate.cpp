// Triangulation of polygons. A strictly convex quad is split from its first corner,
// as programs that write quads expect. Other polygons use ear clipping: a fan over
// a concave polygon covers its outside, and a fan over many corners makes needles.
//
// The polygon is projected along the axis of its largest normal component. That drops a coordinate without rounding. Twice
// the area of a float triangle, computed in double, has the right sign in all but extreme cases.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mesh_polygons.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Ear clipping takes quadratic time; this many corners take a fraction of a second.
constexpr std::size_t most_corners_to_clip = 4096;

struct Point {
  double x, y;
};

/// Twice the signed area of a triangle, positive if counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance_squared(const Point& a, const Point& b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }

bool same_place(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// Twice the polygon's area times its normal, by Newell's method.
Vec3d newell_normal(const PolygonMesh& mesh, const int* corners, std::size_t count) {
  const Vec3f& origin = mesh.positions[static_cast<std::size_t>(corners[0])];
  const auto relative = [&](std::size_t i) {
    const Vec3f& p = mesh.positions[static_cast<std::size_t>(corners[i])];
    return Vec3d{double{p.x} - double{origin.x}, double{p.y} - double{origin.y}, double{p.z} - double{origin.z}};
  };
  Vec3d sum;
  Vec3d last = relative(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d next = relative(i);
    sum += cross(last, next);
    last = next;
  }
  return sum;
}

/// The polygon projected against its normal, so that it is counter-clockwise.
std::vector<Point> flatten(const PolygonMesh& mesh, const int* corners, std::size_t count) {
  const Vec3d normal = newell_normal(mesh, corners, count);
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f& p = mesh.positions[static_cast<std::size_t>(corners[i])];
    Point flat = z >= x && z >= y ? Point{p.x, p.y} : x >= y ? Point{p.y, p.z} : Point{p.z, p.x};
    const double along = z >= x && z >= y ? normal.z : x >= y ? normal.x : normal.y;
    points[i] = along < 0 ? Point{flat.y, flat.x} : flat;
  }
  return points;
}

/// True if every corner turns left and the boundary goes round once, unlike a star: x starts to fall only once.
bool is_strictly_convex(const std::vector<Point>& points) {
  const std::size_t count = points.size();
  int reversals = 0;
  bool leftwards_before = false;
  for (std::size_t i = 0; i < count; ++i) {
    const Point& a = points[i];
    const Point& b = points[(i + 1) % count];
    const Point& c = points[(i + 2) % count];
    if (!(turn(a, b, c) > 0)) return false;
    const auto leftwards = [](const Point& from, const Point& to) {
      return to.x < from.x || (to.x == from.x && to.y < from.y);
    };
    if (i == 0) leftwards_before = leftwards(points[count - 1], a);
    const bool now = leftwards(a, b);
    reversals += now != leftwards_before;
    leftwards_before = now;
  }
  return reversals == 2;
}

/// True if the interiors of two non-adjacent sides cross.
bool crosses_itself(const std::vector<Point>& points) {
  const std::size_t count = points.size();
  const auto apart = [](double left, double right) { return (left > 0 && right < 0) || (left < 0 && right > 0); };
  for (std::size_t i = 0; i + 2 < count; ++i)
    for (std::size_t j = i + 2; j < count; ++j) {
      const Point &a = points[i], &b = points[i + 1], &c = points[j], &d = points[(j + 1) % count];
      if (apart(turn(a, b, c), turn(a, b, d)) && apart(turn(c, d, a), turn(c, d, b))) return true;
    }
  return false;
}

/// Ear clipping (Meisters 1975): a corner whose triangle contains no other
/// corner is an ear, and a simple polygon always has two. The best shaped ear
/// goes first, which keeps nearly collinear corners from becoming needles.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point>& points)
      : points_(points), next_(points.size()), previous_(points.size()), quality_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      next_[i] = (i + 1) % points.size();
      previous_[i] = (i + points.size() - 1) % points.size();
    }
  }

  /// Calls emit(i, j, k) for each triangle. Returns false if the polygon
  /// touches itself, so that a corner without an ear had to be cut.
  template <class Emit>
  bool clip(const Emit& emit) {
    bool simple = true;
    std::size_t first = 0;
    judge_all(first);
    for (std::size_t left = points_.size(); left > 3; --left) {
      std::size_t at = best(first);
      if (quality_[at] <= 0) {
        // Cutting changes the quality of the neighbours, and of others only if corners touch; so all are re-evaluated.
        judge_all(first);
        at = best(first);
      }
      if (quality_[at] <= 0) {
        simple = false;
        at = least_bad(first);
      }
      emit(previous_[at], at, next_[at]);
      first = next_[at];
      next_[previous_[at]] = first;
      previous_[first] = previous_[at];
      quality_[first] = judge(first);
      quality_[previous_[at]] = judge(previous_[at]);
    }
    emit(previous_[first], first, next_[first]);
    return simple;
  }

 private:
  /// The triangle quality at a corner, up to about 0.87 for an equilateral one; 0 if it is no ear.
  double judge(std::size_t corner) const {
    const Point& a = points_[previous_[corner]];
    const Point& b = points_[corner];
    const Point& c = points_[next_[corner]];
    const double area = turn(a, b, c);
    if (!(area > 0)) return 0;
    for (std::size_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
      const Point& p = points_[i];
      // A bridge to a hole visits a position twice; that alone does not block an ear.
      if (same_place(p, a) || same_place(p, b) || same_place(p, c)) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return 0;
    }
    return area / std::max({distance_squared(a, b), distance_squared(b, c), distance_squared(c, a)});
  }

  void judge_all(std::size_t first) {
    std::size_t i = first;
    do {
      quality_[i] = judge(i);
      i = next_[i];
    } while (i != first);
  }

  /// The corner of best quality; ties go to the first after `first`.
  std::size_t best(std::size_t first) const {
    std::size_t found = first;
    for (std::size_t i = next_[first]; i != first; i = next_[i])
      if (quality_[i] > quality_[found]) found = i;
    return found;
  }

  /// If no ear exists: the first corner that turns left, else `first`.
  std::size_t least_bad(std::size_t first) const {
    std::size_t i = first;
    do {
      if (turn(points_[previous_[i]], points_[i], points_[next_[i]]) > 0) return i;
      i = next_[i];
    } while (i != first);
    return first;
  }

  const std::vector<Point>& points_;
  std::vector<std::size_t> next_, previous_;
  std::vector<double> quality_;
};

/// A count and the index of the first.
struct Tally {
  std::size_t count = 0, first = 0;
  void add(std::size_t place) {
    if (count++ == 0) first = place;
  }
};

/// Triangulates one polygon of four or more corners. Returns false if it is not simple.
template <class Emit>
bool cut_up(const std::vector<Point>& points, std::size_t polygon, const std::string& name, const Emit& emit) {
  const std::size_t count = points.size();
  const bool is_large = count > most_corners_to_clip;
  if ((count == 4 || is_large) && is_strictly_convex(points)) {
    for (std::size_t i = 2; i < count; ++i) emit(0, i - 1, i);
    return true;
  }
  if (is_large)
    throw Error({.file = name, .line = 0, .object = {}, .element = "polygon " + std::to_string(polygon)},
                "is concave and has " + std::to_string(count) + " corners",
                "triangulate it in the program that created it");
  const bool has_ears = EarClipper(points).clip(emit);
  return has_ears && !crosses_itself(points);
}

/// The period of a polygon's corner cycle: usually all corners, fewer if the polygon repeats itself.
std::size_t once_round(const int* corners, std::size_t count) {
  std::size_t period = 1;
  while (period < count && corners[period] != corners[0]) ++period;
  if (period < 3 || count % period != 0) return count;
  for (std::size_t i = period; i < count; ++i)
    if (corners[i] != corners[i - period]) return count;
  return period;
}

void note(const Tally& tally, const char* one, const char* many, const char* what, std::vector<std::string>& notes) {
  if (tally.count == 0) return;
  notes.push_back(std::to_string(tally.count) + (tally.count == 1 ? one : many) + what + ", the first " +
                  std::to_string(tally.first));
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(const PolygonMesh& mesh, const std::string& name,
                                            std::vector<std::string>& notes) {
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(mesh.corners.size() - 2 * mesh.ends.size());
  Tally crossing, winding;
  std::size_t begin = 0;
  for (std::size_t polygon = 0; polygon < mesh.ends.size(); ++polygon) {
    const int* const corners = mesh.corners.data() + begin;
    const std::size_t all = mesh.ends[polygon] - begin;
    const std::size_t count = once_round(corners, all);
    if (count < all) winding.add(polygon);
    begin = mesh.ends[polygon];
    const auto emit = [&](std::size_t i, std::size_t j, std::size_t k) {
      triangles.push_back({corners[i], corners[j], corners[k]});
    };
    if (count == 3)
      emit(0, 1, 2);
    else if (!cut_up(flatten(mesh, corners, count), polygon, name, emit))
      crossing.add(polygon);
  }
  note(winding, " polygon that goes", " polygons that go", " round its corners several times counted once", notes);
  note(crossing, " polygon that crosses or touches itself", " polygons that cross or touch themselves",
       " triangulated as well as possible", notes);
  return triangles;
}

}  // namespace pliant

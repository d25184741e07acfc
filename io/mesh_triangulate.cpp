// Divides polygons into triangles. A strictly convex quadrilateral is divided from its first corner, as programs that
// write these expect. Other polygons use ear clipping: a fan over a concave polygon covers its outside, and a fan over
// many corners makes needles.
//
// The polygon is projected along the axis of its normal's largest component, which drops a coordinate without rounding.
// Twice the area of a float triangle, in double precision, has the right sign in all but extreme cases.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mesh_polygons.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Most corners of a polygon for ear clipping, which takes quadratic time: a fraction of a second for this number.
constexpr std::size_t most_corners_to_clip = 4096;

struct Point {
  double x, y;
};

/// Twice the signed area of a triangle, positive if counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance_squared(const Point& a, const Point& b) {
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

bool same_place(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// Newell's normal of a polygon; its length is twice the polygon's area.
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

/// Projects a polygon along its normal so that it is counter-clockwise.
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

/// True if every corner turns left and the polygon goes round once, unlike a star: along it, x begins to fall only
/// once.
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

/// True if the interiors of two sides cross that are not adjacent.
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

/// Ear clipping (Meisters 1975). A corner whose triangle contains no other corner is an ear; a simple polygon
/// always has two. The ear with the best shape is cut first, so that nearly collinear corners do not become
/// needles.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point>& points)
      : points_(points), next_(points.size()), previous_(points.size()), quality_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      next_[i] = (i + 1) % points.size();
      previous_[i] = (i + points.size() - 1) % points.size();
    }
  }

  /// Calls emit(i, j, k) for each triangle. Returns false if a corner that is no ear had to be cut, because the polygon
  /// touches itself.
  template <class Emit>
  bool clip(const Emit& emit) {
    bool simple = true;
    std::size_t first = 0;
    judge_all(first);
    for (std::size_t left = points_.size(); left > 3; --left) {
      std::size_t at = best(first);
      if (quality_[at] <= 0) {
        // A cut changes the quality of the neighbours, and of other corners only if corners touch; so all are evaluated
        // again.
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
  /// The quality of the triangle at a corner, up to about 0.87 for an equilateral one; 0 if the corner is no ear.
  double judge(std::size_t corner) const {
    const Point& a = points_[previous_[corner]];
    const Point& b = points_[corner];
    const Point& c = points_[next_[corner]];
    const double area = turn(a, b, c);
    if (!(area > 0)) return 0;
    for (std::size_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
      const Point& p = points_[i];
      // A bridge to a hole visits a position twice. A corner at the same position therefore does not prevent an ear.
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

  /// The corner of best quality; of equal ones the first after `first`.
  std::size_t best(std::size_t first) const {
    std::size_t found = first;
    for (std::size_t i = next_[first]; i != first; i = next_[i])
      if (quality_[i] > quality_[found]) found = i;
    return found;
  }

  /// The corner to cut if there is no ear: the first that turns left, else `first`.
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

/// Triangulates a polygon of four or more corners. Returns false if the polygon is not simple.
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

/// After how many corners a polygon repeats itself: usually all of them.
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

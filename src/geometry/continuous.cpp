// Continuous collision tests with a certified answer. Double precision rejects nearly all pairs and proves most
// contacts. Only pairs that touch or graze are tested again in double-double precision.
//
// The proof uses signs. When two primitives cross, the signed volume of their four corners changes sign. Let also the
// vertex project into the triangle, or the edges cross, as seen along one direction from before the crossing until
// after it. The volume vanishes in between, by continuity; then the corners are coplanar and the primitives meet. The
// error bounds may be generous, because what they leave open is decided with more digits. After Shewchuk 1997,
// "Adaptive precision floating-point arithmetic and fast robust geometric predicates", extended by time.
#include "geometry/continuous.h"

#include <initializer_list>

#include "geometry/double_double.h"

namespace pliant {

namespace {

using detail::Corners, detail::Paths, detail::corners_at;

using Sharp = DoubleDouble;

/// Upper bound of the error of a corner's position, in roundings of the extent. It comes from differences, motion and
/// position; counted: 6.
constexpr double place_roundings = 16;

/// Error bounds of a volume and an area of corners at most `extent` from the first. Each is a sum of products of
/// differences, which are below 2 extents and have an error of 2 places: 6 x 3 x (2 extents)^2 x 2 places, and 2 x 6 x
/// ... The rounding of the products and sums is smaller than that.
struct Bounds {
  double volume, area;
};

Bounds bounds_of(const Paths<double>& paths) {
  const double extent = detail::extent(paths.start, paths.motion);
  const double place = place_roundings * detail::unit_roundoff(0.0) * extent;
  return {2 * 18 * 4 * 2 * extent * extent * place, 2 * 12 * 2 * 2 * extent * place};
}

double volume(const Corners<double>& x) { return dot(cross(x.at[1] - x.at[0], x.at[2] - x.at[0]), x.at[3] - x.at[0]); }

/// The sign that the area p, q, r keeps along a direction, from `first` to `last`, under linear motion; 0 if it is
/// uncertain. The area is quadratic in time, so its three Bernstein coefficients bound it.
int kept_turn(const Corners<double>& first, const Corners<double>& last, const Vec3d& direction, int p, int q, int r,
              double bound) {
  const Vec3d u[2] = {first.at[q] - first.at[p], last.at[q] - last.at[p]};
  const Vec3d v[2] = {first.at[r] - first.at[p], last.at[r] - last.at[p]};
  const double begins = dot(direction, cross(u[0], v[0])), ends = dot(direction, cross(u[1], v[1]));
  const double between = 0.5 * (dot(direction, cross(u[0], v[1])) + dot(direction, cross(u[1], v[0])));
  const double least = min(begins, min(ends, between)), most = max(begins, max(ends, between));
  return least > bound ? 1 : most < -bound ? -1 : 0;
}

/// True if, seen along the direction, the vertex stays inside the triangle, or the edges stay crossed, at all times.
template <int A>
bool overlap_all_the_time(const Corners<double>& first, const Corners<double>& last, const Vec3d& direction,
                          double bound) {
  const auto turn = [&](int p, int q, int r) { return kept_turn(first, last, direction, p, q, r, bound); };
  if constexpr (A == 1) {
    const int turns = turn(0, 1, 2) + turn(0, 2, 3) + turn(0, 3, 1);
    return turns == 3 || turns == -3;
  } else {
    return turn(0, 1, 2) * turn(0, 1, 3) < 0 && turn(2, 3, 0) * turn(2, 3, 1) < 0;
  }
}

/// True if it is certain that the primitives cross near `time`: within a tenth, a thousandth or less of the motion.
template <int A>
bool crosses_about(const Paths<double>& paths, double time) {
  const Bounds bounds = bounds_of(paths);
  const Corners<double> at = corners_at(paths.start, paths.motion, time);
  const Vec3d u = A == 1 ? at.at[2] - at.at[1] : at.at[1] - at.at[0], v = at.at[3] - at.at[A == 1 ? 1 : 2];
  const Vec3d direction = unit_or(cross(u, v), Vec3d{});
  for (const double within : {1e-1, 1e-3, 1e-6}) {
    const Corners<double> first = corners_at(paths.start, paths.motion, max(0.0, time - within));
    const Corners<double> last = corners_at(paths.start, paths.motion, min(1.0, time + within));
    const double before = volume(first), after = volume(last);
    if (!(min(abs(before), abs(after)) > bounds.volume)) return false;  // shorter intervals fail as well
    if ((before > 0) != (after > 0) && overlap_all_the_time<A>(first, last, direction, bounds.area)) return true;
  }
  return false;
}

/// The distance of one point of each primitive: an upper bound of their distance.
template <int A>
double distance_of(const Corners<double>& x) {
  return length(detail::closest_direction<A>(x));
}

/// True if the primitives are certainly within a thickness shortly after `time`.
template <int A>
bool is_within_soon(const Paths<double>& paths, double thickness, double time) {
  const double rounding =
      4 * place_roundings * detail::unit_roundoff(0.0) * (detail::extent(paths.start, paths.motion) + thickness);
  if (!(thickness > rounding)) return false;
  for (const double later : {0.0, 1e-2, 1e-5, 1e-8}) {
    const double then = min(1.0, time + later);
    if (distance_of<A>(corners_at(paths.start, paths.motion, then)) < thickness - rounding) return true;
  }
  return false;
}

/// Repeats a test in double-double precision, from the last time at which double precision proves separation.
template <int A>
Impact<double> decided(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness) {
  const Impact<double> impact = detail::first_impact<A>(from, to, thickness);
  if (!impact.hit) return impact;
  const Paths<double> paths = detail::relative_paths(from, to);
  if (is_within_soon<A>(paths, thickness, impact.time) || crosses_about<A>(paths, impact.time)) return impact;
  Vec3<Sharp> sharp_from[4], sharp_to[4];
  for (int i = 0; i < 4; ++i) {
    sharp_from[i] = convert<Sharp>(from[i]);
    sharp_to[i] = convert<Sharp>(to[i]);
  }
  const Impact<Sharp> sharp = detail::first_impact<A>(sharp_from, sharp_to, Sharp(thickness), Sharp(impact.time));
  return {sharp.hit, static_cast<double>(sharp.time), convert<double>(sharp.normal), static_cast<double>(sharp.gap),
          true};
}

}  // namespace

Impact<double> vertex_triangle_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness) {
  Impact<double> impact = decided<1>(from, to, thickness);
  impact.front = detail::faces_front(from, to, impact);
  return impact;
}

Impact<double> edge_edge_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness) {
  return decided<2>(from, to, thickness);
}

}  // namespace pliant

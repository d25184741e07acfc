#include "collision/filter/plane_filter.h"

#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr double nearest_to_a_side = 0.1, largest_slab = 0.98;

/// Returns the position at the substep's end in the frame, rounded as the State stores it, relative to the start of
/// particle `origin`.
Vec3d end_of(const Record& x, const Record& d, const Vec3f& frame, const Record& origin) {
  const float ex = x.x + d.x, ey = x.y + d.y, ez = x.z + d.z;
  return {(double(ex) - double(frame.x)) - double(origin.x), (double(ey) - double(frame.y)) - double(origin.y),
          (double(ez) - double(frame.z)) - double(origin.z)};
}

Vec3d start_of(const Record& x, const Record& origin) {
  return {double(x.x) - double(origin.x), double(x.y) - double(origin.y), double(x.z) - double(origin.z)};
}

/// Heights of a pair's four particles along the normal of the separating plane, at the substep's start and end [m].
struct Heights {
  double start[4], end[4];
  double lowest_first = 1e300, highest_second = -1e300;          // heights at the substep's start
  double lowest_first_end = 1e300, highest_second_end = -1e300;  // heights at its end
  double lowest_first_ever = 1e300, highest_second_ever = -1e300;
  double first_sinks = 0, second_rises = 0;                    // largest approach of each side to the other
  bool first_moves = false, second_moves = false;              // true if the side has a dynamic particle
  double first_fixed_low = 1e300, second_fixed_high = -1e300;  // extreme heights of kinematic particles

  double gap() const { return lowest_first - highest_second; }
  /// True if a plane that moves along the normal at constant speed keeps the sides so far apart all the time: heights
  /// above it change linearly, so both ends suffice.
  bool stay_apart(double distance) const {
    return gap() >= distance && lowest_first_end - highest_second_end >= distance;
  }
};

Heights heights_of(const PairStencil& pair, const Vec3d& normal, const Record* positions, const Record* displacements,
                   const Vec3f& frame) {
  Heights h;
  const Record& origin = positions[pair.vertex[0]];
  for (int i = 0; i < 4; ++i) {
    const Record &x = positions[pair.vertex[i]], &d = displacements[pair.vertex[i]];
    h.start[i] = dot(normal, start_of(x, origin));
    h.end[i] = dot(normal, end_of(x, d, frame, origin));
    if (i < pair.first_side) {
      h.lowest_first = std::min(h.lowest_first, h.start[i]);
      h.lowest_first_end = std::min(h.lowest_first_end, h.end[i]);
      h.lowest_first_ever = std::min(h.lowest_first_ever, std::min(h.start[i], h.end[i]));
      h.first_sinks = std::max(h.first_sinks, h.start[i] - h.end[i]);
      if (!(x.w > 0)) h.first_fixed_low = std::min(h.first_fixed_low, std::min(h.start[i], h.end[i]));
    } else {
      h.highest_second = std::max(h.highest_second, h.start[i]);
      h.highest_second_end = std::max(h.highest_second_end, h.end[i]);
      h.highest_second_ever = std::max(h.highest_second_ever, std::max(h.start[i], h.end[i]));
      h.second_rises = std::max(h.second_rises, h.end[i] - h.start[i]);
      if (!(x.w > 0)) h.second_fixed_high = std::max(h.second_fixed_high, std::max(h.start[i], h.end[i]));
    }
  }
  return h;
}

/// By how much rounding moves the end of a truncated step at most [m].
double rounding_of(const Record& x, const Record& d) {
  const float extent =
      max(max(std::abs(x.x), std::abs(x.y)), std::abs(x.z)) + max(max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
  return 1.2e-7 * double(extent);
}

/// The direction between the normals of a pair's closest points at the substep's start and at its end; zero if they are
/// opposite.
Vec3d normal_between(const PairStencil& pair, const Vec3d& at_start, const Record* positions,
                     const Record* displacements) {
  Record ends[4];
  for (int i = 0; i < 4; ++i) {
    const Record &x = positions[pair.vertex[i]], &d = displacements[pair.vertex[i]];
    ends[i] = {x.x + d.x, x.y + d.y, x.z + d.z, x.w};
  }
  const Vec3d sum = at_start + pair_distance({{0, 1, 2, 3}, pair.first_side}, ends).normal;
  const double size = length(sum);
  return size > 1e-6 ? sum * (1 / size) : Vec3d{};
}

/// The normal of a triangle that nothing moves, or of two edges of which one is such, at the substep's start, towards
/// the first side. Zero if there is none.
Vec3d normal_of_fixed_face(const PairStencil& pair, const Vec3d& at_start, const Record* positions) {
  const bool has_edges = pair.first_side == 2;
  const auto is_fixed = [&](int i) { return !(positions[pair.vertex[i]].w > 0); };
  if (!(is_fixed(pair.first_side) && is_fixed(3)) && !(has_edges && is_fixed(0) && is_fixed(1))) return {};
  const auto side = [&](int from, int to) {
    return start_of(positions[pair.vertex[to]], positions[pair.vertex[from]]);
  };
  const Vec3d normal = has_edges ? cross(side(0, 1), side(2, 3)) : cross(side(1, 2), side(1, 3));
  const double size = length(normal);
  return size > 0 ? normal * (dot(normal, at_start) < 0 ? -1 / size : 1 / size) : Vec3d{};
}

}  // namespace

Separation plan_separation(const PairStencil& pair, const PairDistance& at, const Record* positions,
                           const Record* displacements, const Vec3f& frame, double least, SeparatingSlab& slab,
                           std::array<float, 4>& shares) {
  const Heights h = heights_of(pair, at.normal, positions, displacements, frame);
  const double gap = h.gap();
  if (!(gap > 0)) return Separation::unresolvable;
  const double thickness = std::min(least, largest_slab * gap), half = 0.5 * thickness;
  // The tolerance covers rounding, so that steps that another plane has truncated already need no second truncation.
  const double least_gap = thickness * (1 - 1e-9);
  if (h.lowest_first_ever - h.highest_second_ever >= least_gap || h.stay_apart(least_gap)) return Separation::free;
  // What slides past an edge has a normal that turns: a plane along neither keeps it apart, but one between them.
  const Vec3d between = normal_between(pair, at.normal, positions, displacements);
  if (heights_of(pair, between, positions, displacements, {}).stay_apart(least_gap)) return Separation::free;
  // What slides over a mesh is above the plane of a triangle ahead, although the nearest point of that is on its
  // border.
  const Vec3d of_face = normal_of_fixed_face(pair, at.normal, positions);
  if (heights_of(pair, of_face, positions, displacements, {}).stay_apart(least_gap)) return Separation::free;
  // The plane divides the gap in proportion to the motions of both sides, but stays half a margin away from each.
  const double moves = h.first_sinks + h.second_rises;
  double share = std::clamp(moves > 0 ? h.second_rises / moves : 0.5, nearest_to_a_side, 1 - nearest_to_a_side);
  share = std::clamp(share, half / gap, 1 - half / gap);
  double middle = h.highest_second + share * gap;
  // Kinematic particles cannot be limited, so the plane gives way to them.
  middle = std::min(middle, h.first_fixed_low - half);
  middle = std::max(middle, h.second_fixed_high + half);
  slab = {pair, at.normal, frame, at.weight, gap, thickness, middle + half, middle - half};
  // Rounding tolerance: a particle that exceeds its limit by no more than this counts as on its side.
  const double slop = 1e-14 * (std::abs(middle) + std::abs(h.lowest_first) + std::abs(h.highest_second) + half);
  bool unresolvable = false;
  for (int i = 0; i < 4; ++i) {
    const bool first = i < pair.first_side;
    const double limit = first ? slab.above : slab.below, start = h.start[i], end = h.end[i];
    shares[i] = 1;
    if (first ? end >= limit : end <= limit) continue;
    const bool fixed = !(positions[pair.vertex[i]].w > 0);
    const double beyond = first ? limit - (fixed ? end : start) : (fixed ? end : start) - limit;
    const bool inside = beyond <= slop;
    unresolvable = unresolvable || !inside;
    if (fixed) continue;
    const double way = std::abs(start - limit) - rounding_of(positions[pair.vertex[i]], displacements[pair.vertex[i]]);
    shares[i] = inside && way > 0 ? static_cast<float>(way / std::abs(start - end) * (1 - 1e-6)) : 0.f;
  }
  return unresolvable ? Separation::unresolvable : Separation::planned;
}

bool ends_beyond(const SeparatingSlab& slab, int which, const Record* positions, const Record* displacements,
                 float share) {
  const std::int32_t vertex = slab.pair.vertex[which];
  const Record& x = positions[vertex];
  if (!(x.w > 0)) return false;
  const Record d = truncated(displacements[vertex], slab.frame, share);
  const double end = dot(slab.normal, end_of(x, d, slab.frame, positions[slab.pair.vertex[0]]));
  return which < slab.pair.first_side ? end < slab.above : end > slab.below;
}

}  // namespace pliant

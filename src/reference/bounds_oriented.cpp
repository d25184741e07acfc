// Oriented bounding boxes. Float axes are orthonormal only to about 1e-7, so
// everything is computed in double and extents are widened to cover that error.
#include "reference/volumes.h"

#include <initializer_list>

namespace pliant {

namespace {

constexpr double widening_share = 1e-5;

struct Axes {
  Vec3d axis[3];
};

Axes axes_of(const OrientedBoxBounds& box) {
  return {{convert<double>(box.axes[0]), convert<double>(box.axes[1]), convert<double>(box.axes[2])}};
}

/// Box axes for a triangle: along its longest side, along its normal, and perpendicular to both.
Axes axes_of_triangle(const Vec3f* points, int count) {
  const Vec3d a = convert<double>(points[0]), b = convert<double>(points[count > 1 ? 1 : 0]),
              c = convert<double>(points[count > 2 ? 2 : 0]);
  Vec3d side = b - a;
  for (const Vec3d& other : {c - b, a - c})
    if (length_squared(other) > length_squared(side)) side = other;
  const Vec3d x = unit_or(side, Vec3d{1, 0, 0});
  // A triangle without a normal gets any perpendicular: from the coordinate axis that is least aligned with x.
  const Vec3d least = abs(x.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d perpendicular = cross(x, unit_or(cross(b - a, c - a), least));
  const Vec3d y = unit_or(perpendicular, unit_or(cross(x, least), Vec3d{0, 0, 1}));
  return {{x, y, cross(x, y)}};
}

/// The box between the bounds `low` and `high` along `axes`, relative to `origin`.
OrientedBoxBounds box_between(const Axes& axes, const Vec3d& origin, const double (&low)[3], const double (&high)[3]) {
  OrientedBoxBounds box;
  Vec3d centre = origin;
  double half[3], size = 0;
  for (int i = 0; i < 3; ++i) {
    half[i] = 0.5 * (high[i] - low[i]);
    size = max(size, half[i]);
    centre += axes.axis[i] * (0.5 * (low[i] + high[i]));
    box.axes[i] = convert<float>(axes.axis[i]);
  }
  box.centre = convert<float>(centre);
  const double shift = length(convert<double>(box.centre) - centre);  // rounding error of the centre
  const double wider = widening_share * size + shift;
  box.extents = {detail::float_above(half[0] + wider), detail::float_above(half[1] + wider),
                 detail::float_above(half[2] + wider)};
  return box;
}

double half_size_along(const OrientedBoxBounds& box, const Vec3d& axis) {
  const Axes own = axes_of(box);
  return abs(dot(own.axis[0], axis)) * static_cast<double>(box.extents.x) +
         abs(dot(own.axis[1], axis)) * static_cast<double>(box.extents.y) +
         abs(dot(own.axis[2], axis)) * static_cast<double>(box.extents.z);
}

OrientedBoxBounds merged_along(const Axes& axes, const OrientedBoxBounds* boxes, int count) {
  const Vec3d origin = convert<double>(boxes[0].centre);
  double low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < count; ++i) {
      const double middle = dot(axes.axis[k], convert<double>(boxes[i].centre) - origin);
      const double half = half_size_along(boxes[i], axes.axis[k]);
      low[k] = i == 0 ? middle - half : min(low[k], middle - half);
      high[k] = i == 0 ? middle + half : max(high[k], middle + half);
    }
  }
  return box_between(axes, origin, low, high);
}

double surface(const OrientedBoxBounds& box) {
  const Vec3d e = convert<double>(box.extents);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

}  // namespace

OrientedBoxBounds OrientedBoxBounds::of(const Vec3f* points, int count) {
  const Axes axes = axes_of_triangle(points, count);
  const Vec3d origin = convert<double>(points[0]);
  double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (int i = 1; i < count; ++i)
    for (int k = 0; k < 3; ++k) {
      const double s = dot(axes.axis[k], convert<double>(points[i]) - origin);
      low[k] = min(low[k], s);
      high[k] = max(high[k], s);
    }
  return box_between(axes, origin, low, high);
}

// The merged box uses the axes of the first box, of the last box or of the world: those with the least surface area.
OrientedBoxBounds OrientedBoxBounds::merged(const OrientedBoxBounds* boxes, int count) {
  if (count == 1) return boxes[0];
  const Axes world{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  OrientedBoxBounds best = merged_along(world, boxes, count);
  for (const int k : {0, count - 1}) {
    const OrientedBoxBounds other = merged_along(axes_of(boxes[k]), boxes, count);
    if (surface(other) < surface(best)) best = other;
  }
  return best;
}

OrientedBoxBounds OrientedBoxBounds::grown(float margin) const {
  OrientedBoxBounds box = *this;
  const double step = static_cast<double>(margin) * (1 + widening_share);
  box.extents = {detail::float_above(static_cast<double>(extents.x) + step),
                 detail::float_above(static_cast<double>(extents.y) + step),
                 detail::float_above(static_cast<double>(extents.z) + step)};
  return box;
}

float OrientedBoxBounds::distance_bound(const Vec3f& p) const {
  const Vec3d d = convert<double>(p) - convert<double>(centre);
  const Axes own = axes_of(*this);
  const double half[3] = {static_cast<double>(extents.x), static_cast<double>(extents.y),
                          static_cast<double>(extents.z)};
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double outside = max(abs(dot(own.axis[k], d)) - half[k], 0.0);
    squared += outside * outside;
  }
  return detail::float_below(sqrt(squared) * (1 - 1e-6));
}

bool overlap(const OrientedBoxBounds& a, const OrientedBoxBounds& b) {
  const Axes u = axes_of(a), v = axes_of(b);
  const Vec3d apart = convert<double>(b.centre) - convert<double>(a.centre);
  const auto separates = [&](const Vec3d& axis) {
    return abs(dot(axis, apart)) > half_size_along(a, axis) + half_size_along(b, axis);
  };
  for (int i = 0; i < 3; ++i)
    if (separates(u.axis[i]) || separates(v.axis[i])) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3d axis = cross(u.axis[i], v.axis[j]);
      if (length_squared(axis) > 1e-6 && separates(axis)) return false;  // for parallel axes their product adds none
    }
  return true;
}

}  // namespace pliant

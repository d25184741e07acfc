// On which side of a cut's plane parts of an object lie in the rest shape, and how far its blade has come.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "math/functions.h"
#include "model/rods.h"
#include "pliant/scene.h"

namespace pliant {

class PlaneSides {
 public:
  PlaneSides(const Object& object, const PlaneCut& cut, double time)
      : object_(object), point_(wide(cut.point)), normal_(unit(wide(cut.normal))) {
    const Vec3d way = wide(cut.along);
    along_ = unit(way - normal_ * dot(way, normal_));
    double first = std::numeric_limits<double>::infinity(), last = -first;
    const int world = world_particle(object);
    for (std::size_t i = 0; i < object.positions.size(); ++i) {
      if (static_cast<int>(i) == world) continue;
      const Vec3f& p = object.positions[i];
      const double distance = dot(wide(p), along_);
      first = std::min(first, distance);
      last = std::max(last, distance);
      reach_ = std::max({reach_, std::fabs(wide(p).x), std::fabs(wide(p).y), std::fabs(wide(p).z)});
    }
    const double length = static_cast<double>(cut.end) - static_cast<double>(cut.start);
    const double share = length > 0 ? std::min((time - static_cast<double>(cut.start)) / length, 1.) : 1;
    blade_ = share < 1 ? first + (last - first) * share : std::numeric_limits<double>::infinity();
  }

  /// True if the middle of these particles lies on the side of the normal.
  template <std::size_t n>
  bool is_ahead(const std::array<int, n>& particles) const {
    return dot(middle(particles) - point_, normal_) > 0;
  }
  bool is_ahead(const Vec3d& place) const { return dot(place - point_, normal_) > 0; }
  /// For each triangle or tetrahedron: 1 if is_ahead. The sum of the distances of its corners tells it, unless rounding
  /// could.
  template <std::size_t n>
  std::vector<int> ahead_of(const std::vector<std::array<int, n>>& elements) const {
    std::vector<double> distances;
    distances.reserve(object_.positions.size());
    for (const Vec3f& p : object_.positions) distances.push_back(dot(wide(p) - point_, normal_));
    const double rounding = 1e-11 * (reach_ + std::sqrt(dot(point_, point_)));
    std::vector<int> ahead;
    ahead.reserve(elements.size());
    for (const auto& corners : elements) {
      double sum = 0;
      for (const int p : corners) sum += distances[static_cast<std::size_t>(p)];
      ahead.push_back((std::fabs(sum) > rounding ? sum > 0 : is_ahead(corners)) ? 1 : 0);
    }
    return ahead;
  }
  template <std::size_t n>
  bool are_parted(const std::array<int, n>& a, const std::array<int, n>& b) const {
    return is_ahead(a) != is_ahead(b);
  }
  bool is_reached(const Vec3d& place) const { return dot(place, along_) <= blade_; }
  /// True if the blade has passed the middle of these particles.
  template <std::size_t n>
  bool is_reached(const std::array<int, n>& particles) const {
    return dot(middle(particles), along_) <= blade_;
  }

 private:
  static Vec3d wide(const Vec3f& p) { return {p.x, p.y, p.z}; }
  static Vec3d unit(const Vec3d& v) { return v * (1 / std::sqrt(dot(v, v))); }

  template <std::size_t n>
  Vec3d middle(const std::array<int, n>& particles) const {
    Vec3d sum{};
    for (const int p : particles) sum = sum + wide(object_.positions[static_cast<std::size_t>(p)]);
    return sum * (1. / static_cast<double>(n));
  }

  const Object& object_;
  Vec3d point_, normal_, along_;
  double blade_ = 0;  ///< how far the blade has come [m]
  double reach_ = 0;  ///< greatest coordinate [m]
};

}  // namespace pliant

#include "matter/fibres.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "matter/size_class.h"
#include "pliant/error.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const Object& body, const std::string& element, const std::string& problem,
                         const std::string& advice) {
  throw Error({.object = body.name, .element = "fibres" + (element.empty() ? "" : ", " + element)}, problem, advice);
}

void require(const Object& body, const Fibres& fibres, std::size_t tetrahedra) {
  if (!(fibres.modulus > 0 && static_cast<double>(fibres.modulus) <= largest_modulus))
    refuse(body, "modulus", "is " + std::to_string(fibres.modulus), "give more than 0 Pa");
  if (!fibres.directions.empty() && fibres.directions.size() != tetrahedra)
    refuse(body, "directions",
           std::to_string(fibres.directions.size()) + " for " + std::to_string(tetrahedra) + " tetrahedra",
           "give one for each, or one `direction` for all");
  for (std::size_t i = 0; i < fibres.stretch.size(); ++i) {
    const RestKeyframe& key = fibres.stretch[i];
    if (!std::isfinite(key.time) || !(key.factor >= 0 && key.factor <= 1e6f))
      refuse(body, "stretch " + std::to_string(i),
             "is " + std::to_string(key.factor) + " at " + std::to_string(key.time) + " s",
             "give finite times, and 0 to 1e6");
    if (i > 0 && !(key.time > fibres.stretch[i - 1].time))
      refuse(body, "stretch " + std::to_string(i), "is not after the one before", "times must increase");
  }
}

/// The direction of tetrahedron t as a unit vector; (0, 0, 0) if it has none.
Vec3d direction_of(const Object& body, const Fibres& fibres, std::size_t t) {
  const bool has_own = !fibres.directions.empty();
  const Vec3f& given = has_own ? fibres.directions[t] : fibres.direction;
  const Vec3d d{given.x, given.y, given.z};
  const double length = std::sqrt(dot(d, d));
  if (has_own && length == 0) return d;
  if (!(length > 1e-30) || !std::isfinite(length))
    refuse(body, has_own ? "direction of tetrahedron " + std::to_string(t) : "direction", "has no direction",
           "give a vector of any length but 0");
  return d * (1 / length);
}

struct Edges {
  Vec3d a, b, c;

  Edges(const Object& body, const std::array<int, 4>& t) {
    const auto at = [&](std::size_t corner) {
      const Vec3f& p = body.positions[static_cast<std::size_t>(t[corner])];
      return Vec3d{p.x, p.y, p.z};
    };
    a = at(1) - at(0), b = at(2) - at(0), c = at(3) - at(0);
  }
  double six_volumes() const { return dot(cross(a, b), c); }
  /// x with a x.x + b x.y + c x.z = d, by Cramer's rule.
  Vec3d solve(const Vec3d& d) const {
    const double s = 1 / six_volumes();
    return {dot(cross(d, b), c) * s, dot(cross(a, d), c) * s, dot(cross(a, b), d) * s};
  }
};

/// Fibres of tetrahedra that are about as large, and the sum of their stiffnesses [J].
struct FibresOfSize {
  ConstraintGroup group;
  double stiffness = 0;
};

void add_fibre(const std::array<int, 4>& tetrahedron, const Vec3d& along, double stiffness, FibresOfSize& to) {
  to.group.particles.insert(to.group.particles.end(), tetrahedron.begin(), tetrahedron.end());
  for (const double x : {1.0, along.x, along.y, along.z}) to.group.rest.push_back(static_cast<float>(x));
  to.group.compliances.push_back(static_cast<float>(std::min(1 / stiffness, largest_response)));
  to.stiffness += stiffness;
}

}  // namespace

void add_fibres(const Fibres& fibres, double damping_time, const std::vector<std::array<int, 4>>& tetrahedra,
                Object& body) {
  require(body, fibres, tetrahedra.size());
  std::map<int, FibresOfSize> sizes;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const Vec3d direction = direction_of(body, fibres, t);
    if (dot(direction, direction) == 0) continue;
    const Edges edges(body, tetrahedra[t]);
    const double six = edges.six_volumes();
    const int size = damping_time > 0 ? size_class(six / 6) : 0;
    add_fibre(tetrahedra[t], edges.solve(direction), static_cast<double>(fibres.modulus) * six / 6, sizes[size]);
  }
  for (auto& [size, of] : sizes) {
    ConstraintGroup& group = of.group;
    group.type = "fibre";
    group.keyframes = fibres.stretch;
    if (group.keyframes.empty()) group.keyframes.push_back({});
    const double mean = of.stiffness / static_cast<double>(group.compliances.size());
    group.stiffness.damping = static_cast<float>(std::min(damping_time * mean, largest_response));
    body.constraints.push_back(std::move(group));
  }
}

}  // namespace pliant

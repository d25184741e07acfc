// Makes a rope: a distance constraint for each link and, for bending stiffness, one between each two particles two
// links apart.
#include <cmath>
#include <string>
#include <utility>

#include "pliant/error.h"
#include "pliant/scene.h"

namespace pliant {

namespace {

/// The length of each link, computed in double precision. Throws an Error if a length is not positive.
std::vector<double> link_lengths(const std::vector<Vec3f>& points, const std::string& name) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z))
      throw Error({"", 0, name, "point " + std::to_string(i)}, "is not finite", "give finite coordinates in metres");
    if (i == 0) continue;
    const Vec3d a{points[i - 1].x, points[i - 1].y, points[i - 1].z}, b{points[i].x, points[i].y, points[i].z};
    lengths.push_back(std::sqrt(length_squared(b - a)));
    if (lengths.back() == 0)
      throw Error({"", 0, name, "points " + std::to_string(i - 1) + " and " + std::to_string(i)},
                  "have the same position", "remove one of them");
  }
  return lengths;
}

std::vector<float> lumped_masses(const std::vector<double>& lengths, double linear_density) {
  std::vector<float> masses(lengths.size() + 1);
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double before = i > 0 ? lengths[i - 1] : 0, after = i < lengths.size() ? lengths[i] : 0;
    masses[i] = static_cast<float>(linear_density * (before + after) / 2);
  }
  return masses;
}

/// Makes the distance constraints between particles i and i + `apart` for all i.
ConstraintGroup struts(int particles, int apart, const Stiffness& stiffness) {
  ConstraintGroup group;
  group.type = "distance";
  group.stiffness = stiffness;
  for (int i = 0; i + apart < particles; ++i) group.particles.insert(group.particles.end(), {i, i + apart});
  return group;
}

}  // namespace

Object make_rope(const std::vector<Vec3f>& points, const RopeOptions& options) {
  if (points.size() < 2)
    throw Error({"", 0, options.name, ""}, "a rope through " + std::to_string(points.size()) + " points has no link",
                "give two points or more");
  if (!(options.linear_density > 0) || !std::isfinite(options.linear_density))
    throw Error({"", 0, options.name, "linear_density"}, "is " + std::to_string(options.linear_density),
                "give a positive, finite mass per length [kg/m]");
  Object rope;
  rope.name = options.name;
  rope.positions = points;
  rope.thickness = options.thickness;
  rope.masses = lumped_masses(link_lengths(points, options.name), options.linear_density);
  const int particles = static_cast<int>(points.size());
  rope.constraints.push_back(struts(particles, 1, options.stretch));
  if (options.bends && particles > 2) rope.constraints.push_back(struts(particles, 2, options.bending));
  return rope;
}

}  // namespace pliant

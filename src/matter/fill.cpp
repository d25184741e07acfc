// Places for particles: the points of a cubic lattice inside a box or a closed mesh.
#include <algorithm>
#include <cmath>
#include <string>

#include "matter/closed_query.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/random.h"

namespace pliant {

namespace {

void require_positive(const char* element, float value) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error({.element = element}, "is " + std::to_string(value), "give a positive, finite length [m]");
}

/// The places along one axis.
std::vector<float> places(float low, float high, float spacing) {
  const auto count = std::max(1, static_cast<int>(std::floor((high - low) / spacing * (1 + 1e-5f))));
  const float first = (low + high) / 2 - spacing * static_cast<float>(count - 1) / 2;
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out.push_back(first + spacing * static_cast<float>(i));
  return out;
}

}  // namespace

std::vector<Vec3f> fill_box(const Vec3f& low, const Vec3f& high, float spacing) {
  constexpr double most_points = 1 << 26;
  require_positive("spacing", spacing);
  const Vec3f size = high - low;
  for (const float side : {size.x, size.y, size.z}) require_positive("side of the box", side);
  const auto along = [&](float side) {
    return std::max(1., std::floor(static_cast<double>(side) / static_cast<double>(spacing)));
  };
  const double points = along(size.x) * along(size.y) * along(size.z);
  if (points > most_points)
    throw Error({.element = "box"}, "would have " + std::to_string(points) + " particles",
                "give a larger spacing or a smaller box");
  std::vector<Vec3f> out;
  for (const float y : places(low.y, high.y, spacing))
    for (const float z : places(low.z, high.z, spacing))
      for (const float x : places(low.x, high.x, spacing)) out.push_back({x, y, z});
  return out;
}

std::vector<Vec3f> fill_mesh(const TriangleMesh& mesh, float spacing, float clearance) {
  require_positive("spacing", spacing);
  if (!(clearance >= 0) || !std::isfinite(clearance))
    throw Error({.element = "clearance"}, "is " + std::to_string(clearance), "give a finite distance of 0 or more [m]");
  const MeshQuery query = query_of_closed(mesh);
  std::vector<Vec3f> points = fill_box(query.bounds().low, query.bounds().high, spacing);
  std::erase_if(points, [&](const Vec3f& p) {
    return !query.is_inside(p) || (clearance > 0 && query.closest(p, clearance).triangle >= 0);
  });
  if (points.empty())
    throw Error({.element = "mesh"}, "has no room for a particle",
                "give a smaller spacing or clearance, or a larger mesh");
  return points;
}

std::vector<Vec3f> jittered(std::vector<Vec3f> points, float most, int seed) {
  if (!(most >= 0) || !std::isfinite(most))
    throw Error({.element = "displacement"}, "is " + std::to_string(most), "give a finite length of 0 or more [m]");
  Random random(seed);
  for (Vec3f& p : points) {
    const float x = random.between(-most, most), y = random.between(-most, most), z = random.between(-most, most);
    p += Vec3f{x, y, z};
  }
  return points;
}

}  // namespace pliant

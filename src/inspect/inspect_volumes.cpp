// Warnings about volumes with a pressure: surfaces that jump to it at the start.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "inspect/problems.h"
#include "math/functions.h"
#include "math/vector.h"
#include "model/compile_surface.h"
#include "model/object_sets.h"

namespace pliant {

namespace {

/// Speed of the surface in the first substep above which it is doubted [m/s]. The next substeps stop it but for a
/// twentieth to an eighth. Balls of rubber sheet at a pressure of 1.3 are at rest after 0.2 s if they have 0.2 m (90
/// m/s), and after 1 s move at 0.8 m/s if they have 0.5 m (220 m/s), at 6 m/s with 1 m (430 m/s) and at 290 m/s with 10
/// m (4300 m/s).
constexpr double most_speed = 400;
/// Time in which the advice reaches the pressure [s].
constexpr double ramp = 1;

struct Size {
  double volume = 0, area = 0;
};

Size size_of(const Object& object) {
  Size size;
  const auto at = [&](int i) { return convert<double>(object.positions[static_cast<std::size_t>(i)]); };
  const Vec3d origin = at(object.triangles[0][0]);
  for (const auto& t : object.triangles) {
    const Vec3d a = at(t[0]), b = at(t[1]), c = at(t[2]);
    size.volume += dot(cross(a - origin, b - origin), c - origin) / 6;
    size.area += std::sqrt(length_squared(cross(b - a, c - a))) / 2;
  }
  return size;
}

/// By how much a sphere of the object's volume grows in the first substep [m]: all the way to its pressure, less what
/// the constraint yields.
double first_jump(const Object& object, double substep) {
  const Size size = size_of(object);
  const double radius = pow(std::fabs(size.volume) * 3 / (4 * 3.14159265358979), 1.0 / 3);
  const double way = radius * (pow(pressure_at(*object.volume, 0), 1.0 / 3) - 1);
  const Stiffness& stiffness = object.volume->stiffness;
  if (stiffness.kind == Stiffness::Kind::pbd) return way * static_cast<double>(stiffness.value);
  double mass = 0;
  for (const float one : object.masses) mass += std::isfinite(one) ? static_cast<double>(one) : 0;
  // Of C = 6 V, with the same area and mass at each particle.
  const double answer = mass > 0 ? 36 * size.area * size.area / mass : 0;
  const double yielding = static_cast<double>(stiffness.value) / (substep * substep);
  return yielding > 0 ? way * answer / (answer + yielding) : way;
}

}  // namespace

void doubt_jumps_of_volumes(Problems& problems, const Scene& scene) {
  const auto has_volume = [](const Object& object) { return object.volume && !object.triangles.empty(); };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), has_volume)) return;
  const std::vector<int> all = chosen_substeps(scene);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (!has_volume(object)) continue;
    const double substep = static_cast<double>(scene.frame_time) / (all[o] > 0 ? all[o] : substeps_of_volumes);
    const double jump = std::fabs(first_jump(object, substep));
    if (!(jump > most_speed * substep)) continue;
    const std::string pressure = words(pressure_at(*object.volume, 0));
    problems.at(object.name);
    problems.doubtful(
        "volume",
        "has a pressure of " + pressure + " at the start, so its surface jumps by about " +
            words(std::round(1000 * jump) / 1000) + " m in the first substep, at " + words(std::round(jump / substep)) +
            " m/s, and may be thrown about",
        "let the pressure rise from 1 by keyframes: \"keyframes\": [{\"time\": 0, \"pressure\": 1}, {\"time\": " +
            words(ramp) + ", \"pressure\": " + pressure + "}]");
  }
  problems.at("");
}

}  // namespace pliant

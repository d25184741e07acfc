#include "model/compile_surface.h"

#include <algorithm>
#include <cstddef>

#include "constraints/registry.h"
#include "math/functions.h"
#include "math/motion.h"
#include "model/stiffness.h"
#include "topology/boundary.h"

namespace pliant {

namespace {

/// True if the volume ever strains its edges. Stresses that stay would turn a free object by themselves
/// (solver/momentum.h).
bool is_strained(const Volume& volume) {
  if (volume.keyframes.empty()) return volume.pressure != 1;
  return std::any_of(volume.keyframes.begin(), volume.keyframes.end(),
                     [](const PressureKeyframe& key) { return key.pressure != 1; });
}

/// True if no particle is kinematic, and the triangles connect all of them.
bool is_one_free_surface(const Object& object, const CompiledObject& out) {
  for (int p = 0; p < out.particles; ++p)
    if (!(out.positions[p].w > 0) || out.surface.corner_begin[p] == out.surface.corner_begin[p + 1]) return false;
  const int triangles = static_cast<int>(object.triangles.size());
  return find_pieces(find_edges(object.triangles, out.particles), triangles).count == 1;
}

}  // namespace

void fill_triangles(const Object& object, CompiledObject& out) {
  out.surface.triangles.reserve(object.triangles.size());
  for (const auto& triangle : object.triangles)
    out.surface.triangles.push_back({out.place[triangle[0]], out.place[triangle[1]], out.place[triangle[2]]});
}

void fill_corners(CompiledObject& out) {
  Surface& surface = out.surface;
  surface.corner_begin.assign(static_cast<std::size_t>(out.particles) + 1, 0);
  for (const auto& triangle : surface.triangles)
    for (int corner : triangle) ++surface.corner_begin[corner + 1];
  for (int p = 0; p < out.particles; ++p) surface.corner_begin[p + 1] += surface.corner_begin[p];
  surface.corners.resize(3 * surface.triangles.size());
  std::vector<int> next(surface.corner_begin.begin(), surface.corner_begin.end() - 1);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) surface.corners[next[surface.triangles[t][corner]]++] = 4 * t + corner;
  }
}

double pressure_at(const Volume& volume, double time) {
  const std::vector<PressureKeyframe>& keys = volume.keyframes;
  double pressure = static_cast<double>(volume.pressure);
  if (!keys.empty()) {
    std::vector<float> times;
    times.reserve(keys.size());
    for (const PressureKeyframe& key : keys) times.push_back(key.time);
    const TimePlace at = place_in(times, false, time);
    const auto before = static_cast<double>(keys[at.before].pressure),
               after = static_cast<double>(keys[at.after].pressure);
    pressure = before + at.share * (after - before);
  }
  if (!(volume.leak > 0 && pressure > 1)) return pressure;
  return 1 + (pressure - 1) * exp(-static_cast<double>(volume.leak) * std::max(time, 0.0));
}

double largest_pressure(const Volume& volume) {
  if (volume.keyframes.empty()) return static_cast<double>(volume.pressure);
  const auto largest = std::max_element(volume.keyframes.begin(), volume.keyframes.end(),
                                        [](const auto& a, const auto& b) { return a.pressure < b.pressure; });
  return static_cast<double>(largest->pressure);
}

double CompiledVolume::target_at(double time) const { return pressure_at(described, time) * at_rest; }

void fill_volume(const Object& object, int passes, CompiledObject& out) {
  if (!object.volume) return;
  double six_volumes = 0;
  const Vec3f& o = object.positions[object.triangles.empty() ? 0 : object.triangles[0][0]];
  const auto from_origin = [&](int i) {
    const Vec3f& p = object.positions[i];
    return Vec3<double>{double(p.x) - o.x, double(p.y) - o.y, double(p.z) - o.z};
  };
  for (const auto& t : object.triangles)
    six_volumes += dot(cross(from_origin(t[0]), from_origin(t[1])), from_origin(t[2]));
  const Stiffness& stiffness = object.volume->stiffness;
  const bool pbd = stiffness.kind == Stiffness::Kind::pbd;
  out.has_volume = true;
  out.volume.at_rest = six_volumes;
  out.volume.described = *object.volume;
  out.volume.target = object.volume->changes() ? out.volume.target_at(0) : object.volume->pressure * six_volumes;
  out.volume.law = pbd ? Law::pbd : stiffness.damping > 0 ? Law::damped : Law::compliant;
  out.volume.response = pbd ? static_cast<float>(stiffness_per_projection(stiffness.value, passes)) : stiffness.value;
  out.volume.damping = stiffness.damping;
  out.volume.lift = six_volumes < 0 ? -object.volume->lift : object.volume->lift;
  for (int p = 0; p < out.particles; ++p) {
    const bool is_free = out.positions[p].w > 0 && out.surface.corner_begin[p] < out.surface.corner_begin[p + 1];
    out.volume.mass += is_free ? 1.0 / out.positions[p].w : 0;
  }
  out.volume.keeps_momentum = is_strained(*object.volume) && is_one_free_surface(object, out);
}

std::vector<std::array<int, 2>> lines_of(const Object& object, const std::vector<int>& place) {
  std::vector<std::array<int, 2>> lines;
  const auto group = std::find_if(object.constraints.begin(), object.constraints.end(),
                                  [](const ConstraintGroup& one) { return is_length(one.type); });
  if (group == object.constraints.end()) return lines;
  for (std::size_t i = 0; i + 1 < group->particles.size(); i += 2) {
    const int a = group->particles[i], b = group->particles[i + 1];
    if (length_squared(object.positions[a] - object.positions[b]) > 0) lines.push_back({place[a], place[b]});
  }
  return lines;
}

}  // namespace pliant

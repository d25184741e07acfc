#include "solver/volume.h"

#include "math/functions.h"
#include "math/scalar.h"
#include "solver/damper.h"

namespace pliant {

namespace {

/// Positions relative to a particle o: x_i + d_i - x_o for displaced particles, x_i - x_o without displacements.
/// Differences of positions come first, so that rounding stays small.
struct Places {
  const Record* positions;
  const Record* displacements;
  Vec3f seen_from(int origin, int i) const {
    const Record &p = positions[i], &o = positions[origin];
    const Vec3f difference{p.x - o.x, p.y - o.y, p.z - o.z};
    return displacements == nullptr ? difference
                                    : difference + Vec3f{displacements[i].x, displacements[i].y, displacements[i].z};
  }
};

Vec3f gradient_at(const Surface& surface, const Places& places, int particle) {
  const Vec3f x = places.seen_from(particle, particle);
  Vec3f sum{};
  for (int c = surface.corner_begin[particle]; c < surface.corner_begin[particle + 1]; ++c) {
    const auto& triangle = surface.triangles[surface.corners[c] >> 2];
    const int corner = surface.corners[c] & 3;
    const Vec3f j = places.seen_from(particle, triangle[(corner + 1) % 3]),
                k = places.seen_from(particle, triangle[(corner + 2) % 3]);
    sum += cross(j - x, k - x);
  }
  return sum;
}

double dot_double(const Vec3f& a, const Vec3f& b) { return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z; }

void gather_tile(const CompiledObject& object, const Tile& tile, const SweepArguments& a, Record* gradients,
                 TileScratch& scratch) {
  const Places places{a.positions, a.displacements};
  scratch.gradient_squared = scratch.position_along = scratch.motion_along = 0;
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    const Vec3f gradient = gradient_at(object.surface, places, i);
    const Record &d = a.displacements[i], &r = a.remainders[i];
    gradients[i] = {gradient.x, gradient.y, gradient.z, 0};
    scratch.gradient_squared += a.positions[i].w * dot_double(gradient, gradient);
    scratch.position_along += dot_double(places.seen_from(0, i), gradient);
    scratch.motion_along += dot_double({d.x - r.x, d.y - r.y, d.z - r.z}, gradient);
  }
}

/// Computes the change of the multiplier in double precision, by the formulas in project.h.
double multiplier_change(const CompiledVolume& volume, double c, double mass, double motion, double multiplier,
                         const SweepArguments& a) {
  const double least = 1e-30;
  if (volume.law == Law::pbd) return -volume.response * c / max(mass, least);
  const double compliance = min(double(volume.response) * a.inverse_h2, 1e30);
  const double gamma = viscous_share(min(double(volume.response) * volume.damping * a.inverse_h, 1e30));
  return (-c - compliance * multiplier - gamma * motion) / max((1 + gamma) * mass + compliance, least);
}

/// Limits the change of the multiplier to where the linearisation holds. C grows with the cube of the size, so a small
/// balloon with a large target volume would overshoot far. The limit moves the surface on average (by mass: m |w g
/// change|^2 = w |g|^2 change^2) by about the radius of a ball of that volume.
double within_trust(const CompiledVolume& volume, double six_volumes, double mass, double change) {
  if (!(mass > 0)) return change;
  const double size = pow(max(abs(volume.target), abs(six_volumes)), 1.0 / 3);
  const double largest = 0.3 * size * sqrt(volume.mass / mass);
  return clamp(change, -largest, largest);
}

void apply_tile(const Tile& tile, const SweepArguments& a, const Record* gradients, double change) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    Record& d = a.displacements[i];
    const float scale = static_cast<float>(a.positions[i].w * change);
    d = {d.x + gradients[i].x * scale, d.y + gradients[i].y * scale, d.z + gradients[i].z * scale, 0};
  }
}

}  // namespace

namespace {

/// The sums over an object's tiles, and the change of its multiplier.
struct VolumeSums {
  double mass = 0, along = 0, motion = 0, change = 0;

  void add(const TileScratch& tile) {
    mass += tile.gradient_squared;
    along += tile.position_along;
    motion += tile.motion_along;
  }
};

void change_multiplier(const CompiledVolume& volume, const SweepArguments& a, double& multiplier, VolumeSums& sums) {
  if (a.first_pass) multiplier = 0;
  const double six_volumes = sums.along / 3, c = six_volumes - volume.target;
  const double change = multiplier_change(volume, c, sums.mass, sums.motion, multiplier, a);
  sums.change = static_cast<double>(a.relaxation) * within_trust(volume, six_volumes, sums.mass, change);
  multiplier += sums.change;
}

}  // namespace

void project_volumes(const Model& model, Workspace& workspace, Executor& executor,
                     FunctionRef<SweepArguments(int)> arguments, const std::vector<int>& tasks) {
  if (workspace.volume_gradients.empty() || tasks.empty()) return;
  const auto gradients_of = [&](int o) { return workspace.volume_gradients.data() + model.first[o]; };
  const auto tile_of = [&](const Task& tile) -> const Tile& { return model.objects[tile.object].tiles[tile.item]; };
  executor.parallel_for("solve: volume", static_cast<int>(tasks.size()), [&](int i) {
    const Task& tile = model.tiles()[tasks[i]];
    gather_tile(model.objects[tile.object], tile_of(tile), arguments(tile.object), gradients_of(tile.object),
                workspace.tiles[tasks[i]]);
  });
  std::vector<double> changes(tasks.size());  // of the object of each tile
  for (std::size_t i = 0; i < tasks.size();) {
    const int o = model.tiles()[tasks[i]].object;
    VolumeSums sums;
    std::size_t end = i;
    for (; end < tasks.size() && model.tiles()[tasks[end]].object == o; ++end) sums.add(workspace.tiles[tasks[end]]);
    change_multiplier(model.objects[o].volume, arguments(o), workspace.volume_multipliers[o], sums);
    for (; i < end; ++i) changes[i] = sums.change;
  }
  executor.parallel_for("solve: volume", static_cast<int>(tasks.size()), [&](int i) {
    const Task& tile = model.tiles()[tasks[i]];
    apply_tile(tile_of(tile), arguments(tile.object), gradients_of(tile.object), changes[i]);
  });
}

Vec3f volume_gradient(const CompiledObject& object, const Record* positions, int particle) {
  return gradient_at(object.surface, {positions, nullptr}, particle);
}

double volume_error(const CompiledObject& object, const Record* positions) {
  double along = 0;
  const Places places{positions, nullptr};
  for (int i = 0; i < object.particles; ++i)
    along += dot_double(places.seen_from(0, i), gradient_at(object.surface, places, i));
  return along / 3 - object.volume.target;
}

}  // namespace pliant

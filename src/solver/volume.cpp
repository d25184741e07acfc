#include "solver/volume.h"

#include "math/scalar.h"

namespace pliant {

namespace {

Vec3f position_of(const Record& r) { return {r.x, r.y, r.z}; }

Vec3f gradient_at(const Surface& surface, const Record* positions, int particle) {
  const Vec3f x = position_of(positions[particle]);
  Vec3f sum{};
  for (int c = surface.corner_begin[particle]; c < surface.corner_begin[particle + 1]; ++c) {
    const auto& triangle = surface.triangles[surface.corners[c] / 3];
    const int corner = surface.corners[c] % 3;
    const Vec3f j = position_of(positions[triangle[(corner + 1) % 3]]), k = position_of(positions[triangle[(corner + 2) % 3]]);
    sum += cross(j - x, k - x);
  }
  return sum;
}

double dot_double(const Vec3f& a, const Vec3f& b) { return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z; }

void gather_tile(const CompiledObject& object, const Tile& tile, const SweepArguments& a, Record* gradients, TileScratch& scratch) {
  const Vec3f origin = position_of(a.positions[0]);
  scratch.gradient_squared = scratch.position_along = scratch.motion_along = 0;
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    const Vec3f gradient = gradient_at(object.surface, a.positions, i);
    const Record &p = a.positions[i], &q = a.predicted[i], &v = a.velocities[i];
    const Vec3f motion = position_of(v) * a.h + (position_of(p) - position_of(q));
    gradients[i] = {gradient.x, gradient.y, gradient.z, 0};
    scratch.gradient_squared += p.w * dot_double(gradient, gradient);
    scratch.position_along += dot_double(position_of(p) - origin, gradient);
    scratch.motion_along += dot_double(motion, gradient);
  }
}

/// The change of the multiplier, by the same laws as project() in project.h, in double.
double multiplier_change(const CompiledVolume& volume, double c, double mass, double motion, double multiplier,
                         const SweepArguments& a) {
  const double least = 1e-30;
  if (volume.law == Law::pbd) return -volume.response * c / max(mass, least);
  const double compliance = min(double(volume.response) * a.inverse_h2, 1e30);
  const double gamma = min(double(volume.response) * volume.damping * a.inverse_h, 1e30);
  return (-c - compliance * multiplier - gamma * motion) / max((1 + gamma) * mass + compliance, least);
}

void apply_tile(const Tile& tile, const SweepArguments& a, const Record* gradients, double change) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    Record& p = a.positions[i];
    const float scale = static_cast<float>(p.w * change);
    p = {p.x + gradients[i].x * scale, p.y + gradients[i].y * scale, p.z + gradients[i].z * scale, p.w};
  }
}

}  // namespace

void project_volumes(const Model& model, Workspace& workspace, Executor& executor,
                     FunctionRef<SweepArguments(int)> arguments) {
  if (workspace.volume_gradients.empty()) return;
  const auto gather = [&](int task) {
    const CompiledObject& object = model.objects[model.tiles[task].object];
    if (!object.has_volume) return;
    Record* gradients = workspace.volume_gradients.data() + model.first[model.tiles[task].object];
    gather_tile(object, object.tiles[model.tiles[task].tile], arguments(model.tiles[task].object), gradients,
                workspace.tiles[task]);
  };
  executor.parallel_for("solve: volume", static_cast<int>(model.tiles.size()), gather);

  std::vector<double>& multipliers = workspace.volume_multipliers;
  struct Sums {
    double mass = 0, along = 0, motion = 0, change = 0;
  };
  std::vector<Sums> sums(model.objects.size());
  for (std::size_t task = 0; task < model.tiles.size(); ++task) {
    Sums& sum = sums[model.tiles[task].object];
    sum.mass += workspace.tiles[task].gradient_squared;
    sum.along += workspace.tiles[task].position_along;
    sum.motion += workspace.tiles[task].motion_along;
  }
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    const CompiledObject& object = model.objects[o];
    if (!object.has_volume) continue;
    const SweepArguments a = arguments(o);
    if (a.first_pass) multipliers[o] = 0;
    const double c = sums[o].along / 3 - object.volume.target;
    sums[o].change = multiplier_change(object.volume, c, sums[o].mass, sums[o].motion, multipliers[o], a);
    multipliers[o] += sums[o].change;
  }
  const auto apply = [&](int task) {
    const int o = model.tiles[task].object;
    if (!model.objects[o].has_volume) return;
    apply_tile(model.objects[o].tiles[model.tiles[task].tile], arguments(o), workspace.volume_gradients.data() + model.first[o],
               sums[o].change);
  };
  executor.parallel_for("solve: volume", static_cast<int>(model.tiles.size()), apply);
}

double volume_error(const CompiledObject& object, const Record* positions) {
  double along = 0;
  const Vec3f origin = position_of(positions[0]);
  for (int i = 0; i < object.particles; ++i) {
    along += dot_double(position_of(positions[i]) - origin, gradient_at(object.surface, positions, i));
  }
  return along / 3 - object.volume.target;
}

}  // namespace pliant

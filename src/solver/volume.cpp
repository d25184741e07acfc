#include "solver/volume.h"

#include "math/functions.h"
#include "math/scalar.h"

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
    const auto& triangle = surface.triangles[surface.corners[c] / 3];
    const int corner = surface.corners[c] % 3;
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
  const double gamma = min(double(volume.response) * volume.damping * a.inverse_h, 1e30);
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

void project_volumes(const Model& model, Workspace& workspace, Executor& executor,
                     FunctionRef<SweepArguments(int)> arguments, FunctionRef<bool(int)> takes_part) {
  if (workspace.volume_gradients.empty()) return;
  const auto gather = [&](int task) {
    const CompiledObject& object = model.objects[model.tiles()[task].object];
    if (!takes_part(model.tiles()[task].object)) return;
    Record* gradients = workspace.volume_gradients.data() + model.first[model.tiles()[task].object];
    gather_tile(object, object.tiles[model.tiles()[task].item], arguments(model.tiles()[task].object), gradients,
                workspace.tiles[task]);
  };
  executor.parallel_for("solve: volume", static_cast<int>(model.tiles().size()), gather);

  std::vector<double>& multipliers = workspace.volume_multipliers;
  struct Sums {
    double mass = 0, along = 0, motion = 0, change = 0;
  };
  std::vector<Sums> sums(model.objects.size());
  for (std::size_t task = 0; task < model.tiles().size(); ++task) {
    Sums& sum = sums[model.tiles()[task].object];
    sum.mass += workspace.tiles[task].gradient_squared;
    sum.along += workspace.tiles[task].position_along;
    sum.motion += workspace.tiles[task].motion_along;
  }
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    const CompiledObject& object = model.objects[o];
    if (!takes_part(o)) continue;
    const SweepArguments a = arguments(o);
    if (a.first_pass) multipliers[o] = 0;
    const double six_volumes = sums[o].along / 3, c = six_volumes - object.volume.target;
    const double change = multiplier_change(object.volume, c, sums[o].mass, sums[o].motion, multipliers[o], a);
    sums[o].change = static_cast<double>(a.relaxation) * within_trust(object.volume, six_volumes, sums[o].mass, change);
    multipliers[o] += sums[o].change;
  }
  const auto apply = [&](int task) {
    const int o = model.tiles()[task].object;
    if (!takes_part(o)) return;
    apply_tile(model.objects[o].tiles[model.tiles()[task].item], arguments(o),
               workspace.volume_gradients.data() + model.first[o], sums[o].change);
  };
  executor.parallel_for("solve: volume", static_cast<int>(model.tiles().size()), apply);
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

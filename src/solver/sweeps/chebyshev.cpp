#include "solver/sweeps/chebyshev.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/drivers/contacts.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Safety factor on rho as estimated from plain iterations: an overestimate costs more than an underestimate.
constexpr double caution = 0.999;
/// Upper limit of rho: float iterates cannot resolve values closer to 1.
constexpr double largest_radius = 0.99999;
/// If corrections grow by this factor after acceleration began, it diverges, and the rest of the substep is plain.
constexpr double largest_growth = 4;
/// If corrections fall to this share of the substep's first one, the rest is rounding error, and acceleration ends.
constexpr double smallest_share = 1e-7;
/// With an estimated rho, acceleration also ends if after this many steps corrections are still above `least_progress`
/// of their initial size: then they stagnate at rounding error.
constexpr int patience = 32;
constexpr double least_progress = 0.95;
/// rho is judged after numbers of steps that are powers of two, beginning with this one, while the Chebyshev polynomial
/// is below largest_polynomial.
constexpr int first_judgement = 8;
constexpr double largest_polynomial = 1e10;

ChebyshevScratch& chebyshev_of(const Substep& s) { return static_cast<ChebyshevScratch&>(*s.group->acceleration); }

// ---------------------------------------------------------------- rho and the weight

bool is_power_of_two(int n) { return (n & (n - 1)) == 0; }

void start(double radius, double norm, ChebyshevRecurrence& c) {
  c.spectral_radius = radius;
  c.start_norm = norm;
  c.steps = 0;
  c.polynomial = 1;
  c.polynomial_before = 1 / radius;  // T_(-1) = T_1
}

/// Solves T_n(lambda / rho) = excess for lambda: rho cosh(acosh(excess) / n). The number of steps n is a power of two.
double judged_radius(const ChebyshevRecurrence& c, double excess) {
  double root = excess + std::sqrt(excess * excess - 1);
  for (int i = 1; i < c.steps; i *= 2) root = std::sqrt(root);
  return min(c.spectral_radius * (root + 1 / root) / 2, largest_radius);
}

/// If a larger rho explains the slow decrease of corrections, restarts the recurrence with it and returns true.
bool raise_radius(double norm, ChebyshevRecurrence& c) {
  if (c.steps < first_judgement || !is_power_of_two(c.steps) || c.polynomial > largest_polynomial) return false;
  const double excess = norm / c.start_norm * c.polynomial;
  if (!(excess * excess * excess * excess > c.polynomial)) return false;
  const double judged = judged_radius(c, excess);
  if (!(judged > c.spectral_radius)) return false;
  start(judged, norm, c);
  return true;
}

/// Returns omega for the next extrapolation. `norm` is the norm of the last sweep's correction before extrapolation.
double next_weight(const SweepOptions& options, int iteration, double norm, ChebyshevRecurrence& c) {
  const bool estimates = options.spectral_radius == 0;
  const double ratio = iteration > 0 && c.last_norm > 0 ? norm / c.last_norm : 1;
  c.last_norm = norm;
  if (iteration == 0) c.plain_norm = norm;
  if (c.given_up || iteration + 1 < options.plain_iterations) return 1;
  if (c.steps < 0) {  // the last plain iteration is step 0 of the recurrence
    if (!estimates) start(static_cast<double>(options.spectral_radius), norm, c);
    if (estimates && ratio < 1 && norm > 0) start(min(caution * ratio, largest_radius), norm, c);
    c.first_norm = norm;
    return 1;
  }
  const double next = 2 / c.spectral_radius * c.polynomial - c.polynomial_before;
  c.polynomial_before = std::exchange(c.polynomial, min(next, 1e100));
  ++c.steps;
  const bool idle =
      estimates && c.steps >= patience && is_power_of_two(c.steps) && !(norm < least_progress * c.start_norm);
  c.given_up = !(norm <= largest_growth * c.first_norm) || norm <= smallest_share * c.plain_norm || idle;
  if (c.given_up || (estimates && raise_radius(norm, c))) return 1;
  const double squared = c.spectral_radius * c.spectral_radius;
  return c.steps == 1 ? 2 / (2 - squared) : 4 / (4 - squared * c.weight);
}

// ---------------------------------------------------------------- particles

double correction_norm_squared(const Record* positions, const Record* displacements, const Record* before, int first,
                               int last) {
  double sum = 0;
  for (int i = first; i < last; ++i) {
    const double w = static_cast<double>(positions[i].w);
    if (!(w > 0)) continue;
    const double x = static_cast<double>(displacements[i].x - before[i].x),
                 y = static_cast<double>(displacements[i].y - before[i].y),
                 z = static_cast<double>(displacements[i].z - before[i].z);
    sum += (x * x + y * y + z * z) / w;
  }
  return sum;
}

void extrapolate(float weight, const Record* older, Record* displacements, int first, int last) {
  for (int i = first; i < last; ++i) {
    const Record& o = older[i];
    Record& d = displacements[i];
    d = {o.x + weight * (d.x - o.x), o.y + weight * (d.y - o.y), o.z + weight * (d.z - o.z), 0};
  }
}

/// Extrapolates all particles of a tile except those that touch a collider.
void extrapolate_tile(float weight, const Tile& tile, const Record* older, Record* displacements,
                      const std::vector<Contact>& contacts, std::vector<Record>& touching) {
  touching.clear();
  for (const Contact& contact : contacts) touching.push_back(displacements[contact.point[0]]);
  extrapolate(weight, older, displacements, tile.first_particle, tile.last_particle);
  for (std::size_t i = 0; i < touching.size(); ++i) {
    if (contacts[i].push > 0) displacements[contacts[i].point[0]] = touching[i];
  }
}

// ---------------------------------------------------------------- multipliers

/// Extrapolates the multipliers of all pools. It runs on one thread, because this costs little compared with a
/// sweep.
void extrapolate_multipliers(const Substep& s, float weight, const LaneValues& older) {
  LaneValues& multipliers = s.work.multipliers;
  for (std::size_t o = 0; o < multipliers.size(); ++o) {
    if (!is_swept(s, static_cast<int>(o))) continue;
    for (std::size_t p = 0; p < multipliers[o].size(); ++p) {
      const float* from = older[o][p].data();
      float* to = multipliers[o][p].data();
      for (std::size_t i = 0; i < multipliers[o][p].size(); ++i) to[i] = from[i] + weight * (to[i] - from[i]);
    }
  }
}

void extrapolate_everything(Substep& s, float weight) {
  const Model& model = s.model;
  ChebyshevScratch& c = chebyshev_of(s);
  c.touching_points.clear();
  for_touching_points(s, [&](int particle) {
    if (is_swept(s, model.object_of(particle)))
      c.touching_points.emplace_back(particle, s.work.displacements[particle]);
  });
  for_swept_tiles(s, "solve: chebyshev", [&](int task) {
    const int o = model.tiles()[task].object;
    extrapolate_tile(weight, model.objects[o].tiles[model.tiles()[task].item],
                     c.older.displacements.data() + model.first[o], arguments(s, o, false).displacements,
                     s.work.tiles[task].contacts, c.touching[task]);
  });
  for (const auto& [particle, displacement] : c.touching_points) s.work.displacements[particle] = displacement;
  extrapolate_multipliers(s, weight, c.older.multipliers);
  std::vector<double>& volumes = s.work.volume_multipliers;
  for (std::size_t o = 0; o < volumes.size(); ++o)
    if (is_swept(s, static_cast<int>(o)))
      volumes[o] = c.older.volumes[o] + static_cast<double>(weight) * (volumes[o] - c.older.volumes[o]);
}

/// Stores the current multipliers. Before the first sweep of a substep it stores zeros, because the array still holds
/// those of the previous substep.
void keep_multipliers(const Substep& s, bool first, ChebyshevScratch& c) {
  const Workspace& work = s.work;
  for (std::size_t o = 0; o < work.multipliers.size(); ++o) {
    if (!is_swept(s, static_cast<int>(o))) continue;
    for (std::size_t p = 0; p < work.multipliers[o].size(); ++p) {
      AlignedVector<float>& kept = c.before.multipliers[o][p];
      if (first) {
        std::fill(kept.begin(), kept.end(), 0.f);
      } else {
        std::copy(work.multipliers[o][p].begin(), work.multipliers[o][p].end(), kept.begin());
      }
    }
    c.before.volumes[o] = first ? 0 : work.volume_multipliers[o];
  }
}

double correction_norm(Substep& s) {
  const Model& model = s.model;
  ChebyshevScratch& c = chebyshev_of(s);
  std::fill(c.tile_sums.begin(), c.tile_sums.end(), 0.);
  for_swept_tiles(s, "solve: chebyshev", [&](int task) {
    const int o = model.tiles()[task].object;
    const Tile& tile = model.objects[o].tiles[model.tiles()[task].item];
    const SweepArguments a = arguments(s, o, false);
    c.tile_sums[task] =
        correction_norm_squared(a.positions, a.displacements, c.before.displacements.data() + model.first[o],
                                tile.first_particle, tile.last_particle);
  });
  double sum = 0;
  for (double tile : c.tile_sums) sum += tile;  // sum in the order of tiles, so that it does not depend on threads
  return std::sqrt(sum);
}

}  // namespace

void ChebyshevScratch::prepare(const SweepSetup& setup, int object) {
  for (ChebyshevIterate* iterate : {&before, &older}) {
    iterate->displacements.resize(setup.model.particles());
    iterate->multipliers.resize(setup.model.objects.size());
    iterate->multipliers[object].clear();
    if (setup.has(object)) iterate->multipliers[object] = setup.workspace.multipliers[object];
    iterate->volumes.resize(setup.model.objects.size());
  }
  tile_sums.resize(setup.model.tiles().size());
  touching.resize(setup.model.tiles().size());
}

void keep_iterate(Substep& s, int iteration) {
  ChebyshevScratch& c = chebyshev_of(s);
  const Model& model = s.model;
  if (iteration == 0) {
    c.recurrence.weight = 1;
    c.recurrence.last_norm = 0;
    c.recurrence.steps = -1;
    c.recurrence.given_up = false;
  }
  for_swept_tiles(s, "solve: chebyshev", [&](int task) {
    const int o = model.tiles()[task].object;
    const Tile& tile = model.objects[o].tiles[model.tiles()[task].item];
    const Record* displacements = arguments(s, o, false).displacements;
    std::copy(displacements + tile.first_particle, displacements + tile.last_particle,
              c.before.displacements.begin() + model.first[o] + tile.first_particle);
  });
  keep_multipliers(s, iteration == 0, c);
}

void accelerate(Substep& s, int iteration) {
  ChebyshevScratch& c = chebyshev_of(s);
  c.recurrence.weight = next_weight(s.context.options, iteration, correction_norm(s), c.recurrence);
  if (c.recurrence.weight != 1) extrapolate_everything(s, static_cast<float>(c.recurrence.weight));
  std::swap(c.before, c.older);
}

}  // namespace pliant

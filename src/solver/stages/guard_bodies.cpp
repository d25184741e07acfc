// Keeps contact of rigid bodies with cloth and rope from increasing energy.
//
// A body that falls on cloth stretches it further than a substep's solve can take back. What is left is corrected in
// the next substeps, with a velocity of strain / h, so inextensible cloth acts as a trampoline. So if energy of an
// island of bodies and cloth (bodies/body_islands.h) would increase, only a share of its corrections becomes velocity,
// as in guard_energy.cpp. Positions are corrected wholly. Elastic energy of stretched edges may become kinetic energy.
//
// An island on which work is done from outside is left alone: BodyIslands::is_driven, and kinematic particles that
// move.
//
// All sums are made in one pass over nodes, so the cost is linear in bodies, particles and contacts.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "math/vector.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/stages/energy_share.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Energy may increase up to that of the lightest body at this speed, so that stretched cloth recovers: a rise of 3 mm
/// [m^2/s^2].
constexpr double slow_squared = 0.25 * 0.25;

/// Adds the energy of a body's rotation.
void add_rotation(const Substep& s, int frame, CorrectionEnergy& sum) {
  const double inverse_h = 1 / static_cast<double>(s.h);
  const Vec3d inverse = convert<double>(xyz(s.state.frames.inverse_inertias[at(frame)]));
  if (!(inverse.x > 0 && inverse.y > 0 && inverse.z > 0)) return;
  const Quatf back = conjugate(quaternion(s.state.frames.orientations[at(frame)]));
  const auto spin = [&](const Record& turned) { return convert<double>(rotate(back, xyz(turned))) * inverse_h; };
  const auto momentum = [&](const Vec3d& w) { return Vec3d{w.x / inverse.x, w.y / inverse.y, w.z / inverse.z}; };
  const Vec3d predicted = spin(s.work.frames.predicted[at(frame)]),
              correction = spin(s.work.frames.corrections[at(frame)]);
  sum.kinetic += 0.5 * dot(predicted, momentum(predicted));
  sum.linear += dot(predicted, momentum(correction));
  sum.quadratic += 0.5 * dot(correction, momentum(correction));
}

double total(const CorrectionEnergy& of) { return of.predicted + of.linear + of.quadratic; }

/// The elastic energy that the edges of an object gain in the substep: C^2 / (2 alpha) of each compliant edge [J].
double elastic_gain(const Substep& s, int object) {
  const CompiledObject& of = s.model.objects[at(object)];
  const Record* const positions = s.state.positions.data() + s.model.first[at(object)];
  const Record* const displacements = s.work.displacements.data() + s.model.first[at(object)];
  double gain = 0;
  for (const ChainBatch& chain : of.chains) {
    const Pool& pool = of.pools[at(chain.pool)];
    for (int k = 0; k < chain.steps; ++k) {
      const Segment& link = of.segments[at(chain.first_segment + k)];
      for (int lane = 0; lane < link.last_count; ++lane) {
        const float compliance = pool.row(1, link.first_batch)[lane];
        if (!(compliance > 0)) continue;
        const std::int32_t* const points = pool.indices.data() + link.index_offset + lane;
        const int a = points[0], b = points[batch_width];
        const Vec3f start = xyz(positions[b]) - xyz(positions[a]);
        const Vec3f end = start + (xyz(displacements[b]) - xyz(displacements[a]));
        const float rest = pool.row(0, link.first_batch)[lane], before = length(start) - rest,
                    after = length(end) - rest;
        gain += 0.5 * static_cast<double>((after - before) * (after + before)) / static_cast<double>(compliance);
      }
    }
  }
  return gain;
}

/// Sums over an island.
struct IslandEnergy {
  CorrectionEnergy centres, rotations;  ///< of bodies
  CorrectionEnergy points;              ///< of particles
  double edges = 0;                     ///< gain of elastic energy [J]
  float largest_inverse_mass = 0;       ///< of bodies that press [1/kg]
  double excess = 0;                    ///< by how much the energy of bodies increases [J]
};

/// The islands in which bodies press on particles, and on which no work is done from outside, by their smallest node.
class GuardedIslands {
 public:
  GuardedIslands(const Substep& s, const BodyIslands& islands) : islands_(islands), number_(at(islands.nodes()), -1) {
    for (const Contact& c : s.bodies->point_contacts()) {
      if (!(c.push > 0)) continue;
      const int body = s.bodies->body_of(c),
                island = islands.island_of(islands.node_of_points(s.model.object_of(c.point[0])));
      if (islands.is_driven(island)) continue;
      if (number_[at(island)] < 0) {
        number_[at(island)] = static_cast<int>(energies_.size());
        energies_.emplace_back();
      }
      float& largest = of_island(island)->largest_inverse_mass;
      largest = std::max(largest, s.state.positions[at(s.bodies->touched_bodies()[at(body)].particle)].w);
    }
  }

  bool empty() const { return energies_.empty(); }
  std::vector<IslandEnergy>& energies() { return energies_; }
  /// The island of a node; null if it is not guarded.
  IslandEnergy* of(int node) { return of_island(islands_.island_of(node)); }
  IslandEnergy* of_points(int object) { return of(islands_.node_of_points(object)); }

 private:
  IslandEnergy* of_island(int island) {
    const int number = number_[at(island)];
    return number < 0 ? nullptr : &energies_[at(number)];
  }

  const BodyIslands& islands_;
  std::vector<int> number_;  ///< [island] index in energies_, or -1
  std::vector<IslandEnergy> energies_;
};

void add_bodies(const Substep& s, GuardedIslands& islands) {
  const std::vector<TouchedBody>& all = s.bodies->touched_bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    IslandEnergy* const island = islands.of(static_cast<int>(b));
    if (island == nullptr) continue;
    add_correction_energy(s, PredictedGravity(s, all[b].object), object_particles(s, all[b].object),
                          all[b].particle - s.model.first[at(all[b].object)], island->centres);
    add_rotation(s, all[b].frame, island->rotations);
  }
  for (IslandEnergy& island : islands.energies()) {
    add(island.centres, island.rotations);
    island.excess = total(island.rotations);
  }
}

/// The energies of a tile's particles that are no centres of bodies.
CorrectionEnergy energy_of_points(const Substep& s, int task) {
  const int object = s.model.tiles()[at(task)].object;
  const CompiledBodies& bodies = s.model.objects[at(object)].bodies;
  if (bodies.empty()) return correction_energy(s, task);
  CorrectionEnergy sum;
  const AdvanceArguments a = particles(s, task);
  const PredictedGravity gravity(s, object);
  for (int i = a.first; i < a.last; ++i)
    if (!bodies.has_centre(i)) add_correction_energy(s, gravity, a, i, sum);
  return sum;
}

/// Adds particles and edges of islands in which the energy of bodies increases.
void add_points(const Substep& s, GuardedIslands& islands) {
  for_each_tile(s, [&](int task) {
    IslandEnergy* const island = islands.of_points(s.model.tiles()[at(task)].object);
    if (island != nullptr && island->excess > 0) add(energy_of_points(s, task), island->points);
  });
  for_objects(s, [&](int object) {
    IslandEnergy* const island = islands.of_points(object);
    if (island != nullptr && island->excess > 0) island->edges += elastic_gain(s, object);
  });
}

/// Only the energy of bodies is limited: that of light particles between stiff edges is noise, and would leave bodies
/// no share. What the particles lose may go to the bodies.
float share_of(const IslandEnergy& island) {
  if (!(island.excess > 0) || island.points.has_outside_work || island.centres.has_outside_work) return 1;
  CorrectionEnergy bodies = island.rotations;  // and centres: add_bodies
  const double lightest = island.largest_inverse_mass > 0 ? 1 / static_cast<double>(island.largest_inverse_mass) : 0;
  const double from_particles = std::max(-total(island.points), 0.), from_edges = std::max(-island.edges, 0.),
               slow = std::max(lightest * slow_squared / 2 - bodies.kinetic, 0.);
  bodies.predicted -= from_particles + from_edges + slow;
  return static_cast<float>(largest_share(bodies));
}

void set_shares(const Substep& s, GuardedIslands& islands, VelocityShares& shares) {
  const auto share_at = [](const IslandEnergy* island) { return island == nullptr ? 1.f : share_of(*island); };
  const std::vector<TouchedBody>& all = s.bodies->touched_bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const float share = share_at(islands.of(static_cast<int>(b)));
    if (share < 1) shares.set_body(s.model, all[b].object, all[b].body, share);
  }
  for_objects(s, [&](int object) {
    const float share = share_at(islands.of_points(object));
    if (share < 1) shares.set_points(s.model, object, share);
  });
}

}  // namespace

void guard_bodies(Substep& s) {
  if (s.bodies == nullptr) return;
  s.bodies->velocity_shares().clear();
  if (s.bodies->point_contacts().empty()) return;
  GuardedIslands islands(s, s.bodies->find_islands(s));
  if (islands.empty()) return;
  add_bodies(s, islands);
  add_points(s, islands);
  set_shares(s, islands, s.bodies->velocity_shares());
}

}  // namespace pliant

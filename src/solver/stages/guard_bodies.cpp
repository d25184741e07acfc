// Keeps contact of rigid bodies with cloth and rope from increasing energy.
//
// A body that falls on cloth stretches it further than a substep's solve can take back. What is left is corrected in the next
// substeps, with a velocity of strain / h, so inextensible cloth acts as a trampoline. So the objects that press on one another
// form an island, and if energy of an island would increase, only a share of its corrections becomes velocity, as in
// guard_energy.cpp. Positions are corrected wholly. Elastic energy of stretched edges may become kinetic energy.
//
// Where work is done from outside, an island is left alone: by kinematic particles and colliders that move, by joints, which
// may have motors and springs, and by pressure of volumes.
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

using namespace bodies;

/// Energy may increase up to that of the lightest body at this speed, so that stretched cloth recovers: a rise of 3 mm [m^2/s^2].
constexpr double slow_squared = 0.25 * 0.25;

/// Objects joined by contacts of points with bodies: for each the smallest index of its island, or -1 in none.
std::vector<int> islands_of(const Substep& s) {
  std::vector<int> island(s.model.objects.size(), -1);
  const auto root = [&](int object) {
    if (island[at(object)] < 0) island[at(object)] = object;
    while (island[at(object)] != object) object = island[at(object)];
    return object;
  };
  for (const Contact& c : s.bodies->point_contacts()) {
    if (!(c.push > 0)) continue;
    const int a = root(s.model.object_of(c.point[0])), b = root(s.bodies->object_of_solid(c.collider));
    island[at(std::max(a, b))] = std::min(a, b);
  }
  for (int object = 0; object < static_cast<int>(island.size()); ++object)
    if (island[at(object)] >= 0) island[at(object)] = root(object);
  return island;
}

/// True if the object can do work on others without losing energy that is counted here.
bool has_other_energy(const CompiledObject& object) {
  return object.is_collider || object.has_volume || !object.bodies.jointed.empty();
}

bool any_collider_moves(const Substep& s) {
  return std::any_of(s.own->colliders.begin(), s.own->colliders.end(), [](const MovingCollider& c) { return c.moves; });
}

/// Adds the energy of a body's rotation.
void add_rotation(const Substep& s, int frame, CorrectionEnergy& sum) {
  const double inverse_h = 1 / static_cast<double>(s.h);
  const Vec3d inverse = convert<double>(xyz(s.state.frames.inverse_inertias[at(frame)]));
  if (!(inverse.x > 0 && inverse.y > 0 && inverse.z > 0)) return;
  const Quatf back = conjugate(quaternion(s.state.frames.orientations[at(frame)]));
  const auto spin = [&](const Record& turned) { return convert<double>(rotate(back, xyz(turned))) * inverse_h; };
  const auto momentum = [&](const Vec3d& w) { return Vec3d{w.x / inverse.x, w.y / inverse.y, w.z / inverse.z}; };
  const Vec3d predicted = spin(s.work.frames.predicted[at(frame)]), correction = spin(s.work.frames.corrections[at(frame)]);
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
        const float rest = pool.row(0, link.first_batch)[lane], before = length(start) - rest, after = length(end) - rest;
        gain += 0.5 * static_cast<double>((after - before) * (after + before)) / static_cast<double>(compliance);
      }
    }
  }
  return gain;
}

/// The smallest mass of a free body that presses in an island [kg].
double lightest_body(const Substep& s, const std::vector<int>& island, int number) {
  float largest = 0;
  for (const Contact& c : s.bodies->point_contacts()) {
    if (!(c.push > 0) || island[at(s.model.object_of(c.point[0]))] != number) continue;
    largest = std::max(largest, s.state.positions[at(s.bodies->particle_of_solid(c.collider))].w);
  }
  return largest > 0 ? 1 / static_cast<double>(largest) : 0;
}

/// Only the energy of bodies is limited: that of light particles between stiff edges is noise, and would leave bodies no share.
/// What the particles lose may go to the bodies.
double share_of_island(const Substep& s, const std::vector<int>& island, int number) {
  const auto is_inside = [&](int object) { return island[at(object)] == number; };
  bool is_open = false;
  for_objects(s, [&](int o) { is_open = is_open || (is_inside(o) && has_other_energy(s.model.objects[at(o)])); });
  if (is_open) return 1;
  CorrectionEnergy bodies, centres;
  for (const TouchedBody& body : s.bodies->touched_bodies()) {
    if (!is_inside(body.object)) continue;
    const int first = s.model.first[at(body.object)];
    add_correction_energy(s, PredictedGravity(s, body.object), object_particles(s, body.object), body.particle - first,
                          centres);
    add_rotation(s, body.frame, bodies);
  }
  add(centres, bodies);
  if (!(total(bodies) > 0)) return 1;
  CorrectionEnergy all;
  for_each_tile(s, [&](int task) {
    if (is_inside(s.model.tiles()[at(task)].object)) add(correction_energy(s, task), all);
  });
  if (all.has_outside_work) return 1;
  double gain = 0;
  for_objects(s, [&](int object) {
    if (is_inside(object)) gain += elastic_gain(s, object);
  });
  const double from_particles = std::max(total(centres) - total(all), 0.), from_edges = std::max(-gain, 0.),
               slow = std::max(lightest_body(s, island, number) * slow_squared / 2 - bodies.kinetic, 0.);
  bodies.predicted -= from_particles + from_edges + slow;
  return largest_share(bodies);
}

}  // namespace

float velocity_share(const Substep& s, int object) {
  return s.velocity_share * (s.bodies != nullptr ? s.bodies->velocity_share(object) : 1);
}

void guard_bodies(Substep& s) {
  if (s.bodies == nullptr) return;
  std::vector<float>& shares = s.bodies->velocity_shares();
  shares.clear();
  if (s.bodies->point_contacts().empty() || any_collider_moves(s)) return;
  const std::vector<int> island = islands_of(s);
  for (int number = 0; number < static_cast<int>(island.size()); ++number) {
    if (island[at(number)] != number) continue;
    const double share = share_of_island(s, island, number);
    if (!(share < 1)) continue;
    shares.resize(island.size(), 1);
    for (std::size_t object = 0; object < island.size(); ++object)
      if (island[object] == number) shares[object] = static_cast<float>(share);
  }
}

}  // namespace pliant

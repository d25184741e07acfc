// Keeps substeps that become shorter from increasing energy.
//
// An unfinished solve acts like a spring: strain that it leaves is corrected in the next substep, with a velocity of
// strain / h, so the energy stored in it goes with the square of strain / h. If the State demands more substeps in the
// middle of an impact, h decreases while the strain stays, and that energy multiplies
// (docs/internals/default_settings_tried.md). So in a quarter that has more substeps than the last one only a share of
// the corrections becomes velocity. Positions are corrected wholly.
//
// The share is the same for all particles of a group, so corrections still conserve momentum. Without corrections a
// substep conserves energy but for -m g^2 h^2 / 2, so a share exists unless corrections lift particles by more.
#include <algorithm>
#include <cmath>

#include "math/vector.h"
#include "solver/stages/energy_share.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

Vec3d as_double(const Record& r) { return {r.x, r.y, r.z}; }

}  // namespace

CorrectionEnergy correction_energy(const Substep& s, int task) {
  CorrectionEnergy sum;
  if (object_of(s, task).is_collider) return sum;  // it does work where it pushes: is_pushed_by_what_moves
  const AdvanceArguments a = particles(s, task);
  const PredictedGravity gravity(s, s.model.tiles()[task].object);
  for (int i = a.first; i < a.last; ++i) add_correction_energy(s, gravity, a, i, sum);
  return sum;
}

PredictedGravity::PredictedGravity(const Substep& s, int object) : acceleration(convert<double>(s.model.gravity)) {
  const FrameGravity& of = s.work.gravity[object];
  settled = acceleration * of.settled;
  begun = acceleration * of.begun;
}

void add_correction_energy(const Substep& s, const PredictedGravity& gravity, const AdvanceArguments& a, int i,
                           CorrectionEnergy& sum) {
  const Vec3d moved = as_double(a.displacements[i]), carried = as_double(a.remainders[i]);
  const double w = static_cast<double>(a.positions[i].w);
  if (!(w > 0)) {
    sum.has_outside_work = sum.has_outside_work || length(moved - carried) > 0;
    return;
  }
  const Vec3d velocity = as_double(a.velocities[i]), before = velocity + gravity.settled,
              predicted = velocity + gravity.begun;
  const Vec3d correction = (moved - carried) * (1 / static_cast<double>(s.h)) - predicted;
  sum.kinetic += 0.5 * dot(before, before) / w;
  sum.predicted += (0.5 * (dot(predicted, predicted) - dot(before, before)) - dot(gravity.acceleration, moved)) / w;
  sum.linear += dot(predicted, correction) / w;
  sum.quadratic += 0.5 * dot(correction, correction) / w;
}

void add(const CorrectionEnergy& of, CorrectionEnergy& sum) {
  sum.kinetic += of.kinetic;
  sum.predicted += of.predicted;
  sum.linear += of.linear;
  sum.quadratic += of.quadratic;
  sum.has_outside_work = sum.has_outside_work || of.has_outside_work;
}

double largest_share(const CorrectionEnergy& e) {
  if (!(e.predicted + e.linear + e.quadratic > 0) || !(e.quadratic > 0)) return 1;
  const double discriminant = e.linear * e.linear - 4 * e.quadratic * e.predicted;
  const double root = discriminant > 0 ? std::sqrt(discriminant) : 0;
  const double share = (root - e.linear) / (2 * e.quadratic);
  return std::isfinite(share) ? std::clamp(share, 0., 1.) : 1;
}

namespace {

CorrectionEnergy energy_of_group(Substep& s) {
  for_tiles(s, "guard energy", [&](int task) { s.work.tiles[task].energy = correction_energy(s, task); });
  CorrectionEnergy sum;
  for_each_tile(s, [&](int task) { add(s.work.tiles[task].energy, sum); });
  return sum;
}

/// True if the point of a contact is kinematic and moves.
bool is_carried(const Substep& s, int point) {
  const Vec3d moved = as_double(s.work.displacements[point]) - as_double(s.state.remainders[point]);
  return !(s.state.positions[point].w > 0) && length(moved) > 0;
}

bool is_pushing(const MovingCollider& collider) { return collider.moves || collider.slides(); }

/// True if a collider that moves pushes a particle of the group, and so may do work.
bool is_pushed_by_what_moves(const Substep& s) {
  const auto pushes = [&](const Contact& c) { return c.push > 0 && is_pushing(s.own->colliders[c.collider]); };
  const auto any_pushes = [&](const std::vector<Contact>& contacts) {
    return std::any_of(contacts.begin(), contacts.end(), pushes);
  };
  bool found = any_pushes(s.own->shape_contacts);
  for_each_tile(s, [&](int task) { found = found || any_pushes(s.work.tiles[task].contacts); });
  if (found || !s.has_pairs()) return found;
  const auto is_pushed = [&](const Contact& c) {
    bool carried = c.push > 0 && c.surface_motion != Vec3f{};  // by a mesh whose surface slides
    for (std::size_t i = 0; c.push > 0 && i < c.point.size(); ++i)
      carried = carried || (c.weight[i] != 0 && is_carried(s, c.point[i]));
    return carried;
  };
  return std::any_of(s.pairs->contacts().begin(), s.pairs->contacts().end(), is_pushed);
}

}  // namespace

void guard_energy(Substep& s) {
  s.velocity_share = 1;
  if (!s.is_guarded) return;
  if (is_pushed_by_what_moves(s)) return;
  const CorrectionEnergy energy = energy_of_group(s);
  if (!energy.has_outside_work) s.velocity_share = static_cast<float>(largest_share(energy));
}

}  // namespace pliant

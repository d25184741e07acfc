// Contacts in the multigrid correction: a stiff spring along the normal and, against sliding, one no stiffer than Coulomb
// allows, so that what lies on something does not first fall into it and then be torn out of it.
//
// A spring is no friction: what it held too much is given back by the contacts' own projection, which goes on from the pushes
// and the friction that are read off the solution here.
#include <algorithm>

#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

/// A contact is this many times as stiff as a spring beside it.
constexpr float contact_stiffness = 10;

/// A contact's springs about a displacement of its particle.
struct ContactSprings {
  float depth = 0;              ///< negative where it reaches in [m]
  float along = 0, across = 0;  ///< the normal and across it [N/m]
  Vec3f slip{};                 ///< over the surface since the substep's start [m]
};

/// Against sliding mu m depth / h^2 at most: the friction that the particle's own fall into the surface allows.
ContactSprings springs_of(const Contact& contact, const SweepArguments& a, const Vec3f& moved, float stiffness) {
  const Record& r = a.remainders[contact.particle];
  const float w = a.positions[contact.particle].w;
  ContactSprings springs;
  springs.depth = contact.gap + dot(contact.normal, moved);
  if (!(springs.depth < 0) || !(w > 0)) return springs;
  const Vec3f motion = moved - Vec3f{r.x, r.y, r.z} - contact.surface_motion;
  springs.slip = motion - contact.normal * dot(contact.normal, motion);
  springs.along = stiffness;
  const float held = contact.kinetic_friction * a.inverse_h2 / w * -springs.depth;
  springs.across = min(min(contact.kinetic_friction, 1.f) * stiffness, held / max(length(springs.slip), 1e-20f));
  return springs;
}

Vec3f displacement_of(const Record* records, int particle) {
  return {records[particle].x, records[particle].y, records[particle].z};
}

/// Adds along n n^T + across (I - n n^T) to the particle's row, against depth and slip.
void add_contact(const Contact& contact, const SweepArguments& a, float stiffness, MultigridObject& work) {
  const Vec3f n = contact.normal;
  const ContactSprings s = springs_of(contact, a, displacement_of(a.displacements, contact.particle), stiffness);
  if (!(s.along > 0)) return;
  const Vec3f force = n * (-s.along * s.depth) - s.slip * s.across;
  const float k = s.along - s.across;
  const int place = lane_place(contact.particle), batch = place / batch_width;
  float* extra = work.extra.data() + static_cast<std::ptrdiff_t>(batch) * 9 * batch_width;
  if (work.has_extra[batch] == 0) std::fill(extra, extra + 9 * batch_width, 0.f);
  work.has_extra[batch] = 1;
  const float add[9] = {k * n.x * n.x + s.across,
                        k * n.y * n.y + s.across,
                        k * n.z * n.z + s.across,
                        k * n.x * n.y,
                        k * n.x * n.z,
                        k * n.y * n.z,
                        force.x,
                        force.y,
                        force.z};
  for (int c = 0; c < 9; ++c) extra[c * batch_width + place % batch_width] += add[c];
}

/// What the springs have done by now, as the corrections that projections would have made.
void keep_push(const SweepArguments& a, const Record* change, float stiffness, Contact& contact) {
  const Vec3f now = displacement_of(a.displacements, contact.particle), by = displacement_of(change, contact.particle);
  const ContactSprings s = springs_of(contact, a, now - by, stiffness);
  if (!(s.along > 0)) return;
  const float moves = a.positions[contact.particle].w / a.inverse_h2;
  const float deeper = dot(contact.normal, by);
  contact.push += max(0.f, -(s.depth + deeper) * s.along * moves);
  const Vec3f friction = (s.slip + by - contact.normal * deeper) * (s.across * moves);
  const float size = length(friction), most = contact.kinetic_friction * -s.depth;
  contact.friction -= friction * (size > most ? most / size : 1.f);
}

/// visit(contact, stiffness, object) for every contact of objects that are corrected.
template <class Visit>
void for_contacts(Substep& s, const Visit& visit) {
  const Model& model = s.model;
  for (std::size_t task = 0; task < model.tiles.size(); ++task) {
    const int o = model.tiles[task].object;
    if (model.objects[o].multigrid.levels.empty()) continue;
    const std::vector<float>& limits = model.objects[o].multigrid.stiffness_limit;
    for (Contact& contact : s.work.tiles[task].contacts) visit(contact, contact_stiffness * limits[contact.particle], o);
  }
}

}  // namespace

void add_multigrid_contacts(Substep& s) {
  std::vector<MultigridObject>& objects = s.work.sweep.multigrid;
  for (MultigridObject& object : objects) std::fill(object.has_extra.begin(), object.has_extra.end(), 0);
  for_contacts(s, [&](const Contact& contact, float stiffness, int o) {
    add_contact(contact, arguments(s, o, false), stiffness, objects[o]);
  });
}

void keep_multigrid_pushes(Substep& s) {
  for_contacts(s, [&](Contact& contact, float stiffness, int o) {
    const MultigridObject& work = s.work.sweep.multigrid[o];
    if (work.is_made) keep_push(arguments(s, o, false), work.change.data(), stiffness, contact);
  });
}

}  // namespace pliant

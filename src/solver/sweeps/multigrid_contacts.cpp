// Contacts in the multigrid correction. Each becomes a normal spring and a tangential spring limited by Coulomb
// friction. Without them the correction would move objects into what they rest on, and the projection of contacts would
// push them back out.
//
// Springs only approximate friction. At particles that meet colliders, projection starts from the pushes and the
// friction of the springs and corrects any excess. Contacts with several points start from zero instead: after few
// cycles their springs still overlap and seem to push though the particles have not felt it, and with the cone of such
// pushes friction tore cloth apart (docs/internals/multigrid.md).
//
// A contact with a primitive adds to one matrix row. A contact between surfaces couples objects, or distant parts of
// one, which the coarse levels do not represent: each row treats the other side as fixed at its prediction. Conjugate
// gradients apply the true coupling (couple_pair), which corrects this approximation.
#include <algorithm>

#include "math/record.h"
#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

/// Stiffness of a contact with a primitive collider, relative to the stiffness limit of the particle's springs.
constexpr float contact_stiffness = 10;
/// Stiffness of a contact between surfaces, likewise. Stiffer ones would dominate the few conjugate gradient steps:
/// folded cloth would then stretch more and come to rest later.
constexpr float pair_stiffness = 0.2f;

/// Makes the springs of a contact at the relative displacement `moved`; both stiffnesses are 0 if the contact is
/// inactive. The tangential force is at most mu m depth / h^2, with the effective mass m = 1 / inverse_mass.
ContactSpring spring_of(const Contact& contact, const Vec3f& moved, float inverse_mass, float inverse_h2,
                        float stiffness) {
  ContactSpring s;
  s.depth = contact.gap + dot(contact.normal, moved);
  if (!(s.depth < 0) || !(inverse_mass > 0)) return s;
  const Vec3f motion = moved - contact.carried - contact.surface_motion;
  s.slip = motion - contact.normal * dot(contact.normal, motion);
  s.along = stiffness;
  const float held = contact.kinetic_friction * inverse_h2 / inverse_mass * -s.depth;
  s.across = min(min(contact.kinetic_friction, 1.f) * stiffness, held / max(length(s.slip), 1e-20f));
  return s;
}

/// The stiffness matrix along n n^T + across (I - n n^T), as xx yy zz xy xz yz.
std::array<float, 6> block_of(const ContactSpring& s, const Vec3f& n) {
  const float k = s.along - s.across;
  return {k * n.x * n.x + s.across,
          k * n.y * n.y + s.across,
          k * n.z * n.z + s.across,
          k * n.x * n.y,
          k * n.x * n.z,
          k * n.y * n.z};
}

Vec3f force_of(const ContactSpring& s, const Vec3f& n) { return n * (-s.along * s.depth) - s.slip * s.across; }

/// Adds a spring to the matrix row of one of its particles: the diagonal block, as if the other side were fixed, and
/// the force.
void add_to_row(MultigridObject& work, int particle, float weight, const std::array<float, 6>& block,
                const Vec3f& force) {
  const int at = lane_place(particle), batch = at / batch_width;
  if (work.extra.empty()) work.extra.resize(work.has_extra.size() * 9 * batch_width);
  float* extra = work.extra.data() + static_cast<std::ptrdiff_t>(batch) * 9 * batch_width;
  if (work.has_extra[batch] == 0) std::fill(extra, extra + 9 * batch_width, 0.f);
  work.has_extra[batch] = 1;
  extra += at % batch_width;
  for (int c = 0; c < 6; ++c) extra[c * batch_width] += abs(weight) * block[c];
  extra[6 * batch_width] += weight * force.x;
  extra[7 * batch_width] += weight * force.y;
  extra[8 * batch_width] += weight * force.z;
}

/// Stores in a contact the push and the friction that its springs exert after the relative displacement has changed by
/// `by`, as if projections had made them.
void keep_push(const ContactSpring& s, const Vec3f& by, float inverse_mass, float inverse_h2, Contact& contact) {
  const float moves = inverse_mass / inverse_h2, deeper = dot(contact.normal, by);
  contact.push += max(0.f, -(s.depth + deeper) * s.along * moves);
  const Vec3f friction = (s.slip + by - contact.normal * deeper) * (s.across * moves);
  const float size = length(friction), most = contact.kinetic_friction * -s.depth;
  contact.friction -= friction * (size > most ? most / size : 1.f);
}

// ---------------------------------------------------------------- with primitives

/// Calls visit(contact, stiffness, object) for every contact of particles with colliders, of objects that have levels.
template <class Visit>
void for_contacts(Substep& s, const Visit& visit) {
  const Model& model = s.model;
  for_each_tile(s, [&](int task) {
    const int o = model.tiles()[task].object;
    if (model.objects[o].multigrid.levels.empty()) return;
    const std::vector<float>& limits = model.objects[o].multigrid.stiffness_limit;
    for (Contact& contact : s.work.tiles[task].contacts)
      visit(contact, contact_stiffness * limits[contact.point[0]], o);
  });
}

void add_point_contacts(Substep& s) {
  std::vector<MultigridObject>& objects = multigrid_of(s).objects;
  for (MultigridObject& object : objects) std::fill(object.has_extra.begin(), object.has_extra.end(), 0);
  for_contacts(s, [&](const Contact& contact, float stiffness, int o) {
    const SweepArguments a = arguments(s, o, false);
    const int i = contact.point[0];
    const ContactSpring spring = spring_of(contact, xyz(a.displacements[i]), a.positions[i].w, a.inverse_h2, stiffness);
    if (spring.along > 0)
      add_to_row(objects[o], i, 1, block_of(spring, contact.normal), force_of(spring, contact.normal));
  });
}

// ---------------------------------------------------------------- with several points

float inverse_h2_of(const PairParticles& all) { return (1 / all.h) * (1 / all.h); }

/// Sets the particles of a spring and their objects. The softer side determines `stiffness`. Returns false if no
/// particle can move.
bool place(const Model& model, const Contact& contact, const Record* positions, PairSpring& spring, float& stiffness) {
  float limit[2] = {0, 0};
  for (int i = 0; i < 4; ++i) {
    const int v = contact.point[i];
    const int o = model.object_of(v);
    spring.object[i] = -1;
    if (i > 0 && v == contact.point[0]) continue;  // an unused point of the stencil
    if (!(positions[v].w > 0) || model.objects[o].multigrid.levels.empty()) continue;
    spring.object[i] = o;
    spring.particle[i] = v - model.first[o];
    float& side = limit[contact.weight[i] > 0 ? 0 : 1];
    side = max(side, model.objects[o].multigrid.stiffness_limit[spring.particle[i]]);
  }
  const float over_limit = contact.collider >= 0 ? contact_stiffness : pair_stiffness;
  stiffness = over_limit * (limit[0] > 0 && limit[1] > 0 ? min(limit[0], limit[1]) : max(limit[0], limit[1]));
  return stiffness > 0;
}

/// The number of contacts with several points. contact_at() numbers edges and triangles with primitives first, then
/// surfaces.
std::size_t count_surface_contacts(const Substep& s) {
  return s.own->shape_contacts.size() + (s.has_pairs() ? s.pairs->contacts().size() : 0);
}
Contact& contact_at(Substep& s, std::size_t number) {
  std::vector<Contact>& shapes = s.own->shape_contacts;
  return number < shapes.size() ? shapes[number] : s.pairs->contacts()[number - shapes.size()];
}

void add_pair_contacts(Substep& s) {
  MultigridScratch& scratch = multigrid_of(s);
  scratch.springs.clear();
  const PairParticles all = all_particles(s);
  for (std::size_t i = 0; i < count_surface_contacts(s); ++i) {
    const Contact& contact = contact_at(s, i);
    PairSpring spring{};
    float stiffness = 0;
    if (!place(s.model, contact, all.positions, spring, stiffness)) continue;
    static_cast<ContactSpring&>(spring) =
        spring_of(contact, relative(contact, all.displacements), inverse_mass_of(contact, all.positions),
                  inverse_h2_of(all), stiffness);
    if (!(spring.along > 0)) continue;
    spring.weight = contact.weight;
    spring.normal = contact.normal;
    const std::array<float, 6> block = block_of(spring);
    const Vec3f force = force_of(spring, spring.normal);
    for (int k = 0; k < 4; ++k)
      if (spring.object[k] >= 0)
        add_to_row(scratch.objects[spring.object[k]], spring.particle[k], spring.weight[k], block, force);
    scratch.springs.push_back(spring);
  }
}

Vec3f spring_force(const PairSpring& s, const Vec3f& by) {
  return s.normal * ((s.along - s.across) * dot(s.normal, by)) + by * s.across;
}

}  // namespace

std::array<float, 6> block_of(const PairSpring& s) { return block_of(s, s.normal); }

double couple_pair(const PairSpring& s, std::vector<MultigridObject>& objects) {
  Vec3f x[4], between{};
  for (int i = 0; i < 4; ++i) {
    if (s.object[i] < 0) continue;
    x[i] = xyz(objects[s.object[i]].direction[s.particle[i]]);
    between += x[i] * s.weight[i];
  }
  double curvature = 0;
  for (int i = 0; i < 4; ++i) {
    if (s.object[i] < 0) continue;
    const float side = s.weight[i] < 0 ? -1.f : 1.f;
    const Vec3f y = spring_force(s, between * side - x[i]) * abs(s.weight[i]);
    Record& r = objects[s.object[i]].image()[s.particle[i]];
    r = {r.x + y.x, r.y + y.y, r.z + y.z, 0};
    curvature += static_cast<double>(dot(y, x[i]));
  }
  return curvature;
}

void add_multigrid_contacts(Substep& s) {
  add_point_contacts(s);
  add_pair_contacts(s);
}

void keep_multigrid_pushes(Substep& s) {
  for_contacts(s, [&](Contact& contact, float stiffness, int o) {
    const MultigridObject& work = multigrid_of(s).objects[o];
    if (!work.is_made) return;
    const SweepArguments a = arguments(s, o, false);
    const int i = contact.point[0];
    const Vec3f now = xyz(a.displacements[i]), by = xyz(work.change[i]);
    const float w = a.positions[i].w;
    const ContactSpring spring = spring_of(contact, now - by, w, a.inverse_h2, stiffness);
    if (spring.along > 0) keep_push(spring, by, w, a.inverse_h2, contact);
  });
}

}  // namespace pliant

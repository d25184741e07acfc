// Contacts among surfaces in the multigrid correction: a stiff spring between the closest points of two primitives, and against
// sliding one no stiffer than Coulomb allows (multigrid_contacts.cpp has the same for one particle).
//
// What couples objects, and far parts of one, is no part of any hierarchy: there each side of a contact sees the other held
// where it is predicted. Conjugate gradients see the contact as it is, and put right what that gets wrong.
#include <algorithm>

#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

/// A contact is this many times as stiff as a spring beside it. Enough to tell the correction that there is something; where
/// contacts are stiffer, the few steps go into them, and cloth in folds stretches more and comes to rest later.
constexpr float pair_stiffness = 0.2f;

Vec3f relative(const PairContact& contact, const Record* of) {
  Vec3f sum{};
  for (int i = 0; i < 4; ++i) {
    const Record& r = of[contact.vertex[i]];
    sum += Vec3f{r.x, r.y, r.z} * contact.weight[i];
  }
  return sum;
}

float mobility(const PairContact& contact, const Record* positions) {
  float sum = 0;
  for (int i = 0; i < 4; ++i) sum += positions[contact.vertex[i]].w * contact.weight[i] * contact.weight[i];
  return sum;
}

/// Whose particles they are, and how stiff the springs beside the contact are: the softer side's.
bool place(const Model& model, const PairContact& contact, const Record* positions, PairSpring& spring, float& stiffness) {
  float limit[2] = {0, 0};
  for (int i = 0; i < 4; ++i) {
    const int v = contact.vertex[i];
    const int o = static_cast<int>(std::upper_bound(model.first.begin(), model.first.end(), v) - model.first.begin()) - 1;
    spring.object[i] = -1;
    if (!(positions[v].w > 0) || model.objects[o].multigrid.levels.empty()) continue;
    spring.object[i] = o;
    spring.particle[i] = v - model.first[o];
    float& side = limit[contact.weight[i] > 0 ? 0 : 1];
    side = max(side, model.objects[o].multigrid.stiffness_limit[spring.particle[i]]);
  }
  stiffness = pair_stiffness * (limit[0] > 0 && limit[1] > 0 ? min(limit[0], limit[1]) : max(limit[0], limit[1]));
  return stiffness > 0;
}

/// Where its springs stand, given where the relative place has moved to; across is 0 and along is 0 where it does not touch.
void set_springs(const PairContact& contact, const PairParticles& all, float stiffness, PairSpring& spring) {
  const Vec3f moved = relative(contact, all.displacements);
  spring.depth = contact.gap + dot(contact.normal, moved) - contact.thickness;
  spring.along = spring.across = 0;
  const float mobile = mobility(contact, all.positions);
  if (!(spring.depth < 0) || !(mobile > 0)) return;
  const Vec3f motion = moved - relative(contact, all.remainders);
  spring.slip = motion - contact.normal * dot(contact.normal, motion);
  spring.along = stiffness;
  const float held = contact.kinetic_friction * -spring.depth / (all.h * all.h * mobile);
  spring.across = min(min(contact.kinetic_friction, 1.f) * stiffness, held / max(length(spring.slip), 1e-20f));
}

/// Its force on each particle, and the block that holds the particle where the other side is held.
void add_rows(const PairSpring& s, std::vector<MultigridObject>& objects) {
  const Vec3f force = s.normal * (-s.along * s.depth) - s.slip * s.across;
  const std::array<float, 6> block = block_of(s);
  for (int i = 0; i < 4; ++i) {
    if (s.object[i] < 0) continue;
    MultigridObject& work = objects[s.object[i]];
    const int at = lane_place(s.particle[i]), batch = at / batch_width;
    float* extra = work.extra.data() + static_cast<std::ptrdiff_t>(batch) * 9 * batch_width;
    if (work.has_extra[batch] == 0) std::fill(extra, extra + 9 * batch_width, 0.f);
    work.has_extra[batch] = 1;
    extra += at % batch_width;
    for (int c = 0; c < 6; ++c) extra[c * batch_width] += abs(s.weight[i]) * block[c];
    extra[6 * batch_width] += s.weight[i] * force.x;
    extra[7 * batch_width] += s.weight[i] * force.y;
    extra[8 * batch_width] += s.weight[i] * force.z;
  }
}

Vec3f spring_force(const PairSpring& s, const Vec3f& by) {
  return s.normal * ((s.along - s.across) * dot(s.normal, by)) + by * s.across;
}

}  // namespace

std::array<float, 6> block_of(const PairSpring& s) {
  const Vec3f n = s.normal;
  const float k = s.along - s.across;
  return {k * n.x * n.x + s.across,
          k * n.y * n.y + s.across,
          k * n.z * n.z + s.across,
          k * n.x * n.y,
          k * n.x * n.z,
          k * n.y * n.z};
}

void add_multigrid_pairs(Substep& s) {
  SweepScratch& scratch = s.work.sweep;
  scratch.pair_springs.clear();
  if (!s.has_pairs()) return;
  const PairParticles all = all_particles(s);
  const std::vector<PairContact>& contacts = s.work.pairs->contacts();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    PairSpring spring{};
    float stiffness = 0;
    if (!place(s.model, contacts[i], all.positions, spring, stiffness)) continue;
    set_springs(contacts[i], all, stiffness, spring);
    if (!(spring.along > 0)) continue;
    spring.contact = static_cast<std::int32_t>(i);
    spring.weight = contacts[i].weight;
    spring.normal = contacts[i].normal;
    add_rows(spring, scratch.multigrid);
    scratch.pair_springs.push_back(spring);
  }
}

double couple_pair(const PairSpring& s, std::vector<MultigridObject>& objects) {
  Vec3f x[4], between{};
  for (int i = 0; i < 4; ++i) {
    if (s.object[i] < 0) continue;
    const Record& r = objects[s.object[i]].direction[s.particle[i]];
    x[i] = {r.x, r.y, r.z};
    between += x[i] * s.weight[i];
  }
  double curvature = 0;
  for (int i = 0; i < 4; ++i) {
    if (s.object[i] < 0) continue;
    const float side = s.weight[i] < 0 ? -1.f : 1.f;
    const Vec3f y = spring_force(s, between * side - x[i]) * abs(s.weight[i]);
    Record& r = objects[s.object[i]].image[s.particle[i]];
    r = {r.x + y.x, r.y + y.y, r.z + y.z, 0};
    curvature += static_cast<double>(dot(y, x[i]));
  }
  return curvature;
}

void keep_multigrid_pair_pushes(Substep& s) {
  SweepScratch& scratch = s.work.sweep;
  if (scratch.pair_springs.empty()) return;
  const Record* positions = all_particles(s).positions;
  const float h2 = all_particles(s).h * all_particles(s).h;
  std::vector<PairContact>& contacts = s.work.pairs->contacts();
  const auto is_made = [&](int o) { return o < 0 || scratch.multigrid[o].is_made; };
  for (const PairSpring& spring : scratch.pair_springs) {
    if (!std::all_of(spring.object.begin(), spring.object.end(), is_made)) continue;
    PairContact& contact = contacts[spring.contact];
    Vec3f by{};
    for (int i = 0; i < 4; ++i) {
      if (spring.object[i] < 0) continue;
      const Record& change = scratch.multigrid[spring.object[i]].change[spring.particle[i]];
      by += Vec3f{change.x, change.y, change.z} * spring.weight[i];
    }
    const float moves = mobility(contact, positions) * h2, deeper = dot(spring.normal, by);
    contact.push += max(0.f, -(spring.depth + deeper) * spring.along * moves);
    const Vec3f friction = (spring.slip + by - spring.normal * deeper) * (spring.across * moves);
    const float size = length(friction), most = contact.kinetic_friction * -spring.depth;
    contact.friction -= friction * (size > most ? most / size : 1.f);
  }
}

}  // namespace pliant

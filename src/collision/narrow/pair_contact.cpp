#include "collision/narrow/pair_contact.h"

#include "math/vector.h"

namespace pliant {

namespace {

/// Inverse mass of the relative place: sum w weight^2.
float mobility(const PairContact& c, const Record* positions) {
  float sum = 0;
  for (int i = 0; i < 4; ++i) sum += positions[c.vertex[i]].w * c.weight[i] * c.weight[i];
  return sum;
}

Vec3f relative(const PairContact& c, const Record* of) {
  Vec3f sum{};
  for (int i = 0; i < 4; ++i) {
    const Record& r = of[c.vertex[i]];
    sum += Vec3f{r.x, r.y, r.z} * c.weight[i];
  }
  return sum;
}

/// Moves the four so that their relative place changes by `change`.
void move(const PairContact& c, const Vec3f& change, const Record* positions, Record* of) {
  const float sum = mobility(c, positions);
  if (!(sum > 0)) return;
  for (int i = 0; i < 4; ++i) {
    const float share = positions[c.vertex[i]].w * c.weight[i] / sum;
    Record& r = of[c.vertex[i]];
    r = {r.x + change.x * share, r.y + change.y * share, r.z + change.z * share, r.w};
  }
}

}  // namespace

PairContact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h) {
  PairContact c;
  c.vertex = pair.vertex;
  for (int i = 0; i < 4; ++i) c.weight[i] = at.weight[i][lane];
  c.normal = {at.normal[0][lane], at.normal[1][lane], at.normal[2][lane]};
  c.gap = at.distance[lane];
  c.thickness = min(material.thickness, c.gap + largest_pair_separation_speed * h);
  c.static_friction = material.static_friction;
  c.kinetic_friction = material.kinetic_friction;
  c.restitution = material.restitution;
  return c;
}

float approach_of(const PairContact& c, const Record* displacements, const Record* remainders, float h) {
  return dot(c.normal, relative(c, displacements) - relative(c, remainders)) / h;
}

float overlap_of(const PairContact& c, const Record* displacements) {
  return c.thickness - (c.gap + dot(c.normal, relative(c, displacements)));
}

void project_contact(PairContact& c, const Record* positions, const Record* remainders, Record* displacements) {
  const Vec3f moved = relative(c, displacements);
  const float depth = c.thickness - (c.gap + dot(c.normal, moved));
  if (!(depth > 0) && !(c.push > 0)) return;
  Vec3f change{};
  if (depth > 0) {
    change = c.normal * depth;
    c.push += depth;
  }
  if (c.push > 0) {
    const Vec3f motion = moved + change - relative(c, remainders);
    const Vec3f slip = motion - c.normal * dot(c.normal, motion);
    Vec3f friction = c.friction - slip;
    const float wanted = length(friction);
    if (wanted > c.static_friction * c.push) friction = friction * (c.kinetic_friction * c.push / max(wanted, 1e-30f));
    change += friction - c.friction;
    c.friction = friction;
  }
  move(c, change, positions, displacements);
}

void respond_to_contact(const PairContact& c, const Record* positions, Record* velocities, const PairResponse& response) {
  if (!(c.push > 0)) return;
  const float separating = dot(c.normal, relative(c, velocities) + response.missing);
  const bool bounces = c.restitution > 0 && -c.approach > response.slow;
  const float wanted = bounces ? -c.restitution * c.approach : min(separating, 0.f);
  if (wanted != separating) move(c, c.normal * (wanted - separating), positions, velocities);
}

}  // namespace pliant

#include "collision/narrow/pair_contact.h"

#include "math/vector.h"

namespace pliant {

Contact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h) {
  Contact c;
  c.point = pair.vertex;
  for (int i = 0; i < 4; ++i) c.weight[i] = at.weight[i][lane];
  c.normal = {at.normal[0][lane], at.normal[1][lane], at.normal[2][lane]};
  const float distance = at.distance[lane];
  c.thickness = min(material.thickness, distance + largest_pair_separation_speed * h);
  c.gap = distance - c.thickness;
  c.static_friction = material.static_friction;
  c.kinetic_friction = material.kinetic_friction;
  c.restitution = material.restitution;
  return c;
}

float approach_of(const Contact& c, const Record* displacements, float h) {
  return dot(c.normal, relative(c, displacements) - c.carried) / h;
}

float end_impact(const Contact& c, Record* velocities, const Vec3f& missing) {
  const float separating = dot(c.normal, relative(c, velocities) + missing);
  if (!(separating < 0)) return 0;
  move_sides(c, c.normal * -separating, velocities);
  return -separating;
}

void respond_to_contact(const Contact& c, Record* velocities, const PairResponse& response) {
  if (!(c.push > 0)) return;
  const float separating = dot(c.normal, relative(c, velocities) + response.missing);
  const float wanted = separation_after(separating, c.approach, c.restitution, response.slow, false);
  if (wanted != separating) move_sides(c, c.normal * (wanted - separating), velocities);
}

}  // namespace pliant

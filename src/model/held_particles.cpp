#include "model/held_particles.h"

#include <algorithm>
#include <cstddef>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

namespace {

bool is_held_by(const Attachment& attachment) {
  return attachment.stiffness.kind == Stiffness::Kind::compliance && !(attachment.stiffness.damping > 0);
}

}  // namespace

bool holds_particles(const Object& object, const std::vector<ConstraintList>& lists) {
  return std::any_of(object.attachments.begin(), object.attachments.end(), is_held_by) &&
         std::any_of(lists.begin(), lists.end(),
                     [](const ConstraintList& list) { return belongs_to_solid(list.type); });
}

void follow_held_particles(const Object& object, std::vector<int>& tile) {
  for (std::size_t i = 0; i < object.attachments.size(); ++i)
    tile[object.positions.size() + i] = tile[static_cast<std::size_t>(object.attachments[i].particle)];
}

HeldParticles find_held_particles(const Object& object, const std::vector<int>& tile, const CompiledObject& of) {
  HeldParticles held;
  std::vector<int> attachments(object.positions.size(), 0);
  for (const Attachment& attachment : object.attachments) ++attachments[static_cast<std::size_t>(attachment.particle)];
  for (std::size_t i = 0; i < object.attachments.size(); ++i) {
    const Attachment& attachment = object.attachments[i];
    const auto particle = static_cast<std::size_t>(attachment.particle), target = object.positions.size() + i;
    if (!is_held_by(attachment) || attachments[particle] > 1 || tile[particle] != tile[target]) continue;
    held.particles.push_back({of.place[particle], of.place[target], attachment.stiffness.value});
  }
  std::sort(held.particles.begin(), held.particles.end(),
            [](const HeldParticle& a, const HeldParticle& b) { return a.particle < b.particle; });
  for (std::size_t p = 0; p < of.pools.size(); ++p)
    if (of.pools[p].type == length_type() && of.pools[p].law == Law::compliant) held.pool = static_cast<int>(p);
  return held;
}

}  // namespace pliant

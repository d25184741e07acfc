#include "solver/impacts.h"

#include <algorithm>
#include <vector>

#include "collision/narrow/contact.h"
#include "solver/contact_kernels.h"

namespace pliant {

namespace {

/// Finds the contacts of a tile's particles along their paths within `seconds`.
const std::vector<Contact>& find_contacts_ahead(const Substep& s, int task, float seconds) {
  AdvanceArguments a = particles(s, task);
  a.h = seconds;
  a.inverse_h = 1 / seconds;
  a.gravity_begun = a.gravity_step = s.model.gravity * seconds;
  TileScratch& scratch = s.work.tiles[task];
  scratch.more_contacts.clear();
  scratch.bounds = {};
  s.kernels.predict(a, &scratch.bounds);
  find_contacts({object_of(s, task), a, scratch.bounds, s.own->colliders, s.kernels.find_near,
                 s.kernels.contacts.make_point_contacts},
                scratch.near, scratch.more_contacts);
  return scratch.more_contacts;
}

/// Writes the velocities of a tile's particles after their impacts, and counts these. What approaches more slowly than
/// gravity accelerates it within `seconds` only rests.
void stop_at_colliders(const Substep& s, int task, float seconds) {
  const int first = s.model.first[s.model.tiles()[task].object];
  const Tile& tile = tile_of(s, task);
  Record* after = s.work.expected_velocities.data() + first;
  const Record* now = s.state.velocities.data() + first;
  std::copy(now + tile.first_particle, now + tile.last_particle, after + tile.first_particle);
  int& impacts = s.work.tiles[task].impacts;
  impacts = 0;
  const float slow = 2 * length(s.model.gravity) * seconds;
  for (const Contact& contact : find_contacts_ahead(s, task, seconds)) {
    if (!(contact.approach < -slow)) continue;
    Record& v = after[contact.point[0]];
    const Vec3f stop = contact.normal * contact.approach;
    v = {v.x - stop.x, v.y - stop.y, v.z - stop.z, 0};
    ++impacts;
  }
}

}  // namespace

const Record* velocities_after_impacts(Substep& s, double seconds) {
  const double now = time_of(s, s.number);
  move_colliders(s.model, s.work.control, now, now + seconds, s.own->colliders);
  if (s.own->colliders.empty()) return nullptr;
  for_tiles(s, "choose substeps", [&](int task) { stop_at_colliders(s, task, static_cast<float>(seconds)); });
  int impacts = 0;
  for_each_tile(s, [&](int task) { impacts += s.work.tiles[task].impacts; });
  return impacts > 0 ? s.work.expected_velocities.data() : nullptr;
}

}  // namespace pliant

#include "model/compile_particles.h"

#include <algorithm>
#include <cmath>

#include "math/quat.h"
#include "model/choose_order.h"
#include "model/held_particles.h"
#include "model/keep_schedule.h"
#include "topology/tiles.h"

namespace pliant {

namespace {

/// Moments of inertia of which none is below a share of the largest. The inertia in world axes would have no correct
/// digit else.
Vec3f conditioned(const Vec3f& inertia) {
  constexpr float least_share = 1e-5f;
  const auto finite = [](float moment) { return std::isinf(moment) ? 0.f : moment; };
  const float least = least_share * std::max({finite(inertia.x), finite(inertia.y), finite(inertia.z)});
  return {std::max(inertia.x, least), std::max(inertia.y, least), std::max(inertia.z, least)};
}

}  // namespace

std::vector<Vec3f> all_positions(const Object& object) {
  std::vector<Vec3f> positions = object.positions;
  for (const Attachment& attachment : object.attachments) positions.push_back(attachment.target);
  return positions;
}

void fill_particles(const Object& object, const std::vector<Vec3f>& positions, CompiledObject& out) {
  std::vector<float> inverse_mass(positions.size(), 0.f);
  for (std::size_t i = 0; i < object.masses.size(); ++i) {
    inverse_mass[i] = std::isinf(object.masses[i]) ? 0.f : 1.f / object.masses[i];
  }
  for (const Pin& pin : object.pins) inverse_mass[pin.particle] = 0;
  out.positions.resize(positions.size());
  if (!object.velocities.empty()) out.velocities.resize(positions.size());
  for (std::size_t storage = 0; storage < positions.size(); ++storage) {
    const int user = out.order[storage];
    const Vec3f& p = positions[user];
    out.positions[storage] = {p.x, p.y, p.z, inverse_mass[user]};
    if (inverse_mass[user] == 0 || user >= static_cast<int>(object.velocities.size())) continue;
    const Vec3f& v = object.velocities[user];
    out.velocities[storage] = {v.x, v.y, v.z, 0};
  }
}

void fill_frames(const Object& object, FrameRecords& out) {
  const auto inverse = [](float inertia) { return std::isinf(inertia) ? 0.f : 1 / inertia; };
  for (const ObjectFrame& frame : object.frames) {
    const Quatf q = normalise(frame.orientation);
    const Vec3f w = rotate(conjugate(q), frame.angular_velocity), i = conditioned(frame.inertia);
    out.orientations.push_back({q.x, q.y, q.z, q.w});
    const auto free = [](float speed, float inertia) { return std::isinf(inertia) ? 0.f : speed; };
    out.angular_velocities.push_back({free(w.x, i.x), free(w.y, i.y), free(w.z, i.z), 0});
    out.inverse_inertias.push_back({inverse(i.x), inverse(i.y), inverse(i.z), 0});
  }
}

void fill_kinematics(const Object& object, CompiledObject& out) {
  for (const Pin& pin : object.pins) {
    if (pin.motion.moves())
      out.kinematics.push_back({out.place[pin.particle], object.positions[pin.particle], pin.motion});
  }
  for (std::size_t i = 0; i < object.attachments.size(); ++i) {
    const Attachment& attachment = object.attachments[i];
    if (!attachment.motion.moves()) continue;
    out.kinematics.push_back({out.place[object.positions.size() + i], attachment.target, attachment.motion});
  }
  // Kinematic particles are sorted by storage index, so that each tile finds its own. Of two pins of a particle the
  // later one wins.
  std::stable_sort(out.kinematics.begin(), out.kinematics.end(),
                   [](const Kinematic& a, const Kinematic& b) { return a.particle < b.particle; });
}

namespace {

/// Fills the places and tiles of an object from its order, and the tile of each particle.
void fill_tiles(const std::vector<int>& tile, CompiledObject& out) {
  out.place.resize(out.order.size());
  for (int storage = 0; storage < static_cast<int>(out.order.size()); ++storage)
    out.place[out.order[storage]] = storage;
  for (int storage = 0; storage < static_cast<int>(out.order.size()); ++storage) {
    const std::size_t t = tile[out.order[storage]];
    if (t >= out.tiles.size()) out.tiles.push_back({storage, storage, 0, 0});
    out.tiles[t].last_particle = storage + 1;
  }
}

}  // namespace

void number_particles(const std::vector<Vec3f>& positions, const std::vector<ConstraintList>& lists, int largest_tile,
                      const Object* held, std::vector<int>& tile, CompiledObject& out) {
  tile = cut_into_tiles(positions, largest_tile);
  if (held != nullptr) follow_held_particles(*held, tile);
  out.order = choose_order(positions, tile, lists);
  fill_tiles(tile, out);
}

void number_as_before(const KeptSchedule& kept, std::vector<int>& tile, CompiledObject& out) {
  require_fits(kept, static_cast<std::size_t>(out.particles), out.name);
  out.order = kept.order;
  tile.resize(out.order.size());
  int storage = 0, number = 0;
  for (const int end : kept.tile_ends) {
    for (; storage < end; ++storage) tile[out.order[storage]] = number;
    ++number;
  }
  fill_tiles(tile, out);
  out.additions.are_used = true;
  out.additions.first_particle = kept.first_added;
}

}  // namespace pliant

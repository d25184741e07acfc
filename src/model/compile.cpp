// Compiles an object's description to a schedule: tiles, storage order, colours, batches.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "constraints/registry.h"
#include "math/quat.h"
#include "model/attachments.h"
#include "model/chains.h"
#include "model/choose_order.h"
#include "model/compiled_object.h"
#include "model/fill_pool.h"
#include "model/gather_constraints.h"
#include "model/length_ranges.h"
#include "model/object_sets.h"
#include "model/stiffness.h"
#include "topology/boundary.h"
#include "topology/colouring.h"
#include "topology/tiles.h"

namespace pliant {

namespace {

constexpr int batches_per_inter_tile_task = 32, batches_per_stencil_task = 4;

// ---------------------------------------------------------------- particles

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

/// Moments of inertia of which none is below a share of the largest. The inertia in world axes would have no correct digit else.
Vec3f conditioned(const Vec3f& inertia) {
  constexpr float least_share = 1e-5f;
  const auto finite = [](float moment) { return std::isinf(moment) ? 0.f : moment; };
  const float least = least_share * std::max({finite(inertia.x), finite(inertia.y), finite(inertia.z)});
  return {std::max(inertia.x, least), std::max(inertia.y, least), std::max(inertia.z, least)};
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
    if (pin.motion.moves()) out.kinematics.push_back({out.place[pin.particle], object.positions[pin.particle], pin.motion});
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

void number_particles(const std::vector<Vec3f>& positions, const std::vector<ConstraintList>& lists, int largest_tile,
                      std::vector<int>& tile, CompiledObject& out) {
  tile = cut_into_tiles(positions, largest_tile);
  out.order = choose_order(positions, tile, lists);
  out.place.resize(out.order.size());
  for (int storage = 0; storage < static_cast<int>(out.order.size()); ++storage) out.place[out.order[storage]] = storage;
  for (int storage = 0; storage < static_cast<int>(out.order.size()); ++storage) {
    const std::size_t t = tile[out.order[storage]];
    if (t >= out.tiles.size()) out.tiles.push_back({storage, storage, 0, 0});
    out.tiles[t].last_particle = storage + 1;
  }
}

// ---------------------------------------------------------------- constraints

/// Replaces user indices of particles by storage indices, and orders each stencil as its type's `canonical` does.
void renumber(ConstraintList& list, const std::vector<int>& place) {
  const int particles = static_cast<int>(place.size());
  std::vector<int>& stencils = list.stencils.own();
  for (int& number : stencils) number = number < particles ? place[number] : number;  // frames are not reordered
  const auto canonical = constraint_type(list.type).canonical;
  if (canonical == nullptr) return;
  std::array<float, most_rest_fields> rest{};
  const auto fields = static_cast<std::size_t>(list.fields);
  for (std::size_t i = 0; i < static_cast<std::size_t>(list.count()); ++i) {
    for (std::size_t field = 0; field < fields; ++field) rest[field] = list.rest[i * fields + field];
    canonical(&stencils[i * static_cast<std::size_t>(list.size)], rest.data());
    for (std::size_t field = 0; field < fields; ++field) list.rest.set(i * fields + field, rest[field]);
  }
}

/// The constraints of a list, grouped by the tile that contains all their particles; inter-tile constraints come last.
struct ByTile {
  std::vector<int> begin;  ///< first member of each tile, then of the inter-tile ones; one more at the end
  std::vector<int> members;

  std::vector<int> of(int tile) const { return {members.begin() + begin[tile], members.begin() + begin[tile + 1]}; }
};

ByTile split_by_tile(ConstraintList& list, const std::vector<int>& tile_of, int tiles) {
  const std::vector<int>& stencils = list.stencils.own();
  const auto tile_at = [&](int i) {
    const int* stencil = &stencils[static_cast<std::size_t>(i) * list.size];
    int tile = tile_of[stencil[0]];
    for (int slot = 1; slot < list.size; ++slot) {
      if (tile_of[stencil[slot]] != tile) tile = tiles;
    }
    return tile;
  };
  ByTile split;
  split.begin.assign(static_cast<std::size_t>(tiles) + 2, 0);
  for (int i = 0; i < list.count(); ++i) ++split.begin[tile_at(i) + 1];
  std::partial_sum(split.begin.begin(), split.begin.end(), split.begin.begin());
  split.members.resize(static_cast<std::size_t>(list.count()));
  std::vector<int> next(split.begin.begin(), split.begin.end() - 1);
  for (int i = 0; i < list.count(); ++i) split.members[next[tile_at(i)]++] = i;
  return split;
}

/// The constraint in a lane of a batch. With groups of four, lane 4 l + j has member l of group j (see math/wide.h).
/// Lanes beyond the last constraint repeat the first one; they are read, but never written.
int member_in_lane(const Colour& colour, int batch, int lane, bool& valid) {
  const int position = colour.runs != 0 ? batch * batch_width + 4 * (lane % 4) + lane / 4 : batch * batch_width + lane;
  valid = position < static_cast<int>(colour.members.size());
  return colour.members[valid ? position : batch * batch_width];
}

void append_batch(const ConstraintList& list, const std::vector<Row>& rows, const Colour& colour, int batch, Pool& pool) {
  const std::size_t block = pool.blocks.size();
  pool.blocks.resize(block + pool.block_floats);
  bool valid = true;
  for (int lane = 0; lane < batch_width; ++lane) {
    const int member = member_in_lane(colour, batch, lane, valid);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (pool.row_offset[row] >= 0) pool.blocks[block + pool.row_offset[row] + lane] = rows[row].at(member);
    }
    pool.origin.push_back(valid ? list.origin[member] : -1);
  }
  for (int slot = 0; slot < list.size; ++slot) {
    for (int lane = 0; lane < ((colour.runs >> slot & 1) != 0 ? 4 : batch_width); ++lane) {
      const int member = member_in_lane(colour, batch, lane, valid);
      pool.indices.push_back(list.stencils[static_cast<std::size_t>(member) * list.size + slot]);
    }
  }
  ++pool.batches;
}

/// Appends batches [first, last) of a colour to a pool, and returns them as a segment.
Segment append_segment(const ConstraintList& list, const Colour& colour, int first, int last, int pool_number, Pool& pool) {
  const int count = static_cast<int>(colour.members.size());
  Segment segment;
  segment.pool = pool_number;
  segment.runs = colour.runs;
  segment.first_batch = pool.batches;
  segment.batches = last - first;
  const int in_last = std::min(batch_width, count - (last - 1) * batch_width);
  segment.last_count = colour.runs != 0 ? in_last / 4 : in_last;
  segment.index_offset = static_cast<std::int64_t>(pool.indices.size());
  const std::vector<Row> rows = rows_of(list);
  for (int batch = first; batch < last; ++batch) append_batch(list, rows, colour, batch, pool);
  return segment;
}

/// Appends a colour in segments of at most `largest` batches. Inter-tile constraints use several, because threads share
/// them by segment.
void append_colour(const ConstraintList& list, const Colour& colour, int largest, int pool_number, Pool& pool,
                   std::vector<Segment>& segments) {
  const int batches = (static_cast<int>(colour.members.size()) + batch_width - 1) / batch_width;
  for (int first = 0; first < batches;) {
    const int last = first + std::min(batches - first, largest);
    segments.push_back(append_segment(list, colour, first, last, pool_number, pool));
    first = last;
  }
}

/// Gives each constraint a colour of its own, which keeps the order of the list.
std::vector<Colour> one_by_one(const std::vector<int>& members) {
  std::vector<Colour> colours;
  colours.reserve(members.size());
  for (int member : members) colours.push_back({0, {member}});
  return colours;
}

/// The segments of one constraint list: tile by tile, then inter-tile constraints by colour.
struct ListSchedule {
  std::vector<Segment> segments;
  std::vector<int> tile_end, colour_end;  ///< one past the last segment of each tile; of each inter-tile colour
};

/// Reserves more than needed: reserved pages that are never written cost no memory, but a growing array is copied.
void reserve(const ConstraintList& list, Pool& pool) {
  const std::size_t lanes = static_cast<std::size_t>(list.count()) * 5 / 4 + batch_width;
  pool.indices.reserve(lanes * static_cast<std::size_t>(list.size));
  pool.blocks.reserve(lanes / batch_width * static_cast<std::size_t>(pool.block_floats));
  pool.origin.reserve(lanes);
}

ListSchedule schedule_list(ConstraintList& list, const std::vector<int>& tile_of, int tiles, bool in_given_order,
                           int number, Colouring& colouring, Pool& pool) {
  ListSchedule out;
  const ByTile split = split_by_tile(list, tile_of, tiles);
  reserve(list, pool);
  for (int t = 0; t <= tiles; ++t) {
    const bool inter_tile = t == tiles;
    const std::vector<int> members = split.of(t);
    const std::vector<Colour> colours =
        in_given_order ? one_by_one(members) : colouring.colour(list.stencils.own(), list.size, members);
    for (const Colour& colour : colours) {
      append_colour(list, colour, inter_tile ? batches_per_inter_tile_task : 1 << 30, number, pool, out.segments);
      if (inter_tile) out.colour_end.push_back(static_cast<int>(out.segments.size()));
    }
    if (!inter_tile) out.tile_end.push_back(static_cast<int>(out.segments.size()));
  }
  if (pool.indices.capacity() > 2 * pool.indices.size()) pool.indices.shrink_to_fit();  // most slots are contiguous
  return out;
}

/// Merges the segments of all lists: tile by tile, then inter-tile colour by colour; within each, in the order of the
/// lists.
void merge(const std::vector<ListSchedule>& schedules, CompiledObject& out) {
  std::vector<int> next(schedules.size(), 0);
  const auto append_to = [&](std::size_t i, int end) {
    const auto first = schedules[i].segments.begin();
    out.segments.insert(out.segments.end(), first + next[i], first + end);
    next[i] = end;
  };
  for (std::size_t t = 0; t < out.tiles.size(); ++t) {
    out.tiles[t].first_segment = static_cast<int>(out.segments.size());
    for (std::size_t i = 0; i < schedules.size(); ++i)
      if (!schedules[i].tile_end.empty()) append_to(i, schedules[i].tile_end[t]);
    out.tiles[t].last_segment = static_cast<int>(out.segments.size());
  }
  out.phases.push_back({Driver::tile, 0, static_cast<int>(out.tiles.size())});
  for (std::size_t i = 0; i < schedules.size(); ++i) {
    for (const int end : schedules[i].colour_end) {
      const int first = static_cast<int>(out.segments.size());
      append_to(i, end);
      out.phases.push_back({Driver::inter_tile, first, static_cast<int>(out.segments.size())});
    }
  }
}

bool has_tethers(const CompileOptions& options) { return options.tethers || options.sweep == Sweep::tethered_chains; }

/// Tethers that the user did not ask for leave room for the strain that the object's weight causes, also near the pins.
float tether_slack(const Object& object, const CompileOptions& options) {
  constexpr double strain_at_pins = 5;  // over the mean strain
  if (options.tethers) return options.tether_slack;
  const double strain = strain_by_weight(object, double(options.gravity)).value_or(0);
  return options.tether_slack + static_cast<float>(strain_at_pins * strain);
}

/// The fixed particles to which tethers lead, in ascending order: all but the targets of attachments that yield or pull from afar.
std::vector<int> anchors_of(const Object& object, double gravity, const CompiledObject& of) {
  const AttachmentTest test(object, gravity);
  const auto holds = [&](int storage) {
    const auto user = static_cast<std::size_t>(of.order[static_cast<std::size_t>(storage)]);
    return user < object.positions.size() || test.is_like_pin(object.attachments[user - object.positions.size()]);
  };
  std::vector<int> anchors;
  for (int i = 0; i < of.particles; ++i)
    if (of.positions[static_cast<std::size_t>(i)].w == 0 && holds(i)) anchors.push_back(i);
  return anchors;
}

/// True if a later step of compile() reads the list: chains, stencils, tethers or multigrid.
bool is_needed_later(const ConstraintList& list, const CompileOptions& options) {
  return list.chained || !list.in_lanes ||
         (is_length(list.type) && (has_tethers(options) || options.sweep == Sweep::multigrid));
}

/// Schedules one list after another and frees each if possible, to limit the peak of memory.
void schedule(std::vector<ConstraintList>& lists, const std::vector<int>& tile, const CompileOptions& options,
              CompiledObject& out) {
  std::vector<int> tile_of(tile.size());  // tile of each particle, by storage index
  for (std::size_t storage = 0; storage < tile.size(); ++storage) tile_of[storage] = tile[out.order[storage]];
  const bool in_given_order = options.sweep == Sweep::natural;
  std::vector<ListSchedule> schedules(lists.size());
  Colouring colouring(out.particles);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    ConstraintList& list = lists[i];
    renumber(list, out.place);
    out.pools.push_back(make_pool(list));
    if (!list.chained && list.in_lanes)
      schedules[i] = schedule_list(list, tile_of, static_cast<int>(out.tiles.size()), in_given_order, static_cast<int>(i),
                                   colouring, out.pools[i]);
    if (!is_needed_later(list, options)) list = list.empty();
  }
  merge(schedules, out);
}

/// Schedules the constraints that are projected one at a time, list by list, in colours over the whole object. Frames
/// have indices after all particles.
void schedule_stencils(std::vector<ConstraintList>& lists, bool in_given_order, CompiledObject& out) {
  Colouring colouring(out.particles + static_cast<int>(out.frames.size()));
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (lists[i].in_lanes) continue;
    std::vector<int> members(static_cast<std::size_t>(lists[i].count()));
    std::iota(members.begin(), members.end(), 0);
    const std::vector<Colour> colours =
        in_given_order ? one_by_one(members) : colouring.colour_singly(lists[i].stencils.own(), lists[i].size, members);
    for (const Colour& colour : colours) {
      const int first = static_cast<int>(out.segments.size());
      append_colour(lists[i], colour, batches_per_stencil_task, static_cast<int>(i), out.pools[i], out.segments);
      out.phases.push_back({Driver::stencil, first, static_cast<int>(out.segments.size())});
    }
  }
}

// ---------------------------------------------------------------- surface and volume

void fill_triangles(const Object& object, CompiledObject& out) {
  out.surface.triangles.reserve(object.triangles.size());
  for (const auto& triangle : object.triangles)
    out.surface.triangles.push_back({out.place[triangle[0]], out.place[triangle[1]], out.place[triangle[2]]});
}

void fill_corners(CompiledObject& out) {
  Surface& surface = out.surface;
  surface.corner_begin.assign(static_cast<std::size_t>(out.particles) + 1, 0);
  for (const auto& triangle : surface.triangles)
    for (int corner : triangle) ++surface.corner_begin[corner + 1];
  for (int p = 0; p < out.particles; ++p) surface.corner_begin[p + 1] += surface.corner_begin[p];
  surface.corners.resize(3 * surface.triangles.size());
  std::vector<int> next(surface.corner_begin.begin(), surface.corner_begin.end() - 1);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) surface.corners[next[surface.triangles[t][corner]]++] = 3 * t + corner;
  }
}

/// True if no particle is kinematic, and the triangles connect all of them.
bool is_one_free_surface(const Object& object, const CompiledObject& out) {
  for (int p = 0; p < out.particles; ++p)
    if (!(out.positions[p].w > 0) || out.surface.corner_begin[p] == out.surface.corner_begin[p + 1]) return false;
  const int triangles = static_cast<int>(object.triangles.size());
  return find_pieces(find_edges(object.triangles, out.particles), triangles).count == 1;
}

void fill_volume(const Object& object, int passes, CompiledObject& out) {
  if (!object.volume) return;
  double six_volumes = 0;
  const Vec3f& o = object.positions[object.triangles.empty() ? 0 : object.triangles[0][0]];
  const auto from_origin = [&](int i) {
    const Vec3f& p = object.positions[i];
    return Vec3<double>{double(p.x) - o.x, double(p.y) - o.y, double(p.z) - o.z};
  };
  for (const auto& t : object.triangles) six_volumes += dot(cross(from_origin(t[0]), from_origin(t[1])), from_origin(t[2]));
  const Stiffness& stiffness = object.volume->stiffness;
  const bool pbd = stiffness.kind == Stiffness::Kind::pbd;
  out.has_volume = true;
  out.volume.target = object.volume->pressure * six_volumes;
  out.volume.law = pbd ? Law::pbd : stiffness.damping > 0 ? Law::damped : Law::compliant;
  out.volume.response = pbd ? static_cast<float>(stiffness_per_projection(stiffness.value, passes)) : stiffness.value;
  out.volume.damping = stiffness.damping;
  for (int p = 0; p < out.particles; ++p) {
    const bool is_free = out.positions[p].w > 0 && out.surface.corner_begin[p] < out.surface.corner_begin[p + 1];
    out.volume.mass += is_free ? 1.0 / out.positions[p].w : 0;
  }
  out.volume.keeps_momentum = object.volume->pressure > 1 && is_one_free_surface(object, out);
}

/// Adds the phases of volume and tethers, and sorts all phases by driver.
void add_whole_object_phases(CompiledObject& out) {
  if (out.has_volume) out.phases.push_back({Driver::volume, 0, 1});
  if (out.tethers.slots > 0) out.phases.push_back({Driver::tether, 0, 1});
  std::stable_sort(out.phases.begin(), out.phases.end(),
                   [](const ObjectPhase& a, const ObjectPhase& b) { return a.driver < b.driver; });
}

/// The contact lines of an object without triangles: its first group of distance constraints, the links of a rope.
/// Later groups are bending; their lines would always touch the links.
std::vector<std::array<int, 2>> lines_of(const Object& object, const std::vector<int>& place) {
  std::vector<std::array<int, 2>> lines;
  const auto group = std::find_if(object.constraints.begin(), object.constraints.end(),
                                  [](const ConstraintGroup& one) { return is_length(one.type); });
  if (group == object.constraints.end()) return lines;
  for (std::size_t i = 0; i + 1 < group->particles.size(); i += 2) {
    const int a = group->particles[i], b = group->particles[i + 1];
    if (length_squared(object.positions[a] - object.positions[b]) > 0) lines.push_back({place[a], place[b]});
  }
  return lines;
}

/// Compiles an object. `given_away` is that object if its constraints may be moved out of it, else null.
CompiledObject compile(const Object& object, Object* given_away, const CompileOptions& options) {
  CompiledObject out;
  out.name = object.name;
  out.sweep = options.sweep;
  const std::vector<Vec3f> with_targets = object.attachments.empty() ? std::vector<Vec3f>{} : all_positions(object);
  const std::vector<Vec3f>& positions = object.attachments.empty() ? object.positions : with_targets;
  out.particles = static_cast<int>(positions.size());
  out.user_particles = static_cast<int>(object.positions.size());
  const float slack = tether_slack(object, options);  // before the constraints are moved out of the object
  out.own_substeps = own_substeps(object, options.sweep, options.is_blown, options.frame_time);
  out.substep_rule = substep_rule(object, options.sweep, static_cast<double>(options.gravity));

  std::vector<ConstraintList> lists = given_away != nullptr ? gather_constraints(std::move(*given_away), options.passes)
                                                            : gather_constraints(object, options.passes);
  const bool in_given_order = options.sweep == Sweep::natural;
  if (solves_chains(options.sweep)) split_off_chains(lists, held_by_targets(object, static_cast<double>(options.gravity)));
  std::vector<int> tile;
  const int largest_tile = in_given_order ? std::numeric_limits<int>::max() : options.largest_tile;
  number_particles(positions, lists, largest_tile, tile, out);
  fill_frames(object, out.frames);
  out.bodies = compile_bodies(object, out.place, out.particles);
  fill_kinematics(object, out);
  schedule(lists, tile, options, out);
  fill_particles(object, positions, out);
  append_chains(lists, options.chain_softness, out);
  schedule_stencils(lists, in_given_order, out);
  out.joints = compile_joints(object, out);
  fill_triangles(object, out);
  if (options.air || object.volume) fill_corners(out);
  if (has_tethers(options))
    out.tethers = find_tethers(lists, slack, anchors_of(object, static_cast<double>(options.gravity), out), out);
  if (options.sweep == Sweep::multigrid) out.multigrid = build_multigrid(lists, out.positions, options.gravity);
  fill_volume(object, options.passes, out);
  add_whole_object_phases(out);
  out.lengths = find_length_ranges(out);

  if (object.triangles.empty()) out.lines = lines_of(object, out.place);
  out.self_collision = object.self_collision;
  out.collides = object.collides;
  out.groups = object.groups;
  out.mask = object.mask;
  out.thickness = object.thickness;
  out.static_friction = object.static_friction;
  out.kinetic_friction = object.kinetic_friction;
  out.restitution = object.restitution;
  out.rolling_friction = object.rolling_friction;
  out.spinning_friction = object.spinning_friction;
  out.drag = object.drag;
  out.lift = object.lift;
  out.damping = object.damping;
  return out;
}

std::vector<Vec3f> in_storage_order(const std::vector<Vec3f>& places, const CompiledObject& object) {
  std::vector<Vec3f> out;
  out.reserve(places.size());
  for (const int user : object.order) out.push_back(places[static_cast<std::size_t>(user)]);
  return out;
}

/// Sets the motion of a mesh collider, and its vertex positions at time 0.
void fill_carrier(const MeshCollider& collider, CompiledObject& out) {
  Carrier& carrier = out.carrier;
  carrier.motion = collider.motion;
  carrier.rest = in_storage_order(collider.mesh.positions, out);
  carrier.repeat = collider.repeat_frames;
  for (const MeshFrame& frame : collider.frames) {
    carrier.times.push_back(frame.time);
    carrier.frames.push_back(in_storage_order(frame.positions, out));
  }
  const CarrierPose start(carrier, 0);
  for (int i = 0; carrier.moves() && i < out.particles; ++i) {
    const Vec3f place = convert<float>(start.place(i));
    out.positions[static_cast<std::size_t>(i)] = {place.x, place.y, place.z, 0};
  }
}

}  // namespace

CompiledObject compile(const Object& object, const CompileOptions& options) { return compile(object, nullptr, options); }

CompiledObject compile(Object&& object, const CompileOptions& options) {
  const bool is_surface = !object.triangles.empty() && object.bodies.empty();  // else constraints are read again
  return compile(object, is_surface ? &object : nullptr, options);
}

CompiledObject compile(const MeshCollider& collider) {
  Object object;
  object.name = collider.name;
  object.positions = collider.mesh.positions;
  object.masses.assign(object.positions.size(), std::numeric_limits<float>::infinity());
  object.triangles = collider.mesh.triangles;
  object.thickness = collider.thickness;
  object.static_friction = collider.static_friction;
  object.kinetic_friction = collider.kinetic_friction;
  object.collides = true;
  const bool meets = collider.as == MeshCollider::As::triangles;  // otherwise only particles touch it
  object.groups = meets ? collider.groups : 0;
  object.mask = meets ? collider.mask : 0;
  object.restitution = collider.restitution;
  object.rolling_friction = collider.rolling_friction;
  object.spinning_friction = collider.spinning_friction;
  object.drag = object.lift = 0;
  CompiledObject out = compile(object, CompileOptions{});
  out.is_collider = true;
  out.own_substeps = 0;
  out.substep_rule = SubstepRule::any;
  fill_carrier(collider, out);
  return out;
}

}  // namespace pliant

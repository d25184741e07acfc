// Compiles an object's description to a schedule: tiles, storage order, colours, batches.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "constraints/registry.h"
#include "model/attachments.h"
#include "model/chains.h"
#include "model/compile_flow.h"
#include "model/compile_particles.h"
#include "model/compile_surface.h"
#include "model/compiled_object.h"
#include "model/gather_constraints.h"
#include "model/held_particles.h"
#include "model/join_volumes.h"
#include "model/keep_schedule.h"
#include "model/length_ranges.h"
#include "model/object_sets.h"
#include "model/schedule.h"
#include "model/sheet_bending.h"
#include "model/sheet_choice.h"

namespace pliant {

namespace {

bool has_tethers(const CompileOptions& options) { return options.tethers || options.sweep == Sweep::tethered_chains; }

/// Tethers that the user did not ask for leave room for the strain that the object's weight causes, also near the pins.
float tether_slack(const Object& object, const CompileOptions& options) {
  constexpr double strain_at_pins = 5;  // over the mean strain
  if (options.tethers) return options.tether_slack;
  const double strain = strain_by_weight(object, double(options.gravity)).value_or(0);
  return options.tether_slack + static_cast<float>(strain_at_pins * strain);
}

/// The fixed particles to which tethers lead, in ascending order: all but the targets of attachments that yield or pull
/// from afar.
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

void fill_clusters(const Object& object, int passes, CompiledObject& out) {
  if (object.clusters.empty()) return;
  std::vector<float> inverse_masses;
  for (const Record& position : out.positions) inverse_masses.push_back(position.w);
  out.clusters = compile_clusters(object, out.place, inverse_masses, passes);
}

/// Adds the phases of volume, clusters, fluids, grains and tethers, and sorts all phases by driver.
void add_whole_object_phases(CompiledObject& out) {
  if (!out.held.particles.empty()) out.phases.push_back({Driver::held, 0, 1});
  if (out.has_volume) out.phases.push_back({Driver::volume, 0, 1});
  for (const auto& [first, last] : out.clusters.colours) out.phases.push_back({Driver::cluster, first, last});
  if (out.tethers.slots > 0) out.phases.push_back({Driver::tether, 0, 1});
  std::stable_sort(out.phases.begin(), out.phases.end(),
                   [](const ObjectPhase& a, const ObjectPhase& b) { return a.driver < b.driver; });
}

/// The longest substep in which an object is likely to bend, for excess_of_hinges() [s].
double longest_substep(SubstepRule rule, const CompileOptions& options) {
  const bool follows_state = rule == SubstepRule::by_state && !options.names_substeps;
  const double substeps = follows_state ? least_substeps_of_sheets : double(options.passes) / options.iterations;
  return options.frame_time / (substeps * std::sqrt(double(options.iterations)));
}

/// By multigrid, sheets that bend as a whole gain energy at edges of solids, so hinges stay where h^2 B / (rho e^4) is
/// less: there they err by 5 % beyond what the mesh does.
constexpr double most_of_hinges = 0.02;

/// True if an object bends as a sheet. Matter that is to keep its motion has hinges, which keep it; so have coarse
/// sheets, and large ones that come apart, for which each tear would build the energy anew.
bool is_sheet(const Object& object, SubstepRule rule, const CompileOptions& options) {
  constexpr std::size_t most_torn = 10000;
  const bool comes_apart = object.tearing || !object.cuts.empty();
  if (options.sweep == Sweep::natural || options.keeps_energy) return false;
  if (comes_apart && object.positions.size() > most_torn) return false;
  const double h = longest_substep(rule, options);
  if (options.sweep == Sweep::multigrid && h * h * facts_of_sheet(object).stiffness < most_of_hinges) return false;
  return !has_long_edges(object, static_cast<double>(options.gravity)) && bends_as_sheet(object, h);
}

/// Compiles an object. `given_away` is that object if its constraints may be moved out of it, else null. `kept`: null
/// if it is scheduled for the first time.
CompiledObject compile(const Object& object, Object* given_away, const CompileOptions& options,
                       const KeptSchedule* kept) {
  CompiledObject out;
  out.name = object.name;
  out.sweep = options.sweep;
  const std::vector<Vec3f> with_targets = object.attachments.empty() ? std::vector<Vec3f>{} : all_positions(object);
  const std::vector<Vec3f>& positions = object.attachments.empty() ? object.positions : with_targets;
  out.particles = static_cast<int>(positions.size());
  out.user_particles = static_cast<int>(object.positions.size());
  const float slack = tether_slack(object, options);  // before the constraints are moved out of the object
  out.own_substeps = own_substeps(object, options.sweep, options.is_blown, options.frame_time);
  out.grain_heights = heights_of_grains(object, options.frame_time);
  out.substep_rule = substep_rule(object, options.sweep, static_cast<double>(options.gravity));

  const std::vector<ChangingGroup> changing = find_changing_groups(object);  // likewise
  std::optional<SheetFacts> sheet;
  if (is_sheet(object, out.substep_rule, options)) sheet = facts_of_sheet(object);
  std::vector<ConstraintList> lists = given_away != nullptr ? gather_constraints(std::move(*given_away), options.passes)
                                                            : gather_constraints(object, options.passes);
  if (sheet) std::erase_if(lists, [](const ConstraintList& list) { return is_hinge(list.type); });
  out.fans = join_volumes(lists, kept);
  const bool in_given_order = options.sweep == Sweep::natural;
  const std::vector<int> held = held_by_targets(object, static_cast<double>(options.gravity));
  if (solves_chains(options.sweep)) split_off_chains(lists, held);
  const bool is_held = !in_given_order && holds_particles(object, lists);  // before the lists are emptied
  std::vector<int> tile;
  const int largest_tile = in_given_order ? std::numeric_limits<int>::max() : options.largest_tile;
  if (kept != nullptr)
    number_as_before(*kept, tile, out);
  else
    number_particles(positions, lists, largest_tile, is_held ? &object : nullptr, tile, out);
  fill_frames(object, out.frames);
  out.bodies = compile_bodies(object, out.place, out.particles);
  for (const DrivenFrame& driven : out.bodies.driven) {  // nothing else turns them
    out.frames.inverse_inertias[static_cast<std::size_t>(driven.frame)] = {};
    out.frames.angular_velocities[static_cast<std::size_t>(driven.frame)] = {};
  }
  fill_kinematics(object, out);
  schedule(lists, tile, in_given_order, has_tethers(options) || options.sweep == Sweep::multigrid, kept, out);
  if (kept != nullptr && has_many_additions(out)) return out;  // the caller schedules it from scratch
  if (is_held) out.held = find_held_particles(object, tile, out);
  fill_particles(object, positions, out);
  if (sheet) out.sheet = build_sheet(object, *sheet, out.place, out.positions, held);
  append_chains(lists, options.chain_softness, out);
  schedule_stencils(lists, in_given_order, out);
  out.joints = compile_joints(object, out);
  out.changing = compile_changing_rest(changing, out);
  fill_triangles(object, out);
  compile_absorbency(object, out);
  if (options.air || object.volume) fill_corners(out);
  if (has_tethers(options))
    out.tethers = find_tethers(lists, slack, anchors_of(object, static_cast<double>(options.gravity), out), out);
  if (options.sweep == Sweep::multigrid) out.multigrid = build_multigrid(lists, out.positions, options.gravity);
  fill_volume(object, options.passes, out);
  // Stresses that stay, of muscles or after flow, would turn it as those of balloons do (solver/momentum.h).
  if (!changing.empty() && is_one_free_piece(out)) out.volume.keeps_momentum = true;
  fill_clusters(object, options.passes, out);
  out.fluid = object.fluid;
  out.grains = object.grains;
  out.gas = object.gas;
  out.tracers = object.tracers;
  compile_flow(object, out);
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

CompiledObject compile(const Object& object, const CompileOptions& options, const KeptSchedule* kept) {
  if (kept != nullptr) {
    CompiledObject out = compile(object, nullptr, options, kept);
    if (!has_many_additions(out)) return out;
  }
  return compile(object, nullptr, options, nullptr);
}

CompiledObject compile(Object&& object, const CompileOptions& options) {
  const bool is_surface = !object.triangles.empty() && object.bodies.empty();  // else constraints are read again
  return compile(object, is_surface ? &object : nullptr, options, nullptr);
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
  out.surface_velocity = collider.surface_velocity;
  out.own_substeps = 0;
  out.substep_rule = SubstepRule::any;
  fill_carrier(collider, out);
  return out;
}

}  // namespace pliant

#include "solver/frame.h"

#include <algorithm>

#include "math/motion.h"
#include "solver/diagnose.h"
#include "solver/forces.h"
#include "solver/pair_words.h"
#include "solver/sweeps/chains.h"
#include "solver/sweeps/sweep.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// Below this many batches a colour of straddlers is done sooner than other threads can be told of it.
constexpr int fewest_batches_to_share = 96;

/// Rounds of contacts beyond the iterations in which a push is passed on through what lies in layers.
constexpr int most_rounds_of_contacts = 16;

}  // namespace

Frame::Frame(const StepContext& context, double dt, Report& report)
    : context_(context),
      model_(context.model),
      state_(context.state),
      work_(context.workspace),
      executor_(context.executor),
      kernels_(context.kernels),
      report_(report),
      start_(context.state.time),
      dt_(dt),
      h_(static_cast<float>(dt / context.substeps)),
      sweeps_on_entry_(sweep_method(context.sweep).begins_on_entry && !context.record_residuals &&
                       context.options.acceleration == SweepOptions::Acceleration::none) {
  for (std::size_t o = 0; o < work_.gravity.size(); ++o)
    work_.gravity[o] = {0, 0, 0, 1 / (1 + h_ * model_.objects[o].damping)};
  if (!has_pairs()) return;
  work_.pairs->begin_frame(state_.positions.data(), work_.look_for_tangles);
  work_.look_for_tangles = false;
  sweeps_on_entry_ = sweeps_on_entry_ && !work_.pairs->untangles();
}

// ---------------------------------------------------------------- views

SweepArguments Frame::arguments(int object, bool first_pass) const {
  const int first = model_.first[object];
  SweepArguments a;
  a.positions = state_.positions.data() + first;
  a.displacements = work_.displacements.data() + first;
  a.remainders = state_.remainders.data() + first;
  a.multipliers = work_.multiplier_pointers[object].empty() ? nullptr : work_.multiplier_pointers[object].data();
  a.h = h_;
  a.inverse_h = 1 / h_;
  a.inverse_h2 = (1 / h_) * (1 / h_);
  a.first_pass = first_pass;
  a.relaxation = context_.options.relaxation;
  return a;
}

AdvanceArguments Frame::particles(int task) const {
  const TileTask& of = model_.tiles[task];
  const int first = model_.first[of.object];
  const Tile& tile = model_.objects[of.object].tiles[of.tile];
  const FrameGravity& gravity = work_.gravity[of.object];
  AdvanceArguments a;
  a.positions = state_.positions.data() + first;
  a.displacements = work_.displacements.data() + first;
  a.remainders = state_.remainders.data() + first;
  a.velocities = state_.velocities.data() + first;
  a.first = tile.first_particle;
  a.last = tile.last_particle;
  a.h = h_;
  a.inverse_h = 1 / h_;
  a.velocity_kept = gravity.kept;
  a.gravity_step = model_.gravity * h_;
  a.gravity_finished = gravity_for(gravity.finished);
  a.gravity_begun = gravity_for(gravity.begun);
  return a;
}

void Frame::for_tiles(const char* name, FunctionRef<void(int)> body) {
  executor_.parallel_for(name, static_cast<int>(model_.tiles.size()), body);
}

void Frame::for_each_task(const char* name, int tasks, FunctionRef<void(int)> body) {
  executor_.parallel_for(name, tasks, body);
}

// ---------------------------------------------------------------- particles

void Frame::begin_substep(int substep) {
  time_after_ = time_of(substep + 1);
  move_colliders(model_, time_of(substep), time_after_, work_.colliders);
  for (FrameGravity& gravity : work_.gravity) gravity.next(h_);
}

void Frame::apply_external_forces(int substep) {
  apply_forces(
      model_, state_, work_, executor_, time_of(substep), h_, [&](int o) { return gravity_for(work_.gravity[o].settled); },
      report_.warnings);
}

void Frame::enter_tiles(bool finishes_first) {
  for_tiles("solve: tiles", [&](int task) {
    if (enter_tile(task, finishes_first) && sweeps_on_entry_) sweep_tile(task, true, Order::forward);
  });
}

/// A tile's end of one substep and start of the next, in one pass over memory where nothing touched it; false where it must
/// stop.
bool Frame::enter_tile(int task, bool finishes_first) {
  const CompiledObject& object = model_.objects[model_.tiles[task].object];
  const AdvanceArguments a = particles(task);
  TileScratch& scratch = work_.tiles[task];
  const bool in_one_pass = finishes_first && scratch.contacts.empty();
  if (in_one_pass) {
    scratch.finite = kernels_.all_finite(a.displacements, a.first, a.last);
    if (!scratch.finite) return false;
  } else if (finishes_first && !finish_tile(task, false)) {
    return false;
  }
  scratch.contacts.clear();
  scratch.bounds = {};
  PointBounds* bounds = work_.colliders.empty() ? nullptr : &scratch.bounds;
  (in_one_pass ? kernels_.advance : kernels_.predict)(a, bounds);
  move_kinematics(object, a);
  if (bounds != nullptr) {
    find_contacts({object, a, *bounds, work_.colliders, kernels_.find_near}, scratch.near, scratch.contacts);
  }
  return true;
}

namespace {

/// A particle whose place at the substep's end is given.
void move_to(const Vec3d& target, int particle, const AdvanceArguments& a) {
  const Record &x = a.positions[particle], &r = a.remainders[particle];
  Record &d = a.displacements[particle], &v = a.velocities[particle];
  d = {static_cast<float>(target.x - x.x), static_cast<float>(target.y - x.y), static_cast<float>(target.z - x.z), 0};
  v = {(d.x - r.x) * a.inverse_h, (d.y - r.y) * a.inverse_h, (d.z - r.z) * a.inverse_h, 0};
}

}  // namespace

/// Particles on keyframes go where they are to be at the substep's end.
void Frame::move_kinematics(const CompiledObject& object, const AdvanceArguments& a) const {
  if (object.carrier.moves()) {
    const CarrierPose pose(object.carrier, time_after_);
    for (int i = a.first; i < a.last; ++i) move_to(pose.place(i), i, a);
  }
  auto kinematic = std::lower_bound(object.kinematics.begin(), object.kinematics.end(), a.first,
                                    [](const Kinematic& k, int first) { return k.particle < first; });
  for (; kinematic != object.kinematics.end() && kinematic->particle < a.last; ++kinematic) {
    const Vec3<double> target = to_world(pose_at(kinematic->motion, time_after_), convert<double>(kinematic->rest));
    move_to(target, kinematic->particle, a);
  }
}

void Frame::finish_tiles(bool ends_frame) {
  if (ends_frame) {
    for (FrameGravity& gravity : work_.gravity) gravity.next(h_);
  }
  for_tiles("update", [&](int task) { finish_tile(task, ends_frame); });
}

/// False, and nothing changed, where a displacement is not finite.
bool Frame::finish_tile(int task, bool ends_frame) {
  AdvanceArguments a = particles(task);
  TileScratch& scratch = work_.tiles[task];
  scratch.finite = kernels_.all_finite(a.displacements, a.first, a.last);
  if (!scratch.finite) return false;
  const Vec3f settled = gravity_for(work_.gravity[model_.tiles[task].object].settled);
  if (ends_frame) a.gravity_settled = settled;
  kernels_.update(a);
  if (!scratch.contacts.empty()) respond(scratch.contacts, ends_frame ? Vec3f{} : settled, a);
  return true;
}

// ---------------------------------------------------------------- pairs

PairParticles Frame::all_particles() const {
  return {state_.positions.data(), state_.remainders.data(), work_.displacements.data(), h_};
}

void Frame::find_pairs() { work_.pairs->detect(executor_, all_particles()); }
void Frame::sweep_pairs() { work_.pairs->project(all_particles()); }
void Frame::filter_pairs(bool ends_frame) {
  // What drives on can't be shortened: whatever it meets must be out of its way before moves are.
  for (int round = 0; round < most_rounds_of_contacts && work_.pairs->is_overrun(all_particles()); ++round) {
    sweep_pairs();
    sweep_contacts();
  }
  work_.pairs->filter(executor_, all_particles());
  if (ends_frame) work_.pairs->measure_overlaps(all_particles());
}
void Frame::respond_to_pairs(bool ends_frame) {
  work_.pairs->respond(state_.positions.data(), state_.velocities.data(), 2 * length(model_.gravity) * h_,
                       [&](int object) { return ends_frame ? Vec3f{} : gravity_for(work_.gravity[object].settled); });
}

// ---------------------------------------------------------------- constraints

void Frame::sweep_tiles(bool first_pass, Order order) {
  for_tiles("solve: tiles", [&](int task) { sweep_tile(task, first_pass, order); });
}

/// Segments are gone through from either end; the constraints inside one share no particle and have no order.
void Frame::sweep_tile(int task, bool first_pass, Order order) {
  const int object = model_.tiles[task].object;
  const Tile& tile = model_.objects[object].tiles[model_.tiles[task].tile];
  if (order == Order::forward) return sweep_segments(object, tile.first_segment, tile.last_segment, first_pass);
  for (int s = tile.last_segment; s-- > tile.first_segment;) sweep_segments(object, s, s + 1, first_pass);
}

void Frame::sweep_segments(int object, int first, int last, bool first_pass) {
  const CompiledObject& from = model_.objects[object];
  const auto sweep = context_.options.relaxation == 1 ? kernels_.sweep : kernels_.sweep_general;
  sweep(from.pools.data(), from.segments.data() + first, from.segments.data() + last, arguments(object, first_pass));
}

void Frame::sweep_straddlers(bool first_pass, Order order) {
  for_straddlers(order, [&](int object, const Segment* segment) {
    const int number = static_cast<int>(segment - model_.objects[object].segments.data());
    sweep_segments(object, number, number + 1, first_pass);
  });
}

/// Phase after phase, the segments of each shared out among threads where they are many.
void Frame::for_straddlers(Order order, FunctionRef<void(int, const Segment*)> body) {
  const std::size_t phases = model_.straddlers.size();
  for (std::size_t p = 0; p < phases; ++p) {
    const StraddlerPhase& phase = model_.straddlers[order == Order::forward ? p : phases - 1 - p];
    const auto sweep_task = [&](int i) {
      const StraddlerPhase::Task& task = phase.tasks[i];
      body(task.object, model_.objects[task.object].segments.data() + task.segment);
    };
    const int tasks = static_cast<int>(phase.tasks.size());
    if (phase.batches >= fewest_batches_to_share) {
      executor_.parallel_for("solve: straddlers", tasks, sweep_task);
    } else {
      Stopwatch watch(executor_.timings(), "solve: straddlers");
      for (int i = 0; i < tasks; ++i) sweep_task(i);
    }
  }
}

void Frame::sweep_chains(bool first_pass) {
  const ChainKernels& kernels = kernels_.chains;
  const auto of_object = [&](int object) { return arguments(object, first_pass); };
  solve_chains(model_, kernels, work_, executor_, of_object);
}

void Frame::hold_tethers() {
  const auto of_object = [&](int object) { return arguments(object, false); };
  pliant::hold_tethers(model_, kernels_.chains, work_, executor_, of_object);
}

void Frame::sweep_volumes(bool first_pass) {
  project_volumes(model_, work_, executor_, [&](int object) { return arguments(object, first_pass); });
}

void Frame::sweep_contacts() {
  if (work_.colliders.empty()) return;
  for_tiles("solve: contacts", [&](int task) {
    std::vector<Contact>& contacts = work_.tiles[task].contacts;
    if (!contacts.empty()) project_contacts(contacts, arguments(model_.tiles[task].object, false));
  });
}

namespace {

/// As deep as this share of the thickness. What reaches in less is pushed out in the next substep; where it is pushed at once,
/// cloth that rests on a floor stirs two to four times as much.
constexpr float worth_a_contact = 0.25f;

}  // namespace

void Frame::find_more_contacts() {
  if (work_.colliders.empty()) return;
  for_tiles("solve: contacts", [&](int task) {
    TileScratch& scratch = work_.tiles[task];
    const AdvanceArguments a = particles(task);
    for (int i = a.first; i < a.last; ++i) {
      const Record &x = a.positions[i], &d = a.displacements[i];
      Record &low = scratch.bounds.low, &high = scratch.bounds.high;
      low = {min(low.x, x.x + d.x), min(low.y, x.y + d.y), min(low.z, x.z + d.z), 0};
      high = {max(high.x, x.x + d.x), max(high.y, x.y + d.y), max(high.z, x.z + d.z), 0};
    }
    const CompiledObject& object = model_.objects[model_.tiles[task].object];
    scratch.more_contacts.clear();
    find_contacts({object, a, scratch.bounds, work_.colliders, kernels_.find_near}, scratch.near, scratch.more_contacts);
    const auto is_shallow = [&](const Contact& c) {
      const Record& d = a.displacements[c.particle];
      const float thickness = object.thickness + work_.colliders[c.collider].thickness;
      return c.gap + dot(c.normal, Vec3f{d.x, d.y, d.z}) > -worth_a_contact * thickness;
    };
    std::erase_if(scratch.more_contacts, is_shallow);
    if (scratch.more_contacts.empty()) return;
    merge_contacts(scratch.contacts, scratch.more_contacts, scratch.all_contacts);
    std::swap(scratch.contacts, scratch.all_contacts);
  });
}

// ---------------------------------------------------------------- the end

bool Frame::give_up(int substep) {
  const bool failed =
      std::any_of(work_.tiles.begin(), work_.tiles.end(), [](const TileScratch& tile) { return !tile.finite; });
  if (!failed) return false;
  report_.nonfinite = diagnose(
      context_, [&](int task) { return particles(task); }, [&](int o) { return arguments(o, true); });
  report_.nonfinite->frame = state_.frame;
  report_.nonfinite->substep = substep;
  return true;
}

void Frame::count_iterations(int iterations) {
  IterationCount& count = report_.iterations;
  count.smallest = count.smallest == 0 ? iterations : std::min(count.smallest, iterations);
  count.largest = std::max(count.largest, iterations);
  iterations_made_ += iterations;
  count.mean = static_cast<double>(iterations_made_) / ++substeps_counted_;
}

void Frame::end() {
  for (const TileScratch& tile : work_.tiles) {
    report_.contacts +=
        std::count_if(tile.contacts.begin(), tile.contacts.end(), [](const Contact& c) { return c.push > 0; });
  }
  if (has_pairs()) {
    const PairCounts& c = work_.pairs->counts();
    report_.pairs = {c.candidates, c.contacts, c.shortened, c.hopeless, c.tangled, c.rebuilds, c.inside, c.deepest};
    warn_of_pairs(model_, *work_.pairs, report_.warnings);
  }
  state_.time = start_ + dt_;
}

}  // namespace pliant

// The frame, whole: this is the page to read first.
//
//   for each substep of h = dt / substeps
//     kinematics    what is pinned or attached to keyframes gets the velocity that brings it to its next place
//     forces        wind and force fields on the velocities (where there are any)
//     predict       v += h g, displacement = h v                            symplectic Euler
//     collide       contacts of the predicted path with the colliders
//     solve         iterations x (constraints tile by tile, those that straddle tiles, volumes, contacts)
//     update        v from the corrections
//     respond       restitution where something touched (friction is part of the contact's projection)
//
// Mueller et al. 2007, algorithm 1, with the small steps of Macklin et al. 2019. What a tile needs from one substep to the next is
// its own affair, so update, respond, predict, collide and the first sweep are one visit to each tile while it is in the cache.
#include "solver/step.h"

#include <algorithm>
#include <chrono>

#include "math/motion.h"
#include "solver/diagnose.h"
#include "solver/forces.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// Below this many batches a colour of straddlers is done sooner than other threads can be told of it.
constexpr int fewest_batches_to_share = 96;

class Frame {
 public:
  Frame(const StepContext& context, double dt, Report& report)
      : model_(context.model), state_(context.state), work_(context.workspace), executor_(context.executor),
        kernels_(context.kernels), context_(context), report_(report), start_(context.state.time), dt_(dt),
        h_(static_cast<float>(dt / context.substeps)), has_forces_(has_forces(context.model)), gravity_(context.model.objects.size()) {
    for (std::size_t o = 0; o < gravity_.size(); ++o) gravity_[o].kept = 1 / (1 + h_ * model_.objects[o].damping);
  }

  void run() {
    for (int substep = 0; substep < context_.substeps && !failed_; ++substep) {
      begin(substep);
      if (has_forces_) {
        if (substep > 0) for_tiles("update", [&](int task) { finish(task, false); });
        if (give_up(substep - 1)) return;
        apply_forces(model_, state_, work_, executor_, time_of(substep), h_, [&](int o) { return gravity_for(gravity_[o].settled); },
                     report_.warnings);
      }
      const bool finishes_first = substep > 0 && !has_forces_;
      for_tiles("solve: tiles", [&](int task) {
        if (enter_substep(task, finishes_first)) sweep_tile(task, true);
      });
      if (give_up(substep - 1)) return;
      for (int iteration = 0; iteration < context_.iterations; ++iteration) {
        if (iteration > 0) for_tiles("solve: tiles", [&](int task) { sweep_tile(task, false); });
        sweep_straddlers(iteration == 0);
        project_volumes(model_, work_, executor_, [&](int object) { return arguments(object, iteration == 0); });
        sweep_contacts();
      }
    }
    for (Gravity& gravity : gravity_) gravity.next(h_);
    for_tiles("update", [&](int task) { finish(task, true); });
    if (give_up(context_.substeps - 1)) return;
    for (const TileScratch& tile : work_.tiles) {
      for (const Contact& contact : tile.contacts) report_.contacts += contact.push > 0 ? 1 : 0;
    }
    state_.time = start_ + dt_;
  }

 private:
  /// For how long an object's particles have felt this frame's gravity, less what damping took of it [s].
  struct Gravity {
    double finished = 0, begun = 0, settled = 0;  // in the substep that ends, in the one that begins, and between the two
    float kept = 1;
    void next(float h) {
      finished = begun;
      settled = finished * kept;
      begun = settled + h;
    }
  };

  Vec3f gravity_for(double seconds) const { return model_.gravity * static_cast<float>(seconds); }

  double time_of(int substep) const { return start_ + dt_ * substep / context_.substeps; }

  void for_tiles(const char* name, FunctionRef<void(int)> body) {
    executor_.parallel_for(name, static_cast<int>(model_.tiles.size()), body);
  }

  SweepArguments arguments(int object, bool first_pass) const {
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
    return a;
  }

  AdvanceArguments particles(const TileTask& task) const {
    const int first = model_.first[task.object];
    const CompiledObject& object = model_.objects[task.object];
    AdvanceArguments a;
    a.positions = state_.positions.data() + first;
    a.displacements = work_.displacements.data() + first;
    a.remainders = state_.remainders.data() + first;
    a.velocities = state_.velocities.data() + first;
    a.first = object.tiles[task.tile].first_particle;
    a.last = object.tiles[task.tile].last_particle;
    a.h = h_;
    a.inverse_h = 1 / h_;
    const Gravity& gravity = gravity_[task.object];
    a.velocity_kept = gravity.kept;
    a.gravity_step = model_.gravity * h_;
    a.gravity_finished = gravity_for(gravity.finished);
    a.gravity_begun = gravity_for(gravity.begun);
    return a;
  }

  /// Colliders on their way to where this substep ends.
  void begin(int substep) {
    const double before = time_of(substep), after = time_of(substep + 1);
    move_colliders(model_, before, after, work_.colliders);
    for (Gravity& gravity : gravity_) gravity.next(h_);
    time_after_ = after;
  }

  /// Particles on keyframes go where they are to be at the substep's end.
  void move_kinematics(const CompiledObject& object, const AdvanceArguments& a) {
    auto kinematic = std::lower_bound(object.kinematics.begin(), object.kinematics.end(), a.first,
                                      [](const Kinematic& k, int first) { return k.particle < first; });
    for (; kinematic != object.kinematics.end() && kinematic->particle < a.last; ++kinematic) {
      const Vec3<double> target = to_world(pose_at(kinematic->motion, time_after_), convert<double>(kinematic->rest));
      const Record &x = a.positions[kinematic->particle], &r = a.remainders[kinematic->particle];
      Record &d = a.displacements[kinematic->particle], &v = a.velocities[kinematic->particle];
      d = {static_cast<float>(target.x - x.x), static_cast<float>(target.y - x.y), static_cast<float>(target.z - x.z), 0};
      v = {(d.x - r.x) * a.inverse_h, (d.y - r.y) * a.inverse_h, (d.z - r.z) * a.inverse_h, 0};
    }
  }

  /// A tile's end of one substep and start of the next; false where it must stop.
  bool enter_substep(int task, bool finishes_first) {
    const TileTask& tile = model_.tiles[task];
    const AdvanceArguments a = particles(tile);
    TileScratch& scratch = work_.tiles[task];
    const bool in_one_pass = finishes_first && scratch.contacts.empty();
    if (in_one_pass) {
      scratch.finite = kernels_.all_finite(a.displacements, a.first, a.last);
      if (!scratch.finite) return false;
    } else if (finishes_first && !finish(task, false)) {
      return false;
    }
    scratch.contacts.clear();
    scratch.bounds = {};
    Bounds* bounds = work_.colliders.empty() ? nullptr : &scratch.bounds;
    (in_one_pass ? kernels_.advance : kernels_.predict)(a, bounds);
    move_kinematics(model_.objects[tile.object], a);
    if (bounds != nullptr) {
      find_contacts({model_.objects[tile.object], a, *bounds, work_.colliders, kernels_.find_near}, scratch.near, scratch.contacts);
    }
    return true;
  }

  void sweep_tile(int task, bool first_pass) {
    const CompiledObject& object = model_.objects[model_.tiles[task].object];
    const Tile& tile = object.tiles[model_.tiles[task].tile];
    kernels_.sweep(object.pools.data(), object.segments.data() + tile.first_segment, object.segments.data() + tile.last_segment,
                   arguments(model_.tiles[task].object, first_pass));
  }

  void sweep_straddlers(bool first_pass) {
    for (const StraddlerPhase& phase : model_.straddlers) {
      const auto sweep_task = [&](int i) {
        const CompiledObject& object = model_.objects[phase.tasks[i].object];
        const Segment* segment = object.segments.data() + phase.tasks[i].segment;
        kernels_.sweep(object.pools.data(), segment, segment + 1, arguments(phase.tasks[i].object, first_pass));
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

  void sweep_contacts() {
    if (work_.colliders.empty()) return;
    for_tiles("solve: contacts", [&](int task) {
      if (!work_.tiles[task].contacts.empty()) project_contacts(work_.tiles[task].contacts, arguments(model_.tiles[task].object, false));
    });
  }

  /// The end of a tile's substep; false, and nothing changed, where a displacement is not finite.
  bool finish(int task, bool ends_frame) {
    AdvanceArguments a = particles(model_.tiles[task]);
    TileScratch& scratch = work_.tiles[task];
    scratch.finite = kernels_.all_finite(a.displacements, a.first, a.last);
    if (!scratch.finite) return false;
    const Vec3f settled = gravity_for(gravity_[model_.tiles[task].object].settled);
    if (ends_frame) a.gravity_settled = settled;
    kernels_.update(a);
    if (!scratch.contacts.empty()) respond(scratch.contacts, ends_frame ? Vec3f{} : settled, a);
    return true;
  }

  /// Whether some tile met a value that is not finite: it is named, and the state made whole again.
  bool give_up(int substep) {
    for (const TileScratch& tile : work_.tiles) failed_ = failed_ || !tile.finite;
    if (!failed_) return false;
    report_.nonfinite = diagnose(context_, [&](int task) { return particles(model_.tiles[task]); }, [&](int o) { return arguments(o, true); });
    report_.nonfinite->frame = state_.frame;
    report_.nonfinite->substep = substep;
    return true;
  }

  const Model& model_;
  State& state_;
  Workspace& work_;
  Executor& executor_;
  const Kernels& kernels_;
  const StepContext& context_;
  Report& report_;
  double start_, dt_, time_after_ = 0;
  float h_;
  bool has_forces_, failed_ = false;
  std::vector<Gravity> gravity_;  // one an object
};

}  // namespace

void step(const StepContext& context, double dt, Report& report) {
  const auto start = std::chrono::steady_clock::now();
  context.executor.timings().clear();
  for (TileScratch& tile : context.workspace.tiles) tile.finite = true;
  context.executor.enter([&] { Frame(context, dt, report).run(); });
  ++context.state.frame;
  report.frame = context.state.frame;
  report.time = context.state.time;
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (const Timings::Entry& entry : context.executor.timings().entries()) report.phases.push_back({entry.name, entry.milliseconds});
}

}  // namespace pliant

// What the steps of a frame do to tiles, straddlers and contacts. solver/step.cpp says in which order.
#pragma once

#include "solver/step.h"

namespace pliant {

/// Which way the schedule is gone through.
enum class Order { forward, backward };

class Frame {
 public:
  Frame(const StepContext& context, double dt, Report& report);

  /// Colliders move to where substep number `substep` ends; its share of gravity comes into play.
  void begin_substep(int substep);

  /// Wind and force fields on velocities, which must be up to date.
  void apply_external_forces(int substep);

  /// Prediction and contacts of every tile; before them, where `finishes_first`, the end of the substep before; after them,
  /// where the sweep allows it, the first sweep over the tile, which swept_on_entry() tells.
  void enter_tiles(bool finishes_first);
  bool swept_on_entry() const { return sweeps_on_entry_; }

  /// One sweep over the constraints inside tiles; over those between tiles; over volumes; over contacts.
  void sweep_tiles(bool first_pass, Order order);
  void sweep_straddlers(bool first_pass, Order order);
  void sweep_volumes(bool first_pass);

  /// Chains, and tethers, where there are any.
  void sweep_chains(bool first_pass);
  void hold_tethers();

  void sweep_contacts();

  /// Contacts of what has been moved since the prediction, beside those found then; for a sweep that moves particles far.
  void find_more_contacts();

  /// Contacts among what moves, and with meshes (collision/pairs.h): whether there can be any; those of the substep; one
  /// projection of each; and moves shortened so that nothing crosses.
  bool has_pairs() const { return work_.pairs != nullptr; }
  void find_pairs();
  void sweep_pairs();
  std::vector<PairContact>& pair_contacts() { return work_.pairs->contacts(); }
  PairParticles all_particles() const;
  void filter_pairs(bool ends_frame);
  void respond_to_pairs(bool ends_frame);

  /// Velocities and positions of every tile at the end of a substep, or of the frame.
  void finish_tiles(bool ends_frame);

  /// Whether some tile met a value that is not finite in substep number `substep`: it is named, and the state made finite
  /// again.
  bool give_up(int substep);

  /// A substep made so many iterations.
  void count_iterations(int iterations);

  /// Counts contacts and moves the clock.
  void end();

  // For the files of sweeps/ and residual.cpp: the parallel loops over tiles, over the segments between them (object,
  // segment) and over tasks of their own, and what they work on.
  void for_tiles(const char* name, FunctionRef<void(int)> body);
  void for_straddlers(Order order, FunctionRef<void(int, const Segment*)> body);
  void for_each_task(const char* name, int tasks, FunctionRef<void(int)> body);
  SweepArguments arguments(int object, bool first_pass) const;
  const Model& model() const { return model_; }
  Workspace& workspace() { return work_; }
  SweepScratch& scratch() { return work_.sweep; }
  const Kernels& kernels() const { return kernels_; }
  const SweepOptions& options() const { return context_.options; }
  Report& report() { return report_; }

 private:
  Vec3f gravity_for(double seconds) const { return model_.gravity * static_cast<float>(seconds); }
  double time_of(int substep) const { return start_ + dt_ * substep / context_.substeps; }
  AdvanceArguments particles(int task) const;
  bool enter_tile(int task, bool finishes_first);
  bool finish_tile(int task, bool ends_frame);
  void sweep_tile(int task, bool first_pass, Order order);
  void sweep_segments(int object, int first, int last, bool first_pass);
  void move_kinematics(const CompiledObject& object, const AdvanceArguments& a) const;

  const StepContext& context_;
  const Model& model_;
  State& state_;
  Workspace& work_;
  Executor& executor_;
  const Kernels& kernels_;
  Report& report_;
  double start_, dt_, time_after_ = 0;
  float h_;
  std::int64_t iterations_made_ = 0;
  int substeps_counted_ = 0;
  bool sweeps_on_entry_;
};

}  // namespace pliant

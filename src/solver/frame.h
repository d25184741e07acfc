// What the steps of a frame do to tiles, straddlers and contacts. solver/step.cpp says in which order.
#pragma once

#include "solver/step.h"

namespace pliant {

class Frame {
 public:
  Frame(const StepContext& context, double dt, Report& report);

  /// Colliders move to where substep number `substep` ends; its share of gravity comes into play.
  void begin_substep(int substep);

  /// Wind and force fields on velocities, which must be up to date.
  void apply_external_forces(int substep);

  /// Prediction, contacts and the first sweep of every tile; before them, where `finishes_first`, the end of the substep
  /// before.
  void enter_and_sweep_tiles(bool finishes_first);

  /// One sweep over the constraints inside tiles; over those between tiles; over volumes; over contacts.
  void sweep_tiles();
  void sweep_straddlers(bool first_pass);
  void sweep_volumes(bool first_pass);
  void sweep_contacts();

  /// Velocities and positions of every tile at the end of a substep, or of the frame.
  void finish_tiles(bool ends_frame);

  /// Whether some tile met a value that is not finite in substep number `substep`: it is named, and the state made finite
  /// again.
  bool give_up(int substep);

  /// Counts contacts and moves the clock.
  void end();

 private:
  Vec3f gravity_for(double seconds) const { return model_.gravity * static_cast<float>(seconds); }
  double time_of(int substep) const { return start_ + dt_ * substep / context_.substeps; }
  SweepArguments arguments(int object, bool first_pass) const;
  AdvanceArguments particles(int task) const;
  void for_tiles(const char* name, FunctionRef<void(int)> body);
  bool enter_tile(int task, bool finishes_first);
  bool finish_tile(int task, bool ends_frame);
  void sweep_tile(int task, bool first_pass);
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
};

}  // namespace pliant

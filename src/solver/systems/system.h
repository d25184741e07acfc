// What a kind of matter does in a frame beyond the constraints of its objects: rigid bodies, liquids, grains and gases
// are each a system of a substep group (solver/systems/systems.h).
//
// The stages of solver/step.cpp call all systems of a group in one order. A new kind of matter derives from System in a
// folder of its own, overrides the stages that it takes part in, and has one line in systems.cpp.
#pragma once

#include "math/vector.h"
#include "parallel/executor.h"

namespace pliant {

struct Report;
struct State;
struct Substep;

class System {
 public:
  System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;
  virtual ~System() = default;

  // ---------------------------------------------------------------------------------------- in the order of a frame

  /// Starts a frame.
  virtual void begin_frame(Substep& /*s*/) {}
  /// Starts a substep, after colliders have got their poses at its end.
  virtual void control(Substep& /*s*/) {}
  /// Changes velocities before the prediction, if changes_velocities().
  virtual void apply_forces(Substep& /*s*/) {}
  /// After the prediction: finds contacts and neighbours.
  virtual void collide(Substep& /*s*/) {}
  /// In each iteration: after the constraints that are projected one at a time, as often as they are.
  virtual void project_neighbours(Substep& /*s*/, bool /*is_first*/) {}
  /// In each iteration: after all constraints, and before tethers and the contacts of particles.
  virtual void project(Substep& /*s*/, bool /*is_first*/) {}
  /// After the iterations: keeps what they have moved from passing other things on its way.
  virtual void stop_passing(Substep& /*s*/) {}
  /// After the filter of surfaces, which may have truncated displacements.
  virtual void end_filter(Substep& /*s*/) {}
  /// After the update: changes velocities. `gravity(object)` is the part of gravity that the velocities of an object do
  /// not include yet [m/s]. Contacts of surfaces respond after all systems.
  virtual void respond(Substep& /*s*/, FunctionRef<Vec3f(int object)> /*gravity*/) {}
  /// After a substep that may be the last one of the frame: adds the contacts that press. Bodies say which of them are
  /// of points, edges and triangles.
  virtual void count_contacts(Report& /*report*/) const {}
  /// Adds to the State what lasts. All groups end a frame in turn, on empty lists of contacts.
  virtual void end_frame(Substep& /*s*/) {}
  /// After all groups have: puts what they have added in order.
  virtual void order(State& /*state*/) const {}
  /// Adds to the report of the frame.
  virtual void report(Report& /*report*/) const {}

  // ---------------------------------------------------------------------------------------------- what it is like

  /// True if apply_forces does something.
  virtual bool changes_velocities() const { return false; }
};

}  // namespace pliant

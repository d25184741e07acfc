// Contact of particles, edges and triangles with the solids of rigid bodies, in both directions: each contact moves the
// points of a surface and the body by one impulse at the point of contact, with the generalised inverse masses of both
// sides. The impulse m dx / dt of the encyclopedia entry on position based dynamics is the limit of a body much heavier
// than the points.
//
// BodySolids are what points touch, PointImpulses project the contacts that are found here, PointDepenetration moves
// out what starts inside, PointLoads are what particles carry of bodies, and BodyPassing keeps both sides from passing
// one another.
#pragma once

#include <string>
#include <vector>

#include "collision/narrow/shape_contacts.h"
#include "collision/proxies/contact_rules.h"
#include "model/model.h"
#include "solver/bodies/body_passing.h"
#include "solver/bodies/body_solids.h"
#include "solver/bodies/point_depenetration.h"
#include "solver/bodies/point_impulses.h"
#include "solver/bodies/point_loads.h"
#include "solver/bodies/surface_tiles.h"
#include "solver/bodies/swept_contacts.h"

namespace pliant {

struct Substep;

class BodyPoints {
 public:
  BodyPoints() = default;
  /// For objects whose particles may touch the solids of bodies. `rules` stay where they are.
  BodyPoints(const Model& model, const std::vector<int>& objects, const std::vector<TouchedBody>& bodies,
             const ContactRules& rules);

  /// False if no particle can touch a body.
  bool has_any() const { return !tasks_.empty() && !solids_.empty(); }
  const BodySolids& solids() const { return solids_; }
  /// The contacts of the substep.
  const PointImpulses& impulses() const { return impulses_; }
  PointLoads& loads() { return loads_; }
  const std::vector<PointDepenetration::Inside>& inside() const { return depenetration_.inside(); }

  /// Starts a frame: forgets contacts, because a State does not have them.
  void begin_frame(const Substep& s);
  /// Keeps where bodies are, before the next prediction.
  void keep_poses(const Substep& s);
  /// Finds the contacts of a substep, after the prediction.
  void detect(Substep& s);
  /// Projects each contact once, or those with points of the objects for which `of` is not zero. Here and below,
  /// `motions` have the bodies' inverse masses and inertias, in the order of the bodies.
  void project(Substep& s, const std::vector<BodyMotion>& motions, const std::vector<char>* of = nullptr) {
    impulses_.project(s, solids_, motions, of);
  }
  /// See BodyPassing.
  void stop_passing(Substep& s, const std::vector<BodyMotion>& motions);
  void hold_bodies(Substep& s, const std::vector<BodyMotion>& motions);
  void note_shift(float farthest) { passing_.note_shift(farthest); }
  void warn_of_overlaps(const Substep& s, std::vector<std::string>& warnings) const {
    passing_.warn_of_overlaps(s, {solids_, impulses_.contacts(), depenetration_.inside()}, warnings);
    depenetration_.warn(s, solids_, warnings);
  }
  /// Finds the particles that carry bodies. `begins`: at a substep's start, after detect.
  void find_loads(const Substep& s, const std::vector<BodyMotion>& motions, bool begins) {
    loads_.find(s, {impulses_.contacts(), impulses_.impulses(), solids_.body_of_solid()}, motions, begins);
  }
  /// After a phase of chains: gives the bodies the impulses of the particles that carry them.
  void end_chains(Substep& s, const std::vector<BodyMotion>& motions) {
    loads_.end_chains(s, motions, impulses_.impulses());
  }
  /// Applies restitution to velocities. `gravity` is what the velocities of an object lack of this frame's gravity
  /// [m/s].
  void respond(Substep& s, const std::vector<BodyMotion>& motions, FunctionRef<Vec3f(int object)> gravity) {
    impulses_.respond(s, solids_, motions, gravity);
  }

 private:
  BodySolids solids_;
  PointImpulses impulses_;
  PointLoads loads_;
  BodyPassing passing_;
  PointDepenetration depenetration_;
  std::vector<int> objects_, tasks_;           ///< objects with surfaces or particles, and their tiles, ascending
  SurfaceTiles surfaces_;                      ///< of tasks_
  std::vector<const std::vector<int>*> near_;  ///< [task of tasks_] solids that may be near
  std::vector<std::vector<Contact>> of_task_;
  std::vector<Contact> of_shapes_;
  ShapeContacts shapes_;
  SweptContacts swept_;
};

}  // namespace pliant

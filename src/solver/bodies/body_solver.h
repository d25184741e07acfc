// Contact of the rigid bodies of a substep group with one another and with colliders, as stages of a frame.
//
// Contacts are found once a frame, and again where bodies turn fast, and each substep solves them with one soft pass
// that corrects the predicted motion and one pass over velocities after the update, which takes back what the first
// added (manifold_passes.h). Bodies' motions are gathered from the State for a pass and scattered after it, so
// constraints, chains and other contact act on bodies as on any particle and frame.
#pragma once

#include <utility>
#include <vector>

#include "collision/narrow/contact.h"
#include "core/islands.h"
#include "model/model.h"
#include "solver/bodies/body_islands.h"
#include "solver/bodies/body_motions.h"
#include "solver/bodies/body_points.h"
#include "solver/bodies/body_sleep.h"
#include "solver/bodies/carriers.h"
#include "solver/bodies/contact_bodies.h"
#include "solver/bodies/depenetration.h"
#include "solver/bodies/frame_contacts.h"
#include "solver/bodies/manifold_blocks.h"
#include "solver/bodies/manifolds.h"
#include "solver/bodies/velocity_shares.h"
#include "solver/contact_log.h"
#include "solver/systems/system.h"

namespace pliant {

struct Substep;

/// Over fifteen members: the stages that a frame calls.
class BodySolver : public System {
 public:
  /// For the bodies of the given objects, or of all if it is null. Call begin_frame before anything else.
  BodySolver(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes);

  /// False if there are no bodies, so that no stage need be called.
  bool has_any() const { return bodies_.dynamic() > 0; }

  /// Finds the contacts of a frame. Kept ones come from the State.
  void begin_frame(Substep& s) override;
  /// Before the prediction of a substep: finds them again if bodies have turned or moved so far that its arms and
  /// normals are no longer true.
  void control(Substep& s) override;
  /// Finds the contacts of points and bodies in a substep.
  void collide(Substep& s) override;
  /// Starts a substep with the contact impulses of the last one, before joints and chains are solved, so that these
  /// balance them and gravity. Otherwise they would take up contact forces after friction, and bodies at rest would
  /// creep or hum. Moves only islands of jointed and touching bodies that have joints solved directly, or ties to
  /// chains, and none in which contacts turn such a body far. Returns the objects with bodies that were moved, by 1
  /// each [object]; empty if there are none.
  const std::vector<char>& press_joints(Substep& s);
  /// Corrects displacements and rotations of bodies, and of points that touch them. In the first iteration of a
  /// substep, starts from the impulses of the last one, unless press_joints has, and makes bodies bounce. Closes joints
  /// that are solved directly after that.
  void project(Substep& s, bool is_first) override;
  /// Projects the contacts of points of the objects for which `of` is not zero once more.
  void project_points(Substep& s, const std::vector<char>& of) { points_.project(s, motions_.present(), &of); }
  /// Keeps bodies and cloth from passing one another on the way that the iterations have given them.
  void stop_passing(Substep& s) override { points_.stop_passing(s, motions_.present()); }
  /// The same after the filter of surfaces, which may have truncated steps of cloth in front of a body.
  void end_filter(Substep& s) override;
  /// After that: bodies and surfaces have been moved on by at most so far [m].
  void note_shift(float farthest) { points_.note_shift(farthest); }
  /// Finds the particles that carry bodies, for the next solve of chains.
  void find_loads(const Substep& s) {
    if (points_.has_any()) points_.find_loads(s, motions_.present(), false);
  }
  /// What particles carry of bodies in the solve of chains.
  PointLoads& loads() { return points_.loads(); }
  /// After a phase of chains: gives the bodies the impulses of the particles that carry them.
  void end_chains(Substep& s) { points_.end_chains(s, motions_.present()); }
  /// The solids of bodies as points touch them, and the masses and inertias of the bodies by their orientations at the
  /// substep's start.
  const BodySolids& solids() const { return points_.solids(); }
  const std::vector<BodyMotion>& present_motions() const { return motions_.present(); }
  /// In the order of bodies in BodyIslands.
  const std::vector<TouchedBody>& touched_bodies() const { return points_.solids().bodies(); }
  /// The index among touched_bodies() of the body of a contact with points.
  int body_of(const Contact& contact) const { return points_.solids().number_of(contact); }
  /// Finds the islands of a substep after its solve.
  const BodyIslands& find_islands(const Substep& s);
  /// Share of the corrections that becomes velocity.
  VelocityShares& velocity_shares() { return shares_; }
  /// What is deep inside of a body in this substep.
  const std::vector<PointDepenetration::Inside>& points_inside() const { return points_.inside(); }
  const std::vector<Contact>& point_contacts() const { return points_.impulses().contacts(); }
  /// The pass over velocities. Logs the contacts of the substep if somebody asks for them.
  void respond(Substep& s, FunctionRef<Vec3f(int object)> gravity) override;
  void count_contacts(Report& report) const override;
  /// Of the frame, in ascending order of parts.
  const std::vector<BodyContact>& contacts() const { return contacts_.all(); }
  /// Gives the State the contacts, with the impulses of the last substep.
  void end_frame(Substep& s) override;
  void order(State& state) const override;

 private:
  /// Adds the impulses of the current substep, after respond, with those of impacts with restitution.
  void log_contacts(const Substep& s, ContactLog& log);
  void project_contacts(Substep& s, bool is_first);
  void respond_at_contacts(Substep& s, FunctionRef<Vec3f(int object)> gravity);
  void put_to_sleep(Substep& s);
  void take_impulses(const Substep& s);
  void follow_meshes(const Substep& s);
  void make_manifolds(const Substep& s);
  void find_bouncing(const Substep& s);
  void start_substep(const Substep& s);
  void find_tied(const Model& model);
  bool find_jointed(const Substep& s);
  void find_pressed(const Substep& s);
  void start_others(const Substep& s);
  void note_bounces(const Substep& s);
  bool is_pressed(int contact) const;

  ContactBodies bodies_;
  FrameContacts contacts_;
  BodyPoints points_;
  BodyMotions motions_;
  BodyIslands islands_;
  BodySleep sleep_;
  VelocityShares shares_;
  std::vector<std::pair<int, int>> pressing_;  ///< bodies of those that press, for find_islands
  ManifoldColours colours_;                    ///< of contacts_
  ManifoldBlocks blocks_;                      ///< the manifolds of contacts_ in a frame
  std::vector<float> bounced_;  ///< [contact] impulses of impacts with restitution in a substep, for events
  std::vector<int> followed_;   ///< [contact] motion of the mesh that deforms, or -1; empty if none does
  std::vector<char> is_fixed_;  ///< [motion] nonzero: fixed
  std::vector<int> overlaps_;   ///< [place] FrameContacts::count_overlaps
  Carriers carriers_;           ///< of contacts_
  PressedBy pressed_by_ = PressedBy::bodies;
  std::vector<char> is_separating_;    ///< [contact] nonzero: its bodies overlap more than what presses them explains
  std::vector<char> may_bounce_;       ///< [contact] nonzero: has restitution
  std::vector<char> may_restart_;      ///< [body] BodyMotions::bounce
  bool pushes_are_known_ = false;      ///< false in the first substep of a frame
  bool is_pressed_ = false;            ///< true from press_joints to project, if any body is
  float push_share_ = 0;               ///< of the last substep's pushes, with which this one starts
  int last_substep_ = -1;              ///< the last substep of the frame that was started
  Islands jointed_islands_;            ///< of bodies that are jointed or have contacts
  std::vector<char> is_tied_;          ///< [body] to a particle of chains; empty if none is
  std::vector<char> is_jointed_;       ///< [body] by a joint that is solved directly, or tied
  std::vector<char> pressed_bodies_;   ///< [body] started by press_joints
  std::vector<char> pressed_objects_;  ///< [object] with such bodies
  float last_h_ = 0;                   ///< length of the last substep [s]
};

}  // namespace pliant

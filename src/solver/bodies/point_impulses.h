// The contacts of points with bodies in a substep: each moves points and body by one impulse at the point of contact,
// with the generalised inverse masses of both sides. They are projected one after another, in the order in which they
// were found, because they share bodies: averages let a body fall through, sequences do not.
//
// The solids are the same in all calls.
#pragma once

#include <cstddef>
#include <vector>

#include "collision/narrow/contact.h"
#include "solver/bodies/body_solids.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/bodies/pinched_points.h"
#include "solver/bodies/velocity_shares.h"
#include "solver/contact_log.h"

namespace pliant {

struct Substep;

class PointImpulses {
 public:
  void begin_frame();
  /// All contacts of the substep; `collider` is a solid, points are indices in the State. Fill them before
  /// begin_substep.
  std::vector<Contact>& contacts() { return contacts_; }
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// Of contacts() along their normals [N s].
  std::vector<float>& impulses() { return impulses_; }
  /// Starts from contacts without impulses.
  void begin_substep(const Substep& s, const BodySolids& solids);
  /// Adds contacts that were found for the present displacements. Returns the number of the first.
  std::size_t append(const std::vector<Contact>& more);
  /// Takes the present motion of bodies as that for which contacts were found.
  void note_progress(const Substep& s, const BodySolids& solids);

  /// Projects each contact once, or those with points of the objects for which `of` is not zero. `motions` have the
  /// bodies' inverse masses and inertias, in the order of the bodies.
  void project(Substep& s, const BodySolids& solids, const std::vector<BodyMotion>& motions,
               const std::vector<char>* of);
  /// Projects those from number `first` on once. `yields`: the points move too; else only bodies that are not fixed.
  void project_from(Substep& s, const BodySolids& solids, std::size_t first, const std::vector<BodyMotion>& motions,
                    bool yields);
  /// Applies restitution to velocities, and keeps its impulses. `gravity` is what the velocities of an object lack of
  /// this frame's gravity [m/s].
  void respond(Substep& s, const BodySolids& solids, const std::vector<BodyMotion>& motions,
               FunctionRef<Vec3f(int object)> gravity);

  int contacts_that_press() const;
  /// Adds the pushes of the current substep, after respond. `shares` of the corrections have become velocity.
  void log_contacts(const Substep& s, const BodySolids& solids, const VelocityShares& shares, ContactLog& log) const;

 private:
  void begin_pass(const Substep& s, const BodySolids& solids);
  void end_pass(Substep& s, const BodySolids& solids);
  void project(Substep& s, const BodySolids& solids, const BodyMotion& motion, Contact& contact, bool yields);

  std::vector<Contact> contacts_;
  std::vector<float> impulses_;
  /// What respond gave beside them: the next substep's loads are not to take it for a weight.
  std::vector<float> bounced_;
  std::vector<BodyProgress> progress_;  ///< of bodies
  PinchedPoints pinched_;
  bool pinched_are_found_ = false;  ///< among contacts_
};

}  // namespace pliant

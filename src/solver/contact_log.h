// Sums contact impulses between bodies over a frame, for contact events.
#pragma once

#include <map>
#include <utility>

#include "math/vector.h"

namespace pliant {

/// The number of a primitive collider as a body: -1 - its index. Objects and mesh colliders have their index in the
/// Model.
inline constexpr int body_of_collider(int collider) { return -1 - collider; }

/// Sums over the contacts between two bodies in a frame.
struct ContactSum {
  int contacts = 0, in_substep = 0;  ///< number of active contacts: maximum over substeps, and in the current substep
  double impulse = 0;                ///< sum of the magnitudes of normal impulses [N s]
  Vec3d push{};                      ///< sum of normal impulses on the first body [N s]
  Vec3d moment{};                    ///< sum of position x normal impulse [N s m]
};

/// A rigid body of an object, by its index there; -1: a collider, or particles.
struct ContactSide {
  int thing = 0, body = -1;
  friend auto operator<=>(const ContactSide&, const ContactSide&) = default;  // NOLINT(modernize-use-nullptr)
};

/// Contact sums of a frame. Keys have the lower side first.
struct ContactLog {
  std::map<std::pair<int, int>, ContactSum> things;
  std::map<std::pair<ContactSide, ContactSide>, ContactSum> bodies;  ///< where one side is a rigid body at least

  void clear() {
    things.clear();
    bodies.clear();
  }
};

struct Substep;

/// The push of one contact.
struct ContactPush {
  int on = 0, by = 0;              ///< bodies on which the contact acts, and which exerts it
  double impulse = 0;              ///< normal impulse [N s]
  Vec3f normal{};                  ///< unit direction of the impulse on body `on`
  Vec3d at{};                      ///< contact point [m]
  int on_body = -1, by_body = -1;  ///< which of the rigid bodies of the objects; -1: none
};

/// Adds a push to the sums of the current substep.
void add_push(const ContactPush& push, ContactLog& log);
/// Adds the pressure of a liquid, which is no contact: the impulse on side `on` at the place `at`.
void add_pressure(const ContactSide& on, const ContactSide& by, const Vec3d& impulse, const Vec3d& at, ContactLog& log);
/// Ends the counting of a substep's contacts.
void finish_substep(ContactLog& log);

/// Adds a substep's active contacts in a fixed order: particles by tile, edges and triangles with colliders, surfaces.
void log_contacts(const Substep& s, ContactLog& log);

}  // namespace pliant

// How an object is held: which attachments hold it as pins would.
#pragma once

#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Lower bound of the acceleration that loads an object: under less gravity, other forces load it [m/s^2].
inline constexpr double least_acceleration = 9.81;

/// The largest side of the box around points [m]; 0 if there are none.
double largest_extent(const std::vector<Vec3f>& positions);

/// The mass of an object's particles without infinite ones [kg].
double finite_mass(const Object& object);

/// Compares the attachments of an object with pins. The object must outlive this.
class AttachmentTest {
 public:
  AttachmentTest(const Object& object, double gravity);

  /// True if the weight of the whole object would pull the attachment out by 0.2 % of the object's extent at most.
  bool is_firm(const Attachment& attachment) const;

  /// True if the attachment acts like a pin: it is firm, and its target is where its particle starts.
  bool is_like_pin(const Attachment& attachment) const;

  /// True if it also yields so little that nobody could measure it, and its target is near where its particle starts.
  /// Chains end at its target instead of at the particle.
  bool is_rigid(const Attachment& attachment) const;

 private:
  double yield_of(const Attachment& attachment) const;
  double gap_of(const Attachment& attachment) const;

  const Object& object_;
  double extent_, weight_;
};

/// For each particle of the user the target that a rigid attachment holds it at, else the particle itself; empty if
/// there is no such attachment. Of two attachments of a particle the later one counts, as it is the last to be
/// projected.
std::vector<int> held_by_targets(const Object& object, double gravity);

}  // namespace pliant

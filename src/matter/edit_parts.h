// What edits of surfaces and of solids share.
#pragma once

#include <span>
#include <vector>

#include "pliant/edit.h"

namespace pliant {

/// Throws an Error unless an object has a mass for each particle.
void require_masses(const Object& object);

/// The type of a group's constraints. Throws an Error if it is unknown.
const ConstraintType& type_of(const ConstraintGroup& group, const Object& object);

/// The number of slots of a group's constraints. Throws an Error if their type is unknown.
int slots_of(const ConstraintGroup& group, const Object& object);

/// The slots of constraint `number` of a group.
std::vector<int> stencil_of(const ConstraintGroup& group, int slots, int number);

/// The particles of a constraint; -1 in place of frames. Throws an Error if one does not exist.
std::vector<int> points_of(const ConstraintType& type, const std::vector<int>& stencil, const Object& object);

/// The slot of the particle that a constraint ties to a body, a triangle or a tetrahedron; -1 if it is no tie.
int tied_slot(const ConstraintType& type);
/// Appends a copy of a tie for each copy of the particle that is tied. Copies have numbers from `first` on, and are of
/// `origins`.
void append_for_copies(const ConstraintGroup& from, int number, std::vector<int> stencil, const ConstraintType& type,
                       const std::vector<int>& origins, int first, ConstraintGroup& to);

/// The constraints of a group that use a particle with 1 in `marks`, one for each particle: ascending numbers. Throws
/// an Error if one of the group uses a particle that does not exist.
std::vector<int> constraints_at(const ConstraintGroup& group, const std::vector<char>& marks, const Object& object);

/// The rest data of constraint `number` of a group: as given, or measured from the positions of the description. Its
/// slots are particles that exist.
std::vector<double> rest_of(const ConstraintGroup& group, int number, const Object& object);

/// The places of particles as a ConstraintDefinition takes them, relative to the first, so that rounding does not grow
/// with the distance from the origin.
std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3f> positions);
std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3d> positions);

/// A group without constraints, otherwise alike.
ConstraintGroup empty_like(const ConstraintGroup& group);

/// Appends a copy of constraint `number` of a group with the given stencil, and with its compliance times `softer`.
void append(const ConstraintGroup& from, int number, const std::vector<int>& stencil, double softer,
            ConstraintGroup& to);

/// Puts `followers` in the place of some constraints of a group, whose numbers ascend: of the i-th of these, those up
/// to `ends[i]`. Others stay, in their order.
void replace_constraints(ConstraintGroup& group, int slots, const std::vector<int>& numbers,
                         const ConstraintGroup& followers, const std::vector<int>& ends);

/// The same, where `follow(number, followers)` appends what becomes of a constraint.
template <class Follow>
void rewrite(ConstraintGroup& group, int slots, const std::vector<int>& numbers, Follow&& follow) {
  ConstraintGroup followers = empty_like(group);
  std::vector<int> ends;
  for (const int number : numbers) {
    follow(number, followers);
    ends.push_back(static_cast<int>(followers.particles.size()) / slots);
  }
  replace_constraints(group, slots, numbers, followers, ends);
}

/// Pins and attaches copies as the particles that they are of, and adds them to their clusters, at the same place in
/// their rest shapes. The copies have numbers from `first` on.
void hold_like(const std::vector<int>& origins, int first, Object& object);

/// An Edit after which all particles are where they were.
Edit edit_to(Object object);

}  // namespace pliant

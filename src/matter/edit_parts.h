// What edits of surfaces and of solids share.
#pragma once

#include <span>
#include <vector>

#include "pliant/scene.h"

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

/// The rest data of constraint `number` of a group: as given, or measured from the positions of the description. Its slots are particles that
/// exist.
std::vector<double> rest_of(const ConstraintGroup& group, int number, const Object& object);

/// The places of particles as a ConstraintDefinition takes them, relative to the first, so that rounding does not grow with the distance
/// from the origin.
std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3f> positions);

/// A group without constraints, otherwise alike.
ConstraintGroup empty_like(const ConstraintGroup& group);

/// Appends a copy of constraint `number` of a group with the given stencil, and with its compliance times `softer`.
void append(const ConstraintGroup& from, int number, const std::vector<int>& stencil, double softer, ConstraintGroup& to);

/// Pins and attaches a copy of particle `of` as that is, and adds it to its clusters, at the same place in their rest shapes.
void hold_like(int of, int copy, Object& object);

}  // namespace pliant

// Manifolds, on which the solver works within a frame, and the contacts of a State, which last.
#pragma once

#include "collision/bodies/manifold.h"
#include "pliant/state.h"

namespace pliant {

/// Coefficients of two bodies in contact, most of them [-].
struct BodyMaterial {
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
  float rolling_friction = 0, spinning_friction = 0;  ///< [m]
};

/// The manifold of a contact between bodies `a` and `b` in a frame that begins with substeps of length h [s].
Manifold manifold_of(const BodyContact& contact, int a, int b, const BodyMaterial& material, float h);

/// Keeps the impulses of substeps of length h [s] in the contact.
void keep_impulses(const Manifold& manifold, float h, BodyContact& contact);

/// Multiplies impulses, where the next substep is longer or shorter by that factor.
void scale_impulses(float factor, Manifold& manifold);

}  // namespace pliant

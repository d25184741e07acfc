// The blocks of joints whose bodies are eliminated (JointTree), written once: D is double for one tree, WideDouble for
// eight side by side.
#pragma once

#include "math/scalar.h"
#include "math/vector.h"

namespace pliant::joint_tree_formulas {

/// The gradient of a row for the displacement and the rotation of one body.
template <class D>
struct Gradient {
  Vec3<D> displacement, rotation;
};

/// What a body yields by.
template <class D>
struct InverseMass {
  D mass;        ///< of displacement [1/kg]
  D inertia[6];  ///< in world axes: xx, yy, zz, yz, zx, xy [1 / (kg m^2)]
};

/// A symmetric matrix times a vector.
template <class D>
PLIANT_HD Vec3<D> times(const D (&m)[6], const Vec3<D>& v) {
  return {m[0] * v.x + m[5] * v.y + m[4] * v.z, m[5] * v.x + m[1] * v.y + m[3] * v.z,
          m[4] * v.x + m[3] * v.y + m[2] * v.z};
}

template <class D>
PLIANT_HD D product(const Gradient<D>& a, const Gradient<D>& b) {
  return dot(a.displacement, b.displacement) + dot(a.rotation, b.rotation);
}

/// M^-1 times a gradient.
template <class D>
PLIANT_HD Gradient<D> accelerated(const Gradient<D>& g, const InverseMass<D>& of) {
  return {g.displacement * of.mass, times(of.inertia, g.rotation)};
}

/// Subtracts J M^-1 J^T of one body from the upper half of a joint's block, and sets M^-1 J^T.
template <class D>
PLIANT_HD void subtract_body(const Gradient<D>* g, const InverseMass<D>& of, int rows, D* m, int stride,
                             Gradient<D>* moved) {
  for (int r = 0; r < rows; ++r) {
    moved[r] = accelerated(g[r], of);
    for (int c = r; c < rows; ++c) m[r * stride + c] = m[r * stride + c] - product(moved[r], g[c]);
  }
}

/// Couples a joint with another one of the same body, given M^-1 J^T of the one and J of the other.
template <class D>
PLIANT_HD void couple(const Gradient<D>* moved, int rows, const Gradient<D>* other, int other_rows, D* to_parent,
                      int stride) {
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < other_rows; ++c) to_parent[r * stride + c] = -product(moved[r], other[c]);
}

/// The displacement and rotation that multipliers give a body: -M^-1 J^T lambda.
template <class D>
PLIANT_HD void move_body(const Gradient<D>* g, const D* multipliers, int rows, const InverseMass<D>& of,
                         Gradient<D>& move) {
  const D zero(0);
  Vec3<D> force{zero, zero, zero}, torque{zero, zero, zero};
  for (int r = 0; r < rows; ++r) {
    force = force + g[r].displacement * multipliers[r];
    torque = torque + g[r].rotation * multipliers[r];
  }
  move.displacement = move.displacement - force * of.mass;
  move.rotation = move.rotation - times(of.inertia, torque);
}

}  // namespace pliant::joint_tree_formulas

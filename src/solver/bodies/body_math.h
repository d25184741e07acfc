// Small functions that the contact of bodies shares.
#pragma once

#include <array>

#include "core/at.h"
#include "math/quat.h"
#include "math/record.h"
#include "pliant/state.h"
#include "solver/bodies/joint_formulas.h"

namespace pliant {

inline Record plus(const Record& r, const Vec3f& v) { return {r.x + v.x, r.y + v.y, r.z + v.z, r.w}; }

/// A symmetric matrix (xx, yy, zz, yz, zx, xy) times a vector.
inline Vec3f times(const std::array<float, 6>& m, const Vec3f& v) {
  return {m[0] * v.x + m[5] * v.y + m[4] * v.z, m[5] * v.x + m[1] * v.y + m[3] * v.z,
          m[4] * v.x + m[3] * v.y + m[2] * v.z};
}

/// Turns an orientation by a small rotation vector in world axes.
inline void rotate_by(const Vec3f& theta, Record& orientation) {
  const Quatf now = joint_formulas::turned(quaternion(orientation), theta);
  orientation = {now.x, now.y, now.z, now.w};
}

/// The rotation vector between two close orientations.
inline Vec3f turn_between(const Quatf& from, const Quatf& to) {
  const Quatf turn = multiply(to, conjugate(from));
  const float sign = turn.w < 0 ? -2.f : 2.f;
  return {sign * turn.x, sign * turn.y, sign * turn.z};
}

}  // namespace pliant

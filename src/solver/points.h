// The per-particle work of a substep as functors for launch (parallel/launch.h), in plain floats. The sequential
// kernels run them. Tests run them block by block and as device code, and compare the SIMD kernels with them.
#pragma once

#include "math/scalar.h"
#include "model/substep.h"

namespace pliant {

/// Gravity on a particle; zero for infinite mass.
PLIANT_HD Vec3f gravity_on(const Record& x, const Vec3f& gravity) {
  const bool free = x.w > 0;
  return {select(free, gravity.x, 0.f), select(free, gravity.y, 0.f), select(free, gravity.z, 0.f)};
}

/// Ends a substep: v = (v + (d - d predicted) / h) kept, x += d; the residue is the part of d that x cannot represent.
struct UpdatePoint {
  AdvanceArguments a;

  PLIANT_HD void operator()(int i) const {
    Record &x = a.positions[i], &d = a.displacements[i], &r = a.remainders[i], &v = a.velocities[i];
    const Vec3f finished = gravity_on(x, a.gravity_finished), settled = gravity_on(x, a.gravity_settled);
    component(x.x, d.x, r.x, v.x, finished.x, settled.x);
    component(x.y, d.y, r.y, v.y, finished.y, settled.y);
    component(x.z, d.z, r.z, v.z, finished.z, settled.z);
  }

 private:
  PLIANT_HD void component(float& x, float& d, float& r, float& v, float finished, float settled) const {
    const float predicted = r + (v + finished) * a.h;
    v = (v + (d - predicted) * a.inverse_h) * a.velocity_kept + settled;
    const float moved = x + d;
    r = d - (moved - x);
    x = moved;
  }
};

/// The displacement with which a particle starts a substep: residue + h (v + gravity).
PLIANT_HD Record predicted_displacement(const AdvanceArguments& a, int i) {
  const Record &r = a.remainders[i], &v = a.velocities[i];
  const Vec3f gravity = gravity_on(a.positions[i], a.gravity_begun);
  return {r.x + (v.x + gravity.x) * a.h, r.y + (v.y + gravity.y) * a.h, r.z + (v.z + gravity.z) * a.h, 0};
}

/// Starts a particle's substep.
struct PredictPoint {
  AdvanceArguments a;

  PLIANT_HD void operator()(int i) const { a.displacements[i] = predicted_displacement(a, i); }
};

/// True if x, y and z are finite: x - x is zero for finite x, otherwise NaN.
PLIANT_HD bool is_finite(const Record& p) { return (p.x - p.x) + (p.y - p.y) + (p.z - p.z) == 0; }

/// Sets the flag of a range of particles if any of them is not finite.
struct FindNonfinite {
  const Record* records;
  unsigned char* nonfinite;

  PLIANT_HD void operator()(int i) const { nonfinite[i] = is_finite(records[i]) ? 0 : 1; }
};

}  // namespace pliant

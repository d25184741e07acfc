// The functions of MotionKernels as loops over formulas (motion_formulas.h), for R in so many lanes. Include it where
// the records of R can be loaded.
#pragma once

#include "solver/motion_formulas.h"

namespace pliant::motion_formulas {

/// `Unit` is a type of an unnamed namespace, so that the linker never mixes the code of two levels; void for the
/// sequential reference.
template <class R, int lanes, class Unit>
struct Loops {
  using At = Lanes<R, lanes>;
  using BodyAt = BodyLanes<R, lanes>;

  static void predict(const FrameArrays& a, int first, int last, float h) {
    for (int i = first; i < last; i += lanes) predict_frames(a, At::from(i, last), h);
  }
  static bool update(const FrameArrays& a, int first, int last, float h, float share) {
    R sum(0.f);
    for (int i = first; i < last; i += lanes) sum += update_frames(a, At::from(i, last), h, share);
    return all_zero(sum);
  }
  static void gather_inertia(const BodyArrays& a, int first, int last) {
    for (int i = first; i < last; i += lanes) load_inertia(a, BodyAt(a, i, last));
  }
  static void gather_predicted(const BodyArrays& a, int first, int last, float h, bool is_first, float share) {
    for (int i = first; i < last; i += lanes) load_predicted(a, BodyAt(a, i, last), h, is_first, share);
  }
  static void scatter_predicted(const BodyArrays& a, int first, int last, float h) {
    for (int i = first; i < last; i += lanes) store_predicted(a, BodyAt(a, i, last), h);
  }
  static void gather_velocities(const BodyArrays& a, int first, int last, const Vec3f& gravity) {
    for (int i = first; i < last; i += lanes) load_velocities(a, BodyAt(a, i, last), gravity);
  }
  static void scatter_velocities(const BodyArrays& a, int first, int last) {
    for (int i = first; i < last; i += lanes) store_velocities(a, BodyAt(a, i, last));
  }

  static constexpr MotionKernels table{
      &predict,           &update, &gather_inertia, &gather_predicted, &scatter_predicted, &gather_velocities,
      &scatter_velocities};
};

}  // namespace pliant::motion_formulas

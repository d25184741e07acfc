#include "solver/rotation.h"

#include <atomic>

#include "math/motion.h"
#include "parallel/ranges.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/motion_kernels.h"

namespace pliant {

namespace {

constexpr int frames_a_task = 256;

/// Calls body(first, last) for ranges of the frames [first, last) on all threads.
void for_range(Substep& s, const char* name, int first, int last, FunctionRef<void(int, int)> body) {
  for_ranges(s.context.executor, name, last - first, frames_a_task,
             [&](int from, int to) { body(first + from, first + to); });
}

/// The same for the frames of all objects that take part.
void for_frames(Substep& s, const char* name, FunctionRef<void(int, int)> body) {
  if (s.part == nullptr) return for_range(s, name, 0, s.model.frames(), body);
  for_objects(s, [&](int o) {
    if (s.model.objects[o].frames.size() > 0)
      for_range(s, name, s.model.first_frame[o], s.model.end_of_frames(o), body);
  });
}

/// Turns a frame to `after` at the end of a substep, by the shorter way.
void drive_frame(const FrameArrays& a, int frame, Quatf after, float h) {
  const Quatf before = quaternion(a.starts[frame]);
  if (before.x * after.x + before.y * after.y + before.z * after.z + before.w * after.w < 0)
    after = {-after.x, -after.y, -after.z, -after.w};
  const Vec3f turn = turn_between(before, after), spin = rotate(conjugate(after), turn) * (1 / h);
  a.orientations[frame] = {after.x, after.y, after.z, after.w};
  a.angular_velocities[frame] = {spin.x, spin.y, spin.z, 0};
  a.predicted[frame] = {turn.x, turn.y, turn.z, 0};
}

/// Turns bodies that follow their pins, or poses of the user, to where they are at the substep's end.
void drive_frames(const Substep& s, const FrameArrays& arrays) {
  const double share = static_cast<double>(s.number + 1) / s.planned;
  for_objects(s, [&](int o) {
    for (const DrivenFrame& driven : s.model.objects[o].bodies.driven) {
      const Quatd after = multiply(pose_at(driven.motion, s.time_after).rotation, driven.rest);
      drive_frame(arrays, s.model.first_frame[o] + driven.frame, convert<float>(normalise(after)), s.h);
    }
    const ObjectControl* const control = s.work.control.object(o);
    if (control == nullptr) return;
    for (const TurnTarget& turn : control->turns) {
      const Quatd after = s.is_last() ? turn.to : slerp(turn.from, turn.to, share);
      drive_frame(arrays, s.model.first_frame[o] + turn.frame, convert<float>(normalise(after)), s.h);
    }
  });
}

}  // namespace

FrameArrays frame_arrays(const Substep& s) {
  return {s.state.frames.orientations.data(),
          s.state.frames.angular_velocities.data(),
          s.state.frames.inverse_inertias.data(),
          s.work.frames.starts.data(),
          s.work.frames.predicted.data(),
          s.work.frames.corrections.data(),
          s.work.frames.round.data()};
}

void predict_frames(Substep& s) {
  if (s.model.frames() == 0) return;
  const FrameArrays arrays = frame_arrays(s);
  for_frames(s, "predict: frames",
             [&](int first, int last) { s.kernels.motions.predict_frames(arrays, first, last, s.h); });
  drive_frames(s, arrays);
}

void update_frames(Substep& s) {
  if (s.model.frames() == 0) return;
  const FrameArrays arrays = frame_arrays(s);
  std::atomic<bool> are_finite{true};
  for_objects(s, [&](int o) {
    const float kept = velocity_kept(s.h, s.model.objects[o].damping);
    const int first_of_object = s.model.first_frame[o], end = s.model.end_of_frames(o);
    for (int i = first_of_object; i < end; ++i) s.work.frames.corrections[i].w = kept;
    for (const DrivenFrame& driven : s.model.objects[o].bodies.driven)
      s.work.frames.corrections[first_of_object + driven.frame].w = 1;
    if (const ObjectControl* const control = s.work.control.object(o))
      for (const TurnTarget& turn : control->turns) s.work.frames.corrections[first_of_object + turn.frame].w = 1;
    // Corrections stay whole, because contacts and angular momentum follow what the frame has turned.
    const auto update = [&](int from, int to, float share) {
      for_range(s, "update: frames", first_of_object + from, first_of_object + to, [&](int first, int last) {
        if (!s.kernels.motions.update_frames(arrays, first, last, s.h, s.velocity_share * share))
          are_finite.store(false, std::memory_order_relaxed);
      });
    };
    if (s.bodies == nullptr) return update(0, end - first_of_object, 1);
    s.bodies->velocity_shares().for_frames(o, 0, end - first_of_object, update);
  });
  s.frames_are_finite = are_finite.load();
}

}  // namespace pliant

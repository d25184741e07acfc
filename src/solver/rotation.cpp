#include "solver/rotation.h"

#include <algorithm>

#include "math/quat.h"

namespace pliant {

namespace {

constexpr int frames_a_task = 256;

Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }
Record record(const Vec3f& v) { return {v.x, v.y, v.z, 0}; }

/// I^-1 ((I m) x m) for I in principal axes: Euler's equations without torque [1/s^2]. Zero if rotation about an axis
/// is locked.
Vec3f gyroscopic_rate(const Vec3f& inverse, const Vec3f& m) {
  if (!(inverse.x > 0 && inverse.y > 0 && inverse.z > 0)) return {};
  const Vec3f inertia{1 / inverse.x, 1 / inverse.y, 1 / inverse.z};
  return {inverse.x * ((inertia.y - inertia.z) * m.y * m.z), inverse.y * ((inertia.z - inertia.x) * m.z * m.x),
          inverse.z * ((inertia.x - inertia.y) * m.x * m.y)};
}

void predict(float h, const Vec3f& inverse, Record& orientation, Record& velocity, Record& predicted) {
  const Vec3f w = xyz(velocity);
  Vec3f change{};
  for (int round = 0; round < 2; ++round) change = gyroscopic_rate(inverse, w + 0.5f * change) * h;
  const Vec3f angle = (w + 0.5f * change) * h;
  // Taylor series of the quaternion exponential. The next terms are below a float's precision up to half a radian per
  // substep.
  const float t = length_squared(angle) * 0.25f, imaginary = 0.5f * (1 - t * (1 / 6.f));
  const Quatf step{angle.x * imaginary, angle.y * imaginary, angle.z * imaginary, 1 - t * 0.5f + t * t * (1 / 24.f)};
  const Quatf q{orientation.x, orientation.y, orientation.z, orientation.w};
  predicted = record(rotate(q, angle));
  const Quatf now = normalise(multiply(q, step));
  orientation = {now.x, now.y, now.z, now.w};
  velocity = record(w + change);
}

void for_range(Substep& s, const char* name, int first, int last, FunctionRef<void(int)> body) {
  const int tasks = (last - first + frames_a_task - 1) / frames_a_task;
  for_tasks(s, name, tasks, [&](int task) {
    const int from = first + task * frames_a_task;
    for (int i = from; i < std::min(last, from + frames_a_task); ++i) body(i);
  });
}

void for_frames(Substep& s, const char* name, FunctionRef<void(int)> body) {
  if (s.part == nullptr) return for_range(s, name, 0, s.model.frames(), body);
  for_objects(s, [&](int o) {
    if (s.model.objects[o].frames.size() > 0) for_range(s, name, s.model.first_frame[o], s.model.end_of_frames(o), body);
  });
}

}  // namespace

void predict_frames(Substep& s) {
  if (s.model.frames() == 0) return;
  FrameRecords& frames = s.state.frames;
  for_frames(s, "predict: frames", [&](int i) {
    s.work.frames.starts[i] = frames.orientations[i];
    predict(s.h, xyz(frames.inverse_inertias[i]), frames.orientations[i], frames.angular_velocities[i],
            s.work.frames.predicted[i]);
    s.work.frames.corrections[i] = {};
  });
}

void update_frames(Substep& s) {
  if (s.model.frames() == 0) return;
  FrameRecords& frames = s.state.frames;
  Records& corrections = s.work.frames.corrections;
  for_objects(s, [&](int o) {  // w is the factor by which damping reduces the velocity
    for (int i = s.model.first_frame[o]; i < s.model.end_of_frames(o); ++i)
      corrections[i].w = 1 / (1 + s.h * s.model.objects[o].damping);
  });
  const float inverse_h = s.velocity_share / s.h;
  for_frames(s, "update: frames", [&](int i) {
    const Record& q = frames.orientations[i];
    const Vec3f local = rotate(conjugate(Quatf{q.x, q.y, q.z, q.w}), xyz(corrections[i]));
    frames.angular_velocities[i] = record((xyz(frames.angular_velocities[i]) + local * inverse_h) * corrections[i].w);
  });
  const auto is_finite = [](const Record& r) { return (r.x - r.x) + (r.y - r.y) + (r.z - r.z) + (r.w - r.w) == 0; };
  s.frames_are_finite = true;
  for_objects(s, [&](int o) {
    for (int i = s.model.first_frame[o]; i < s.model.end_of_frames(o); ++i)
      if (!is_finite(frames.orientations[i]) || !is_finite(frames.angular_velocities[i])) s.frames_are_finite = false;
  });
}

}  // namespace pliant

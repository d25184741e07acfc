// Finds and interpolates keyframes, and converts the public rotations. It is no header, because no device needs it: the
// few poses of a substep are computed on the host.
#include "math/motion.h"

#include <algorithm>
#include <vector>

#include "pliant/error.h"

namespace pliant {
namespace {

/// Maps `time` into the keyframes' range if the motion repeats.
double time_in_cycle(double first, double last, bool repeat, double time) {
  const double period = last - first;
  if (!repeat || !(period > 0) || !(time > last)) return time;
  return time - period * __builtin_floor((time - first) / period);
}

Quatd rotation_of(const Keyframe& key) { return normalise(convert<double>(key.rotation)); }

/// The interpolated pose of the keyframes before and after `time`, without the pivot.
Posed interpolated(const std::vector<Keyframe>& keys, double time) {
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Keyframe& key) { return t < key.time; });
  if (after == keys.begin()) return {convert<double>(keys.front().position), rotation_of(keys.front())};
  const Keyframe& before = *(after - 1);
  if (after == keys.end()) return {convert<double>(before.position), rotation_of(before)};
  const double from = before.time, share = (time - from) / (after->time - from);  // from <= time < after->time
  const Vec3d start = convert<double>(before.position), end = convert<double>(after->position);
  return {start + (end - start) * share, slerp(rotation_of(before), rotation_of(*after), share)};
}

}  // namespace

Posed pose_at(const Motion& motion, double time) {
  if (motion.keyframes.empty()) return {};
  const double first = motion.keyframes.front().time, last = motion.keyframes.back().time;
  Posed pose = interpolated(motion.keyframes, time_in_cycle(first, last, motion.repeat, time));
  const Vec3d pivot = convert<double>(motion.pivot);
  pose.position += pivot - rotate(pose.rotation, pivot);
  return pose;
}

TimePlace place_in(const std::vector<float>& times, bool repeat, double time) {
  const double at = time_in_cycle(times.front(), times.back(), repeat, time);
  const auto after =
      std::upper_bound(times.begin(), times.end(), at, [](double t, float one) { return t < double(one); });
  const auto number = static_cast<std::size_t>(after - times.begin());
  if (number == 0) return {};
  if (number == times.size()) return {number - 1, number - 1, 0};
  const double from = times[number - 1], to = times[number];  // from <= at < to
  return {number - 1, number, (at - from) / (to - from)};
}

Quatf rotation(const Vec3f& axis, float degrees) {
  const Vec3d direction = convert<double>(axis);
  const double size = length(direction);
  if (!(size > 0 && size < 1e300))
    throw Error({}, "the axis of a rotation has length 0 or is not finite", "give a finite axis with a length above 0");
  if (!(abs(degrees) < 1e30f))
    throw Error({}, "the angle of a rotation is not finite, or beyond 1e30 degrees", "give a finite number of degrees");
  const SineCosine half = sine_cosine_of_degrees(0.5 * static_cast<double>(degrees));
  const Vec3d imaginary = direction * (half.sine / size);
  return convert<float>(Quatd{imaginary.x, imaginary.y, imaginary.z, half.cosine});
}

}  // namespace pliant

// The list of findings, and checks that objects and colliders share.
#include "inspect/problems.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "math/vector.h"
#include "pliant/error.h"

namespace pliant {

std::string Tally::name(const std::string& kind) const {
  return kind + " " + std::to_string(first) + (count > 1 ? " and " + std::to_string(count - 1) + " more" : "");
}

void Problems::put(bool grave, const std::string& element, const std::string& problem, const std::string& advice) {
  findings_.push_back({grave, Error({"", 0, object_, element}, problem).what(), advice});
}

void Problems::grave(const std::string& element, const std::string& problem, const std::string& advice) {
  if (mode_ == Mode::throw_grave) throw Error({"", 0, object_, element}, problem, advice);
  ++grave_count_;
  put(true, element, problem, advice);
}

void Problems::grave(const Tally& tally, const std::string& kind, const std::string& problem,
                     const std::string& advice) {
  if (tally.count > 0) grave(tally.name(kind), problem, advice);
}

void Problems::doubtful(const std::string& element, const std::string& problem, const std::string& advice) {
  if (wants_doubts()) put(false, element, problem, advice);
}

void Problems::doubtful(const Tally& tally, const std::string& kind, const std::string& problem,
                        const std::string& advice) {
  if (tally.count > 0) doubtful(tally.name(kind), problem, advice);
}

std::vector<Finding> Problems::take() {
  std::stable_partition(findings_.begin(), findings_.end(), [](const Finding& finding) { return finding.grave; });
  return std::move(findings_);
}

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

bool is_place(const Vec3f& v) {
  return std::fabs(v.x) <= largest_place && std::fabs(v.y) <= largest_place && std::fabs(v.z) <= largest_place;
}

void require_range(Problems& problems, const std::string& element, double value, double low, double high) {
  if (value >= low && value <= high) return;
  const std::string limits = std::isinf(high) ? words(low) + " or more" : words(low) + " to " + words(high);
  problems.grave(element, "is " + words(value), "give " + limits);
}

void require_place(Problems& problems, const std::string& element, const Vec3f& place) {
  if (is_place(place)) return;
  problems.grave(element, is_finite(place) ? "is more than " + words(largest_place) + " away" : "is not finite",
                 "give finite numbers in SI units");
}

void check_stiffness(Problems& problems, const std::string& element, const Stiffness& stiffness) {
  if (stiffness.kind == Stiffness::Kind::compliance) {
    require_range(problems, element + ", compliance", stiffness.value, 0, largest_quantity);
    require_range(problems, element + ", damping", stiffness.damping, 0, largest_quantity);
    return;
  }
  require_range(problems, element + ", stiffness k", stiffness.value, 0, 1);
  if (!(stiffness.damping == 0))
    problems.grave(element + ", damping", "cannot be combined with a PBD stiffness",
                   "give a compliance instead (compliance_from_stiffness converts)");
}

void check_rotation(Problems& problems, const std::string& element, const Quatf& q) {
  const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(std::fabs(squared - 1) < 1e-3f))
    problems.grave(element, "is not a unit quaternion: the sum of its squares is " + words(squared),
                   "divide it by its length, or make it with rotation(axis, degrees)");
}

void check_motion(Problems& problems, const std::string& element, const Motion& motion) {
  require_place(problems, element + ", pivot", motion.pivot);
  for (std::size_t k = 0; k < motion.keyframes.size(); ++k) {
    const Keyframe& keyframe = motion.keyframes[k];
    const std::string name = element + ", keyframe " + std::to_string(k);
    require_range(problems, name + ", time", keyframe.time, -largest_place, largest_place);
    require_place(problems, name + ", position", keyframe.position);
    check_rotation(problems, name + ", rotation", keyframe.rotation);
    if (k > 0 && !(keyframe.time > motion.keyframes[k - 1].time))
      problems.grave(name, "is at " + words(keyframe.time) + " s, but times must increase", "sort keyframes by time");
  }
  if (motion.repeat && motion.keyframes.size() < 2)
    problems.doubtful(element, "repeats " + std::to_string(motion.keyframes.size()) + " keyframes", "give two or more");
}

void check_rolling(Problems& problems, float rolling_friction, float spinning_friction) {
  require_range(problems, "rolling_friction", rolling_friction, 0, largest_place);
  require_range(problems, "spinning_friction", spinning_friction, 0, largest_place);
}

void check_surface_velocity(Problems& problems, const std::string& element, const Vec3f& velocity) {
  constexpr double fastest = 1e6;  // [m/s]
  require_range(problems, element, std::sqrt(static_cast<double>(length_squared(velocity))), 0, fastest);
}

void check_friction(Problems& problems, float static_friction, float kinetic_friction, float restitution) {
  require_range(problems, "static_friction", static_friction, 0, largest_place);
  require_range(problems, "kinetic_friction", kinetic_friction, 0, largest_place);
  require_range(problems, "restitution", restitution, 0, 1);
  if (kinetic_friction > static_friction)
    problems.grave("kinetic_friction",
                   "is " + words(kinetic_friction) + ", more than the static " + words(static_friction),
                   "lower it to the static friction or less");
}

bool is_sound(const Plasticity& plasticity) {
  const auto is_number = [](float value) { return value >= 0 && value <= 1e30f; };
  return is_number(plasticity.yield) && is_number(plasticity.rate) && is_number(plasticity.most);
}

}  // namespace pliant

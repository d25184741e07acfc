#include "model/attachments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "math/vector.h"

namespace pliant {

namespace {

/// Bounds of the yield under the object's weight, and of the distance from particle to target at the start, as shares
/// of the object's extent. Targets that are 0.6 % of a sheet farther apart than it is wide made tethers gain energy.
/// Chains that start at targets 3 % away do less harm than chains that pull their particles off the targets, 10 % away
/// more.
constexpr double most_yield_of_pin = 0.002, most_gap_of_pin = 0.001;
constexpr double most_yield_of_rigid = 1e-5, most_gap_of_rigid = 0.03;

}  // namespace

double largest_extent(const std::vector<Vec3f>& positions) {
  double extent = 0;
  if (positions.empty()) return extent;
  for (const auto coordinate : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
    const auto [low, high] =
        std::minmax_element(positions.begin(), positions.end(),
                            [&](const Vec3f& a, const Vec3f& b) { return a.*coordinate < b.*coordinate; });
    extent = std::max(extent, static_cast<double>((*high).*coordinate) - static_cast<double>((*low).*coordinate));
  }
  return extent;
}

double finite_mass(const Object& object) {
  double mass = 0;
  for (const float m : object.masses) mass += std::isfinite(m) ? static_cast<double>(m) : 0;
  return mass;
}

AttachmentTest::AttachmentTest(const Object& object, double gravity)
    : object_(object),
      extent_(largest_extent(object.positions)),
      weight_(finite_mass(object) * std::max(gravity, least_acceleration)) {}

double AttachmentTest::yield_of(const Attachment& attachment) const {
  const Stiffness& stiffness = attachment.stiffness;
  if (stiffness.kind == Stiffness::Kind::compliance) return static_cast<double>(stiffness.value) * weight_;
  return stiffness.value >= 1 ? 0 : std::numeric_limits<double>::infinity();
}

double AttachmentTest::gap_of(const Attachment& attachment) const {
  const auto p = static_cast<std::size_t>(attachment.particle);
  if (p >= object_.positions.size()) return std::numeric_limits<double>::infinity();  // the scene is not validated yet
  return length(convert<double>(attachment.target) - convert<double>(object_.positions[p]));
}

bool AttachmentTest::is_firm(const Attachment& attachment) const {
  return yield_of(attachment) <= most_yield_of_pin * extent_;
}

bool AttachmentTest::is_like_pin(const Attachment& attachment) const {
  return is_firm(attachment) && gap_of(attachment) <= most_gap_of_pin * extent_;
}

bool AttachmentTest::is_rigid(const Attachment& attachment) const {
  return yield_of(attachment) <= most_yield_of_rigid * extent_ && gap_of(attachment) <= most_gap_of_rigid * extent_;
}

std::vector<int> held_by_targets(const Object& object, double gravity) {
  if (object.attachments.empty()) return {};
  const AttachmentTest test(object, gravity);
  std::vector<int> held(object.positions.size());
  std::iota(held.begin(), held.end(), 0);
  bool any = false;
  for (std::size_t i = 0; i < object.attachments.size(); ++i) {
    const Attachment& attachment = object.attachments[i];
    const auto p = static_cast<std::size_t>(attachment.particle);
    if (p >= object.masses.size() || !std::isfinite(object.masses[p])) continue;
    const bool is_rigid = test.is_rigid(attachment);  // the last one of a particle counts, as it is projected last
    held[p] = static_cast<int>(is_rigid ? object.positions.size() + i : p);
    any = any || is_rigid;
  }
  for (const Pin& pin : object.pins) held[static_cast<std::size_t>(pin.particle)] = pin.particle;  // stays at its pin
  return any ? held : std::vector<int>{};
}

}  // namespace pliant

#include "solver/bodies/carriers.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"

namespace pliant {

namespace {

/// The series of small angles below hold up to this [rad].
constexpr float largest_turn = 0.5f;

Vec3f across_normal(const Vec3f& v, const Vec3f& normal) { return v - normal * dot(v, normal); }

/// True if a body turns by itself about the normal of a contact, so that a rider would leave its circle along the chord
/// of a frame.
bool carries(const BodyState& body, const Vec3f& normal, const Vec3f& arm, double left) {
  constexpr float least_departure = 1e-8f;  // from the circle [m]
  const float turn = dot(body.spin, normal) * static_cast<float>(left);
  return body.is_driven_round && turn * turn * length(across_normal(arm, normal)) > least_departure;
}

/// By how much an arm across a normal changes when it turns about that.
Vec3f change_by_turn(const Vec3f& normal, const Vec3f& arm, float angle) {
  const float t = std::clamp(angle, -largest_turn, largest_turn);
  return cross(normal, arm) * (t - t * t * t * (1 / 6.f)) - arm * (t * t * 0.5f);
}

}  // namespace

void turn_arm(const BodyState& body, const BodyState& other, const Vec3f& outward, double left, Vec3f& arm) {
  if (!body.is_driven_round || !(dot(outward, arm) < 0)) return;
  const Vec3f across = across_normal(body.spin, outward), along_itself = cross(across, arm);
  const float squared = length_squared(along_itself);
  const float share =
      squared > 0 ? std::clamp(dot(other.velocity - body.velocity, along_itself) / squared, 0.f, 1.f) : 0;
  const Vec3f turn = across * (share * static_cast<float>(left / 2));
  const Vec3f half = turn * std::fmin(1.f, largest_turn / std::fmax(length(turn), largest_turn)),
              along = cross(half, arm);
  arm += along + cross(half, along) * 0.5f;
}

void Carriers::note(int contact, const BodyState& a, const BodyState& b, const Manifold& m, double left) {
  carrier_[at(contact)] = carries(a, m.normal, m.arm_a, left) ? 1 : carries(b, m.normal, m.arm_b, left) ? 2 : 0;
}

void Carriers::list(const ManifoldColours& colours, const std::vector<std::pair<int, int>>& bodies,
                    const std::vector<BodyContact>& contacts) {
  rides_.clear();
  rides_.reserve(carrier_.size() - at(std::count(carrier_.begin(), carrier_.end(), 0)));
  for (int number = 0; number < static_cast<int>(colours.order().size()); ++number) {
    const int i = colours.order()[at(number)];
    if (carrier_[at(i)] == 0) continue;
    const auto& [a, b] = bodies[at(i)];
    const BodyContact& c = contacts[at(i)];
    const bool carries_b = carrier_[at(i)] == 1;
    rides_.push_back({number, carries_b ? a : b, carries_b ? b : a, carries_b, c.normal, carries_b ? c.arm_a : c.arm_b,
                      carries_b ? c.arm_b : c.arm_a});
  }
}

void Carriers::move_contacts(std::span<const BodyMotion> motions, float h, ManifoldBlocks& blocks) const {
  const float half = h / 2;
  for (const Ride& ride : rides_) {
    const BodyMotion &carrier = motions[at(ride.carrier)], &rider = motions[at(ride.rider)];
    const float angle = dot(rider.rotation + rider.spin * half, ride.normal);
    const Vec3f by_turn = change_by_turn(ride.normal, across_normal(ride.rider_arm, ride.normal), angle);
    const Vec3f way =
        (rider.displacement - carrier.displacement) + (rider.velocity - carrier.velocity) * half + by_turn;
    const Vec3f on_carrier = ride.carrier_arm + across_normal(way, ride.normal), on_rider = ride.rider_arm + by_turn;
    blocks.set_arms(ride.number, ride.carries_b ? on_carrier : on_rider, ride.carries_b ? on_rider : on_carrier);
  }
}

}  // namespace pliant

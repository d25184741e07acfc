#include "collision/bodies/body_paths.h"

#include <algorithm>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// The velocity of a body where another one is, if that moves with it. Only what turns by itself turns like that
/// for a whole frame [m/s].
Vec3d velocity_at(const BodyState& body, const BodyState& other) {
  const Vec3d velocity = convert<double>(body.velocity);
  if (!body.is_driven_round) return velocity;
  return velocity + cross(convert<double>(body.spin), other.pose.position - body.pose.position);
}

/// The displacement of b against a in a frame, in the world [m].
Vec3d displacement(const BodyState& a, const BodyState& b, double dt) {
  return (velocity_at(b, a) - velocity_at(a, b)) * dt;
}

}  // namespace

bool BodyPaths::is_held(int body) const {
  const BodyState& state = (*bodies_)[at(body)];
  return state.is_fixed || !state.yields;
}

bool BodyPaths::turns(int body, int pair) const { return turns_[at(body)].pair >= 0 && turns_[at(body)].pair != pair; }

/// `normal` points to the body.
void BodyPaths::note(int body, int other, const FirstTouch& touch, const Vec3d& normal) {
  Turn& turn = turns_[at(body)];
  if (is_held(body) || !(touch.time < turn.time)) return;
  const double closing = std::min(dot(normal, displacement((*bodies_)[at(other)], (*bodies_)[at(body)], dt_)), 0.);
  const double share = is_held(other) ? 1 : 0.5;  // masses are not known here
  turn = {touch.pair, touch.time, normal * (-share * closing)};
}

void BodyPaths::begin(const std::vector<BodyState>& bodies, float dt, const std::vector<FirstTouch>& touches) {
  bodies_ = &bodies;
  dt_ = static_cast<double>(dt);
  turns_.assign(bodies.size(), {});
  for (const FirstTouch& touch : touches) {
    note(touch.a, touch.b, touch, -touch.normal);
    note(touch.b, touch.a, touch, touch.normal);
  }
}

double BodyPaths::first_turn(int a, int b, int pair) const {
  return std::min(turns(a, pair) ? turns_[at(a)].time : 2, turns(b, pair) ? turns_[at(b)].time : 2);
}

ContactPath BodyPaths::straight(const BodyState& a, const BodyState& b, float dt, const Quatd& axes) {
  return ContactPath(rotate(conjugate(axes), displacement(a, b, static_cast<double>(dt))));
}

ContactPath BodyPaths::between(int a, int b, int pair, const Quatd& axes) const {
  ContactPath path(rotate(conjugate(axes), displacement((*bodies_)[at(a)], (*bodies_)[at(b)], dt_)));
  const Turn &of_a = turns_[at(a)], &of_b = turns_[at(b)];
  if (turns(b, pair)) path.turn(of_b.time, rotate(conjugate(axes), of_b.change));
  if (turns(a, pair)) path.turn(of_a.time, rotate(conjugate(axes), -of_a.change));
  return path;
}

}  // namespace pliant

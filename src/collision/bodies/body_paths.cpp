#include "collision/bodies/body_paths.h"

#include <algorithm>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

Vec3d BodyPaths::displacement(int body) const { return convert<double>((*bodies_)[at(body)].velocity) * dt_; }

bool BodyPaths::is_held(int body) const {
  const BodyState& state = (*bodies_)[at(body)];
  return state.is_fixed || !state.yields;
}

bool BodyPaths::turns(int body, int pair) const { return turns_[at(body)].pair >= 0 && turns_[at(body)].pair != pair; }

/// `normal` points to the body.
void BodyPaths::note(int body, int other, const FirstTouch& touch, const Vec3d& normal) {
  Turn& turn = turns_[at(body)];
  if (is_held(body) || !(touch.time < turn.time)) return;
  const double closing = std::min(dot(normal, displacement(body) - displacement(other)), 0.);
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
  return ContactPath(rotate(conjugate(axes), convert<double>(b.velocity - a.velocity) * static_cast<double>(dt)));
}

ContactPath BodyPaths::between(int a, int b, int pair, const Quatd& axes) const {
  ContactPath path(rotate(conjugate(axes), displacement(b) - displacement(a)));
  const Turn &of_a = turns_[at(a)], &of_b = turns_[at(b)];
  if (turns(b, pair)) path.turn(of_b.time, rotate(conjugate(axes), of_b.change));
  if (turns(a, pair)) path.turn(of_a.time, rotate(conjugate(axes), -of_a.change));
  return path;
}

}  // namespace pliant

#include "collision/bodies/body_paths.h"

#include <algorithm>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

Vec3d BodyPaths::displacement(int body) const { return convert<double>((*bodies_)[at(body)].velocity) * dt_; }

/// `normal` points to the body.
void BodyPaths::note(int body, int other, double time, const Vec3d& normal) {
  Turn& turn = turns_[at(body)];
  if ((*bodies_)[at(body)].is_fixed || !(time < turn.time)) return;
  const double closing = std::min(dot(normal, displacement(body) - displacement(other)), 0.);
  const double share = (*bodies_)[at(other)].is_fixed ? 1 : 0.5;  // masses are not known here
  turn = {other, time, normal * (-share * closing)};
}

void BodyPaths::begin(const std::vector<BodyState>& bodies, float dt, const std::vector<FirstTouch>& touches) {
  bodies_ = &bodies;
  dt_ = static_cast<double>(dt);
  turns_.assign(bodies.size(), {});
  for (const FirstTouch& touch : touches) {
    note(touch.a, touch.b, touch.time, -touch.normal);
    note(touch.b, touch.a, touch.time, touch.normal);
  }
}

double BodyPaths::first_turn(int a, int b) const {
  const auto by_third = [&](int body, int other) {
    const Turn& turn = turns_[at(body)];
    return turn.other >= 0 && turn.other != other ? turn.time : 2.;
  };
  return std::min(by_third(a, b), by_third(b, a));
}

ContactPath BodyPaths::straight(const BodyState& a, const BodyState& b, float dt, const Quatd& axes) {
  return ContactPath(rotate(conjugate(axes), convert<double>(b.velocity - a.velocity) * static_cast<double>(dt)));
}

ContactPath BodyPaths::between(int a, int b, const Quatd& axes) const {
  ContactPath path(rotate(conjugate(axes), displacement(b) - displacement(a)));
  const Turn &of_a = turns_[at(a)], &of_b = turns_[at(b)];
  if (of_b.other >= 0 && of_b.other != a) path.turn(of_b.time, rotate(conjugate(axes), of_b.change));
  if (of_a.other >= 0 && of_a.other != b) path.turn(of_a.time, rotate(conjugate(axes), -of_a.change));
  return path;
}

}  // namespace pliant

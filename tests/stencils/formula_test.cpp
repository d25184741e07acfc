// Tests the mathematics of types in the long form, in double: gradients by finite differences, also for rotations;
// forces and torques that sum to zero; sixteen lanes compared with one. Every type in all.h takes part, so a new type
// is tested without a change here.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "constraints/all.h"
#include "math/quat.h"
#include "math/wide.h"
#include "support/stencil_types.h"

namespace pliant {
namespace {

using namespace testing_support;

template <class List>
struct WithOurs;
template <class... Types>
struct WithOurs<TypeList<Types...>> {
  using Type = testing::Types<Types..., TestJoint, TwoBars, Spread>;
};

struct NameOfType {
  template <class T>
  static std::string GetName(int) {
    return T::name;
  }
};

template <class T, class R>
using Values = SlotValues<typename T::slots, R>;
template <class T, class R>
using RowsOf = Rows<typename T::slots, T::rows, R>;

template <class T>
class Stencil : public testing::Test {
 protected:
  static constexpr int slot_total = T::slots::count, samples = 100;
  using Params = typename T::template Params<double>;

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967295.0);
  }
  Vec3d point(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }
  Quatd rotation() { return normalise(Quatd{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.2, 1)}); }

  static bool is_frame(int slot) { return T::slots::kinds[static_cast<std::size_t>(slot)] == SlotKind::frame; }

  /// Points that are well apart, because formulas have kinks where points coincide.
  Values<T, double> values() {
    Values<T, double> at;
    const Quatd turned = rotation();
    for (int i = 0; i < slot_total; ++i) {
      at.point[i] = rotate(turned, Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}) + point(0.2);
      at.frame[i] = rotation();
    }
    return at;
  }

  Params params() {
    double slot_numbers[4 * slot_total], rest[32];
    const Values<T, double> other = values();
    for (int i = 0; i < slot_total; ++i) {
      const Quatd q = is_frame(i) ? other.frame[i] : Quatd{other.point[i].x, other.point[i].y, other.point[i].z, 0};
      const double numbers[4] = {q.x, q.y, q.z, q.w};
      std::copy_n(numbers, 4, slot_numbers + 4 * i);
    }
    for (double& field : rest) field = uniform(-1, 1);
    const ConstraintDefinition definition = detail::definition_of<T>();
    if (definition.measure != nullptr) definition.measure(slot_numbers, rest);
    return detail::params_of<T, double>(rest);
  }

  static RowsOf<T, double> rows(const Values<T, double>& at, const Params& p) {
    RowsOf<T, double> out;
    detail::evaluate_rows<T, double>(at, p, out);
    return out;
  }

  /// A copy of `at` in which one slot is moved, or rotated, by h along an axis of the world.
  static Values<T, double> moved(Values<T, double> at, int slot, int axis, double h) {
    const Vec3d v{axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
    if (!is_frame(slot)) {
      at.point[slot] += v;
      return at;
    }
    const double half = std::sin(h / 2) / h;
    at.frame[slot] = multiply(Quatd{v.x * half, v.y * half, v.z * half, std::cos(h / 2)}, at.frame[slot]);
    return at;
  }

  std::mt19937 random_{20261122};
};
TYPED_TEST_SUITE(Stencil, WithOurs<AllConstraints>::Type, NameOfType);

double part(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

TYPED_TEST(Stencil, GradientIsTheDerivativeOfPlacesAndRotations) {
  const double h = 1e-5;
  int compared = 0;
  for (int sample = 0; sample < this->samples; ++sample) {
    const auto at = this->values();
    const auto params = this->params();
    const auto here = this->rows(at, params);
    for (int slot = 0; slot < this->slot_total; ++slot) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto high = this->rows(this->moved(at, slot, axis, h), params);
        const auto low = this->rows(this->moved(at, slot, axis, -h), params);
        const auto higher = this->rows(this->moved(at, slot, axis, 2 * h), params);
        const auto lower = this->rows(this->moved(at, slot, axis, -2 * h), params);
        for (int row = 0; row < TypeParam::rows; ++row) {
          const double near = high.c[row] - low.c[row], far = higher.c[row] - lower.c[row];
          if (std::fabs(near) > 1 || std::fabs(far) > 1) continue;  // an angle that wraps around
          const double numeric = (8 * near - far) / (12 * h);       // of fourth order
          // Near the singularity of an angle, third derivatives grow as the cube of the gradient.
          const double steep = 1 + std::fabs(numeric) * std::fmax(1, numeric * numeric / 20);
          ASSERT_NEAR(part(here.gradient[row][slot], axis), numeric, 2e-8 * steep)
              << "row " << row << ", slot " << slot << ", axis " << axis;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 99 * this->samples * this->slot_total * 3 * TypeParam::rows / 100);
}

TYPED_TEST(Stencil, NoNetForceAndNoNetTorque) {
  for (int sample = 0; sample < this->samples; ++sample) {
    const auto at = this->values();
    const auto found = this->rows(at, this->params());
    double error = 0;
    for (double c : found.c) error += c * c;
    error = std::sqrt(error);
    for (int row = 0; row < TypeParam::rows; ++row) {
      Vec3d force{}, torque{};
      for (int slot = 0; slot < this->slot_total; ++slot) {
        const Vec3d g = found.gradient[row][slot];
        if (!this->is_frame(slot)) force += g;
        torque += this->is_frame(slot) ? g : cross(at.point[slot], g);
      }
      EXPECT_LT(length(force), 1e-12 * (1 + length(found.gradient[row][0])));
      // The force of a joint or tie with a gap has a torque across that gap; other types have none.
      const double gap = TypeParam::slots::frames > 0 || TypeParam::rows > 1 ? error : 0;
      EXPECT_LT(length(torque), gap + 1e-12 * (1 + length(found.gradient[row][0])));
    }
  }
}

TYPED_TEST(Stencil, RigidMotionKeepsTheSizeOfC) {
  for (int sample = 0; sample < this->samples; ++sample) {
    const auto at = this->values();
    const auto params = this->params();
    auto other = at;
    const Quatd turned = this->rotation();
    const Vec3d shift = this->point(10);
    for (int slot = 0; slot < this->slot_total; ++slot) {
      other.point[slot] = rotate(turned, at.point[slot]) + shift;
      other.frame[slot] = multiply(turned, at.frame[slot]);
    }
    double before = 0, after = 0;
    const auto first = this->rows(at, params), second = this->rows(other, params);
    for (int row = 0; row < TypeParam::rows; ++row) {
      before += first.c[row] * first.c[row];
      after += second.c[row] * second.c[row];
    }
    EXPECT_NEAR(before, after, 1e-11 * (1 + before));
  }
}

TYPED_TEST(Stencil, LanesAreTheScalarBits) {
  constexpr int slots = TypeParam::slots::count, fields = detail::field_count<TypeParam>;
  float in[7 * slots + (fields > 0 ? fields : 1)][16];
  for (auto& row : in)
    for (float& lane : row) lane = static_cast<float>(this->uniform(-1, 1));
  const auto wide = [&](int row) { return load_wide(in[row]); };
  Values<TypeParam, Wide> at;
  typename TypeParam::template Params<Wide> params;
  Wide rest[fields > 0 ? fields : 1];
  for (int i = 0; i < slots; ++i) {
    at.point[i] = {wide(7 * i), wide(7 * i + 1), wide(7 * i + 2)};
    at.frame[i] = {wide(7 * i + 3), wide(7 * i + 4), wide(7 * i + 5), wide(7 * i + 6)};
  }
  for (int field = 0; field < fields; ++field) rest[field] = wide(7 * slots + field);
  if constexpr (fields > 0) std::memcpy(static_cast<void*>(&params), rest, sizeof params);
  RowsOf<TypeParam, Wide> out;
  detail::evaluate_rows<TypeParam, Wide>(at, params, out);
  for (int lane = 0; lane < 16; ++lane) {
    Values<TypeParam, float> one;
    float own[fields > 0 ? fields : 1] = {};
    for (int i = 0; i < slots; ++i) {
      one.point[i] = {in[7 * i][lane], in[7 * i + 1][lane], in[7 * i + 2][lane]};
      one.frame[i] = {in[7 * i + 3][lane], in[7 * i + 4][lane], in[7 * i + 5][lane], in[7 * i + 6][lane]};
    }
    for (int field = 0; field < fields; ++field) own[field] = in[7 * slots + field][lane];
    RowsOf<TypeParam, float> alone;
    detail::evaluate_rows<TypeParam, float>(one, detail::params_of<TypeParam, float>(own), alone);
    for (int row = 0; row < TypeParam::rows; ++row) {
      float c[16], x[16];
      store_wide(c, out.c[row]);
      EXPECT_EQ(c[lane], alone.c[row]) << "lane " << lane;
      for (int i = 0; i < slots; ++i) {
        store_wide(x, out.gradient[row][i].y);
        EXPECT_EQ(x[lane], alone.gradient[row][i].y) << "lane " << lane << ", slot " << i;
      }
    }
  }
}

}  // namespace
}  // namespace pliant

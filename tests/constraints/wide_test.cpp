// Tests that sixteen lanes give the bits of sixteen floats: every constraint type, evaluated and projected with every
// law, on ordinary and extreme numbers. This file is compiled for the default machine; tests/solver does the same for
// wider instruction sets.
#include "math/wide.h"

#include <gtest/gtest.h>

#include "solver/project.h"
#include "support/bits.h"
#include "support/constraint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int batches = 7000;  // batches of sixteen: more than 100 000 constraints

/// Sixteen of each input of a projection.
template <class T>
struct Inputs {
  float x[size_of<T>][3][wide_width], w[size_of<T>][wide_width], motion[size_of<T>][3][wide_width];
  float params[field_count<T>][wide_width], response[wide_width], damping[wide_width], multiplier[wide_width];

  explicit Inputs(Random& random) {
    float* all = &x[0][0][0];
    for (std::size_t i = 0; i < sizeof *this / sizeof(float); ++i) all[i] = nasty_float(random);
    for (auto& slot : w) {
      for (float& value : slot) value = random() % 4 == 0 ? 0.f : std::fabs(value);
    }
    for (int lane = 0; lane < wide_width; ++lane) {
      response[lane] = random() % 4 == 0 ? 0.f : std::fabs(response[lane]);
      damping[lane] = std::fabs(damping[lane]);
    }
  }
};

Vec3<Wide> wide_vector(const float (&v)[3][wide_width]) { return {load_wide(v[0]), load_wide(v[1]), load_wide(v[2])}; }
Vec3f lane_vector(const float (&v)[3][wide_width], int lane) { return {v[0][lane], v[1][lane], v[2][lane]}; }
float lane_of(const Wide& a, int lane) {
  float all[wide_width];
  store_wide(all, a);
  return all[lane];
}
void expect_lane(const Wide& wide, float scalar, int lane, const char* what) {
  ASSERT_TRUE(same_bits(lane_of(wide, lane), scalar))
      << what << ", lane " << lane << ": " << lane_of(wide, lane) << " and " << scalar;
}
void expect_lane(const Vec3<Wide>& wide, const Vec3f& scalar, int lane, const char* what) {
  expect_lane(wide.x, scalar.x, lane, what);
  expect_lane(wide.y, scalar.y, lane, what);
  expect_lane(wide.z, scalar.z, lane, what);
}

template <class T>
class WideEqualsFloat : public testing::Test {
 protected:
  Random random_{99};
};
TYPED_TEST_SUITE(WideEqualsFloat, ConstraintAndContactTypes, NameOfType);

template <class T>
ParamsOf<T, Wide> wide_params(const Inputs<T>& in) {
  ParamsOf<T, Wide> params;
  static_assert(sizeof params == sizeof in.params);
  std::memcpy(static_cast<void*>(&params), in.params, sizeof params);
  return params;
}
template <class T>
ParamsOf<T, float> lane_params(const Inputs<T>& in, int lane) {
  float fields[field_count<T>];
  for (int i = 0; i < field_count<T>; ++i) fields[i] = in.params[i][lane];
  ParamsOf<T, float> params;
  std::memcpy(static_cast<void*>(&params), fields, sizeof fields);
  return params;
}

TYPED_TEST(WideEqualsFloat, Evaluated) {
  using T = TypeParam;
  for (int batch = 0; batch < batches; ++batch) {
    const Inputs<T> in(this->random_);
    Vec3<Wide> x[size_of<T>], gradient[size_of<T>];
    for (std::size_t i = 0; i < size_of<T>; ++i) x[i] = wide_vector(in.x[i]);
    const Wide c = T::evaluate(x, wide_params<T>(in), gradient);
    for (int lane = 0; lane < wide_width; ++lane) {
      Stencil<T, float> at;
      for (std::size_t i = 0; i < size_of<T>; ++i) at[i] = lane_vector(in.x[i], lane);
      const auto value = evaluate<T, float>(at, lane_params<T>(in, lane));
      ASSERT_NO_FATAL_FAILURE(expect_lane(c, value.c, lane, "C"));
      for (std::size_t i = 0; i < size_of<T>; ++i) {
        ASSERT_NO_FATAL_FAILURE(expect_lane(gradient[i], value.gradient[i], lane, "gradient"));
      }
    }
  }
}

template <class T, Law law, bool keeps>
void compare_projection(Random& random) {
  const Inputs<T> in(random);
  SweepArguments arguments;
  arguments.h = 0.003f;
  arguments.inverse_h = 1 / 0.003f;
  arguments.inverse_h2 = arguments.inverse_h * arguments.inverse_h;
  Vec3<Wide> x[size_of<T>], motion[size_of<T>], correction[size_of<T>];
  Wide w[size_of<T>];
  for (std::size_t i = 0; i < size_of<T>; ++i) {
    x[i] = wide_vector(in.x[i]);
    motion[i] = wide_vector(in.motion[i]);
    w[i] = load_wide(in.w[i]);
  }
  ConstraintResponse<Wide> response{load_wide(in.response), load_wide(in.damping), load_wide(in.multiplier)};
  project<T, law, keeps, false, Wide>(x, w, wide_params<T>(in), motion, response, arguments, correction);
  for (int lane = 0; lane < wide_width; ++lane) {
    Vec3f y[size_of<T>], moved[size_of<T>], alone_correction[size_of<T>];
    float mass[size_of<T>];
    for (std::size_t i = 0; i < size_of<T>; ++i) {
      y[i] = lane_vector(in.x[i], lane);
      moved[i] = lane_vector(in.motion[i], lane);
      mass[i] = in.w[i][lane];
    }
    ConstraintResponse<float> alone{in.response[lane], in.damping[lane], in.multiplier[lane]};
    project<T, law, keeps, false, float>(y, mass, lane_params<T>(in, lane), moved, alone, arguments, alone_correction);
    for (std::size_t i = 0; i < size_of<T>; ++i)
      ASSERT_NO_FATAL_FAILURE(expect_lane(correction[i], alone_correction[i], lane, "correction"));
    ASSERT_NO_FATAL_FAILURE(expect_lane(response.multiplier, alone.multiplier, lane, "multiplier"));
  }
}

TYPED_TEST(WideEqualsFloat, Projected) {
  for (int batch = 0; batch < batches / 5; ++batch) {
    ASSERT_NO_FATAL_FAILURE((compare_projection<TypeParam, Law::compliant, false>(this->random_)));
    ASSERT_NO_FATAL_FAILURE((compare_projection<TypeParam, Law::compliant, true>(this->random_)));
    ASSERT_NO_FATAL_FAILURE((compare_projection<TypeParam, Law::damped, false>(this->random_)));
    ASSERT_NO_FATAL_FAILURE((compare_projection<TypeParam, Law::damped, true>(this->random_)));
    ASSERT_NO_FATAL_FAILURE((compare_projection<TypeParam, Law::pbd, false>(this->random_)));
  }
}

}  // namespace
}  // namespace pliant

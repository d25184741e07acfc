// What the typed tests of constraints share: the list of types for GoogleTest, and random stencils.
//
// Everything is derived from the types, so a new type in constraints/all.h is tested without a change here.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <random>
#include <string>

#include "constraints/all.h"
#include "constraints/plane_contact.h"
#include "math/quat.h"
#include "math/vector.h"
#include "support/random.h"

namespace pliant::testing_support {

template <class Types, class List>
struct AsTypes;
template <class... Taken>
struct AsTypes<::testing::Types<Taken...>, TypeList<>> {
  using Alone = ::testing::Types<Taken...>;
  using WithContact = ::testing::Types<Taken..., PlaneContact>;
};
template <class... Taken, class First, class... More>
struct AsTypes<::testing::Types<Taken...>, TypeList<First, More...>>
    : AsTypes<std::conditional_t<in_lanes<First>, ::testing::Types<Taken..., First>, ::testing::Types<Taken...>>,
              TypeList<More...>> {};
/// Every type in constraints/all.h that has one row over points; tests/stencils tests all types.
using ConstraintTypes = AsTypes<::testing::Types<>, AllConstraints>::Alone;
/// The same types, and the plane contact.
using ConstraintAndContactTypes = AsTypes<::testing::Types<>, AllConstraints>::WithContact;

struct NameOfType {
  template <class T>
  static std::string GetName(int) {
    return T::name;
  }
};

template <class T>
inline constexpr std::size_t size_of = static_cast<std::size_t>(slot_count<T>);
template <class T, class R>
using Stencil = std::array<Vec3<R>, size_of<T>>;
template <class T, class R>
using ParamsOf = typename T::template Params<R>;
template <class T>
inline constexpr int field_count = static_cast<int>(sizeof(ParamsOf<T, float>) / sizeof(float));

/// True if a type can measure its rest data from a stencil; the plane contact cannot.
template <class T>
inline constexpr bool measures = requires(const Vec3<double> (&x)[size_of<T>]) {
  T::template measure<double>(x);
};

/// Converts the parameters of a constraint to another precision.
template <class T, class To, class From>
ParamsOf<T, To> convert_params(const ParamsOf<T, From>& from) {
  From in[field_count<T>];
  To out[field_count<T>];
  static_assert(sizeof in == sizeof from);
  std::memcpy(in, &from, sizeof in);
  for (int i = 0; i < field_count<T>; ++i) out[i] = static_cast<To>(in[i]);
  ParamsOf<T, To> to;
  std::memcpy(static_cast<void*>(&to), out, sizeof to);
  return to;
}

/// C and its gradients at a stencil.
template <class T, class R>
struct Value {
  R c;
  Stencil<T, R> gradient;
};

template <class T, class R>
Value<T, R> evaluate(const Stencil<T, R>& at, const ParamsOf<T, R>& params) {
  Vec3<R> x[size_of<T>], gradient[size_of<T>];
  for (std::size_t i = 0; i < size_of<T>; ++i) x[i] = at[i];
  Value<T, R> value{T::template evaluate<R>(x, params, gradient), {}};
  for (std::size_t i = 0; i < size_of<T>; ++i) value.gradient[i] = gradient[i];
  return value;
}

template <class T, class R>
ParamsOf<T, R> measure(const Stencil<T, R>& at) {
  Vec3<R> x[size_of<T>];
  for (std::size_t i = 0; i < size_of<T>; ++i) x[i] = at[i];
  return T::template measure<R>(x);
}

/// Calls T::canonical if T has it.
template <class T>
void canonical_order(std::array<int, size_of<T>>& order, ParamsOf<T, float>& params) {
  if constexpr (requires { T::canonical(order, params); }) T::canonical(order, params);
}

inline Vec3d random_point(Random& random, double reach) {
  return {uniform(random, -reach, reach), uniform(random, -reach, reach), uniform(random, -reach, reach)};
}
inline Quatd random_rotation(Random& random) {
  const Vec3d v = random_point(random, 1);
  return normalise(Quatd{v.x, v.y, v.z, uniform(random, 0.2, 1)});
}

/// True if no two points are close and no three nearly collinear, so that no formula is near a singularity.
template <std::size_t n>
bool is_well_spread(const std::array<Vec3d, n>& x) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (length(x[i] - x[j]) < 0.5) return false;
      for (std::size_t k = 0; k < j; ++k) {
        if (length(cross(x[i] - x[k], x[j] - x[k])) < 0.4) return false;
      }
    }
  }
  return true;
}

/// True if a type has no rest shape without volume.
template <class T>
inline constexpr bool needs_volume = std::is_base_of_v<TetrahedronStrain, T> || std::is_same_v<T, TetrahedronVolume> ||
                                     std::is_same_v<T, VolumeAroundEdge>;

/// True if C is a norm of several numbers. Its level sets are curved at any distance from rest, so one projection
/// removes its share only roughly, and several turn the direction of the gradient.
template <class T>
inline constexpr bool is_norm = std::is_base_of_v<TetrahedronStrain, T> && !std::is_same_v<T, GreenTrace>;

/// An edge along z and six points around it, none of them exactly in its place, turned as a whole.
inline Stencil<VolumeAroundEdge, double> random_ring(Random& random) {
  Stencil<VolumeAroundEdge, double> x;
  const Quatd turn = random_rotation(random);
  for (std::size_t i = 0; i < 8; ++i) {
    const double angle = 1.0471975511965976 * static_cast<double>(i);
    const Vec3d place = i < 6 ? Vec3d{std::cos(angle), std::sin(angle), 0} : Vec3d{0, 0, i == 6 ? -0.8 : 0.8};
    x[i] = rotate(turn, place + random_point(random, 0.2));
  }
  return x;
}

/// True unless a type needs a volume that its first four points do not enclose.
template <class T>
bool spans_volume(const Stencil<T, double>& x) {
  if constexpr (needs_volume<T>)
    return std::fabs(dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0])) > 0.3;
  else
    return true;
}

template <class T>
Stencil<T, double> random_stencil(Random& random) {
  if constexpr (std::is_same_v<T, VolumeAroundEdge>) return random_ring(random);
  for (;;) {
    Stencil<T, double> x;
    for (Vec3d& p : x) p = random_point(random, 1);
    if (is_well_spread(x) && spans_volume<T>(x)) return x;
  }
}

/// Rest data measured at another random stencil, so that C is not zero; for the plane contact, a random plane.
template <class T>
ParamsOf<T, double> random_params(Random& random) {
  if constexpr (std::is_same_v<T, DistanceLimit>) {  // beyond one of its limits, as it does nothing between
    const double length = uniform(random, 0, 0.05);
    return uniform(random, 0, 1) < 0.5 ? ParamsOf<T, double>{length, 0} : ParamsOf<T, double>{20, 10 + length};
  } else if constexpr (measures<T>) {
    return measure<T, double>(random_stencil<T>(random));
  } else {
    const Vec3d normal = rotate(random_rotation(random), Vec3d{0, 1, 0});
    double fields[] = {normal.x, normal.y, normal.z, uniform(random, -1, 1)};
    static_assert(sizeof fields == sizeof(ParamsOf<T, double>), "what can't be measured is taken to be a plane");
    ParamsOf<T, double> params;
    std::memcpy(static_cast<void*>(&params), fields, sizeof fields);
    return params;
  }
}

/// A random stencil with a flat rest shape: all points at z = 0, the third and the fourth on opposite sides of the
/// first two. Of a type that needs a volume, any stencil.
template <class T>
Stencil<T, double> flat_stencil(Random& random) {
  if constexpr (needs_volume<T>) return random_stencil<T>(random);
  for (;;) {
    Stencil<T, double> x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double side = i == 2 ? 1 : i == 3 ? -1 : 0;
      x[i] = {uniform(random, -1, 1), side * uniform(random, 0.3, 1), 0};
    }
    if (is_well_spread(x)) return x;
  }
}

}  // namespace pliant::testing_support

// Formulas with floats in and floats out: the same text is compiled by the host's compiler and by nvcc, to compare the
// bits.
//
// A probe has a name, numbers of floats in and out, and a function for both machines. New constraint types are in the
// list automatically.
#pragma once

#include <cstring>

#include "device_headers.h"

namespace pliant::cuda {

/// Probes C, the gradients and, if the type has it, `measure`.
template <class T>
struct ConstraintProbe {
  using Parameters = typename T::template Params<float>;
  static constexpr int fields = sizeof(Parameters) / sizeof(float);
  static constexpr bool measures = requires(const Vec3<float> (&x)[slot_count<T>]) { T::template measure<float>(x); };

  static constexpr const char* name = T::name;
  static constexpr int inputs = 3 * slot_count<T> + fields;
  static constexpr int outputs = 1 + 3 * slot_count<T> + (measures ? fields : 0);

  PLIANT_HD static void run(const float* in, float* out) {
    Vec3<float> x[slot_count<T>], gradient[slot_count<T>];
    Parameters parameters;
    memcpy(static_cast<void*>(x), in, sizeof x);
    memcpy(static_cast<void*>(&parameters), in + 3 * slot_count<T>, sizeof parameters);
    out[0] = T::evaluate(x, parameters, gradient);
    memcpy(out + 1, gradient, sizeof gradient);
    if constexpr (measures) {
      const Parameters measured = T::measure(x);
      memcpy(out + 1 + 3 * slot_count<T>, &measured, sizeof measured);
    }
  }
};

/// Probes the functions that replace libm.
struct FunctionProbe {
  static constexpr const char* name = "functions";
  static constexpr int inputs = 2;
  static constexpr int outputs = 9;

  PLIANT_HD static void run(const float* in, float* out) {
    const float x = in[0], y = in[1];
    out[0] = pliant::atan2(y, x);
    out[1] = pliant::acos(x);
    out[2] = pliant::sin(x);
    out[3] = pliant::cos(x);
    out[4] = pliant::exp(x);
    out[5] = pliant::log(x);
    out[6] = pliant::sqrt(x);
    out[7] = static_cast<float>(pliant::pow(static_cast<double>(x), static_cast<double>(y)));
    out[8] = pliant::clamp(x, -1.f, y);
  }
};

/// A probe for each type that is projected in lanes, then the others given.
template <class List, class... Made>
struct Probes;
template <class... Made>
struct Probes<TypeList<>, Made...> {
  using Type = TypeList<Made..., ConstraintProbe<PlaneContact>, FunctionProbe>;
};
template <class First, class... More, class... Made>
requires(in_lanes<First>) struct Probes<TypeList<First, More...>, Made...>
    : Probes<TypeList<More...>, Made..., ConstraintProbe<First>> {
};
template <class First, class... More, class... Made>
requires(!in_lanes<First>) struct Probes<TypeList<First, More...>, Made...> : Probes<TypeList<More...>, Made...> {
};
using AllProbes = Probes<AllConstraints>::Type;

}  // namespace pliant::cuda

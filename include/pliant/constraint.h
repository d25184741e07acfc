// Constraint types of your own, defined in your own header. The library need not be rebuilt.
//
//   struct RightAngle {                                       // three points; the angle at the first one is 90 degrees
//     static constexpr const char* name = "right_angle";      // its name in ConstraintGroup::type and scene files
//     using slots = pliant::Points<3>;
//     static constexpr int rows = 1;
//     template <class R> struct Params {};                    // rest data: members of type R alone
//     static constexpr std::array<const char*, 0> fields{};   // their names
//     template <class R>
//     static void evaluate(const pliant::SlotValues<slots, R>& at, const Params<R>& p, pliant::Rows<slots, rows, R>& out);
//   };
//   pliant::register_constraint<RightAngle>();
//
// A type with `static constexpr bool is_bounded = true` also fills out.low and out.high, bounds of each row's force: a
// stop that only pushes has low = 0, a motor has its greatest torque. With `acts_on_motion = true` a row does not bring
// C to zero, but the speed of C to out.speed, within the bounds; its compliance is a speed over a force (a viscous
// damper's inverse rate).
//
// A type whose rest shape can yield (Plasticity) has `static bool flow(at, params, start, by)`: it changes the rest
// data `params`, which were `start` in the beginning, by the PlasticFlow `by`, and returns true if it did. One whose
// rest field 0 is a size that keyframes may multiply has `static constexpr bool rest_scales = true`.
//
// The unit of compliance is the inverse unit of the energy C^2 / 2. PBD stiffness, damping, multipliers, Report and
// scene files work as for the library's types. Your constraints are projected one at a time, in colours that all
// threads share.
//
// To get the same bits on every machine, use the functions of pliant/formula.h and no others of the C or C++ library,
// and compile with -ffp-contract=off and without -ffast-math.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "pliant/formula.h"
#include "pliant/scene.h"

namespace pliant {

/// A constraint type as the library stores it: a description, and functions on plain arrays. A slot is four numbers: a
/// position and a zero, or a quaternion. Gradients have three numbers each and are ordered by row, then by slot.
struct ConstraintDefinition {
  std::string name;
  std::vector<SlotKind> slots;
  int rows = 1;
  std::vector<std::string> rest_fields;
  bool is_length = false;    ///< true if C is the distance of two points minus the only rest field
  bool is_compiled = false;  ///< true for built-in types of one row over points, which are projected sixteen at a time
  /// True for bilateral joints of two bodies (point, frame, point, frame): trees of them are solved directly.
  bool is_joint = false;
  bool is_tie = false;  ///< true if C is the way from a place on a body to a particle (slots body, frame, particle) [m]
  bool acts_on_motion = false;  ///< true if rows impose a speed of C; only with `evaluate_bounded`
  float largest_change = 0;     ///< largest change of C in one projection; 0: no limit
  void (*evaluate)(const float* slots, const float* rest, float* c, float* gradients) = nullptr;
  /// As evaluate; also low, high and speed of each row. Null: rows are without bounds.
  void (*evaluate_bounded)(const float* slots, const float* rest, float* c, float* gradients, float* bounds) = nullptr;
  void (*evaluate_double)(const double* slots, const double* rest, double* c, double* gradients) = nullptr;
  void (*measure)(const double* slots,
                  double* rest) = nullptr;                 ///< computes rest data from a rest shape; null: give them
  void (*canonical)(int* stencil, float* rest) = nullptr;  ///< reorders slots that are symmetric; null: none are
  /// Lets rest data follow the present shape (Plasticity); false if they stay. Null: the type is always elastic.
  bool (*flow)(const float* slots, float* rest, const float* start, const PlasticFlow& by) = nullptr;
  bool rest_scales = false;  ///< true if rest field 0 is a size that ConstraintGroup::keyframes may multiply
};

/// Registers a constraint type by its name, for Worlds made afterwards; repeating it is permitted. Throws an Error if
/// another type has that name, or if the definition is incomplete. Call it before other threads use the library.
void register_constraint(const ConstraintDefinition& definition);

namespace detail {

template <class T>
inline constexpr int field_count = static_cast<int>(T::fields.size());

/// True if T has the short form of evaluate: one row over points, evaluate(x, params, gradient) returns C.
template <class T, class R>
inline constexpr bool is_short = requires(const Vec3<R> (&x)[static_cast<std::size_t>(T::slots::count)],
                                          const typename T::template Params<R>& params,
                                          Vec3<R> (&gradient)[static_cast<std::size_t>(T::slots::count)]) {
  { T::evaluate(x, params, gradient) } -> std::same_as<R>;
};

template <class T, class R>
typename T::template Params<R> params_of(const R* rest) {
  typename T::template Params<R> params{};
  if constexpr (field_count < T >> 0) {
    static_assert(sizeof params == static_cast<std::size_t>(field_count<T>) * sizeof(R),
                  "`fields` names every member of Params");
    std::memcpy(static_cast<void*>(&params), rest, sizeof params);
  }
  return params;
}

template <class S, class R>
SlotValues<S, R> values_of(const R* slots) {
  SlotValues<S, R> at;
  for (int slot = 0; slot < S::count; ++slot, slots += 4) {
    if (S::kinds[static_cast<std::size_t>(slot)] == SlotKind::point)
      at.point[slot] = {slots[0], slots[1], slots[2]};
    else
      at.frame[slot] = {slots[0], slots[1], slots[2], slots[3]};
  }
  return at;
}

/// Evaluates C and its gradients by either form of T::evaluate: the one that returns C, or the one that fills Rows.
template <class T, class R>
void evaluate_rows(const SlotValues<typename T::slots, R>& at, const typename T::template Params<R>& params,
                   Rows<typename T::slots, T::rows, R>& out) {
  if constexpr (is_short<T, R>) {
    static_assert(T::rows == 1 && T::slots::frames == 0, "the short form has one row over points");
    out.c[0] = T::evaluate(at.point, params, out.gradient[0]);
  } else {
    T::evaluate(at, params, out);
  }
}

template <class T, class R>
void store_rows(const Rows<typename T::slots, T::rows, R>& out, R* c, R* gradients) {
  for (int row = 0; row < T::rows; ++row) {
    c[row] = out.c[row];
    for (int slot = 0; slot < T::slots::count; ++slot, gradients += 3) {
      gradients[0] = out.gradient[row][slot].x;
      gradients[1] = out.gradient[row][slot].y;
      gradients[2] = out.gradient[row][slot].z;
    }
  }
}

template <class T, class R>
void evaluate(const R* slots, const R* rest, R* c, R* gradients) {
  Rows<typename T::slots, T::rows, R> out;
  evaluate_rows<T, R>(values_of<typename T::slots, R>(slots), params_of<T, R>(rest), out);
  store_rows<T, R>(out, c, gradients);
}

template <class T>
inline constexpr bool acts_on_motion = [] {
  if constexpr (requires { T::acts_on_motion; }) return T::acts_on_motion;
  return false;
}();
template <class T>
inline constexpr bool is_bounded = [] {
  if constexpr (requires { T::is_bounded; }) return T::is_bounded;
  return false;
}();

/// Bounds are three numbers a row: low, high, speed.
template <class T>
void evaluate_bounded(const float* slots, const float* rest, float* c, float* gradients, float* bounds) {
  Rows<typename T::slots, T::rows, float> out;
  evaluate_rows<T, float>(values_of<typename T::slots, float>(slots), params_of<T, float>(rest), out);
  store_rows<T, float>(out, c, gradients);
  for (int row = 0; row < T::rows; ++row, bounds += 3) {
    bounds[0] = out.low[row];
    bounds[1] = out.high[row];
    bounds[2] = acts_on_motion<T> ? out.speed[row] : 0;
  }
}

template <class T>
inline constexpr bool measures_points = requires(const Vec3<double> (&x)[static_cast<std::size_t>(T::slots::count)]) {
  T::template measure<double>(x);
};
template <class T>
inline constexpr bool measures_slots = requires(const SlotValues<typename T::slots, double>& at) {
  T::template measure<double>(at);
};

template <class T>
void measure(const double* slots, double* rest) {
  const auto at = values_of<typename T::slots, double>(slots);
  typename T::template Params<double> params{};
  if constexpr (measures_points<T>)
    params = T::template measure<double>(at.point);
  else
    params = T::template measure<double>(at);
  if constexpr (field_count < T >> 0) std::memcpy(rest, &params, sizeof params);
}

template <class T>
inline constexpr bool has_canonical = requires(std::array<int, static_cast<std::size_t>(T::slots::count)>& stencil,
                                               typename T::template Params<float>& params) {
  T::canonical(stencil, params);
};

template <class T>
void canonical(int* stencil, float* rest) {
  std::array<int, static_cast<std::size_t>(T::slots::count)> order;
  typename T::template Params<float> params = params_of<T, float>(rest);
  std::memcpy(order.data(), stencil, sizeof order);
  T::canonical(order, params);
  std::memcpy(stencil, order.data(), sizeof order);
  if constexpr (field_count < T >> 0) std::memcpy(rest, &params, sizeof params);
}

template <class T>
inline constexpr bool flows = requires(const SlotValues<typename T::slots, float>& at,
                                       typename T::template Params<float>& params, const PlasticFlow& by) {
  T::flow(at, params, params, by);
};

template <class T>
bool flow(const float* slots, float* rest, const float* start, const PlasticFlow& by) {
  typename T::template Params<float> params = params_of<T, float>(rest);
  if (!T::flow(values_of<typename T::slots, float>(slots), params, params_of<T, float>(start), by)) return false;
  std::memcpy(rest, &params, sizeof params);
  return true;
}

template <class T>
ConstraintDefinition definition_of() {
  static_assert(T::rows >= 1 && T::rows <= 6, "a type has one to six rows");
  ConstraintDefinition made;
  made.name = T::name;
  made.slots.assign(T::slots::kinds.begin(), T::slots::kinds.end());
  made.rows = T::rows;
  made.rest_fields.assign(T::fields.begin(), T::fields.end());
  if constexpr (requires { T::is_length; }) made.is_length = T::is_length;
  if constexpr (requires { T::largest_change; }) made.largest_change = T::largest_change;
  static_assert(is_bounded<T> || !acts_on_motion<T>, "a type with acts_on_motion has is_bounded too");
  static_assert(!is_bounded<T> || T::rows > 1 || T::slots::frames > 0,
                "a bounded row over points alone: not supported");
  made.acts_on_motion = acts_on_motion<T>;
  if constexpr (requires { T::is_joint; }) made.is_joint = T::is_joint;
  if constexpr (requires { T::is_tie; }) made.is_tie = T::is_tie;
  if constexpr (is_bounded<T>) made.evaluate_bounded = &evaluate_bounded<T>;
  made.evaluate = &evaluate<T, float>;
  made.evaluate_double = &evaluate<T, double>;
  if constexpr (measures_points<T> || measures_slots<T> || field_count<T> == 0) {
    if constexpr (measures_points<T> || measures_slots<T>)
      made.measure = &measure<T>;
    else
      made.measure = [](const double*, double*) {};
  }
  if constexpr (has_canonical<T>) made.canonical = &canonical<T>;
  if constexpr (flows<T>) made.flow = &flow<T>;
  if constexpr (requires { T::rest_scales; }) made.rest_scales = T::rest_scales;
  return made;
}

}  // namespace detail

/// Registers the constraint type T by its name, T::name. See the top of this file.
template <class T>
void register_constraint() {
  register_constraint(detail::definition_of<T>());
}

}  // namespace pliant

// Vector operations beyond the public header: conversion, length, unit vectors, componentwise operations.
#pragma once

#include "math/scalar.h"

namespace pliant {

/// Converts a vector to another precision.
template <class To, class From>
PLIANT_HD Vec3<To> convert(const Vec3<From>& v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
}

template <class R>
PLIANT_HD R length(const Vec3<R>& v) {
  return sqrt(length_squared(v));
}

/// Selects by components: a where the mask is set, else b.
template <class Mask, class R>
PLIANT_HD Vec3<R> select(const Mask& mask, const Vec3<R>& a, const Vec3<R>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

template <class R>
PLIANT_HD Vec3<R> abs(const Vec3<R>& v) {
  return {abs(v.x), abs(v.y), abs(v.z)};
}
template <class R>
PLIANT_HD Vec3<R> min(const Vec3<R>& a, const Vec3<R>& b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <class R>
PLIANT_HD Vec3<R> max(const Vec3<R>& a, const Vec3<R>& b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

/// The largest absolute value of a component.
template <class R>
PLIANT_HD R largest(const Vec3<R>& v) {
  return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

/// True if all components are finite.
template <class R>
PLIANT_HD bool is_finite(const Vec3<R>& v) {
  return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0;
}

/// The unit vector v / |v|; `otherwise` if |v|^2 is below the smallest normal float (|v| < 1.1e-19).
template <class R>
PLIANT_HD Vec3<R> unit_or(const Vec3<R>& v, const Vec3<R>& otherwise) {
  const R squared = length_squared(v), least = R(1.17549435e-38f);
  return select(squared < least, otherwise, v * (R(1) / sqrt(max(squared, least))));
}

}  // namespace pliant

// Three-component vectors and unit quaternions, the only mathematics in the public interface.
//
// The scalar type is a template parameter, because a formula is used with four: float for one particle, Wide for
// sixteen, double for the tests' comparison, and float on a CUDA device.
#pragma once

#include <cstdint>

#if defined(__CUDACC__)
#define PLIANT_HD __host__ __device__ __forceinline__
#else
// Functions are force-inlined, so that code compiled for different instruction sets never shares one.
#define PLIANT_HD inline __attribute__((always_inline))
#endif

namespace pliant {

/// A vector of three scalars. Positions are in metres, velocities in metres per second, forces in newtons.
template <class R>
struct Vec3 {
  R x{}, y{}, z{};
};

template <class R>
PLIANT_HD Vec3<R> operator+(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
PLIANT_HD Vec3<R> operator-(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
PLIANT_HD Vec3<R> operator-(const Vec3<R>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class R>
PLIANT_HD Vec3<R> operator*(const Vec3<R>& a, const R& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class R>
PLIANT_HD Vec3<R> operator*(const R& s, const Vec3<R>& a) {
  return a * s;
}
template <class R>
PLIANT_HD Vec3<R>& operator+=(Vec3<R>& a, const Vec3<R>& b) {
  return a = a + b;
}
template <class R>
PLIANT_HD Vec3<R>& operator-=(Vec3<R>& a, const Vec3<R>& b) {
  return a = a - b;
}
template <class R>
PLIANT_HD R dot(const Vec3<R>& a, const Vec3<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
PLIANT_HD Vec3<R> cross(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
PLIANT_HD R length_squared(const Vec3<R>& a) {
  return dot(a, a);
}

/// A rotation as a unit quaternion with imaginary part (x, y, z) and real part w.
template <class R>
struct Quat {
  R x{}, y{}, z{}, w{R(1)};
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Quatf = Quat<float>;

inline bool operator==(const Vec3f& a, const Vec3f& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
inline bool operator==(const Quatf& a, const Quatf& b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

}  // namespace pliant

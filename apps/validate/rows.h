// The groups of rows, and functions that make rows and small scenes.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "apps/validate/validate.h"
#include "pliant/world.h"

namespace pliant::validate {

inline constexpr double pi = std::numbers::pi, infinity = std::numeric_limits<double>::infinity();
inline constexpr double standard_gravity = 9.81;  ///< [m/s^2]
inline constexpr float frame_time = 1.f / 60;     ///< [s]

inline double length(const Vec3d& v) { return std::sqrt(length_squared(v)); }
inline float length(const Vec3f& v) { return std::sqrt(length_squared(v)); }
inline Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3d to_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

// Each of these functions adds the rows and charts of one group.
void spring_rows(Result& result, bool slow);
void chain_rows(Result& result, bool slow);
void momentum_rows(Result& result, bool slow);
void pendulum_rows(Result& result, bool slow);
void contact_rows(Result& result, bool slow);
void body_rows(Result& result, bool slow);
void mechanism_rows(Result& result, bool slow);
void motion_rows(Result& result, bool slow);
void collision_rows(Result& result, bool slow);
void stiffness_rows(Result& result, bool slow);
void bending_rows(Result& result, bool slow);
void woven_rows(Result& result, bool slow);
void balloon_rows(Result& result, bool slow);
void drape_rows(Result& result, bool slow);
void steadiness_rows(Result& result, bool slow);
void heavy_chain_rows(Result& result, bool slow);
void convergence_rows(Result& result, bool slow);
void sweep_rows(Result& result, bool slow);
void solid_rows(Result& result, bool slow);
void liquid_rows(Result& result, bool slow);
void viscous_liquid_rows(Result& result);
void overlapping_liquid_rows(Result& result);
void liquid_under_gravity_rows(Result& result);
void grain_rows(Result& result, bool slow);
void impact_of_body_rows(Result& result);
void trusted_contact_rows(Result& result);
/// Adds rows of the group `collision` for sets of queries. Throws an Error if the folder has none.
void query_set_rows(Result& result, const std::string& folder);

/// Makes a row with its verdict. A value that is not finite fails.
Row relative(std::string name, double expected, double measured, double tolerance, std::string unit,
             std::string note = {});
Row absolute(std::string name, double expected, double measured, double tolerance, std::string unit,
             std::string note = {});
Row at_most(std::string name, double bound, double measured, std::string unit, std::string note = {});
Row at_least(std::string name, double bound, double measured, std::string unit, std::string note = {});

/// A number in few digits: "1e-08", "50", "0.0166667".
std::string brief(double value);

/// The value of `measured` that is farthest from `expected`; NaN if any is NaN.
double farthest(double expected, const std::vector<double>& measured);

/// An object of free particles. An infinite mass fixes a particle.
Object particles(const std::vector<Vec3f>& positions, const std::vector<float>& masses);

/// Adds distance constraints between pairs of particles, with one stiffness and the given rest lengths.
void connect(Object& object, const std::vector<int>& pairs, const std::vector<float>& lengths,
             const Stiffness& stiffness);

/// A straight hanging line of `count` particles at distances `length`; the first is fixed at the origin.
Object hanging_line(int count, float length, float mass, float last_mass, const Stiffness& stiffness);

/// A scene with one object, one thread, and gravity (0, -g, 0).
Scene scene_with(Object object, double g, int substeps, int iterations);

/// The random number generator of Lehmer (Park and Miller 1988), so that every run has the same rows.
class Random {
 public:
  explicit Random(unsigned seed) : state_(seed % 2147483646U + 1) {}
  double uniform(double low, double high);
  Vec3d vector(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }

 private:
  unsigned long long state_;
};

}  // namespace pliant::validate

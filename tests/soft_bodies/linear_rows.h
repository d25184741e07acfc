// A linear elastic system in double precision as a sum of squares, and its displacements under gravity: the part that
// oracles of small strain share.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "pliant/scene.h"

namespace pliant::testing_support {

/// The stiffness matrix of an object as a sum of k g g^T over rows.
class LinearRows {
 public:
  explicit LinearRows(const Object& object) : object_(object) {}

  /// The displacements [m] of particles that hang in `gravity` [m/s^2], while those of `pinned` stay.
  std::vector<Vec3d> hang(const Vec3d& gravity, const std::vector<int>& pinned) const {
    std::vector<Vec3d> load;
    load.reserve(object_.masses.size());
    for (const float mass : object_.masses) load.push_back(static_cast<double>(mass) * gravity);
    return yield_to(load, pinned);
  }

  /// The displacements [m] of particles under forces [N], while those of `pinned` stay. Without pins, forces must be in
  /// equilibrium.
  std::vector<Vec3d> yield_to(const std::vector<Vec3d>& load, const std::vector<int>& pinned) const {
    std::vector<double> free(load.size(), 1);
    for (const int i : pinned) free[static_cast<std::size_t>(i)] = 0;
    return solve(load, free);
  }

 protected:
  const Object& object_;

  template <std::size_t size>
  void add_row(double stiffness, const std::size_t (&corner)[size], const Vec3d (&gradient)[size]) {
    Row& row = rows_.emplace_back();
    row.stiffness = stiffness;
    row.gradient.reserve(size);
    for (std::size_t k = 0; k < size; ++k) row.gradient.emplace_back(corner[k], gradient[k]);
  }

 private:
  using Vectors = std::vector<Vec3d>;
  struct Row {
    double stiffness;
    std::vector<std::pair<std::size_t, Vec3d>> gradient;
  };
  std::vector<Row> rows_;

  static double sum(const Vectors& a, const Vectors& b) {
    double s = 0;
    for (std::size_t i = 0; i < a.size(); ++i) s += dot(a[i], b[i]);
    return s;
  }

  /// Conjugate gradients, preconditioned by the trace of each particle's block. `free`: 0 for particles that stay, else
  /// 1.
  Vectors solve(const Vectors& load, const std::vector<double>& free) const {
    const std::size_t n = load.size();
    std::vector<double> scale(n, 1e-300);
    for (const Row& row : rows_)
      for (const auto& [i, g] : row.gradient) scale[i] += row.stiffness * length_squared(g);
    Vectors u(n), r(n), z(n), p(n), q(n);
    for (std::size_t i = 0; i < n; ++i) r[i] = free[i] * load[i];
    double before = 1, first = 0;
    for (int iteration = 0; iteration < 20000; ++iteration) {
      for (std::size_t i = 0; i < n; ++i) z[i] = (1 / scale[i]) * r[i];
      const double now = sum(r, z);
      if (iteration == 0) first = now;
      if (!(now > 1e-14 * first)) break;
      for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + (now / before) * p[i];
      before = now;
      apply(p, q);
      for (std::size_t i = 0; i < n; ++i) q[i] = free[i] * q[i];
      const double step = now / sum(p, q);
      for (std::size_t i = 0; i < n; ++i) {
        u[i] += step * p[i];
        r[i] += -step * q[i];
      }
    }
    return u;
  }

  void apply(const Vectors& x, Vectors& out) const {
    out.assign(x.size(), Vec3d{});
    for (const Row& row : rows_) {
      double along = 0;
      for (const auto& [i, g] : row.gradient) along += dot(g, x[i]);
      for (const auto& [i, g] : row.gradient) out[i] += (row.stiffness * along) * g;
    }
  }
};

}  // namespace pliant::testing_support

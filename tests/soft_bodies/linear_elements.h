// The oracle of elastic solids at small strain: linear finite elements of the same tetrahedra and masses, in double
// precision.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/volume_around_edge.h"
#include "math/vector.h"
#include "model/join_volumes.h"
#include "pliant/scene.h"

namespace pliant::testing_support {

/// The stiffness matrix of an object's tetrahedra, as a sum of k g g^T over its rows: six of each tetrahedron for the
/// shear modulus, and one for each volume, which tetrahedra around an edge have in common where they are nearly
/// incompressible, as in the engine.
class LinearElements {
 public:
  explicit LinearElements(const Object& object) : object_(object) {
    std::vector<ConstraintList> lists = gather_constraints(object, 1);
    join_volumes(lists);
    for (const ConstraintList& list : lists)
      for (std::size_t i = 0; i < static_cast<std::size_t>(list.count()); ++i) add(list, i);
  }

  /// The displacements [m] of particles that hang in `gravity` [m/s^2], while those of `pinned` stay.
  std::vector<Vec3d> hang(const Vec3d& gravity, const std::vector<int>& pinned) const {
    std::vector<Vec3d> load;
    load.reserve(object_.masses.size());
    for (const float mass : object_.masses) load.push_back(static_cast<double>(mass) * gravity);
    std::vector<double> free(load.size(), 1);
    for (const int i : pinned) free[static_cast<std::size_t>(i)] = 0;
    return solve(load, free);
  }

 private:
  using Vectors = std::vector<Vec3d>;
  struct Row {
    double stiffness;
    std::vector<std::pair<std::size_t, Vec3d>> gradient;
  };
  const Object& object_;
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

  template <std::size_t size>
  void add(const ConstraintList& list, std::size_t i,
           void (LinearElements::*rows)(const ConstraintList&, std::size_t, const Vec3d (&)[size],
                                        const std::size_t (&)[size])) {
    Vec3d x[size];
    std::size_t corner[size];
    for (std::size_t k = 0; k < size; ++k) {
      corner[k] = static_cast<std::size_t>(list.stencils[size * i + k]);
      x[k] = convert<double>(object_.positions[corner[k]]);
    }
    (this->*rows)(list, i, x, corner);
  }

  void add(const ConstraintList& list, std::size_t i) {
    if (list.type == find_constraint_type(VolumeAroundEdge::name)) return add<8>(list, i, &LinearElements::add_fan);
    if (gives_shape(list.type)) return add<4>(list, i, &LinearElements::add_shear);
    if (belongs_to_solid(list.type)) add<4>(list, i, &LinearElements::add_volume);  // green_trace: the same at rest
  }

  static double stiffness_of(const ConstraintList& list, std::size_t i) {
    return 1 / static_cast<double>(list.response[i]);
  }

  template <std::size_t size>
  void add_row(double stiffness, const std::size_t (&corner)[size], const Vec3d (&gradient)[size]) {
    Row& row = rows_.emplace_back();
    row.stiffness = stiffness;
    row.gradient.reserve(size);
    for (std::size_t k = 0; k < size; ++k) row.gradient.emplace_back(corner[k], gradient[k]);
  }

  void add_volume(const ConstraintList& list, std::size_t i, const Vec3d (&x)[4], const std::size_t (&corner)[4]) {
    Vec3d gradient[4];
    TetrahedronVolume::evaluate<double>(x, TetrahedronVolume::measure<double>(x), gradient);
    add_row(stiffness_of(list, i), corner, gradient);
  }

  void add_fan(const ConstraintList& list, std::size_t i, const Vec3d (&x)[8], const std::size_t (&corner)[8]) {
    Vec3d gradient[8];
    const auto field = [&](std::size_t k) { return static_cast<double>(list.rest[3 * i + k]); };
    VolumeAroundEdge::evaluate<double>(x, {field(0), field(1), field(2)}, gradient);
    add_row(stiffness_of(list, i), corner, gradient);
  }

  /// The energy mu V |e|^2 of the linear strain e; mu V is the stiffness.
  void add_shear(const ConstraintList& list, std::size_t i, const Vec3d (&x)[4], const std::size_t (&corner)[4]) {
    const double stiffness = stiffness_of(list, i);
    const Vec3d a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const double scale = 1 / dot(cross(a, b), c);
    const Vec3d n[4] = {-scale * (cross(b, c) + cross(c, a) + cross(a, b)), scale * cross(b, c), scale * cross(c, a),
                        scale * cross(a, b)};
    for (int component = 0; component < 6; ++component) {
      Vec3d gradient[4];
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3d& m = n[k];
        const Vec3d all[6] = {{m.x, 0, 0}, {0, m.y, 0}, {0, 0, m.z}, {m.y, m.x, 0}, {m.z, 0, m.x}, {0, m.z, m.y}};
        gradient[k] = all[component];
      }
      add_row(component < 3 ? 2 * stiffness : stiffness, corner, gradient);
    }
  }
};

}  // namespace pliant::testing_support

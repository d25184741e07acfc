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
#include "soft_bodies/linear_rows.h"

namespace pliant::testing_support {

/// The stiffness matrix of an object's tetrahedra, as a sum of k g g^T over its rows: six of each tetrahedron for the
/// shear modulus, and one for each volume, which tetrahedra around an edge have in common where they are nearly
/// incompressible, as in the engine.
class LinearElements : public LinearRows {
 public:
  explicit LinearElements(const Object& object) : LinearRows(object) {
    std::vector<ConstraintList> lists = gather_constraints(object, 1);
    join_volumes(lists);
    for (const ConstraintList& list : lists)
      for (std::size_t i = 0; i < static_cast<std::size_t>(list.count()); ++i) add(list, i);
  }

 private:
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

// The oracle of woven cloth at small strain: its distances and triangles, linearised at rest, solved in double
// precision.
#pragma once

#include <cstddef>
#include <cstring>

#include "constraints/distance.h"
#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "soft_bodies/linear_rows.h"

namespace pliant::testing_support {

class LinearWoven : public LinearRows {
 public:
  explicit LinearWoven(const Object& cloth) : LinearRows(cloth) {
    for (const ConstraintGroup& group : cloth.constraints) {
      if (group.type == Distance::name) add<Distance>(group);
      if (group.type == TriangleStretch::name) add<TriangleStretch>(group);
      if (group.type == TriangleShear::name) add<TriangleShear>(group);
    }
  }

 private:
  template <class Type>
  void add(const ConstraintGroup& group) {
    constexpr std::size_t size = static_cast<std::size_t>(Type::slots::count), fields = Type::fields.size();
    for (std::size_t i = 0; i < group.compliances.size(); ++i) {
      Vec3d x[size], gradient[size];
      std::size_t corner[size];
      for (std::size_t k = 0; k < size; ++k) {
        corner[k] = static_cast<std::size_t>(group.particles[size * i + k]);
        x[k] = convert<double>(object_.positions[corner[k]]);
      }
      double rest[fields];
      for (std::size_t k = 0; k < fields; ++k) rest[k] = static_cast<double>(group.rest[fields * i + k]);
      typename Type::template Params<double> params;
      std::memcpy(&params, rest, sizeof params);
      Type::evaluate(x, params, gradient);
      add_row(1 / static_cast<double>(group.compliances[i]), corner, gradient);
    }
  }
};

}  // namespace pliant::testing_support

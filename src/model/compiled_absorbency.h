// A surface that takes up liquid: what its particles hold, and along which edges the liquid spreads.
#pragma once

#include <vector>

#include "pliant/material.h"

namespace pliant {

struct CompiledObject;
struct Object;

struct CompiledAbsorbency {
  /// An edge along which liquid spreads. Flow through it is diffusivity times `weight` times the difference of what
  /// both ends hold on an area.
  struct Edge {
    int a = 0, b = 0;  ///< particles in storage order, a < b
    /// Half the cotangents of the opposite angles at rest (Pinkall and Polthier 1993), 0 if that is negative [-]
    float weight = 0;
    float length = 0;  ///< at rest [m]
  };
  bool is_used = false;
  Absorbency described;
  std::vector<float> areas;  ///< of each particle: a third of its triangles at rest [m^2]
  std::vector<Edge> edges;   ///< ascending by a, then b
};

/// Sets `absorbency` of a compiled object, after fill_triangles.
void compile_absorbency(const Object& object, CompiledObject& out);

}  // namespace pliant

// Sand and gravel as particles.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// What a real granular material is like.
struct GrainKind {
  std::string name;
  float density = 2650;   ///< of the solid [kg/m^3]
  float friction = 0.6f;  ///< of the bulk: tangent of the angle of repose [-]
  float cohesion = 0;     ///< of the bulk: tensile stress at which it parts [Pa]
  std::string source;     ///< where the numbers come from
};

/// Returns a built-in material: "dry sand", "wet sand" or "gravel". For any other name throws an Error that lists the
/// names.
const GrainKind& grain_kind(std::string_view name);

/// All built-in materials of grains.
const std::vector<GrainKind>& grain_kinds();

/// Options of make_grains.
struct GrainsOptions {
  std::string name = "grains";
  Grains grains{};
  Vec3f velocity{};  ///< at the start [m/s]
  Flow flow{};       ///< how particles come and go; `spare` follows from the capacity
  int capacity = 0;  ///< most particles that are there at a time, up to 2^26; 0: those at the start
};

/// Makes grains with centres at given places, a diameter or more apart: fill_box of pliant/liquid.h gives such places.
/// Each has the mass of a solid sphere, and meets colliders at its radius, with the friction of the grains. Throws an
/// Error that names an option that is out of range.
Object make_grains(const std::vector<Vec3f>& positions, const GrainsOptions& options = {});

}  // namespace pliant

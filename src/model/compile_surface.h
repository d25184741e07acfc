// The surface of a compiled object: its triangles, or contact lines if it has none, and the volume that it encloses.
#pragma once

#include <array>
#include <vector>

#include "model/compiled_object.h"

namespace pliant {

void fill_triangles(const Object& object, CompiledObject& out);

/// Lists the triangles around each particle, after fill_triangles.
void fill_corners(CompiledObject& out);

/// The pressure of a volume at a time [s].
double pressure_at(const Volume& volume, double time);
/// The largest pressure that a volume ever has.
double largest_pressure(const Volume& volume);

/// Sets the constraint of volume, after fill_particles and fill_corners. `passes` is that of CompileOptions.
void fill_volume(const Object& object, int passes, CompiledObject& out);

/// The contact lines of an object without triangles: its first group of distance constraints, the links of a rope.
/// Later groups are bending; their lines would always touch the links.
std::vector<std::array<int, 2>> lines_of(const Object& object, const std::vector<int>& place);

}  // namespace pliant

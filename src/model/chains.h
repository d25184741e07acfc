// Distance constraints as paths, and tethers to pins: what the chain sweep works on, compiled.
#pragma once

#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

/// Marks the distances that chains take: compliant and rigid ones between two particles at a distance. What has no
/// direction to solve along (attachments, whose rest length is zero) goes to a list of its own and is swept as before; so
/// are damped and PBD distances, whose answers are not those of one linear system.
void split_off_chains(std::vector<ConstraintList>& lists);

/// Lays the marked lists along paths of the object, whose particles have their places already and whose pools exist.
void append_chains(const std::vector<ConstraintList>& lists, float softness, CompiledObject& out);

/// For each free particle its distance along distance constraints and across the surface's triangles to the nearest pin of
/// each of the four nearest groups of pins, times 1 + slack. Needs the surface.
Tethers find_tethers(const std::vector<ConstraintList>& lists, float slack, const CompiledObject& object);

}  // namespace pliant

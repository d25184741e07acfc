// Facts about one object that decide its sweep: its springs, how it bends, whether it is regular, and how it is held.
#pragma once

#include <cstddef>

#include "pliant/scene.h"

namespace pliant {

/// The number of particles that springs link; 0 without springs. A path has one particle more than springs. Springs are
/// distances with compliance, which multigrid and chains correct; PBD distances are left to the sweeps.
std::size_t linked_particles(const Object& object);

/// True if the bending length (B / rho g)^(1/3) (Peirce 1930), the overhang at which a sheet bends under its own
/// weight, is large compared with its size. Cubes are compared, because machines differ in cube roots.
bool is_stiff_sheet(const Object& object, double gravity);

/// True if most springs continue straight at most of their ends, as on a grid and in a rope: chains are then long and
/// carry a force across the object in one pass.
bool is_regular(const Object& object);

/// True if tethers do not change how an object moves: it hangs from pins or attachments whose distances stay, and is
/// not meant to stretch.
bool may_be_tethered(const Object& object, double gravity);

/// True if more than a tenth of the particles are pinned or attached, as in Cusick's test of drape. What overhangs is
/// short, and bends by the substeps that its strain demands; with tethers there is less strain, so fewer substeps, and
/// cloth that can touch itself drapes too softly.
bool lies_on_pins(const Object& object);

/// True if particles are tied to bodies.
bool has_ties(const Object& object);

/// True if rest lengths of distances change (ConstraintGroup::keyframes), which multigrid and tethers do not see.
bool has_changing_lengths(const Object& object);

/// True if threads without compliance sew particles together, which only chains close under load: multigrid and tethers
/// do not see them.
bool is_sewn(const Object& object);

/// True if pins, attachments or infinite masses hold a part of the object.
bool has_fixed(const Object& object);

}  // namespace pliant

// Continuous tests that tell apart what touches from what passes by a hair: twice double's precision where double finds a
// contact. For audits and for measuring the others; a hundred times as slow where there is contact. For hosts only.
#pragma once

#include "geometry/continuous.h"

namespace pliant {

/// As vertex_triangle_impact, but what passes by at more than 1e-29 of the extent is no contact.
Impact<double> sharp_vertex_triangle_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

/// As edge_edge_impact, but what passes by at more than 1e-29 of the extent is no contact.
Impact<double> sharp_edge_edge_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness);

}  // namespace pliant

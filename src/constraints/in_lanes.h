// The constraint types that are swept in lanes: one row over points. They come first of all types (all.h), so that
// their numbers are their places in this list, and what sweeps them need not know the others.
#pragma once

#include "constraints/corotational_strain.h"
#include "constraints/dihedral_bending.h"
#include "constraints/distance.h"
#include "constraints/distance_limit.h"
#include "constraints/fibre.h"
#include "constraints/green_strain.h"
#include "constraints/isometric_bending.h"
#include "constraints/tetrahedron_shear.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/traits.h"
#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "constraints/type_list.h"
#include "constraints/volume_around_edge.h"

namespace pliant {

using LaneConstraints =
    TypeList<Distance, DihedralBending, IsometricBending, Fibre, TetrahedronShear, TetrahedronVolume, TriangleShear,
             TriangleStretch, DistanceLimit, VolumeAroundEdge, CorotationalStrain, GreenStrain, GreenTrace>;

}  // namespace pliant

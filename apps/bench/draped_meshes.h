// Cotton sheets that fall over meshes of a folder, for the table of scene_table.h (`pliant bench default --meshes`).
#pragma once

#include <string>
#include <vector>

#include "apps/bench/scene_table.h"

namespace pliant::bench {

/// A scene for each mesh file (.obj, .ply, .stl) of a folder and the folders below it, in the order of their paths: the
/// mesh, scaled to half a metre, stands on the ground as a collider, and a cotton sheet of 1 m with 100 x 100 particles
/// and self-collision falls over it from 2 cm above. Sweep and substeps are left open. Throws an Error if the folder
/// holds no mesh, or if a mesh cannot be read.
std::vector<NamedScene> draped_meshes(const std::string& folder);

/// The scene of one mesh, in metres of any size.
Scene draped_mesh(const TriangleMesh& mesh);

}  // namespace pliant::bench

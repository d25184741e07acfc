// Reads meshes and robots from the bytes of a file: of databases, networks, archives and other languages. Scenes have
// parse_scene_file (io.h), States and Worlds load_state_bytes and load_world_bytes (save.h). Part of the library
// pliant_io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/io.h"

namespace pliant {

/// Reads a mesh from the bytes of an .obj, .ply or .stl file, as read_mesh_file does. The suffix of `name`, as in
/// "shirt.obj", says the format unless the bytes do; `name` stands for the file in errors. Throws an Error as
/// read_mesh_file does.
MeshFile parse_mesh(std::string_view bytes, const std::string& name, const MeshReadOptions& options = {});

/// Reads a tetrahedral mesh from the bytes of a file, as read_tetrahedral_mesh does. The suffix of `name` says the
/// format: .msh, .vtk, .vtu, .mesh, .meshb or .t. Throws an Error as read_tetrahedral_mesh does.
TetrahedralMeshFile parse_tetrahedral_mesh(std::string_view bytes, const std::string& name);

/// Reads a tetrahedral mesh of TetGen from the bytes of its .node file and of its .ele file. In errors they are `name`
/// with these suffixes.
TetrahedralMeshFile parse_tetgen(std::string_view nodes, std::string_view elements, const std::string& name = "tetgen");

/// Reads a robot description from the text of a URDF file, as read_urdf does. `name` stands for the file in errors and
/// warnings. Paths of meshes are relative to `folder`; UrdfOptions::meshes gives meshes in memory. Throws an Error as
/// read_urdf does.
Object parse_urdf(std::string_view text, const std::string& name = "robot.urdf", const std::string& folder = ".",
                  const UrdfOptions& options = {}, std::vector<std::string>* warnings = nullptr);

}  // namespace pliant

// What the fuzzers of mesh readers share. Any bytes must give a valid mesh or an Error, and nothing else.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "io/mesh_polygons.h"
#include "pliant/error.h"

namespace pliant::fuzz {

inline int read_as(const char* name, const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const MeshReadOptions as_it_is{false, false, false};
  for (const MeshReadOptions& options : {MeshReadOptions{}, as_it_is}) try {
      const TriangleMesh mesh = parse_mesh(bytes, name, options).mesh;
      if (mesh.triangles.empty()) std::abort();
      for (const auto& triangle : mesh.triangles)
        for (const int corner : triangle)
          if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.positions.size()) std::abort();
      for (const Vec3f& p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
      inspect(mesh);
    } catch (const Error& error) {
      if (error.problem().empty()) std::abort();
    }
  return 0;
}

}  // namespace pliant::fuzz

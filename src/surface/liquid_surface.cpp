// The surface of a liquid: particles are sorted into cells, get kernels, and these are summed on a sparse grid, whose
// level becomes a mesh.
#include "pliant/surface.h"

#include <cmath>
#include <string>
#include <utility>

#include "pliant/error.h"
#include "surface/marching_cubes.h"
#include "surface/smooth_mesh.h"

namespace pliant {

namespace {

void require(bool is_right, const char* option, const std::string& advice) {
  if (!is_right) throw Error(Location{.element = option}, "is out of range", advice);
}

void require_options(const SurfaceOptions& options) {
  const float spacing = options.spacing;
  require(spacing > 1e-9f && spacing < 1e9f, "spacing",
          "give the distance of particles at rest in metres, 1e-9 to 1e9");
  const bool is_right = options.cell == 0 || (options.cell >= spacing / 8 && options.cell <= spacing);
  require(is_right, "cell", "give 0, or an eighth of the spacing to the spacing");
  require(options.smoothing >= 0 && options.smoothing <= 100, "smoothing", "give 0 to 100 passes");
  require(options.threads >= 0, "threads", "give 0 for all hardware threads, or their number");
}

/// Throws an Error for the first position that is not finite, or so far away that a float cannot tell neighbours apart.
void require_positions(std::span<const Vec3f> positions, float spacing) {
  const float most = 1e6f * spacing;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float away = largest(positions[i]), sum = positions[i].x + positions[i].y + positions[i].z;
    if (away <= most && sum == sum) continue;
    const Location where{.element = "particle " + std::to_string(i)};
    if (!std::isfinite(sum))
      throw Error(where, "has a position that is not finite", "leave it out, or find what made it so");
    throw Error(where, "is farther from the origin than a million spacings",
                "leave it out, or move the liquid to the origin");
  }
}

/// What is needed only to make the field is freed before there is a mesh.
surface::Field field_of(std::span<const Vec3f> positions, const SurfaceOptions& options, Executor& executor) {
  const surface::ParticleCells cells = surface::sort_into_cells(positions, options.spacing, executor);
  const surface::Splats splats = surface::make_splats(cells, options.spacing, options.anisotropic, executor);
  return surface::make_field(cells, splats, options.cell > 0 ? options.cell : options.spacing / 2, executor);
}

}  // namespace

TriangleMesh liquid_surface(std::span<const Vec3f> positions, const SurfaceOptions& options) {
  require_options(options);
  require_positions(positions, options.spacing);
  if (positions.empty()) return {};
  Executor executor(options.threads);
  TriangleMesh mesh;
  executor.enter([&] {
    surface::LinkedMesh linked = surface::marching_cubes(field_of(positions, options, executor), executor);
    surface::smooth(linked, options.smoothing, executor);
    mesh = surface::unlinked(std::move(linked), executor);
  });
  return mesh;
}

}  // namespace pliant

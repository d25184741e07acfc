// Skins: surfaces that follow the tetrahedra of a soft body.
#include <cmath>
#include <string>

#include "matter/cut_faces.h"
#include "matter/tetrahedron_query.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace pliant {

Skin make_skin(const Object& soft_body, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < soft_body.positions.size(); ++i)
    if (const Vec3f& p = soft_body.positions[i]; !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error({.object = soft_body.name, .element = "particle " + std::to_string(i)},
                  "has a position that is not finite", "give finite coordinates in metres");
  const TetrahedronQuery query(soft_body.positions, required_tetrahedra(soft_body, "make a skin of a soft body"));
  Skin skin;
  skin.triangles = mesh.triangles;
  skin.vertices.reserve(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f& place = mesh.positions[v];
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z))
      throw Error({.object = soft_body.name, .element = "vertex " + std::to_string(v) + " of the skin"},
                  "is not finite", "give finite coordinates in metres");
    const PlaceInTetrahedron found = query.nearest(place);
    SkinVertex vertex;
    vertex.particles = query.tetrahedron(found.tetrahedron);
    for (std::size_t i = 0; i < 4; ++i) vertex.weights[i] = static_cast<float>(found.weights[i]);
    skin.vertices.push_back(vertex);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int corner : mesh.triangles[t])
      if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.positions.size())
        throw Error({.object = soft_body.name, .element = "triangle " + std::to_string(t) + " of the skin"},
                    "uses a vertex that does not exist", "indices count from 0");
  return skin;
}

std::vector<Vec3f> skinned(const Skin& skin, const std::vector<Vec3f>& particles) {
  for (std::size_t v = 0; v < skin.vertices.size(); ++v)
    for (const int p : skin.vertices[v].particles)
      if (p < 0 || static_cast<std::size_t>(p) >= particles.size())
        throw Error({.element = "skin vertex " + std::to_string(v)},
                    "uses particle " + std::to_string(p) + " of " + std::to_string(particles.size()),
                    "give the positions of the object that the skin was made for");
  std::vector<Vec3f> out;
  out.reserve(skin.vertices.size());
  for (const SkinVertex& vertex : skin.vertices) {
    Vec3d sum{};
    for (std::size_t i = 0; i < 4; ++i)
      sum = sum + convert<double>(particles[static_cast<std::size_t>(vertex.particles[i])]) *
                      static_cast<double>(vertex.weights[i]);
    out.push_back(convert<float>(sum));
  }
  return out;
}

}  // namespace pliant

// Elastic solids of tetrahedra: gelatine, rubber, foam, muscle.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/scene.h"

namespace pliant {

/// A mesh of tetrahedra. Seen from its fourth corner, the first three corners run counter-clockwise, so that its volume
/// is positive; make_soft_body turns those that are not.
struct TetrahedralMesh {
  std::vector<Vec3f> positions;                ///< [m]
  std::vector<std::array<int, 4>> tetrahedra;  ///< indices of positions
};

/// How the energy of an elastic solid grows with its strain. All agree with Hooke's law at small strain, however much
/// it turns.
enum class SolidModel {
  neo_hookean,   ///< rubber and flesh; holds at any strain (Smith, de Goes and Kim 2018)
  corotational,  ///< stress grows with the strain in the nearest rotation (Stomakhin, Howes, Schroeder and Teran 2012)
  st_venant_kirchhoff,  ///< stress grows with Green's strain: stiffer where it is pulled; gives way where it is pressed below 0.58 of its length
};

/// Properties of an elastic solid. They do not depend on a mesh.
struct ElasticSolid {
  std::string name;
  float density = 1000;           ///< mass per volume [kg/m^3]
  float youngs_modulus = 5e4f;    ///< stress per strain of a bar that is pulled, > 0 [Pa]
  float poisson_ratio = 0.45f;    ///< how much narrower the bar becomes per strain, 0..0.495 [-]
  float damping = 0;              ///< stress over elastic modulus and rate of strain [s]
  float static_friction = 0.6f;   ///< coefficient of friction at rest [-]
  float kinetic_friction = 0.5f;  ///< coefficient of friction while sliding [-]
  std::string source;             ///< where the numbers come from
  /// Strain beyond which it keeps the new shape, and how fast that flows; none: elastic. Only its shape flows, its
  /// volume does not.
  std::optional<Plasticity> plasticity{};
  SolidModel model{};
};

/// Returns a built-in elastic solid: "gelatine", "rubber", "foam" or "muscle". For any other name throws an Error that
/// lists the names.
const ElasticSolid& elastic_solid(std::string_view name);

/// All built-in elastic solids.
const std::vector<ElasticSolid>& elastic_solids();

/// Fibres in an elastic solid, which stiffen it along a direction, and shorten where it is a muscle.
struct Fibres {
  Vec3f direction{1, 0, 0};         ///< of all fibres, in the rest shape; of any length but 0
  std::vector<Vec3f> directions{};  ///< instead: one for each tetrahedron of the mesh; (0, 0, 0): it has none
  float modulus = 1e5f;             ///< stress per strain along the fibre, besides that of the solid, > 0 [Pa]
  /// The length that fibres want over their length at rest: 0.6 where a muscle contracts by 40 %. At times, as
  /// ConstraintGroup::keyframes; ObjectHandle::set_rest_factor sets it by call. None: always 1.
  std::vector<RestKeyframe> stretch{};
};

/// Options of make_soft_body.
struct SoftBodyOptions {
  std::string name = "soft_body";
  ElasticSolid material{};
  Vec3f velocity{};          ///< at the start [m/s]
  float thickness = 0.001f;  ///< Object::thickness: distance that its surface keeps [m]
  std::optional<Fibres> fibres{};
  /// Of the edges of its tetrahedra; none: it stretches as far as it is pulled.
  std::optional<StrainLimit> strain_limit{};
};

/// Makes an elastic body of a tetrahedral mesh, which becomes its rest shape: of each tetrahedron a quarter of the mass
/// at each corner, and two constraints, on its shape and on its volume, which together are the solid of its model and
/// its Lame coefficients (as a pair of constraints: Macklin and Mueller 2021). Its border is its surface, and collides
/// with other objects; with itself only if Object::self_collision is set. Corners that no tetrahedron uses are dropped.
/// Throws an Error that names a tetrahedron that cannot be used, or an option that is out of range.
Object make_soft_body(const TetrahedralMesh& mesh, const SoftBodyOptions& options = {});

/// The tetrahedra of a soft body: particles of the Object, in the order of its constraints on shape. Empty for other
/// objects.
std::vector<std::array<int, 4>> tetrahedra_of(const Object& object);

/// The triangles that belong to one tetrahedron alone, counter-clockwise seen from outside. Throws an Error that names
/// a tetrahedron that shares a face with two others.
std::vector<std::array<int, 3>> border_triangles(const TetrahedralMesh& mesh);

/// How the cubes of a box are cut into six tetrahedra about a diagonal.
enum class BoxCut {
  alike,    ///< all along the same diagonal: what is dropped level bounces aside (docs/internals/solids.md)
  mirrored  ///< as mirror images on both sides of the middle of each axis, if the number of cubes along it is even
};

/// A box about the origin of `cells` cubes along each axis, each cut into six tetrahedra about a diagonal (Kuhn 1960),
/// so that faces match. Throws an Error unless the sizes are positive and there are 1 to 2^24 cells.
TetrahedralMesh box_tetrahedra(const Vec3f& size, const std::array<int, 3>& cells, BoxCut cut = BoxCut::alike);

/// A tetrahedral mesh that was made of a surface, and what there is to say about it.
struct FilledMesh {
  TetrahedralMesh mesh;
  std::vector<std::string> notes;
};

/// Fills what a closed mesh encloses with tetrahedra whose edges are about `size` long [m], cut from a body-centred
/// cubic lattice; its border is moved onto the mesh where no tetrahedron becomes flat. Parts thinner than `size` may be
/// lost, and a note says so. A surface that passes through itself encloses where it winds around. Throws an Error if
/// the mesh has an edge without two triangles, encloses nothing at that size, or there would be more than 2^22 nodes.
FilledMesh fill_with_tetrahedra(const TriangleMesh& mesh, float size);

/// Makes a Skin of a mesh in the rest shape of a soft body: each vertex follows the tetrahedron that it lies in, or the
/// nearest one. Throws an Error if the object has no tetrahedra, or a vertex is not finite.
Skin make_skin(const Object& soft_body, const TriangleMesh& mesh);

/// The vertices of a skin where an object's particles have these positions (or velocities, and the like).
std::vector<Vec3f> skinned(const Skin& skin, const std::vector<Vec3f>& particles);

}  // namespace pliant

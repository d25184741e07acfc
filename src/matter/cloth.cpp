// Makes cloth of a triangle mesh: masses by area, a distance constraint for each edge, a bending constraint for each
// inner edge.
//
// Stiffness is a material property, so each compliance follows from the area that its edge represents. A finer mesh of
// the same piece then stretches and folds alike. All values are computed in double and rounded once.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "constraints/dihedral_bending.h"
#include "constraints/isometric_bending.h"
#include "math/vector.h"
#include "matter/irregular_springs.h"
#include "matter/strain_limit.h"
#include "pliant/error.h"
#include "pliant/scene.h"
#include "topology/boundary.h"
#include "topology/edges.h"

namespace pliant {

namespace {

/// Upper limit of compliances. Larger ones have no effect, and divided by h^2 they would overflow a float.
constexpr double largest_compliance = 1e12;

float as_compliance(double alpha) { return static_cast<float>(std::min(alpha, largest_compliance)); }

std::string name_of(const Edge& edge) { return "edge " + std::to_string(edge.a) + "-" + std::to_string(edge.b); }

/// A mesh being converted to cloth, with its measurements.
struct ClothDraft {
  const TriangleMesh& mesh;
  const ClothOptions& options;
  std::vector<Triangle> triangles;  ///< triangles, wound consistently if possible
  std::vector<Edge> edges;
  std::vector<double> areas;   ///< area of each triangle [m^2]
  std::vector<double> masses;  ///< mass of each particle [kg]

  Vec3d at(int vertex) const {
    const Vec3f& p = mesh.positions[static_cast<std::size_t>(vertex)];
    return {p.x, p.y, p.z};
  }
  int vertex_count() const { return static_cast<int>(mesh.positions.size()); }
  void find_edges_again() { edges = find_edges(triangles, vertex_count()); }

  /// The total area of the one or two triangles at an edge [m^2].
  double area_at(const Edge& edge) const {
    double area = 0;
    for (int t : edge.triangles)
      if (t >= 0) area += areas[static_cast<std::size_t>(t)];
    return area;
  }

  [[noreturn]] void refuse(const std::string& element, const std::string& problem, const std::string& advice) const {
    throw Error({"", 0, options.name, element}, problem, advice);
  }
};

// ------------------------------------------------------------------------------------------------ validation

void require_fraction(const ClothDraft& piece, const char* field, float value) {
  if (!(value >= 0 && value <= 1)) piece.refuse(field, "is " + std::to_string(value), "give 0 to 1");
}

void require_material(const ClothDraft& piece) {
  const Fabric& m = piece.options.material;
  const auto refuse = [&](const char* field, float value, const char* advice) {
    piece.refuse(std::string("material, ") + field, "is " + std::to_string(value), advice);
  };
  if (!(m.area_density > 0) || std::isinf(m.area_density))
    refuse("area_density", m.area_density, "give more than 0 kg/m^2");
  if (!(m.thickness >= 0) || std::isinf(m.thickness)) refuse("thickness", m.thickness, "give 0 m or more");
  if (!(m.stretch_stiffness > 0))
    refuse("stretch_stiffness", m.stretch_stiffness, "give more than 0 N/m; infinity makes it inextensible");
  if (!(m.weft_stiffness >= 0)) refuse("weft_stiffness", m.weft_stiffness, "give 0 N/m or more");
  if (!(m.shear_stiffness >= 0)) refuse("shear_stiffness", m.shear_stiffness, "give 0 N/m or more");
  if (!(m.bending_stiffness >= 0)) refuse("bending_stiffness", m.bending_stiffness, "give 0 N m or more");
  require_fraction(piece, "material, bending_damping", m.bending_damping);
}

void require_positions(const ClothDraft& piece) {
  if (piece.mesh.positions.empty() || piece.mesh.triangles.empty())
    piece.refuse("", "the mesh has no triangle", "cloth needs at least one");
  for (int v = 0; v < piece.vertex_count(); ++v) {
    const Vec3d p = piece.at(v);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      piece.refuse("vertex " + std::to_string(v), "is not finite", "give finite coordinates in metres");
  }
}

/// Throws an Error if a triangle occurs twice. Edges of three or more triangles are allowed: they get no hinge.
void require_distinct_triangles(const ClothDraft& piece) {
  for (const Edge& edge : piece.edges) {
    if (edge.is_inner() && edge.opposites[0] == edge.opposites[1])
      piece.refuse("triangle " + std::to_string(edge.triangles[1]),
                   "has the same corners as triangle " + std::to_string(edge.triangles[0]), "remove one of them");
  }
}

// ------------------------------------------------------------------------------------------------ winding

/// Six times the volume that the triangles enclose [m^3].
double six_volumes(const ClothDraft& piece) {
  double sum = 0;
  for (const Triangle& t : piece.triangles) {
    // Positions are relative to a vertex, so that a balloon far from the origin keeps its precision.
    const Vec3d origin = piece.at(0);
    sum += dot(cross(piece.at(t[0]) - origin, piece.at(t[1]) - origin), piece.at(t[2]) - origin);
  }
  return sum;
}

/// Makes the winding of triangles consistent, for pictures and balloons. Distances and hinges do not need
/// it.
void wind_alike(ClothDraft& piece) {
  if (is_wound_consistently(piece.edges)) return;
  const Pieces pieces = find_pieces(piece.edges, static_cast<int>(piece.triangles.size()));
  if (piece.options.volume && !pieces.one_sided_edges.empty())
    piece.refuse(name_of(piece.edges[static_cast<std::size_t>(pieces.one_sided_edges.front())]),
                 "has triangles that cannot be wound alike: the surface is one-sided, like a Moebius strip",
                 "leave out the volume, or give a closed surface");
  flip(piece.triangles, pieces.flipped);
  piece.find_edges_again();
}

/// Throws an Error unless the mesh is closed, as balloons require. Flips all triangles if they face inward.
void require_balloon(ClothDraft& piece) {
  for (const Edge& edge : piece.edges) {
    if (edge.is_border())
      piece.refuse(name_of(edge), "is open", "a balloon needs a closed mesh: fill the hole or remove the volume");
    if (edge.triangle_count > 2)
      piece.refuse(name_of(edge), "joins " + std::to_string(edge.triangle_count) + " triangles",
                   "a balloon needs two triangles at every edge: split the mesh there");
  }
  const double volume = six_volumes(piece);
  if (!(std::fabs(volume) > 0)) piece.refuse("", "the mesh encloses no volume", "remove the volume");
  if (volume > 0) return;
  for (Triangle& t : piece.triangles) std::swap(t[1], t[2]);
  piece.find_edges_again();
}

// ------------------------------------------------------------------------------------------------ masses

void measure_areas(ClothDraft& piece) {
  piece.areas.reserve(piece.triangles.size());
  for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
    const Triangle& corners = piece.triangles[t];
    const Vec3d origin = piece.at(corners[0]);
    const Vec3d normal = cross(piece.at(corners[1]) - origin, piece.at(corners[2]) - origin);
    const double area = std::sqrt(length_squared(normal)) / 2;
    if (!(area > 0) || !std::isfinite(area))
      piece.refuse("triangle " + std::to_string(t), area > 0 ? "is too large" : "has no area",
                   area > 0 ? "scale the mesh to metres" : "remove it; mesh files are read without such");
    piece.areas.push_back(area);
  }
}

/// Gives each particle a third of the mass of each of its triangles.
void lump_masses(ClothDraft& piece) {
  piece.masses.assign(piece.mesh.positions.size(), 0);
  const double density = piece.options.material.area_density;
  for (std::size_t t = 0; t < piece.triangles.size(); ++t)
    for (int corner : piece.triangles[t])
      piece.masses[static_cast<std::size_t>(corner)] += density * piece.areas[t] / 3;
  for (std::size_t v = 0; v < piece.masses.size(); ++v) {
    const std::string vertex = "vertex " + std::to_string(v);
    if (piece.masses[v] == 0) piece.refuse(vertex, "belongs to no triangle, so it has no mass", "drop it");
    if (!(piece.masses[v] > 1e-30 && piece.masses[v] < 1e30))
      piece.refuse(vertex, "would weigh " + std::to_string(piece.masses[v]) + " kg", "scale the mesh to metres");
  }
}

// ------------------------------------------------------------------------------------------------ constraints

/// How much softer the springs are than Y says, because the triangles are irregular (matter/irregular_springs.h).
double softness_of_springs(const ClothDraft& piece) {
  std::vector<Vec3d> positions;
  std::vector<double> areas;
  positions.reserve(piece.mesh.positions.size());
  areas.reserve(piece.edges.size());
  for (int v = 0; v < piece.vertex_count(); ++v) positions.push_back(piece.at(v));
  for (const Edge& edge : piece.edges) areas.push_back(piece.area_at(edge));
  return softness_of({positions, piece.triangles, piece.edges, areas});
}

/// Makes the distance constraints. An edge represents the strip of material beside it: alpha = L^2 / (Y (A1 + A2)) (Van
/// Gelder 1998), over the softness of the mesh.
ConstraintGroup stretch_group(const ClothDraft& piece) {
  ConstraintGroup group;
  group.type = "distance";
  double stiffness = piece.options.material.stretch_stiffness;
  const bool measured = !piece.options.stretch && std::isfinite(stiffness);
  if (measured) stiffness *= softness_of_springs(piece);
  if (piece.options.stretch) group.stiffness = *piece.options.stretch;
  group.particles.reserve(2 * piece.edges.size());
  group.rest.reserve(piece.edges.size());
  if (measured) group.compliances.reserve(piece.edges.size());
  for (const Edge& edge : piece.edges) {
    const double squared = length_squared(piece.at(edge.b) - piece.at(edge.a));
    group.particles.push_back(edge.a);
    group.particles.push_back(edge.b);
    group.rest.push_back(static_cast<float>(std::sqrt(squared)));
    if (measured) group.compliances.push_back(as_compliance(squared / (stiffness * piece.area_at(edge))));
  }
  return group;
}

/// The two directions of a triangle's yarns at rest, as shares of its first two edges: D^-1 d of the constraint types.
struct Yarns {
  std::array<float, 2> warp{}, weft{};
};

Yarns yarns_of(const ClothDraft& piece, std::size_t triangle) {
  const Triangle& t = piece.triangles[triangle];
  const Vec3d edge1 = piece.at(t[1]) - piece.at(t[0]), edge2 = piece.at(t[2]) - piece.at(t[0]);
  const Vec3d across = cross(edge1, edge2), normal = across * (1 / length(across));
  Vec3d warp = edge1;
  for (const Vec3d& wanted : {convert<double>(piece.options.warp), Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    warp = wanted - normal * dot(wanted, normal);
    if (length_squared(warp) > 1e-6 * length_squared(wanted)) break;  // else the yarns go through the triangle
  }
  warp = warp * (1 / length(warp));
  const auto shares = [&](const Vec3d& d) {
    return std::array<float, 2>{static_cast<float>(dot(cross(d, edge2), normal) / length(across)),
                                static_cast<float>(dot(cross(edge1, d), normal) / length(across))};
  };
  return {shares(warp), shares(cross(normal, warp))};
}

/// The sine of the angle within which an edge lies along a yarn.
constexpr double along_yarn = 1e-3;

/// The edge of a triangle that lies along a direction, shares of its first two edges: the number of its first corner;
/// -1: none.
int edge_along(const ClothDraft& piece, std::size_t triangle, const std::array<float, 2>& shares) {
  const Triangle& t = piece.triangles[triangle];
  const double a1 = static_cast<double>(shares[0]), a2 = static_cast<double>(shares[1]);
  // The gradients of the three corners: that of the corner opposite to an edge along the yarn is zero.
  const double a[3] = {-a1 - a2, a1, a2};
  int best = -1;
  double least = along_yarn;
  for (int k = 0; k < 3; ++k) {
    const int b = (k + 1) % 3, c = (k + 2) % 3;
    const double length = std::sqrt(length_squared(piece.at(t[c]) - piece.at(t[b])));
    const double height = 2 * piece.areas[triangle] / length, sine = std::fabs(a[k]) * height;
    if (sine < least) {
      least = sine;
      best = b;
    }
  }
  return best;
}

/// The stretch of woven cloth. Of a triangle with an edge along a yarn, the yarn's stretch is that of the edge: a
/// distance, which chains solve whatever the mesh. A modulus Y of the areas A beside an edge of length L has the
/// compliance L^2 / (Y A).
struct YarnGroups {
  ConstraintGroup edges, triangles;
};

void add_triangle_stretch(const ClothDraft& piece, std::size_t t, const std::array<float, 2>& a, double stiffness,
                          ConstraintGroup& group) {
  group.particles.insert(group.particles.end(), piece.triangles[t].begin(), piece.triangles[t].end());
  group.rest.insert(group.rest.end(), {1, a[0], a[1]});
  group.compliances.push_back(as_compliance(1 / (stiffness * piece.areas[t])));
}

YarnGroups yarn_groups(const ClothDraft& piece) {
  YarnGroups groups;
  groups.edges.type = "distance";
  groups.triangles.type = "triangle_stretch";
  const Fabric& m = piece.options.material;
  const double warp = m.stretch_stiffness, weft = m.weft_stiffness > 0 ? m.weft_stiffness : m.stretch_stiffness;
  std::map<std::pair<int, int>, double> forces;  // of edges: modulus times area [N m]
  for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
    const Yarns yarns = yarns_of(piece, t);
    for (const bool is_warp : {true, false}) {
      const std::array<float, 2>& a = is_warp ? yarns.warp : yarns.weft;
      const double stiffness = is_warp ? warp : weft;
      const int first = edge_along(piece, t, a);
      if (first < 0) {
        add_triangle_stretch(piece, t, a, stiffness, groups.triangles);
        continue;
      }
      const int v0 = piece.triangles[t][first], v1 = piece.triangles[t][(first + 1) % 3];
      forces[{std::min(v0, v1), std::max(v0, v1)}] += stiffness * piece.areas[t];
    }
  }
  groups.edges.particles.reserve(2 * forces.size());
  for (const auto& [ends, force] : forces) {
    const double squared = length_squared(piece.at(ends.second) - piece.at(ends.first));
    groups.edges.particles.push_back(ends.first);
    groups.edges.particles.push_back(ends.second);
    groups.edges.rest.push_back(static_cast<float>(std::sqrt(squared)));
    groups.edges.compliances.push_back(as_compliance(squared / force));
  }
  return groups;
}

/// A fabric that does not say has a hundredth of its stretch stiffness, as woven ones have about.
double shear_stiffness(const Fabric& material) {
  constexpr double of_stretch = 0.01;
  return material.shear_stiffness > 0 ? material.shear_stiffness : of_stretch * material.stretch_stiffness;
}

/// The same for the shear of each triangle.
ConstraintGroup shear_group(const ClothDraft& piece) {
  ConstraintGroup group;
  group.type = "triangle_shear";
  for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
    const Yarns yarns = yarns_of(piece, t);
    group.particles.insert(group.particles.end(), piece.triangles[t].begin(), piece.triangles[t].end());
    group.rest.insert(group.rest.end(), {yarns.warp[0], yarns.warp[1], yarns.weft[0], yarns.weft[1]});
    group.compliances.push_back(as_compliance(1 / (shear_stiffness(piece.options.material) * piece.areas[t])));
  }
  return group;
}

/// Grinspun et al. 2003 and Bergou et al. 2006 give a hinge the energy B/2 . 3 |e|^2 / (A1 +
/// A2) . theta^2; here it is a third of that. Theirs holds for equal curvature in all
/// directions. Cloth hardly stretches, so it curves in one direction: only hinges across the
/// roll bend, and the mean of their squares is three times that of one curvature. Without the
/// factor 3 a roll of radius R stores B / (2 R^2) per area, which defines flexural rigidity.
constexpr double share_of_rolled_sheet = 3;

/// The compliance of the bending constraint at an inner edge [1/(N m)].
double hinge_compliance(const ClothDraft& piece, const Edge& edge, bool isometric) {
  const double stiffness = piece.options.material.bending_stiffness;
  if (isometric) return share_of_rolled_sheet / stiffness;
  return piece.area_at(edge) / (length_squared(piece.at(edge.b) - piece.at(edge.a)) * stiffness);
}

/// Squared lengths of a hinge's gradients in the rest shape. For isometric bending these are constant: coefficients
/// times one direction.
std::array<double, 4> squared_gradients(const Vec3d (&x)[4], bool isometric) {
  if (isometric) {
    const auto k = IsometricBending::measure(x);
    const double k0 = k.k1 + k.k2 + k.k3;
    return {k0 * k0, k.k1 * k.k1, k.k2 * k.k2, k.k3 * k.k3};
  }
  Vec3d g[4];
  DihedralBending::evaluate(x, DihedralBending::Params<double>{0}, g);
  return {length_squared(g[0]), length_squared(g[1]), length_squared(g[2]), length_squared(g[3])};
}

/// A single hinge is an oscillator of mass 1 / w and stiffness 1 / alpha, with w
/// = sum of w_i |grad_i C|^2. Its critical damping is 2 / sqrt(w alpha) [N m s].
double critical_damping(const ClothDraft& piece, const int* v, double compliance, bool isometric) {
  const Vec3d x[4] = {piece.at(v[0]), piece.at(v[1]), piece.at(v[2]), piece.at(v[3])};
  const std::array<double, 4> squared = squared_gradients(x, isometric);
  double inverse_mass = 0;
  for (std::size_t i = 0; i < 4; ++i) inverse_mass += squared[i] / piece.masses[static_cast<std::size_t>(v[i])];
  return 2 / std::sqrt(inverse_mass * compliance);
}

/// Sets the compliance of each hinge, and the damping coefficient of their group as a share of their mean critical
/// damping.
void apply_material(const ClothDraft& piece, ConstraintGroup& group, bool isometric) {
  const double fraction = piece.options.material.bending_damping;
  const std::size_t count = group.particles.size() / 4;
  double critical = 0;
  group.compliances.reserve(count);
  for (const Edge& edge : piece.edges) {
    if (!edge.is_inner()) continue;
    const int* hinge = &group.particles[4 * group.compliances.size()];
    const double compliance = hinge_compliance(piece, edge, isometric);
    if (fraction > 0) critical += critical_damping(piece, hinge, compliance, isometric);
    group.compliances.push_back(as_compliance(compliance));
  }
  if (count == 0) return;
  group.stiffness.damping =
      static_cast<float>(std::min(fraction * critical / static_cast<double>(count), largest_compliance));
}

/// Makes the bending constraints. Their rest angles are left out; the constraint type computes them later.
ConstraintGroup bending_group(const ClothDraft& piece) {
  const bool isometric = piece.options.bending_model == ClothOptions::Bending::isometric;
  ConstraintGroup group;
  group.type = isometric ? "isometric_bending" : "dihedral_bending";
  group.particles.reserve(4 * piece.edges.size());
  for (const Edge& edge : piece.edges) {
    if (!edge.is_inner()) continue;
    const Hinge h = hinge_of(edge);
    for (int v : {h.v0, h.v1, h.v2, h.v3}) group.particles.push_back(v);
  }
  if (piece.options.bending)
    group.stiffness = *piece.options.bending;
  else if (std::isfinite(piece.options.material.bending_stiffness))
    apply_material(piece, group, isometric);
  group.plasticity = piece.options.bending_plasticity;
  return group;
}

bool bends(const ClothOptions& options) {
  return options.bending_model != ClothOptions::Bending::none &&
         (options.bending || options.material.bending_stiffness > 0);
}

void require_yarns(const ClothDraft& piece) {
  const ClothOptions& options = piece.options;
  if (options.stretch_model == ClothOptions::Stretching::springs) return;
  if (options.stretch)
    piece.refuse(
        "stretch", "is the stiffness of edges, which woven cloth does not have",
        "give the material's stretch_stiffness, weft_stiffness and shear_stiffness, or leave stretch_model out");
  const double squared = length_squared(convert<double>(options.warp));
  if (!(squared > 1e-30 && squared < 1e30))
    piece.refuse("warp", "is not a direction", "give a finite vector of any length but 0");
}

Object assemble(ClothDraft& piece) {
  const ClothOptions& options = piece.options;
  Object cloth;
  cloth.name = options.name;
  cloth.positions = piece.mesh.positions;
  cloth.masses.assign(piece.masses.begin(), piece.masses.end());
  if (!(options.velocity == Vec3f{})) cloth.velocities.assign(cloth.positions.size(), options.velocity);
  if (options.stretch_model == ClothOptions::Stretching::springs) {
    cloth.constraints.push_back(stretch_group(piece));
  } else {
    YarnGroups yarns = yarn_groups(piece);
    for (ConstraintGroup* group : {&yarns.edges, &yarns.triangles})
      if (!group->particles.empty()) cloth.constraints.push_back(std::move(*group));
    cloth.constraints.push_back(shear_group(piece));
  }
  if (bends(options)) cloth.constraints.push_back(bending_group(piece));
  if (options.strain_limit) {
    std::vector<std::array<int, 2>> edges;
    for (const Edge& edge : piece.edges) edges.push_back({edge.a, edge.b});
    cloth.constraints.push_back(limit_edges(cloth.positions, std::move(edges), *options.strain_limit, options.name));
  }
  if (cloth.constraints.back().particles.empty()) cloth.constraints.pop_back();
  cloth.triangles = std::move(piece.triangles);
  cloth.volume = options.volume;
  cloth.thickness = options.material.thickness;
  cloth.static_friction = options.material.static_friction;
  cloth.kinetic_friction = options.material.kinetic_friction;
  return cloth;
}

}  // namespace

Object make_cloth(const TriangleMesh& mesh, const ClothOptions& options) {
  ClothDraft piece{mesh, options, mesh.triangles, {}, {}, {}};
  require_material(piece);
  require_positions(piece);
  try {
    piece.find_edges_again();
  } catch (const Error& error) {  // the error names the triangle; add the name of the object
    piece.refuse(error.where().element, error.problem(), error.advice());
  }
  measure_areas(piece);
  require_distinct_triangles(piece);
  wind_alike(piece);
  if (options.volume) require_balloon(piece);
  if (options.bending_plasticity && options.bending_model != ClothOptions::Bending::dihedral)
    piece.refuse("bending_plasticity", "needs dihedral bending: other hinges have no angle at rest",
                 "set bending_model to dihedral, or leave the plasticity out");
  require_yarns(piece);
  lump_masses(piece);
  return assemble(piece);
}

}  // namespace pliant

// Makes elastic bodies of tetrahedra: masses by volume, and for each tetrahedron two constraints, on its shape and on
// its volume.
#include "pliant/soft_body.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "constraints/gives_shape.h"
#include "matter/fibres.h"
#include "matter/size_class.h"
#include "matter/strain_limit.h"
#include "matter/tetrahedron_faces.h"
#include "pliant/error.h"
#include "topology/sort_by_first.h"

namespace pliant {

namespace {

using Tetrahedron = std::array<int, 4>;

/// A tetrahedron whose volume is below this share of the product of three edges is flat: its constraints would be zero.
constexpr double least_volume = 1e-5;
constexpr double largest_quantity = 1e12, largest_plastic = static_cast<double>(1e30f);

struct Source {
  const TetrahedralMesh& mesh;
  const std::string& name;
  [[noreturn]] void refuse(const std::string& element, const std::string& problem, const std::string& advice) const {
    throw Error({.object = name, .element = element}, problem, advice);
  }
};

std::string name_of(std::size_t tetrahedron) { return "tetrahedron " + std::to_string(tetrahedron); }

void require(const Source& from, const char* field, float value, double least, bool above, double most,
             const char* advice) {
  const auto number = static_cast<double>(value);
  if (!(number >= least && number <= most) || (above && number == least))
    from.refuse(field, "is " + std::to_string(value), advice);
}

void require_options(const Source& from, const SoftBodyOptions& options) {
  const ElasticSolid& m = options.material;
  require(from, "material, density", m.density, 0, true, largest_quantity, "give more than 0 kg/m^3");
  require(from, "material, youngs_modulus", m.youngs_modulus, 0, true, largest_modulus, "give more than 0 Pa");
  require(from, "material, poisson_ratio", m.poisson_ratio, 0, false, static_cast<double>(0.495f),
          "give 0 to 0.495: 0.5 would be incompressible");
  require(from, "material, damping", m.damping, 0, false, 1e6, "give 0 s or more");
  require(from, "material, kinetic_friction", m.kinetic_friction, 0, false, 1e6, "give 0 or more");
  require(from, "material, static_friction", m.static_friction, static_cast<double>(m.kinetic_friction), false, 1e6,
          "give the kinetic friction or more");
  require(from, "thickness", options.thickness, 0, false, 1e6, "give 0 m or more");
  if (!m.plasticity) return;
  require(from, "material, plasticity, yield", m.plasticity->yield, 0, false, largest_plastic,
          "give a strain of 0 or more");
  require(from, "material, plasticity, rate", m.plasticity->rate, 0, false, largest_plastic, "give 0 1/s or more");
  require(from, "material, plasticity, most", m.plasticity->most, 0, false, largest_plastic,
          "give a strain of 0 or more");
}

void require_positions(const Source& from) {
  if (from.mesh.tetrahedra.empty()) from.refuse("", "the mesh has no tetrahedron", "a soft body needs at least one");
  for (std::size_t i = 0; i < from.mesh.positions.size(); ++i) {
    const Vec3f& p = from.mesh.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      from.refuse("vertex " + std::to_string(i), "is not finite", "give finite coordinates in metres");
  }
}

void require_corners(const Source& from) {
  const auto count = static_cast<int>(from.mesh.positions.size());
  for (std::size_t t = 0; t < from.mesh.tetrahedra.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i) {
      const int corner = from.mesh.tetrahedra[t][i];
      if (corner < 0 || corner >= count)
        from.refuse(name_of(t), "uses vertex " + std::to_string(corner) + ", which does not exist",
                    "indices run from 0 to " + std::to_string(count - 1));
      for (std::size_t k = 0; k < i; ++k)
        if (from.mesh.tetrahedra[t][k] == corner)
          from.refuse(name_of(t), "uses vertex " + std::to_string(corner) + " twice",
                      "remove it, or give four corners");
    }
}

/// Six times the volume of a tetrahedron, and the product of its three edges at the first corner.
std::pair<double, double> six_volumes(const Source& from, const Tetrahedron& t) {
  const auto [a, b, c] = ways_of(t, from.mesh.positions);
  return {dot(cross(a, b), c), std::sqrt(dot(a, a) * dot(b, b) * dot(c, c))};
}

/// The tetrahedra with positive volumes, and their volumes [m^3].
struct MeasuredTetrahedra {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<double> volumes;
};

MeasuredTetrahedra wound_alike(const Source& from) {
  MeasuredTetrahedra out;
  for (std::size_t t = 0; t < from.mesh.tetrahedra.size(); ++t) {
    Tetrahedron corners = from.mesh.tetrahedra[t];
    const auto [six, edges] = six_volumes(from, corners);
    if (!(std::fabs(six) > least_volume * edges))
      from.refuse(name_of(t), "is flat", "remove it, or mesh the body again: flat tetrahedra have no shape to keep");
    if (six < 0) std::swap(corners[2], corners[3]);
    out.tetrahedra.push_back(corners);
    out.volumes.push_back(std::fabs(six) / 6);
  }
  return out;
}

struct SortedFace {
  std::array<int, 3> sorted;
  std::size_t tetrahedron;
  std::size_t number;
};

std::vector<SortedFace> sorted_faces(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<SortedFace> all;
  all.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    for (std::size_t f = 0; f < tetrahedron_faces.size(); ++f) {
      std::array<int, 3> sorted = face_of(tetrahedra[t], f);
      std::sort(sorted.begin(), sorted.end());
      all.push_back({sorted, t, f});
    }
  int particles = 0;
  for (const SortedFace& face : all) particles = std::max(particles, face.sorted[0] + 1);
  sort_by_first(
      all, static_cast<std::size_t>(particles), [](const SortedFace& face) { return face.sorted[0]; },
      [](const SortedFace& a, const SortedFace& b) {
        return std::tie(a.sorted, a.tetrahedron, a.number) < std::tie(b.sorted, b.tetrahedron, b.number);
      });
  return all;
}

std::vector<std::array<int, 3>> border_of(const Source& from, const std::vector<Tetrahedron>& tetrahedra) {
  const std::vector<SortedFace> all = sorted_faces(tetrahedra);
  std::vector<SortedFace> border;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end].sorted == all[i].sorted) ++end;
    if (end - i > 2)
      from.refuse(name_of(all[i + 2].tetrahedron), "shares a face with two other tetrahedra",
                  "remove one: a face separates two tetrahedra at most");
    if (end - i == 1) border.push_back(all[i]);
    i = end;
  }
  std::sort(border.begin(), border.end(), [](const SortedFace& a, const SortedFace& b) {
    return std::pair(a.tetrahedron, a.number) < std::pair(b.tetrahedron, b.number);
  });
  std::vector<std::array<int, 3>> out;
  out.reserve(border.size());
  for (const SortedFace& face : border) out.push_back(face_of(tetrahedra[face.tetrahedron], face.number));
  return out;
}

/// Gives used corners new numbers without gaps. Returns the old number of each.
std::vector<int> drop_unused(std::size_t corners, std::vector<Tetrahedron>& tetrahedra) {
  std::vector<int> number(corners, -1), kept;
  for (const Tetrahedron& t : tetrahedra)
    for (const int corner : t) number[static_cast<std::size_t>(corner)] = 0;
  for (std::size_t i = 0; i < corners; ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(static_cast<int>(i));
  }
  for (Tetrahedron& t : tetrahedra)
    for (int& corner : t) corner = number[static_cast<std::size_t>(corner)];
  return kept;
}

/// Adds a constraint for each tetrahedron, whose compliance is 1 / (modulus volume). All of a group have one damping,
/// which is to be the damping time over the compliance; so with damping there is a group for each size. A large one's
/// would stop a small one.
void add_groups(const char* type, const MeasuredTetrahedra& solid, double modulus, double damping_time,
                const std::optional<Plasticity>& plasticity, Object& body) {
  std::map<int, std::vector<std::size_t>> classes;
  for (std::size_t t = 0; t < solid.tetrahedra.size(); ++t)
    classes[damping_time > 0 ? size_class(solid.volumes[t]) : 0].push_back(t);
  for (const auto& [size, members] : classes) {
    ConstraintGroup group;
    group.type = type;
    double stiffness = 0;
    for (const std::size_t t : members) {
      group.particles.insert(group.particles.end(), solid.tetrahedra[t].begin(), solid.tetrahedra[t].end());
      const double energy = modulus * solid.volumes[t];
      group.compliances.push_back(static_cast<float>(std::min(1 / energy, largest_response)));
      stiffness += energy / static_cast<double>(members.size());
    }
    group.stiffness.damping = static_cast<float>(std::min(damping_time * stiffness, largest_response));
    group.plasticity = plasticity;
    body.constraints.push_back(std::move(group));
  }
}

void set_masses(const MeasuredTetrahedra& solid, double density, Object& body) {
  std::vector<double> masses(body.positions.size(), 0);
  for (std::size_t t = 0; t < solid.tetrahedra.size(); ++t)
    for (const int corner : solid.tetrahedra[t])
      masses[static_cast<std::size_t>(corner)] += density * solid.volumes[t] / 4;
  body.masses.assign(masses.begin(), masses.end());
}

/// Lame's coefficients [Pa].
struct Lame {
  double lambda, mu;
};

Lame lame_of(const ElasticSolid& material) {
  const double e = material.youngs_modulus, nu = material.poisson_ratio;
  return {e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))};
}

/// The constraint types of a solid: with the shear modulus mu, and with lambda. Of Green's strain both have the rest
/// shape, so both flow.
struct Types {
  const char *shape, *volume;
  std::optional<Plasticity> flow{};  ///< of the second
};

Types types_of(const ElasticSolid& material) {
  switch (material.model) {
    case SolidModel::neo_hookean:
      break;
    case SolidModel::corotational:
      return {"corotational_strain", "tetrahedron_volume"};
    case SolidModel::st_venant_kirchhoff:
      return {"green_strain", "green_trace", material.plasticity};
  }
  return {"tetrahedron_shear", "tetrahedron_volume"};
}

std::vector<std::array<int, 2>> edges_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<std::array<int, 2>> edges;
  for (const Tetrahedron& t : tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k) edges.push_back({t[k], t[i]});
  return edges;
}

}  // namespace

std::vector<std::array<int, 4>> tetrahedra_of(const Object& object) {
  std::vector<Tetrahedron> out;
  for (const ConstraintGroup& group : object.constraints) {
    if (!gives_shape(group.type)) continue;
    const std::size_t first = out.size();
    out.resize(first + group.particles.size() / 4);
    for (std::size_t t = first; t < out.size(); ++t)
      std::copy_n(group.particles.data() + 4 * (t - first), 4, out[t].begin());
  }
  return out;
}

std::vector<std::array<int, 3>> border_triangles(const TetrahedralMesh& mesh) {
  const std::string none;
  const Source from{mesh, none};
  require_corners(from);
  std::vector<Tetrahedron> tetrahedra = mesh.tetrahedra;
  for (Tetrahedron& t : tetrahedra) t = wound(t, mesh.positions);
  return border_of(from, tetrahedra);
}

Object make_soft_body(const TetrahedralMesh& mesh, const SoftBodyOptions& options) {
  const Source from{mesh, options.name};
  require_options(from, options);
  require_positions(from);
  require_corners(from);
  MeasuredTetrahedra solid = wound_alike(from);
  Object body;
  body.name = options.name;
  body.triangles = border_of(from, solid.tetrahedra);
  if (body.triangles.empty()) from.refuse("", "has no border: each tetrahedron is there twice", "remove the copies");
  const std::vector<int> kept = drop_unused(mesh.positions.size(), solid.tetrahedra);
  std::vector<int> number(mesh.positions.size(), -1);
  for (const int old : kept) {
    number[static_cast<std::size_t>(old)] = static_cast<int>(body.positions.size());
    body.positions.push_back(mesh.positions[static_cast<std::size_t>(old)]);
  }
  for (auto& triangle : body.triangles)
    for (int& corner : triangle) corner = number[static_cast<std::size_t>(corner)];
  set_masses(solid, options.material.density, body);
  if (!(options.velocity == Vec3f{})) body.velocities.assign(body.positions.size(), options.velocity);
  const Lame lame = lame_of(options.material);
  const double damping = options.material.damping;
  const Types types = types_of(options.material);
  add_groups(types.shape, solid, lame.mu, damping, options.material.plasticity, body);
  if (lame.lambda > 0) add_groups(types.volume, solid, lame.lambda, damping, types.flow, body);
  if (options.fibres) add_fibres(*options.fibres, damping, solid.tetrahedra, body);
  if (options.strain_limit)
    body.constraints.push_back(
        limit_edges(body.positions, edges_of(solid.tetrahedra), *options.strain_limit, options.name));
  body.thickness = options.thickness;
  body.collides = true;
  body.static_friction = options.material.static_friction;
  body.kinetic_friction = options.material.kinetic_friction;
  return body;
}

namespace {

/// The corners of a cube along its diagonal from (0,0,0) to (1,1,1): one step along each axis, in six orders. The odd
/// orders are mirrored, so their last two corners are exchanged.
constexpr std::array<std::array<int, 4>, 6> kuhn{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// The same mirrored along the axes whose bits are set. An odd number of mirrors turns tetrahedra inside out.
std::array<std::array<int, 4>, 6> kuhn_about(int mirrored) {
  const bool is_odd = std::popcount(static_cast<unsigned>(mirrored)) % 2 == 1;
  std::array<std::array<int, 4>, 6> cut = kuhn;
  for (std::array<int, 4>& corners : cut) {
    if (is_odd) std::swap(corners[1], corners[2]);
    for (int& corner : corners) corner ^= mirrored;
  }
  return cut;
}

/// Bit `axis` is set in the second half of the cells along it.
int half_of(const std::array<int, 3>& cell, const std::array<int, 3>& cells) {
  int half = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) half |= (2 * cell[axis] >= cells[axis] ? 1 : 0) << axis;
  return half;
}

}  // namespace

TetrahedralMesh box_tetrahedra(const Vec3f& size, const std::array<int, 3>& cells, BoxCut cut) {
  constexpr std::int64_t most_cells = 1 << 24;
  for (const float side : {size.x, size.y, size.z})
    if (!(side > 0) || !std::isfinite(side))
      throw Error({.element = "size"}, "is " + std::to_string(side), "give positive, finite sizes [m]");
  std::int64_t count = 1;
  for (const int along : cells) {
    if (along < 1 || along > most_cells || (count *= along) > most_cells)
      throw Error(
          {.element = "cells"},
          "are " + std::to_string(cells[0]) + " x " + std::to_string(cells[1]) + " x " + std::to_string(cells[2]),
          "give 1 or more along each axis, and 2^24 together at most");
  }
  const auto place = [](float side, int i, int n) {
    return side * (static_cast<float>(i) / static_cast<float>(n) - 0.5f);
  };
  TetrahedralMesh mesh;
  for (int z = 0; z <= cells[2]; ++z)
    for (int y = 0; y <= cells[1]; ++y)
      for (int x = 0; x <= cells[0]; ++x)
        mesh.positions.push_back({place(size.x, x, cells[0]), place(size.y, y, cells[1]), place(size.z, z, cells[2])});
  const int row = cells[0] + 1, layer = row * (cells[1] + 1);
  for (int z = 0; z < cells[2]; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (const auto& corners : kuhn_about(cut == BoxCut::mirrored ? half_of({x, y, z}, cells) : 0)) {
          Tetrahedron t;
          for (std::size_t i = 0; i < 4; ++i)
            t[i] = (z + (corners[i] >> 2)) * layer + (y + (corners[i] >> 1 & 1)) * row + x + (corners[i] & 1);
          mesh.tetrahedra.push_back(t);
        }
  return mesh;
}

}  // namespace pliant

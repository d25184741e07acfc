// Springs of the stiffness Y A / L^2 (Van Gelder 1998) store the energy of a sheet of the modulus Y if its vertices move
// affinely. The forces of a uniform strain cancel at a vertex whose neighbours lie in opposite pairs. At others they do
// not: these vertices move, and the sheet yields further than Y says.
//
// With r the forces of a uniform strain at the vertices, K the stiffness matrix and E = sum of k L^2 strain^2 of the
// springs, the vertices move by w = K^-1 r, and of E remains E - r.w. So the sheet is softer by 1 / (1 - r.w / E). r.w
// is averaged over strains that weigh all directions alike. A few conjugate gradient steps suffice: what one vertex and
// those around it do counts most.
//
// Displacements lie in the tangent planes of the vertices, and strains are taken there too. So curvature by itself
// causes no forces: a grid rolled into a cylinder is regular.
#include "matter/irregular_springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pliant {

namespace {

/// The strains are a a^T - strain_across I in space, projected onto the surface. The axes a are the six diagonals of an
/// icosahedron: their products of degree four average to those of all directions. So they weigh the directions within
/// any plane alike.
constexpr std::size_t strain_count = 6;
constexpr double long_part = 0.85065080835203993, short_part = 0.52573111211913361;
constexpr std::array<std::array<double, 3>, strain_count> strain_axes{{{0, short_part, long_part},
                                                                       {0, -short_part, long_part},
                                                                       {short_part, long_part, 0},
                                                                       {-short_part, long_part, 0},
                                                                       {long_part, 0, short_part},
                                                                       {long_part, 0, -short_part}}};
/// With this, dilation and shear store energy by 1 : 2, averaged over the axes, as in a sheet of Poisson's ratio 1/3
/// that is pulled one way.
constexpr double strain_across = 0.22792408;
/// Conjugate gradient steps. Many more add 0.01 to the result where triangles differ at random, 0.03 in rings of a disc.
constexpr int gradient_steps = 8;
/// A vertex is held where the surface bends by more than the angle of this cosine from its mean normal.
constexpr double least_cosine = 0.85;
/// Meshes softer by less than this count as regular: it is about the error.
constexpr double least_softness = 1.02;
/// So do those with less than this share of the energy in r.D^-1 r, D being the blocks of K.
constexpr double least_yield = 0.002;
constexpr double largest_softness = 2;

/// A value for each strain: of both coordinates in the tangent plane of a vertex.
using Values = std::array<double, strain_count>;
struct Tangential {
  Values x{}, y{};
};

/// The tangent plane of a vertex, and the inverse of its 2 x 2 block of K; 0 if the vertex is held.
struct VertexFrame {
  Vec3d normal, x, y;
  double xx = 0, xy = 0, yy = 0;
};

/// A spring, with its directions in the tangent planes of its ends.
struct MeshSpring {
  std::size_t a = 0, b = 0;
  double stiffness = 0, length = 0;
  std::array<double, 2> at_a{}, at_b{};
};

struct SpringSystem {
  std::vector<VertexFrame> frames;
  std::vector<MeshSpring> springs;
};

std::vector<char> held_vertices(const SpringMesh& mesh, const std::vector<VertexFrame>& frames,
                                const std::vector<Vec3d>& normals) {
  std::vector<char> held(mesh.positions.size(), 0);
  for (const Edge& edge : mesh.edges)
    if (!edge.is_inner() || !edge.is_wound_consistently())
      held[static_cast<std::size_t>(edge.a)] = held[static_cast<std::size_t>(edge.b)] = 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int corner : mesh.triangles[t]) {
      const auto v = static_cast<std::size_t>(corner);
      if (!(dot(frames[v].normal, normals[t]) > least_cosine * std::sqrt(length_squared(normals[t])))) held[v] = 1;
    }
  return held;
}

/// Makes the tangent planes, and returns which vertices are held.
std::vector<char> make_frames(const SpringMesh& mesh, std::vector<VertexFrame>& frames) {
  std::vector<Vec3d> normals;
  normals.reserve(mesh.triangles.size());
  frames.resize(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& origin = mesh.positions[static_cast<std::size_t>(t[0])];
    normals.push_back(cross(mesh.positions[static_cast<std::size_t>(t[1])] - origin,
                            mesh.positions[static_cast<std::size_t>(t[2])] - origin));
    for (const int corner : t) frames[static_cast<std::size_t>(corner)].normal += normals.back();
  }
  for (VertexFrame& frame : frames) {
    const Vec3d n = unit_or(frame.normal, Vec3d{});
    const Vec3d other = std::fabs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    frame.normal = n;
    frame.x = unit_or(cross(other, n), Vec3d{});
    frame.y = cross(n, frame.x);
  }
  return held_vertices(mesh, frames, normals);
}

/// The direction of an edge in a tangent plane, of length 1; 0 if it is square to that.
std::array<double, 2> direction_in(const VertexFrame& frame, const Vec3d& edge) {
  const double x = dot(edge, frame.x), y = dot(edge, frame.y), squared = x * x + y * y;
  const double scale = squared > 1e-6 * length_squared(edge) ? 1 / std::sqrt(squared) : 0;
  return {scale * x, scale * y};
}

void add_block(VertexFrame& frame, double stiffness, const std::array<double, 2>& d) {
  frame.xx += stiffness * d[0] * d[0];
  frame.xy += stiffness * d[0] * d[1];
  frame.yy += stiffness * d[1] * d[1];
}

void invert_block(VertexFrame& frame, bool is_held) {
  const double xx = frame.xx, xy = frame.xy, yy = frame.yy, det = xx * yy - xy * xy;
  const bool is_free = !is_held && det > 1e-9 * xx * yy;
  frame.xx = is_free ? yy / det : 0;
  frame.xy = is_free ? -xy / det : 0;
  frame.yy = is_free ? xx / det : 0;
}

SpringSystem make_system(const SpringMesh& mesh) {
  SpringSystem system;
  const std::vector<char> held = make_frames(mesh, system.frames);
  system.springs.reserve(mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    MeshSpring spring;
    spring.a = static_cast<std::size_t>(mesh.edges[e].a);
    spring.b = static_cast<std::size_t>(mesh.edges[e].b);
    const Vec3d edge = mesh.positions[spring.b] - mesh.positions[spring.a];
    const double squared = length_squared(edge);
    spring.length = std::sqrt(squared);
    spring.stiffness = mesh.areas[e] / squared;
    spring.at_a = direction_in(system.frames[spring.a], edge);
    spring.at_b = direction_in(system.frames[spring.b], edge);
    add_block(system.frames[spring.a], spring.stiffness, spring.at_a);
    add_block(system.frames[spring.b], spring.stiffness, spring.at_b);
    system.springs.push_back(spring);
  }
  for (std::size_t v = 0; v < held.size(); ++v) invert_block(system.frames[v], held[v] != 0);
  return system;
}

/// The strain of a spring in each of the uniform strains.
Values strains_along(const VertexFrame& frame, const std::array<double, 2>& direction) {
  const Vec3d d = direction[0] * frame.x + direction[1] * frame.y;
  Values strains{};
  for (std::size_t k = 0; k < strain_count; ++k) {
    const double cosine = strain_axes[k][0] * d.x + strain_axes[k][1] * d.y + strain_axes[k][2] * d.z;
    strains[k] = cosine * cosine - strain_across;
  }
  return strains;
}

/// Adds the forces of the uniform strains at one end of a spring, and returns the mean of its energies. Held ends have
/// none.
double add_end(const VertexFrame& frame, const std::array<double, 2>& direction, double tension, Tangential& force) {
  if (frame.xx == 0) return 0;
  const Values strains = strains_along(frame, direction);
  double energy = 0;
  for (std::size_t k = 0; k < strain_count; ++k) {
    force.x[k] += tension * strains[k] * direction[0];
    force.y[k] += tension * strains[k] * direction[1];
    energy += strains[k] * strains[k];
  }
  return energy;
}

/// The forces of the uniform strains. Returns twice the energies, added up over the strains; a spring counts by its
/// ends that are not held.
double load(const SpringSystem& system, std::vector<Tangential>& forces) {
  double energy = 0;
  for (const MeshSpring& spring : system.springs) {
    const double tension = spring.stiffness * spring.length;
    const double ends = add_end(system.frames[spring.a], spring.at_a, tension, forces[spring.a]) +
                        add_end(system.frames[spring.b], spring.at_b, -tension, forces[spring.b]);
    energy += tension * spring.length * ends / 2;
  }
  return energy;
}

void add_force(const Values& force, double x, double y, Tangential& out) {
  for (std::size_t k = 0; k < strain_count; ++k) out.x[k] += force[k] * x;
  for (std::size_t k = 0; k < strain_count; ++k) out.y[k] += force[k] * y;
}

/// Adds K p to `out`, and returns p.K p for each strain.
Values apply(const SpringSystem& system, const std::vector<Tangential>& p, std::vector<Tangential>& out) {
  Values energy{};
  for (const MeshSpring& s : system.springs) {
    const Tangential &pa = p[s.a], &pb = p[s.b];
    Values force{};  // apart from `out`, so that compilers need not expect an overlap
    for (std::size_t k = 0; k < strain_count; ++k) {
      const double stretch = s.at_b[0] * pb.x[k] + s.at_b[1] * pb.y[k] - s.at_a[0] * pa.x[k] - s.at_a[1] * pa.y[k];
      force[k] = s.stiffness * stretch;
      energy[k] += force[k] * stretch;
    }
    add_force(force, -s.at_a[0], -s.at_a[1], out[s.a]);
    add_force(force, s.at_b[0], s.at_b[1], out[s.b]);
  }
  return energy;
}

/// r.D^-1 r, D being the blocks of K.
Values work_of(const SpringSystem& system, const std::vector<Tangential>& r) {
  Values sum{};
  for (std::size_t v = 0; v < r.size(); ++v) {
    const VertexFrame& f = system.frames[v];
    for (std::size_t k = 0; k < strain_count; ++k) {
      const double x = r[v].x[k], y = r[v].y[k];
      sum[k] += f.xx * x * x + 2 * f.xy * x * y + f.yy * y * y;
    }
  }
  return sum;
}

void subtract(const Values& by, const std::vector<Tangential>& q, std::vector<Tangential>& r) {
  for (std::size_t v = 0; v < r.size(); ++v) {
    for (std::size_t k = 0; k < strain_count; ++k) r[v].x[k] -= by[k] * q[v].x[k];
    for (std::size_t k = 0; k < strain_count; ++k) r[v].y[k] -= by[k] * q[v].y[k];
  }
}

/// Sets p to D^-1 r + scale p, and q to 0.
void redirect(const SpringSystem& system, const std::vector<Tangential>& r, const Values& scale,
              std::vector<Tangential>& p, std::vector<Tangential>& q) {
  for (std::size_t v = 0; v < r.size(); ++v) {
    const VertexFrame& f = system.frames[v];
    for (std::size_t k = 0; k < strain_count; ++k) {
      const double x = r[v].x[k], y = r[v].y[k];
      p[v].x[k] = f.xx * x + f.xy * y + scale[k] * p[v].x[k];
      p[v].y[k] = f.xy * x + f.yy * y + scale[k] * p[v].y[k];
    }
    q[v] = {};
  }
}

double total(const Values& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

/// r.K^-1 r, added up over the strains, by conjugate gradients; 0 if r.D^-1 r is less than `least`. Changes r.
double yielded(const SpringSystem& system, std::vector<Tangential>& r, double least) {
  Values by{}, scale{}, now = work_of(system, r);
  if (total(now) < least) return 0;
  const Values first = now;
  std::vector<Tangential> p(r.size()), q(r.size());
  double sum = 0;
  for (int step = 0; step < gradient_steps; ++step) {
    redirect(system, r, scale, p, q);
    const Values energy = apply(system, p, q);
    for (std::size_t k = 0; k < strain_count; ++k) {
      by[k] = now[k] > 1e-20 * first[k] && energy[k] > 0 ? now[k] / energy[k] : 0;
      sum += by[k] * now[k];
    }
    const Values before = now;
    subtract(by, q, r);
    now = work_of(system, r);
    for (std::size_t k = 0; k < strain_count; ++k) scale[k] = before[k] > 0 ? now[k] / before[k] : 0;
  }
  return sum;
}

}  // namespace

double softness_of(const SpringMesh& mesh) {
  const SpringSystem system = make_system(mesh);
  std::vector<Tangential> forces(mesh.positions.size());
  const double energy = load(system, forces);
  if (!(energy > 0)) return 1;  // all vertices are held
  const double left = 1 - yielded(system, forces, least_yield * energy) / energy;
  if (!std::isfinite(left) || left * least_softness > 1) return 1;
  return left * largest_softness > 1 ? 1 / left : largest_softness;
}

}  // namespace pliant

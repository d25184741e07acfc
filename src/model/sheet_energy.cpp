// The bending energy of a flat sheet as a matrix (model/sheet_bending.h).
#include <algorithm>
#include <cmath>
#include <span>

#include "constraints/registry.h"
#include "core/at.h"
#include "math/vector.h"
#include "model/sheet_bending.h"
#include "topology/edges.h"

namespace pliant {

namespace {

/// Hinges err by 2.3 of this: where s = h^2 B / (rho e^4) is less, they are within 5 %, and cost less.
constexpr double most_of_hinges = 0.02;
/// Beyond this, l / e = 18, floats of M + h^2 K have no room for M: measured up to 16.
constexpr double most_of_floats = 1e5;
/// Hinges at a vertex that differ by more in their stiffness are a crease, or a seam of another material.
constexpr double largest_ratio = 4;
/// A rest shape is flat if no hinge is folded by more [rad].
constexpr double largest_fold = 1e-3;

Vec3d rest_of(const Object& object, int particle) { return convert<double>(object.positions[at(particle)]); }

/// The flexural rigidity B that the compliance of a hinge stands for (matter/cloth.cpp) [N m].
double rigidity_of(const std::array<Vec3d, 4>& x, double compliance, bool isometric) {
  if (isometric) return 3 / compliance;
  const Vec3d e = x[1] - x[0];
  const double areas = (length(cross(e, x[2] - x[0])) + length(cross(e, x[3] - x[0]))) / 2;
  return areas / (length_squared(e) * compliance);
}

std::array<Vec3d, 4> hinge_at(const Object& object, const ConstraintGroup& group, std::size_t hinge) {
  std::array<Vec3d, 4> x;
  for (std::size_t slot = 0; slot < 4; ++slot) x[slot] = rest_of(object, group.particles[4 * hinge + slot]);
  return x;
}

/// True if all hinges of a group are flat at rest.
bool is_flat(const Object& object, const ConstraintGroup& group) {
  const bool angles = !group.rest.empty() && !is_flat_hinge(group.type);
  const auto is_folded = [](float angle) { return std::fabs(double(angle)) > largest_fold; };
  if (angles && std::any_of(group.rest.begin(), group.rest.end(), is_folded)) return false;
  for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
    const std::array<Vec3d, 4> x = hinge_at(object, group, i);
    if (std::fabs(fold_angle({x[0], x[1], x[2], x[3]})) > largest_fold) return false;
  }
  return true;
}

/// True if every edge of two triangles has one hinge, and none has three or more triangles. A seam or crease without
/// hinges bends freely.
bool has_hinges_everywhere(const Object& object) {
  std::vector<std::array<int, 2>> hinges;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const auto [a, b] = std::minmax(group.particles[4 * i], group.particles[4 * i + 1]);
      hinges.push_back({a, b});
    }
  }
  std::sort(hinges.begin(), hinges.end());
  std::size_t inner = 0;
  for (const Edge& edge : find_edges(object.triangles, static_cast<int>(object.positions.size()))) {
    if (edge.triangle_count > 2) return false;
    if (!edge.is_inner()) continue;
    const std::array<int, 2> ends{std::min(edge.a, edge.b), std::max(edge.a, edge.b)};
    const auto [first, last] = std::equal_range(hinges.begin(), hinges.end(), ends);
    if (last - first != 1) return false;
    ++inner;
  }
  return inner == hinges.size();
}

/// True if the initial positions are the rest shape, as they are not where pieces were welded.
bool is_at_rest(const Object& object) {
  constexpr double tolerated = 0.01;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.rest.empty()) continue;
    for (std::size_t i = 0; 2 * i + 1 < group.particles.size() && i < group.rest.size(); ++i) {
      const double rest = double(group.rest[i]);
      const double now = length(rest_of(object, group.particles[2 * i + 1]) - rest_of(object, group.particles[2 * i]));
      if (std::fabs(now - rest) > tolerated * std::max(now, rest)) return false;
    }
  }
  return true;
}

/// True if a group has the compliances of a material, which nothing changes.
bool is_of_material(const ConstraintGroup& group) {
  return !group.compliances.empty() && group.stiffness.kind == Stiffness::Kind::compliance && !group.plasticity &&
         group.keyframes.empty() && !(group.break_force > 0);
}

/// The rigidity at each particle: the mean of its hinges; 0 without one.
std::vector<double> rigidities(const Object& object) {
  std::vector<double> sum(object.positions.size(), 0), count(object.positions.size(), 0);
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const double b = rigidity_of(hinge_at(object, group, i), double(group.compliances[i]), is_flat_hinge(group.type));
      for (std::size_t slot = 0; slot < 4; ++slot) {
        sum[at(group.particles[4 * i + slot])] += b;
        count[at(group.particles[4 * i + slot])] += 1;
      }
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = count[v] > 0 ? sum[v] / count[v] : 0;
  return sum;
}

/// The triangles of a sheet and what is around each vertex, by the object's indices.
struct SheetMesh {
  const Object& object;
  std::vector<double> areas;               ///< of each triangle [m^2]
  std::vector<std::vector<int>> star;      ///< of each vertex, its triangles
  std::vector<std::array<int, 3>> across;  ///< of each edge, by the smaller end: its ends, and a corner opposite to it

  explicit SheetMesh(const Object& of) : object(of), star(of.positions.size()) {
    areas.reserve(of.triangles.size());
    across.reserve(3 * of.triangles.size());
    for (std::size_t t = 0; t < of.triangles.size(); ++t) {
      const auto& [a, b, c] = of.triangles[t];
      areas.push_back(length(cross(rest_of(of, b) - rest_of(of, a), rest_of(of, c) - rest_of(of, a))) / 2);
      for (const int v : of.triangles[t]) star[at(v)].push_back(static_cast<int>(t));
      across.push_back({std::min(a, b), std::max(a, b), c});
      across.push_back({std::min(b, c), std::max(b, c), a});
      across.push_back({std::min(c, a), std::max(c, a), b});
    }
    std::sort(across.begin(), across.end());
  }

  /// The corners opposite to an edge.
  std::span<const std::array<int, 3>> opposite(int a, int b) const {
    const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
    const auto first = std::lower_bound(across.begin(), across.end(), std::array<int, 3>{edge[0], edge[1], -1});
    auto last = first;
    while (last != across.end() && (*last)[0] == edge[0] && (*last)[1] == edge[1]) ++last;
    return {first, last};
  }

  std::vector<int> neighbours(int vertex) const {
    std::vector<int> out;
    for (const int t : star[at(vertex)])
      for (const int v : object.triangles[at(t)])
        if (v != vertex) out.push_back(v);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  double area_at(int vertex) const {
    double area = 0;
    for (const int t : star[at(vertex)]) area += areas[at(t)] / 3;
    return area;
  }
  Vec3d normal_at(int vertex) const {
    Vec3d sum{};
    for (const int t : star[at(vertex)]) {
      const auto& [a, b, c] = object.triangles[at(t)];
      const Vec3d n = cross(rest_of(object, b) - rest_of(object, a), rest_of(object, c) - rest_of(object, a));
      sum += dot(sum, n) < 0 ? -n : n;  // triangles need not be wound alike
    }
    const double size = length(sum);
    return size > 0 ? sum * (1 / size) : Vec3d{0, 1, 0};
  }
  bool is_inner(int vertex, const std::vector<int>& ring) const {
    return std::all_of(ring.begin(), ring.end(), [&](int v) { return opposite(vertex, v).size() == 2; });
  }
};

void sort_unique(std::vector<int>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

/// The vertices around an irregular one whose offsets give its curvature: its neighbours, and the tips across the
/// border of its star. By neighbours alone a sheet of alternating diagonals is 30 % too soft, and an irregular one 5 to
/// 10 %.
std::vector<int> wide_stencil(const SheetMesh& mesh, const std::vector<std::vector<int>>& rings, int vertex) {
  constexpr std::size_t least = 6;
  std::vector<int> out = rings[at(vertex)];
  for (const int t : mesh.star[at(vertex)]) {
    const auto& [a, b, c] = mesh.object.triangles[at(t)];
    const auto tips = vertex == a ? mesh.opposite(b, c) : vertex == b ? mesh.opposite(c, a) : mesh.opposite(a, b);
    for (const std::array<int, 3>& edge : tips) out.push_back(edge[2]);
  }
  sort_unique(out);
  if (out.size() <= least)
    for (const int v : rings[at(vertex)]) out.insert(out.end(), rings[at(v)].begin(), rings[at(v)].end());
  sort_unique(out);
  out.erase(std::remove(out.begin(), out.end(), vertex), out.end());
  return out;
}

/// Solves a symmetric positive definite system of five by Cholesky, for several right-hand sides in place.
void solve_five(std::array<std::array<double, 5>, 5> a, std::array<std::array<double, 3>, 5>& b) {
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t k = 0; k < j; ++k)
      for (std::size_t i = j; i < 5; ++i) a[i][j] -= a[i][k] * a[j][k];
    const double root = std::sqrt(a[j][j]);
    for (std::size_t i = j; i < 5; ++i) a[i][j] /= root;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i][c] -= a[i][k] * b[k][c];
      b[i][c] /= a[i][i];
    }
    for (std::size_t i = 5; i-- > 0;) {
      for (std::size_t k = i + 1; k < 5; ++k) b[i][c] -= a[k][i] * b[k][c];
      b[i][c] /= a[i][i];
    }
  }
}

/// Curvature at a vertex as a sum over vertices: coefficients of kxx, kxy and kzz [1/m^2]. The vertex itself is the
/// last.
struct Curvature {
  std::vector<int> of;
  std::vector<std::array<double, 3>> by;
  double weight = 0;  ///< B A [N m^3]
};

Curvature curvature_at(const SheetMesh& mesh, int vertex, const std::vector<int>& ring) {
  const Vec3d normal = mesh.normal_at(vertex), origin = rest_of(mesh.object, vertex);
  const Vec3d helper = std::fabs(normal.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d first = cross(helper, normal), u = first * (1 / length(first)), v = cross(normal, u);
  std::vector<std::array<double, 5>> terms;
  std::vector<double> weights;
  double size = 0;
  for (const int i : ring) {
    const Vec3d d = rest_of(mesh.object, i) - origin;
    size += length_squared(d) / static_cast<double>(ring.size());
  }
  size = std::sqrt(std::max(size, 1e-30));
  std::array<std::array<double, 5>, 5> normal_matrix{};
  for (const int i : ring) {
    const Vec3d d = (rest_of(mesh.object, i) - origin) * (1 / size);
    const double x = dot(d, u), z = dot(d, v), squared = std::max(x * x + z * z, 1e-12);
    terms.push_back({x, z, x * x / 2, x * z, z * z / 2});
    weights.push_back(1 / squared);
    for (std::size_t r = 0; r < 5; ++r)
      for (std::size_t c = 0; c < 5; ++c) normal_matrix[r][c] += weights.back() * terms.back()[r] * terms.back()[c];
  }
  double trace = 0;
  for (std::size_t r = 0; r < 5; ++r) trace += normal_matrix[r][r];
  // Where too few vertices tell, as in a strip one cell wide: what may be a slope is one.
  for (std::size_t r = 0; r < 5; ++r) normal_matrix[r][r] += (r < 2 ? 1e-13 : 1e-9) * trace;
  std::array<std::array<double, 3>, 5> solution{};
  for (std::size_t c = 0; c < 3; ++c) solution[2 + c][c] = 1;
  solve_five(normal_matrix, solution);
  Curvature out{ring, {}, 0};
  std::array<double, 3> own{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    std::array<double, 3> by{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t r = 0; r < 5; ++r) by[c] += terms[i][r] * solution[r][c];
      by[c] *= weights[i] / (size * size);
      own[c] -= by[c];
    }
    out.by.push_back(by);
  }
  out.of.push_back(vertex);
  out.by.push_back(own);
  return out;
}

/// At a pinned vertex beside triangles that cannot move, the sheet bends on the other side alone: the mean square of
/// the curvature is the square of its mean over that side's share. Without this factor a clamp yields by a quarter of
/// an edge.
double factor_of_clamp(const SheetMesh& mesh, int vertex, const std::vector<char>& is_fixed) {
  if (is_fixed[at(vertex)] == 0) return 1;
  double all = 0, fixed = 0;
  for (const int t : mesh.star[at(vertex)]) {
    const auto& corners = mesh.object.triangles[at(t)];
    all += mesh.areas[at(t)];
    if (std::all_of(corners.begin(), corners.end(), [&](int v) { return is_fixed[at(v)] != 0; }))
      fixed += mesh.areas[at(t)];
  }
  return fixed < all ? all / (all - fixed) : 1;
}

/// The size of the coefficients of a curvature: large ones tell that its vertices hardly determine it.
double size_of(const Curvature& curvature) {
  double sum = 0;
  for (const std::array<double, 3>& by : curvature.by) sum += by[0] * by[0] + 2 * by[1] * by[1] + by[2] * by[2];
  return sum;
}

/// The curvature at a pinned vertex. Vertices beyond its neighbours that are pinned too tell nothing of the side that
/// bends: with them a clamp of several rows yields by half an edge. They stay where the others do not suffice.
Curvature curvature_of_pinned(const SheetMesh& mesh, int vertex, const std::vector<int>& ring,
                              const std::vector<char>& is_fixed, std::vector<int> stencil) {
  constexpr double most = 4;
  Curvature all = curvature_at(mesh, vertex, stencil);
  const auto is_clamped_tip = [&](int v) {
    return is_fixed[at(v)] != 0 && std::find(ring.begin(), ring.end(), v) == ring.end();
  };
  stencil.erase(std::remove_if(stencil.begin(), stencil.end(), is_clamped_tip), stencil.end());
  if (stencil.size() == all.by.size() - 1 || stencil.size() < 5) return all;
  Curvature free = curvature_at(mesh, vertex, stencil);
  return size_of(free) < most * size_of(all) ? free : all;
}

/// K = sum over vertices of weight C^T diag(1, 2, 1) C, by the object's indices.
SparseRows assemble(const std::vector<Curvature>& all, std::size_t rows) {
  std::vector<std::vector<std::array<int, 2>>> stencils_with(rows);
  for (std::size_t v = 0; v < all.size(); ++v)
    for (std::size_t k = 0; k < all[v].of.size(); ++k)
      stencils_with[at(all[v].of[k])].push_back({static_cast<int>(v), static_cast<int>(k)});
  SparseRows out;
  out.row.resize(rows);
  std::vector<double> sum(rows, 0);
  std::vector<char> is_in(rows, 0);
  std::vector<int> columns;
  for (std::size_t i = 0; i < rows; ++i) {
    columns.clear();
    for (const auto& [v, k] : stencils_with[i]) {
      const Curvature& c = all[at(v)];
      const std::array<double, 3>& mine = c.by[at(k)];
      for (std::size_t other = 0; other < c.of.size(); ++other) {
        const int j = c.of[other];
        if (is_in[at(j)] == 0) columns.push_back(j);
        is_in[at(j)] = 1;
        sum[at(j)] += c.weight * (mine[0] * c.by[other][0] + 2 * mine[1] * c.by[other][1] + mine[2] * c.by[other][2]);
      }
    }
    std::sort(columns.begin(), columns.end());
    for (const int j : columns) {
      out.row[i].push_back({j, sum[at(j)], 0});
      sum[at(j)] = 0;
      is_in[at(j)] = 0;
    }
  }
  return out;
}

/// Renumbers rows and columns by storage, leaves out what is next to nothing, and adds the masses.
SparseRows in_storage(const SparseRows& from, const std::vector<int>& place, const std::vector<Record>& positions) {
  SparseRows out;
  out.row.resize(positions.size());
  std::vector<double> diagonal(from.row.size(), 0);
  for (std::size_t i = 0; i < from.row.size(); ++i)
    for (const SparseRows::Entry& entry : from.row[i])
      if (at(entry.column) == i) diagonal[i] = entry.stiffness;
  for (std::size_t i = 0; i < from.row.size(); ++i) {
    double own = diagonal[i];
    std::vector<SparseRows::Entry>& row = out.row[at(place[i])];
    for (const auto& [j, k, mass] : from.row[i]) {
      if (at(j) == i) continue;
      if (k * k > 1e-12 * diagonal[i] * diagonal[at(j)])
        row.push_back({place[at(j)], k, 0});
      else
        own += k;
    }
    const float inverse = positions[at(place[i])].w;
    row.push_back({place[i], own, inverse > 0 ? 1 / static_cast<double>(inverse) : 0});
    std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.column < b.column; });
  }
  return out;
}

/// B / (rho e^4) of the finest hundredth of a sheet: by its diagonals, which in a grid are 28.5 times that.
double stiffness_of_finest(const SparseRows& matrices) {
  constexpr double of_grid = 28.5;
  std::vector<double> rates;
  rates.reserve(matrices.row.size());
  for (std::size_t i = 0; i < matrices.row.size(); ++i)
    for (const auto& [j, stiffness, mass] : matrices.row[i])
      if (at(j) == i && mass > 0) rates.push_back(stiffness / mass);
  if (rates.empty()) return 0;
  const auto place = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() - 1 - rates.size() / 100);
  std::nth_element(rates.begin(), place, rates.end());
  return *place / of_grid;
}

/// Numbers the pieces of a sheet.
void find_pieces(const SheetDraft& draft, SheetBending& out) {
  const std::size_t rows = draft.rest.size();
  out.piece.assign(rows, -1);
  std::vector<char> seen(rows, 0);
  std::vector<int> stack;
  for (std::size_t seed = 0; seed < rows; ++seed) {
    if (seen[seed] != 0 || draft.around[seed].empty()) continue;
    stack.assign(1, static_cast<int>(seed));
    seen[seed] = 1;
    while (!stack.empty()) {
      const int i = stack.back();
      stack.pop_back();
      out.piece[at(i)] = out.pieces;
      for (const int j : draft.around[at(i)]) {
        if (seen[at(j)] != 0) continue;
        seen[at(j)] = 1;
        stack.push_back(j);
      }
    }
    ++out.pieces;
  }
}

/// True if the hinges at each vertex are much alike.
bool is_alike(const Object& object) {
  constexpr double none = 1e300;
  std::vector<double> least(object.positions.size(), none), most(object.positions.size(), 0);
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
      const double b = rigidity_of(hinge_at(object, group, i), double(group.compliances[i]), is_flat_hinge(group.type));
      for (std::size_t slot = 0; slot < 4; ++slot) {
        const std::size_t v = at(group.particles[4 * i + slot]);
        least[v] = std::min(least[v], b);
        most[v] = std::max(most[v], b);
      }
    }
  }
  for (std::size_t v = 0; v < least.size(); ++v)
    if (least[v] < none && !(most[v] <= largest_ratio * least[v])) return false;
  return true;
}

/// B / (rho e^4) of a sheet, e its mean edge [1/s^2]; 0 if it has no hinges with compliances, or no mass.
double sheet_stiffness(const Object& object) {
  double edges = 0, rigidity = 0, hinges = 0, area = 0, mass = 0, weighed = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type)) continue;
    for (std::size_t i = 0; i < group.compliances.size() && 4 * i + 3 < group.particles.size(); ++i) {
      const std::array<Vec3d, 4> x = hinge_at(object, group, i);
      rigidity += rigidity_of(x, double(group.compliances[i]), is_flat_hinge(group.type));
      edges += length(x[1] - x[0]);
      hinges += 1;
    }
  }
  double vertices = 0;
  std::vector<char> has_triangle(object.positions.size(), 0);
  for (const auto& triangle : object.triangles) {
    const auto& [a, b, c] = triangle;
    area += length(cross(rest_of(object, b) - rest_of(object, a), rest_of(object, c) - rest_of(object, a))) / 2;
    for (const int v : triangle) has_triangle[at(v)] = 1;
  }
  for (std::size_t v = 0; v < has_triangle.size(); ++v) {
    if (has_triangle[v] == 0) continue;
    vertices += 1;
    if (!std::isfinite(object.masses[v])) continue;
    mass += double(object.masses[v]);
    weighed += 1;
  }
  if (!(hinges > 0 && weighed > 0 && area > 0)) return 0;
  const double density = mass / weighed * vertices / area, edge = edges / hinges;
  return rigidity / hinges / (density * edge * edge * edge * edge);
}

/// Damping over stiffness of the hinges [s].
float damping_time(const Object& object) {
  float time = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_hinge(group.type) || group.compliances.empty()) continue;
    std::vector<float> sorted = group.compliances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    time = std::max(time, group.stiffness.damping * *middle);
  }
  return time;
}

SheetDraft draft_of(const SheetMesh& mesh, const std::vector<int>& place, const std::vector<char>& is_fixed,
                    std::size_t rows) {
  SheetDraft draft;
  draft.rest.resize(rows);
  draft.normal.resize(rows);
  draft.around.resize(rows);
  draft.is_fixed.assign(rows, 1);  // as the targets of attachments are, which have no triangle
  for (std::size_t v = 0; v < is_fixed.size(); ++v) {
    const int vertex = static_cast<int>(v);
    const std::size_t row = at(place[v]);
    const std::vector<int> ring = mesh.neighbours(vertex);
    draft.rest[row] = rest_of(mesh.object, vertex);
    draft.normal[row] = mesh.normal_at(vertex);
    if (ring.empty()) continue;
    draft.is_fixed[row] = is_fixed[v];
    for (const int n : ring) draft.around[row].push_back(place[at(n)]);
    std::sort(draft.around[row].begin(), draft.around[row].end());
  }
  return draft;
}

std::vector<Curvature> curvatures(const SheetMesh& mesh, const std::vector<double>& rigidity,
                                  const std::vector<char>& is_fixed) {
  const std::size_t vertices = is_fixed.size();
  std::vector<std::vector<int>> rings(vertices);
  std::vector<char> is_inner(vertices, 0), may_be_regular(vertices, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    rings[v] = mesh.neighbours(static_cast<int>(v));
    is_inner[v] = mesh.is_inner(static_cast<int>(v), rings[v]) ? 1 : 0;
    may_be_regular[v] = is_inner[v] == 0 || rings[v].size() == 6 ? 1 : 0;
  }
  std::vector<Curvature> all;
  all.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const int vertex = static_cast<int>(v);
    if (rings[v].empty() || !(rigidity[v] > 0) || !(mesh.area_at(vertex) > 0)) continue;
    const auto regular = [&](int n) { return may_be_regular[at(n)] != 0; };
    const bool has_own =
        is_inner[v] != 0 && regular(static_cast<int>(v)) && std::all_of(rings[v].begin(), rings[v].end(), regular);
    const std::vector<int> stencil = has_own ? rings[v] : wide_stencil(mesh, rings, vertex);
    all.push_back(is_fixed[v] == 0 ? curvature_at(mesh, vertex, stencil)
                                   : curvature_of_pinned(mesh, vertex, rings[v], is_fixed, stencil));
    all.back().weight = rigidity[v] * mesh.area_at(vertex) * factor_of_clamp(mesh, vertex, is_fixed);
  }
  return all;
}

}  // namespace

bool bends_as_sheet(const Object& object, double h) {
  const double stiffness = sheet_stiffness(object);
  if (!(h * h * stiffness > most_of_hinges && h * h * stiffness < most_of_floats)) return false;
  const auto can_be_sheet = [&](const ConstraintGroup& group) {
    return !is_hinge(group.type) || group.particles.empty() || (is_of_material(group) && is_flat(object, group));
  };
  return object.bodies.empty() && std::all_of(object.constraints.begin(), object.constraints.end(), can_be_sheet) &&
         has_hinges_everywhere(object) && is_at_rest(object) && is_alike(object);
}

double excess_of_hinges(const Object& object, double h) {
  constexpr double measured = 2.3;
  if (bends_as_sheet(object, h)) return 0;
  return measured * h * h * sheet_stiffness(object);
}

SheetFacts facts_of_sheet(const Object& object) {
  return {rigidities(object), sheet_stiffness(object), damping_time(object)};
}

SheetBending build_sheet(const Object& object, const SheetFacts& facts, const std::vector<int>& place,
                         const std::vector<Record>& positions) {
  const SheetMesh mesh(object);
  std::vector<char> is_fixed(object.positions.size(), 0);
  for (std::size_t v = 0; v < is_fixed.size(); ++v) is_fixed[v] = positions[at(place[v])].w == 0 ? 1 : 0;
  SheetBending out;
  out.damping_time = facts.damping_time;
  SheetDraft draft = draft_of(mesh, place, is_fixed, positions.size());
  find_pieces(draft, out);
  SparseRows matrices = in_storage(assemble(curvatures(mesh, facts.rigidity, is_fixed), is_fixed.size()), place, positions);
  out.stiffness = static_cast<float>(std::max(facts.stiffness, stiffness_of_finest(matrices)));
  append_levels(std::move(draft), std::move(matrices), out.levels);
  return out;
}

}  // namespace pliant

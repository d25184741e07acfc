// The bending energy of a flat sheet as a matrix (model/sheet_bending.h).
#include <algorithm>
#include <cmath>
#include <span>

#include "core/at.h"
#include "math/vector.h"
#include "model/sheet_bending.h"
#include "model/sheet_lattice.h"

namespace pliant {

namespace {

/// The triangles of a sheet and what is around each vertex, by the object's indices.
struct SheetMesh {
  const Object& object;
  std::vector<Vec3d> rest;                 ///< of each vertex: unrounded_rest_positions() [m]
  std::vector<double> areas;               ///< of each triangle [m^2]
  std::vector<std::vector<int>> star;      ///< of each vertex, its triangles
  std::vector<std::array<int, 3>> across;  ///< of each edge, by the smaller end: its ends, and a corner opposite to it

  explicit SheetMesh(const Object& of) : object(of), rest(unrounded_rest_positions(of)), star(of.positions.size()) {
    areas.reserve(of.triangles.size());
    across.reserve(3 * of.triangles.size());
    for (std::size_t t = 0; t < of.triangles.size(); ++t) {
      const auto& [a, b, c] = of.triangles[t];
      areas.push_back(length(cross(rest[at(b)] - rest[at(a)], rest[at(c)] - rest[at(a)])) / 2);
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
    return {across.data() + (first - across.begin()), static_cast<std::size_t>(last - first)};
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
      const Vec3d n = cross(rest[at(b)] - rest[at(a)], rest[at(c)] - rest[at(a)]);
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
  const Vec3d normal = mesh.normal_at(vertex), origin = mesh.rest[at(vertex)];
  const Vec3d helper = std::fabs(normal.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d first = cross(helper, normal), u = first * (1 / length(first)), v = cross(normal, u);
  std::vector<std::array<double, 5>> terms;
  std::vector<double> weights;
  double size = 0;
  for (const int i : ring) {
    const Vec3d d = mesh.rest[at(i)] - origin;
    size += length_squared(d) / static_cast<double>(ring.size());
  }
  size = std::sqrt(std::max(size, 1e-30));
  std::array<std::array<double, 5>, 5> normal_matrix{};
  for (const int i : ring) {
    const Vec3d d = (mesh.rest[at(i)] - origin) * (1 / size);
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

/// Sheets that bend more slowly have no coarse levels, which take 40 % of the time to build: substeps of up to 2 ms do
/// without, and longer ones, which are few, make more iterations [1/s^2].
constexpr float least_of_levels = 8000;

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
    draft.rest[row] = mesh.rest[at(vertex)];
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

SheetBending build_sheet(const Object& object, const SheetFacts& facts, const std::vector<int>& place,
                         std::vector<Record> positions, const std::vector<int>& held) {
  const SheetMesh mesh(object);
  std::vector<char> is_held(held.empty() ? 0 : positions.size(), 0);
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (held[v] == static_cast<int>(v)) continue;
    is_held[at(place[v])] = 1;
    positions[at(place[v])].w = 0;
  }
  std::vector<char> is_fixed(object.positions.size(), 0);
  for (std::size_t v = 0; v < is_fixed.size(); ++v) is_fixed[v] = positions[at(place[v])].w == 0 ? 1 : 0;
  SheetBending out;
  out.is_held = std::move(is_held);
  out.damping_time = facts.damping_time;
  SheetDraft draft = draft_of(mesh, place, is_fixed, positions.size());
  find_pieces(draft, out);
  std::vector<double> rigidity = facts.rigidity;
  unify(rigidity);
  SparseRows matrices = in_storage(assemble(curvatures(mesh, rigidity, is_fixed), is_fixed.size()), place, positions);
  out.stiffness = static_cast<float>(std::max(facts.stiffness, stiffness_of_finest(matrices)));
  // Without neighbours, no vertex is kept for a coarser level.
  if (out.stiffness < least_of_levels) draft.around.assign(draft.around.size(), {});
  append_levels(std::move(draft), std::move(matrices), out.levels);
  return out;
}

}  // namespace pliant

// Fills closed meshes with tetrahedra of a body-centred cubic lattice, and moves the border onto the mesh. Isosurface
// stuffing (Labelle and Shewchuk 2007) starts from the same lattice and cuts tetrahedra at the surface; here none is
// cut, so that all keep about the same size, which decides how long a substep may be.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>

#include "matter/closed_query.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace pliant {

namespace {

constexpr double most_nodes = 1 << 22;  // of up to six tetrahedra each
/// Nodes up to this share of a cell outside of the mesh belong to the body; the border is then about as often outside
/// as inside.
constexpr float share_of_cell_outside = 0.25f;
/// Of a tetrahedron when a corner is moved: volume over that of a regular one with edges of the same root mean square.
constexpr double least_quality = 0.25;
/// Pieces of fewer tetrahedra are dropped: two dozen share one edge of the lattice.
constexpr int fewest_of_piece = 24;
constexpr int passes = 4;

/// Cubes of side `side`, whose corners and centres are the nodes of the lattice.
struct Lattice {
  Vec3f low{};
  float side = 0;
  std::array<int, 3> cubes{};

  int corner(int x, int y, int z) const { return (z * (cubes[1] + 1) + y) * (cubes[0] + 1) + x; }
  int corners() const { return corner(cubes[0], cubes[1], cubes[2]) + 1; }
  int centre(int x, int y, int z) const { return corners() + (z * cubes[1] + y) * cubes[0] + x; }

  std::vector<Vec3f> places() const {
    std::vector<Vec3f> out;
    for (int half = 0; half < 2; ++half)
      for (int z = 0; z <= cubes[2] - half; ++z)
        for (int y = 0; y <= cubes[1] - half; ++y)
          for (int x = 0; x <= cubes[0] - half; ++x) {
            const float shift = half == 0 ? 0.f : 0.5f;
            out.push_back(low + side * Vec3f{static_cast<float>(x) + shift, static_cast<float>(y) + shift,
                                             static_cast<float>(z) + shift});
          }
    return out;
  }
};

Lattice lattice_about(const BoxBounds& bounds, float size) {
  Lattice out{.side = size};
  const Vec3f sides = bounds.high - bounds.low, middle = 0.5f * (bounds.low + bounds.high);
  const auto count = [&](float along) { return std::ceil(static_cast<double>(along) / static_cast<double>(size)) + 2; };
  const double nodes = 2 * (count(sides.x) + 1) * (count(sides.y) + 1) * (count(sides.z) + 1);
  if (!(nodes <= most_nodes))
    throw Error({.element = "size"}, "would make " + std::to_string(nodes) + " nodes", "give a larger size");
  out.cubes = {static_cast<int>(count(sides.x)), static_cast<int>(count(sides.y)), static_cast<int>(count(sides.z))};
  out.low = middle - (0.5f * size) * Vec3f{static_cast<float>(out.cubes[0]), static_cast<float>(out.cubes[1]),
                                           static_cast<float>(out.cubes[2])};
  return out;
}

/// A mesh of tetrahedra under construction, with the surface that it fills.
class Filling {
 public:
  Filling(const MeshQuery& query, const Lattice& lattice)
      : query_(query), lattice_(lattice), places_(lattice.places()) {
    is_kept_.reserve(places_.size());
    for (const Vec3f& p : places_)
      is_kept_.push_back(query_.closest(p, share_of_cell_outside * lattice_.side).triangle >= 0 || query_.is_inside(p));
    add_tetrahedra();
  }

  bool is_empty() const { return tetrahedra_.empty(); }

  /// Drops the tetrahedra of small pieces, which share faces with few others. Returns their number.
  int drop_crumbs();

  /// Moves the corners of the border onto the mesh, or as far as all tetrahedra keep a shape.
  void fit_border();

  /// The tetrahedra, with corners numbered in the order of the lattice.
  TetrahedralMesh result() const;

 private:
  Vec3d at(int node) const {
    const Vec3f& p = places_[static_cast<std::size_t>(node)];
    return {p.x, p.y, p.z};
  }
  void add_tetrahedra();
  void add(const std::array<int, 4>& nodes);
  void add_across(int here, int there, const std::array<int, 4>& face);
  double quality(const std::array<int, 4>& t) const;
  bool have_shape(std::size_t node) const;
  void move(std::size_t node, const std::vector<bool>& on_border);
  void find_uses();

  const MeshQuery& query_;
  const Lattice& lattice_;
  std::vector<Vec3f> places_;
  std::vector<bool> is_kept_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<std::size_t> first_use_, uses_;  ///< the tetrahedra at each node
};

void Filling::add(const std::array<int, 4>& nodes) {
  for (const int node : nodes)
    if (!is_kept_[static_cast<std::size_t>(node)]) return;
  std::array<int, 4> t = nodes;
  if (dot(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])), at(t[3]) - at(t[0])) < 0) std::swap(t[2], t[3]);
  tetrahedra_.push_back(t);
}

/// Four tetrahedra about the line between two centres, each with an edge of the face between them.
void Filling::add_across(int here, int there, const std::array<int, 4>& face) {
  for (std::size_t i = 0; i < 4; ++i) add({here, there, face[i], face[(i + 1) % 4]});
}

void Filling::add_tetrahedra() {
  const Lattice& l = lattice_;
  const auto& n = l.cubes;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const int here = l.centre(x, y, z);
        if (x + 1 < n[0])
          add_across(here, l.centre(x + 1, y, z),
                     {l.corner(x + 1, y, z), l.corner(x + 1, y + 1, z), l.corner(x + 1, y + 1, z + 1),
                      l.corner(x + 1, y, z + 1)});
        if (y + 1 < n[1])
          add_across(here, l.centre(x, y + 1, z),
                     {l.corner(x, y + 1, z), l.corner(x + 1, y + 1, z), l.corner(x + 1, y + 1, z + 1),
                      l.corner(x, y + 1, z + 1)});
        if (z + 1 < n[2])
          add_across(here, l.centre(x, y, z + 1),
                     {l.corner(x, y, z + 1), l.corner(x + 1, y, z + 1), l.corner(x + 1, y + 1, z + 1),
                      l.corner(x, y + 1, z + 1)});
      }
}

/// Joins the pieces of tetrahedra that share a face.
class PiecesOf {
 public:
  explicit PiecesOf(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> root_;
};

int Filling::drop_crumbs() {
  std::vector<std::pair<std::array<int, 3>, std::size_t>> sides;
  for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
    for (std::size_t without = 0; without < 4; ++without) {
      std::array<int, 3> side{};
      for (std::size_t i = 0, k = 0; i < 4; ++i)
        if (i != without) side[k++] = tetrahedra_[t][i];
      std::sort(side.begin(), side.end());
      sides.emplace_back(side, t);
    }
  std::sort(sides.begin(), sides.end());
  PiecesOf pieces(tetrahedra_.size());
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].first == sides[i - 1].first) pieces.join(sides[i].second, sides[i - 1].second);
  std::vector<int> count(tetrahedra_.size(), 0);
  for (std::size_t t = 0; t < tetrahedra_.size(); ++t) ++count[pieces.find(t)];
  std::vector<std::array<int, 4>> kept;
  for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
    if (count[pieces.find(t)] >= fewest_of_piece) kept.push_back(tetrahedra_[t]);
  const auto dropped = static_cast<int>(tetrahedra_.size() - kept.size());
  tetrahedra_ = std::move(kept);
  return dropped;
}

double Filling::quality(const std::array<int, 4>& t) const {
  constexpr double regular = 8.48528137423857;  // 6 sqrt(2): cube of the edge over the volume
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k) squares += length_squared(at(t[i]) - at(t[k])) / 6;
  const double volume = dot(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])), at(t[3]) - at(t[0])) / 6;
  return regular * volume / (squares * std::sqrt(squares));
}

void Filling::find_uses() {
  first_use_.assign(places_.size() + 1, 0);
  for (const auto& t : tetrahedra_)
    for (const int node : t) ++first_use_[static_cast<std::size_t>(node) + 1];
  std::partial_sum(first_use_.begin(), first_use_.end(), first_use_.begin());
  uses_.resize(4 * tetrahedra_.size());
  std::vector<std::size_t> next(first_use_.begin(), first_use_.end() - 1);
  for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
    for (const int node : tetrahedra_[t]) uses_[next[static_cast<std::size_t>(node)]++] = t;
}

bool Filling::have_shape(std::size_t node) const {
  for (std::size_t i = first_use_[node]; i < first_use_[node + 1]; ++i)
    if (quality(tetrahedra_[uses_[i]]) < least_quality) return false;
  return true;
}

/// Moves a node of the border all the way to the mesh, or half or a quarter of it, and an inner one towards the middle
/// of its neighbours, which gives the border room.
void Filling::move(std::size_t node, const std::vector<bool>& on_border) {
  const Vec3f from = places_[node];
  Vec3f to{};
  if (on_border[node]) {
    to = query_.closest(from).point;
  } else {
    float count = 0;
    for (std::size_t i = first_use_[node]; i < first_use_[node + 1]; ++i)
      for (const int other : tetrahedra_[uses_[i]]) {
        to += places_[static_cast<std::size_t>(other)];
        count += 1;
      }
    to = (1 / count) * to;
  }
  for (const float part : {1.f, 0.5f, 0.25f}) {
    places_[node] = from + part * (to - from);
    if (have_shape(node)) return;
  }
  places_[node] = from;
}

void Filling::fit_border() {
  std::vector<bool> on_border(places_.size(), false), beside(places_.size(), false);
  for (const auto& triangle : border_triangles({places_, tetrahedra_}))
    for (const int corner : triangle) on_border[static_cast<std::size_t>(corner)] = true;
  for (const auto& t : tetrahedra_)
    if (std::any_of(t.begin(), t.end(), [&](int corner) { return on_border[static_cast<std::size_t>(corner)]; }))
      for (const int corner : t) beside[static_cast<std::size_t>(corner)] = true;
  find_uses();
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t node = 0; node < places_.size(); ++node)
      if (on_border[node]) move(node, on_border);
    if (pass + 1 == passes) return;  // the last word is the border's
    for (std::size_t node = 0; node < places_.size(); ++node)
      if (beside[node] && !on_border[node]) move(node, on_border);
  }
}

TetrahedralMesh Filling::result() const {
  TetrahedralMesh mesh;
  std::vector<int> number(places_.size(), -1);
  for (const auto& t : tetrahedra_)
    for (const int node : t) number[static_cast<std::size_t>(node)] = 0;
  for (std::size_t node = 0; node < places_.size(); ++node) {
    if (number[node] < 0) continue;
    number[node] = static_cast<int>(mesh.positions.size());
    mesh.positions.push_back(places_[node]);
  }
  for (auto t : tetrahedra_) {
    for (int& node : t) node = number[static_cast<std::size_t>(node)];
    mesh.tetrahedra.push_back(t);
  }
  return mesh;
}

/// Says which vertices of the mesh the tetrahedra do not reach.
void note_what_is_far(const TriangleMesh& mesh, float size, FilledMesh& filled) {
  const MeshQuery border(filled.mesh.positions, border_triangles(filled.mesh));
  std::vector<bool> is_used(mesh.positions.size(), false);
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle) is_used[static_cast<std::size_t>(corner)] = true;
  std::size_t far = 0, first = 0;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i] || border.closest(mesh.positions[i], 0.5f * size).triangle >= 0) continue;
    if (border.is_inside(mesh.positions[i])) continue;  // as where the mesh overlaps itself
    if (far++ == 0) first = i;
  }
  if (far > 0)
    filled.notes.push_back(std::to_string(far) + " of " + std::to_string(is_used.size()) +
                           " vertices of the mesh, the first " + std::to_string(first) +
                           ", lie off the tetrahedra: a smaller size follows thin parts");
}

/// Far from the origin, neighbouring floats are too coarse for a lattice of this size.
void require_near_origin(const BoxBounds& bounds, float size) {
  float farthest = 0;
  for (const Vec3f& p : {bounds.low, bounds.high})
    farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (size < 1e-5f * farthest)
    throw Error({.element = "size"},
                "is " + std::to_string(size) + " m for a mesh " + std::to_string(farthest) +
                    " m from the origin, where floats are too coarse",
                "move the mesh to the origin, or give a larger size");
}

}  // namespace

FilledMesh fill_with_tetrahedra(const TriangleMesh& mesh, float size) {
  if (!(size > 0) || !std::isfinite(size))
    throw Error({.element = "size"}, "is " + std::to_string(size), "give a positive, finite length [m]");
  const MeshQuery query = query_of_closed(mesh);
  const Lattice lattice = lattice_about(query.bounds(), size);
  require_near_origin(query.bounds(), size);
  Filling filling(query, lattice);
  FilledMesh out;
  const int crumbs = filling.drop_crumbs();
  if (filling.is_empty())
    throw Error({.element = "size"},
                "is too large: the mesh has no room for tetrahedra of " + std::to_string(size) + " m",
                "give a smaller size");
  if (crumbs > 0) out.notes.push_back(std::to_string(crumbs) + " tetrahedra of small pieces apart were left out");
  filling.fit_border();
  out.mesh = filling.result();
  note_what_is_far(mesh, size, out);
  return out;
}

}  // namespace pliant

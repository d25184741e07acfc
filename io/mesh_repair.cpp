// The repairs of read_mesh, and their descriptions.
//
// Merging vertices (welding) can do harm: a sheet folded flat onto itself would become one non-manifold layer. So
// coincident vertices stay separate if merging would give an edge more than two triangles that had two or fewer. Soups
// without connectivity (STL) are always merged, because they would fall apart otherwise.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/at.h"
#include "math/disjoint_sets.h"
#include "mesh_polygons.h"

namespace pliant {

namespace {

using Triangle = std::array<int, 3>;

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  const auto position_of = [&](int i) {
    const Vec3f& p = mesh.positions[at(i)];
    return Vec3d{p.x, p.y, p.z};
  };
  // Zero if and only if the corners are collinear: for points of similar size, differences of floats and their products
  // are exact in double precision.
  return length_squared(cross(position_of(t[1]) - position_of(t[0]), position_of(t[2]) - position_of(t[0]))) > 0;
}

/// A mesh under repair. `numbers` are the triangles' indices in the file, for messages.
struct Work {
  TriangleMesh& mesh;
  std::vector<std::string>& repairs;
  std::vector<std::size_t> numbers;
};

/// Removes the triangles for which drop(i) is true.
template <class Drop>
Tally drop_triangles(Work& work, const Drop& drop) {
  Tally dropped;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < work.mesh.triangles.size(); ++i) {
    if (drop(i)) {
      dropped.add(work.numbers[i]);
      continue;
    }
    work.mesh.triangles[kept] = work.mesh.triangles[i];
    work.numbers[kept++] = work.numbers[i];
  }
  work.mesh.triangles.resize(kept);
  work.numbers.resize(kept);
  return dropped;
}

void drop_degenerate(Work& work) {
  const Tally dropped =
      drop_triangles(work, [&](std::size_t i) { return !has_area(work.mesh, work.mesh.triangles[i]); });
  if (dropped.count > 0)
    work.repairs.push_back("dropped " + counted(dropped.count, "triangle", "triangles") + " without area, the first " +
                           std::to_string(dropped.first));
}

/// For each vertex, the first vertex at the same position.
std::vector<int> find_first_in_place(const std::vector<Vec3f>& positions) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3f& p = positions[at(i)];
    return std::make_tuple(p.x, p.y, p.z, i);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[at(order[i])] == positions[at(order[i - 1])];
    first[at(order[i])] = same ? first[at(order[i - 1])] : order[i];
  }
  return first;
}

/// For each vertex, the first one at the same position to which edges of length zero connect it. Such vertices are one,
/// whatever else is at that position.
std::vector<int> find_connected_in_place(const TriangleMesh& mesh) {
  DisjointSets places(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(t[k]), b = at(t[(k + 1) % 3]);
      if (mesh.positions[a] == mesh.positions[b]) places.join(a, b);
    }
  std::vector<int> first(mesh.positions.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = static_cast<int>(places.root(i));
  return first;
}

/// A triangle rotated so that its smallest corner comes first; so triangles that differ only in their start are equal.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Marks every triangle that repeats an earlier one, corner by corner in the same cyclic order.
std::vector<bool> find_repeated(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::size_t>> sorted(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) sorted[i] = {canonical(triangles[i]), i};
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> repeated(triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) repeated[sorted[i].second] = true;
  return repeated;
}

/// A side of a triangle before and after merging, with the smaller vertex first.
struct Side {
  std::pair<int, int> after, before;
};

/// All sides that still have two vertices after merging, sorted by these vertices.
std::vector<Side> find_sides(const std::vector<Triangle>& triangles, const std::vector<int>& merged) {
  std::vector<Triangle> welded = triangles;
  for (Triangle& t : welded) t = {merged[at(t[0])], merged[at(t[1])], merged[at(t[2])]};
  const std::vector<bool> repeated = find_repeated(welded);
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3 && !repeated[i]; ++k)
      sides.push_back({std::minmax({welded[i][k], welded[i][(k + 1) % 3]}),
                       std::minmax({triangles[i][k], triangles[i][(k + 1) % 3]})});
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.after, a.before) < std::tie(b.after, b.before); });
  return sides;
}

/// Calls visit(a, b, count, was_joined) for each edge a-b of the merged mesh; `count` is its number of triangles,
/// `was_joined` is true if several edges became this one.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].after == sides[begin].after) ++end;
    visit(at(sides[begin].after.first), at(sides[begin].after.second), end - begin,
          sides[begin].before != sides[end - 1].before);
  }
}

/// Finds merged vertices that must stay separate: those on edges that merging would make non-manifold, and adjacent
/// ones that would touch in a point alone, like the corners of a sheet folded in two.
std::vector<bool> find_branching(const std::vector<Triangle>& triangles, const std::vector<int>& merged) {
  const std::vector<Side> sides = find_sides(triangles, merged);
  std::vector<bool> branching(merged.size(), false), beside(merged.size(), false), on_seam(merged.size(), false);
  for_each_edge(sides, [&](std::size_t a, std::size_t b, std::size_t count, bool was_joined) {
    if (count > 2 && was_joined) branching[a] = branching[b] = true;
  });
  for_each_edge(sides, [&](std::size_t a, std::size_t b, std::size_t, bool was_joined) {
    if (branching[a]) beside[b] = true;
    if (branching[b]) beside[a] = true;
    if (was_joined && !branching[a] && !branching[b]) on_seam[a] = on_seam[b] = true;
  });
  for (std::size_t i = 0; i < branching.size(); ++i)
    if (beside[i] && !on_seam[i]) branching[i] = true;
  return branching;
}

/// Replaces vertices by the first one at the same position; where that would do harm, only by vertices that `connected`
/// gives. Returns which vertices are no longer used.
std::vector<bool> merge_vertices(Work& work, const std::vector<int>& connected, bool is_soup) {
  TriangleMesh& mesh = work.mesh;
  std::vector<int> merged = find_first_in_place(mesh.positions);
  std::vector<bool> emptied(merged.size(), false);
  const auto stays = [&, i = 0](int to) mutable { return to == i++; };
  if (std::all_of(merged.begin(), merged.end(), stays))
    return emptied;  // no two vertices coincide, as in most meshes: skips the slow merging below
  for (Triangle& t : mesh.triangles) t = {connected[at(t[0])], connected[at(t[1])], connected[at(t[2])]};
  const std::vector<bool> branching =
      is_soup ? std::vector<bool>(merged.size(), false) : find_branching(mesh.triangles, merged);
  Tally joined, apart;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    if (at(merged[i]) == i) continue;
    if (branching[at(merged[i])]) merged[i] = connected[i];
    emptied[i] = at(merged[i]) != i;
    (emptied[i] ? joined : apart).add(i);
  }
  for (Triangle& t : mesh.triangles) t = {merged[at(t[0])], merged[at(t[1])], merged[at(t[2])]};
  if (joined.count > 0)
    work.repairs.push_back("merged " + counted(joined.count, "vertex", "vertices") +
                           " with others at the same position, the first " + std::to_string(joined.first));
  if (apart.count > 0)
    work.repairs.push_back("kept " + counted(apart.count, "vertex", "vertices") +
                           " separate from others at the same position, the first " + std::to_string(apart.first) +
                           ", because merging would join more than two triangles at an edge there");
  return emptied;
}

void drop_repeated(Work& work) {
  const std::vector<bool> repeated = find_repeated(work.mesh.triangles);
  const Tally dropped = drop_triangles(work, [&](std::size_t i) { return repeated[i]; });
  if (dropped.count > 0)
    work.repairs.push_back("dropped " + counted(dropped.count, "triangle that repeats", "triangles that repeat") +
                           " another, the first " + std::to_string(dropped.first));
}

/// Removes the vertices that merging has emptied and, if `drop_isolated`, those that no triangle uses.
void drop_vertices(Work& work, const std::vector<bool>& emptied, bool drop_isolated) {
  TriangleMesh& mesh = work.mesh;
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) used[at(corner)] = true;
  std::vector<int> number(mesh.positions.size(), -1);
  Tally dropped;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const bool isolated = !used[i] && !emptied[i];
    if (isolated && drop_isolated) dropped.add(i);
    if (emptied[i] || (isolated && drop_isolated)) continue;
    mesh.positions[kept] = mesh.positions[i];
    number[i] = static_cast<int>(kept++);
  }
  mesh.positions.resize(kept);
  for (Triangle& t : mesh.triangles) t = {number[at(t[0])], number[at(t[1])], number[at(t[2])]};
  if (dropped.count > 0)
    work.repairs.push_back("dropped " + counted(dropped.count, "vertex", "vertices") + " of no triangle, the first " +
                           std::to_string(dropped.first));
}

}  // namespace

void repair(MeshFile& file, bool is_soup, const MeshReadOptions& options) {
  Work work{file.mesh, file.repairs, {}};
  work.numbers.resize(file.mesh.triangles.size());
  std::iota(work.numbers.begin(), work.numbers.end(), std::size_t{0});
  // This must precede the removal of degenerate triangles: a strip of zero width still connects its two sides.
  const std::vector<int> connected = options.merge_duplicates ? find_connected_in_place(file.mesh) : std::vector<int>();
  if (options.drop_degenerate) drop_degenerate(work);
  std::vector<bool> emptied(file.mesh.positions.size(), false);
  if (options.merge_duplicates) {
    emptied = merge_vertices(work, connected, is_soup);
    drop_repeated(work);
  }
  drop_vertices(work, emptied, options.drop_isolated);
}

}  // namespace pliant

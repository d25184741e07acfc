#include "tetra_builder.h"

#include <algorithm>
#include <limits>

#include "far_mesh.h"
#include "pliant/error.h"
#include "tetra_parts.h"

namespace pliant {

void TetraBuilder::fail(int line, const std::string& problem, const std::string& advice) const {
  throw Error({.file = name_, .line = line}, problem, advice);
}

void TetraBuilder::add_node(std::int64_t number, const Vec3f& at, int line) {
  if (nodes_.size() == std::numeric_limits<int>::max()) fail(line, "there are too many nodes", "give a coarser mesh");
  nodes_.push_back({number, at, line});
}

void TetraBuilder::add_tetrahedron(const std::array<std::int64_t, 4>& nodes, int line) {
  if (tetrahedra_.size() == std::numeric_limits<int>::max() / 4)
    fail(line, "there are too many tetrahedra", "give a coarser mesh");
  tetrahedra_.push_back({nodes, line});
}

void TetraBuilder::sort_nodes() {
  std::stable_sort(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) { return a.number < b.number; });
  const auto same = std::adjacent_find(nodes_.begin(), nodes_.end(),
                                       [](const Node& a, const Node& b) { return a.number == b.number; });
  if (same != nodes_.end())
    fail(same[1].line, "node " + std::to_string(same->number) + " is there twice",
         "give each node a number of its own");
}

std::size_t TetraBuilder::place_of(std::int64_t number, int line) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), number,
                                      [](const Node& node, std::int64_t wanted) { return node.number < wanted; });
  if (found == nodes_.end() || found->number != number)
    fail(line, "a tetrahedron uses node " + std::to_string(number) + ", which does not exist",
         nodes_.empty() ? "the file has no nodes"
                        : "nodes run from " + std::to_string(nodes_.front().number) + " to " +
                              std::to_string(nodes_.back().number));
  return static_cast<std::size_t>(found - nodes_.begin());
}

namespace {

double six_volumes(const std::vector<Vec3f>& at, const std::array<int, 4>& t) {
  const auto from_first = [&](int corner) {
    const Vec3f &p = at[static_cast<std::size_t>(corner)], &origin = at[static_cast<std::size_t>(t[0])];
    return Vec3d{static_cast<double>(p.x) - origin.x, static_cast<double>(p.y) - origin.y,
                 static_cast<double>(p.z) - origin.z};
  };
  return dot(cross(from_first(t[1]), from_first(t[2])), from_first(t[3]));
}

}  // namespace

TetrahedralMeshFile TetraBuilder::result() {
  if (tetrahedra_.empty())
    throw Error({.file = name_}, "has no tetrahedron", "export the volume mesh, not its surface alone");
  sort_nodes();
  std::vector<int> number(nodes_.size(), -1);
  TetrahedralMeshFile out;
  std::vector<std::array<std::size_t, 4>> places;
  for (const Corners& one : tetrahedra_) {
    std::array<std::size_t, 4> at{};
    for (std::size_t i = 0; i < 4; ++i) number[at[i] = place_of(one.nodes[i], one.line)] = 0;
    places.push_back(at);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(out.mesh.positions.size());
    out.mesh.positions.push_back(nodes_[i].at);
  }
  std::size_t turned = 0;
  for (const auto& at : places) {
    std::array<int, 4> t{number[at[0]], number[at[1]], number[at[2]], number[at[3]]};
    if (six_volumes(out.mesh.positions, t) < 0) std::swap(t[2], t[3]), ++turned;
    out.mesh.tetrahedra.push_back(t);
  }
  out.repairs = std::move(repairs_);
  const Rounding rounding = rounding_of(out.mesh.positions, out.mesh.tetrahedra);
  if (rounding.is_too_coarse()) throw Error({.file = name_}, rounding.in_words(), move_nearer);
  if (rounding.is_noticeable()) out.repairs.push_back(rounding.in_words() + ": " + move_nearer);
  if (turned > 0)
    out.repairs.push_back(turned == 1 ? "1 tetrahedron was inside out, and was turned"
                                      : std::to_string(turned) + " tetrahedra were inside out, and were turned");
  if (const std::size_t unused = nodes_.size() - out.mesh.positions.size(); unused > 0)
    out.repairs.push_back(unused == 1 ? "1 node that no tetrahedron uses was left out"
                                      : std::to_string(unused) + " nodes that no tetrahedron uses were left out");
  if (std::string touching = note_of_touching_parts(out.mesh); !touching.empty())
    out.repairs.push_back(std::move(touching));
  return out;
}

}  // namespace pliant

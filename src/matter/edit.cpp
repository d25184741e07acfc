// Edits the description of an object: removes triangles, and cuts surfaces along edges.
#include "pliant/edit.h"

#include <algorithm>
#include <set>
#include <string>

#include "matter/cut_edges.h"
#include "matter/edit_parts.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"

namespace pliant {

namespace {

std::set<EdgeEnds> edges_of(const Object& object, std::span<const int> path) {
  std::vector<char> is_on(object.positions.size());
  for (const int p : path) is_on[static_cast<std::size_t>(p)] = 1;
  require_triangles(object);
  const Around around(object.triangles, is_on);
  std::set<EdgeEnds> edges;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const EdgeEnds cut = edge_of(path[i], path[i + 1]);
    if (cut.first == cut.second || triangles_of({cut.first, cut.second}, object, around).empty())
      throw Error(
          {.object = object.name, .element = "edge " + std::to_string(path[i]) + "-" + std::to_string(path[i + 1])},
          "is not an edge of a triangle, so it cannot be cut", "give a path along edges of triangles");
    edges.insert(cut);
  }
  return edges;
}

/// The edits of this file know of surfaces; tetrahedra would be left behind.
void refuse_soft_body(const Object& object) {
  if (is_soft_body(object))
    throw Error({.object = object.name}, "is a soft body, whose tetrahedra cannot be cut as a surface",
                "use part_tetrahedra or remove_tetrahedra");
}

}  // namespace

Edit unchanged(const Object& object) { return edit_to(object); }

Edit remove_triangles(const Object& object, std::span<const int> triangles) {
  refuse_soft_body(object);
  std::vector<char> present(object.triangles.size(), 1);
  for (const int t : triangles) {
    if (t < 0 || t >= static_cast<int>(present.size()))
      throw Error({.object = object.name, .element = "triangle " + std::to_string(t)},
                  "does not exist; there are " + std::to_string(present.size()), "triangles count from 0");
    present[static_cast<std::size_t>(t)] = 0;
  }
  require_triangles(object);
  std::vector<char> is_reached(object.positions.size());
  for (const int t : triangles)
    for (const int corner : object.triangles[static_cast<std::size_t>(t)])
      is_reached[static_cast<std::size_t>(corner)] = 1;
  const Around around(object.triangles, is_reached);
  Edit edit = unchanged(object);
  edit.object.triangles.clear();
  for (std::size_t t = 0; t < present.size(); ++t)
    if (present[t] != 0) edit.object.triangles.push_back(object.triangles[t]);
  for (ConstraintGroup& group : edit.object.constraints) {
    const ConstraintType& type = type_of(group, object);
    const int slots = type.stencil_size;
    rewrite(group, slots, constraints_at(group, is_reached, object), [&](int c, ConstraintGroup& kept) {
      const std::vector<int> stencil = stencil_of(group, slots, c),
                             had = triangles_of(points_of(type, stencil, object), object, around);
      const auto has =
          std::count_if(had.begin(), had.end(), [&](int t) { return present[static_cast<std::size_t>(t)] != 0; });
      if (has == std::ssize(had) || (slots == 2 && has > 0)) append(group, c, stencil, 1, kept);
    });
  }
  return edit;
}

Edit cut(const Object& object, std::span<const int> path) {
  refuse_soft_body(object);
  for (const int p : path)
    if (p < 0 || p >= static_cast<int>(object.positions.size()))
      throw Error({.object = object.name, .element = "particle " + std::to_string(p)}, "does not exist",
                  "particles count from 0");
  return cut_edges(object, edges_of(object, path));
}

Edit part_triangles(const Object& object, std::span<const int> part) {
  refuse_soft_body(object);
  if (part.size() != object.triangles.size())
    throw Error({.object = object.name},
                "has " + std::to_string(object.triangles.size()) + " triangles and is given " +
                    std::to_string(part.size()) + " numbers of parts",
                "give one for each triangle");
  return cut_edges(object, edges_between(object, part));
}

}  // namespace pliant

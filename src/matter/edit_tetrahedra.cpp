// Edits of soft bodies: removes tetrahedra, and parts them along faces.
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "matter/around.h"
#include "matter/cut_faces.h"
#include "matter/edit_parts.h"
#include "matter/part_solid.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace pliant {

std::vector<std::array<int, 4>> required_tetrahedra(const Object& object, const std::string& advice) {
  require_masses(object);
  std::vector<std::array<int, 4>> out = tetrahedra_of(object);
  if (out.empty()) throw Error({.object = object.name}, "has no tetrahedra", advice);
  bool all_exist = true;  // looked at first, without a branch for each
  for (const std::array<int, 4>& t : out)
    for (const int corner : t) all_exist &= static_cast<std::size_t>(corner) < object.positions.size();
  if (all_exist) return out;
  for (const std::array<int, 4>& t : out)
    for (const int corner : t)
      if (corner < 0 || corner >= static_cast<int>(object.positions.size()))
        throw Error({.object = object.name, .element = "particle " + std::to_string(corner)}, "does not exist",
                    "particles count from 0");
  return out;
}

std::vector<InnerFace> inner_faces(const std::vector<std::array<int, 4>>& tetrahedra, const std::vector<char>& at,
                                   const std::function<bool(const Face&)>& wanted) {
  const auto is_at = [&](int p) { return at.empty() || at[static_cast<std::size_t>(p)] != 0; };
  std::vector<std::pair<Face, int>> sides;
  for (int t = 0; t < static_cast<int>(tetrahedra.size()); ++t) {
    const auto& [a, b, c, d] = tetrahedra[static_cast<std::size_t>(t)];
    if (int{is_at(a)} + int{is_at(b)} + int{is_at(c)} + int{is_at(d)} < 3) continue;
    for (Face face : {Face{b, c, d}, Face{a, c, d}, Face{a, b, d}, Face{a, b, c}}) {
      std::sort(face.begin(), face.end());
      if (std::all_of(face.begin(), face.end(), is_at) && wanted(face)) sides.emplace_back(face, t);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<InnerFace> found;
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].first == sides[i - 1].first) found.push_back({sides[i].first, sides[i - 1].second, sides[i].second});
  return found;
}

Edit cut_faces(const Object& object, const std::set<Face>& faces, const std::vector<char>& whole) {
  std::vector<char> reached(object.positions.size());
  for (const Face& face : faces)
    for (const int p : face)
      if (whole.empty() || whole[static_cast<std::size_t>(p)] == 0) reached[static_cast<std::size_t>(p)] = 1;
  return part_solid(object, {required_tetrahedra(object), {}, faces, std::move(reached)});
}

Edit remove_tetrahedra(const Object& object, std::span<const int> tetrahedra) {
  std::vector<std::array<int, 4>> all = required_tetrahedra(object);
  std::vector<char> removed(all.size()), reached(object.positions.size());
  for (const int t : tetrahedra) {
    if (t < 0 || t >= static_cast<int>(all.size()))
      throw Error({.object = object.name, .element = "tetrahedron " + std::to_string(t)},
                  "does not exist; there are " + std::to_string(all.size()), "tetrahedra count from 0");
    removed[static_cast<std::size_t>(t)] = 1;
    for (const int corner : all[static_cast<std::size_t>(t)]) reached[static_cast<std::size_t>(corner)] = 1;
  }
  if (std::find(removed.begin(), removed.end(), 0) == removed.end())
    throw Error({.object = object.name}, "would lose all its tetrahedra", "remove the object instead");
  return part_solid(object, {std::move(all), std::move(removed), {}, std::move(reached)});
}

Edit part_tetrahedra(const Object& object, std::span<const int> part) {
  std::vector<std::array<int, 4>> all = required_tetrahedra(object);
  if (part.size() != all.size())
    throw Error({.object = object.name},
                "has " + std::to_string(all.size()) + " tetrahedra and is given " + std::to_string(part.size()) +
                    " numbers of parts",
                "give one for each tetrahedron");
  std::vector<char> reached =
      where_parts_meet(all, part, object.positions.size());  // be it in an edge or a point alone
  std::set<Face> open;
  for (const InnerFace& inner : inner_faces(all, reached))
    if (part[static_cast<std::size_t>(inner.a)] != part[static_cast<std::size_t>(inner.b)]) open.insert(inner.face);
  return part_solid(object, {std::move(all), {}, std::move(open), std::move(reached)});
}

}  // namespace pliant

// Cuts surfaces along edges.
//
// At each particle of the cut, triangles connected across uncut edges form a fan. The first fan keeps the
// particle, every other fan gets a copy of it. A constraint follows the fans of the triangles that
// contain it.
#include "matter/cut_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "matter/edit_parts.h"
#include "pliant/error.h"

namespace pliant {

namespace {

double area_of(const Object& object, int t) {
  const std::array<int, 3>& c = object.triangles[static_cast<std::size_t>(t)];
  const auto p = [&](int i) { return object.positions[static_cast<std::size_t>(c[static_cast<std::size_t>(i)])]; };
  const Vec3f n = cross(p(1) - p(0), p(2) - p(0));
  return 0.5 * std::sqrt(double(n.x) * n.x + double(n.y) * n.y + double(n.z) * n.z);
}

/// Which copy of a particle each triangle uses after a cut, and of which particle it is a copy.
class Cut {
 public:
  Cut(const Object& object, const std::set<EdgeEnds>& edges, const std::vector<char>& whole)
      : object_(object), edges_(edges), is_split_(object.positions.size()) {
    std::set<int> ends;
    for (const auto& [a, b] : edges_)
      for (const int p : {a, b})
        if (whole.empty() || whole[static_cast<std::size_t>(p)] == 0) ends.insert(p);
    std::vector<char> at(object.positions.size());
    for (const int p : ends) at[static_cast<std::size_t>(p)] = 1;
    around_ = Around(object.triangles, at);
    for (const int p : ends) split(p);
  }

  Edit make() {
    Edit edit = edit_to(object_);
    edit.object.skin.reset();
    edit.from.insert(edit.from.end(), origins_.begin(), origins_.end());
    share_masses(edit.object);
    for (const int origin : origins_) {
      const auto at = static_cast<std::size_t>(origin);
      edit.object.positions.push_back(object_.positions[at]);
      if (!object_.velocities.empty()) edit.object.velocities.push_back(object_.velocities[at]);
    }
    for (const auto& [place, copy] : copies_) {
      std::array<int, 3>& corners = edit.object.triangles[static_cast<std::size_t>(place.second)];
      std::replace(corners.begin(), corners.end(), place.first, copy);
    }
    split_constraints(edit.object.constraints);
    hold_like(origins_, particles(), edit.object);
    return edit;
  }

 private:
  int particles() const { return static_cast<int>(object_.positions.size()); }

  /// The copy of particle p that triangle t uses; p itself if it uses no copy.
  int copy(int p, int t) const {
    const auto found = copies_.find({p, t});
    return found == copies_.end() ? p : found->second;
  }

  /// Splits a particle by its fans of triangles: the first fan keeps it.
  void split(int p) {
    const std::span<const int> around = around_[p];
    std::set<int> left(around.begin(), around.end());
    for (bool first = true; !left.empty(); first = false) {
      std::vector<int> fan{*left.begin()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < fan.size(); ++i) {
        for (auto other = left.begin(); other != left.end();) {
          if (!joined(p, fan[i], *other)) {
            ++other;
            continue;
          }
          fan.push_back(*other);
          other = left.erase(other);
        }
      }
      if (first) continue;
      origins_.push_back(p);
      is_split_[static_cast<std::size_t>(p)] = 1;
      for (const int t : fan) copies_[{p, t}] = particles() + static_cast<int>(origins_.size()) - 1;
    }
  }

  /// True if two triangles share an uncut edge at p.
  bool joined(int p, int a, int b) const {
    for (const int other : object_.triangles[static_cast<std::size_t>(a)])
      if (other != p && has_corner(object_.triangles[static_cast<std::size_t>(b)], other) &&
          edges_.count(edge_of(p, other)) == 0)
        return true;
    return false;
  }

  void share_masses(Object& out) const {
    out.masses.resize(static_cast<std::size_t>(particles()) + origins_.size());
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      const auto origin = static_cast<std::size_t>(origins_[i]);
      double whole = 0, part = 0;
      for (const int t : around_[origins_[i]]) {
        whole += area_of(object_, t);
        if (copy(origins_[i], t) == particles() + static_cast<int>(i)) part += area_of(object_, t);
      }
      const double share = whole > 0 ? part / whole : 0.5;
      const float mass = object_.masses[origin];
      float& of_copy = out.masses[static_cast<std::size_t>(particles()) + i];
      of_copy = std::isinf(mass) ? mass : static_cast<float>(mass * share);
      if (!std::isinf(mass)) out.masses[origin] -= of_copy;
    }
  }

  /// Distributes the constraints on particles that split. Other particles of these are looked up in their triangles
  /// too.
  void split_constraints(std::vector<ConstraintGroup>& groups) {
    std::vector<std::vector<int>> reached;  // of each group
    std::vector<char> at(object_.positions.size());
    for (const ConstraintGroup& group : groups) {
      const ConstraintType& type = type_of(group, object_);
      reached.push_back(constraints_at(group, is_split_, object_));
      for (const int c : reached.back())
        for (const int p : points_of(type, stencil_of(group, type.stencil_size, c), object_))
          if (p >= 0) at[static_cast<std::size_t>(p)] = 1;
    }
    around_ = Around(object_.triangles, at);
    for (std::size_t g = 0; g < groups.size(); ++g) split(groups[g], reached[g]);
  }

  void split(ConstraintGroup& group, const std::vector<int>& reached) const {
    const ConstraintType& type = type_of(group, object_);
    rewrite(group, type.stencil_size, reached, [&](int c, ConstraintGroup& out) { split(group, type, c, out); });
  }

  /// A constraint on one side of the cut follows it, an edge on the cut is doubled, others are removed.
  void split(const ConstraintGroup& group, const ConstraintType& type, int number, ConstraintGroup& out) const {
    const int slots = type.stencil_size, tied = tied_slot(type);
    const std::vector<int> stencil = stencil_of(group, slots, number);
    std::vector<int> points = points_of(type, stencil, object_);
    if (tied >= 0) points[static_cast<std::size_t>(tied)] = -1;  // it may be of other triangles
    const std::vector<int> triangles = triangles_of(points, object_, around_);
    std::map<std::vector<int>, double> sides;  // area of the triangles on each side; key: stencil on that side
    if (triangles.empty()) sides[stencil] = 0;
    double whole = 0;
    for (const int t : triangles) {
      std::vector<int> side = copies(points, t, triangles);
      for (std::size_t slot = 0; slot < side.size(); ++slot)
        if (side[slot] < 0) side[slot] = stencil[slot];
      sides[side] += area_of(object_, t);
      whole += area_of(object_, t);
    }
    if (sides.size() > 1 && slots > 2) return;
    for (const auto& [side, area] : sides) {
      append(group, number, side, sides.size() > 1 && area > 0 ? whole / area : 1, out);
      append_for_copies(group, number, side, type, origins_, particles(), out);
    }
  }

  /// The stencil after the cut, as seen from triangle t; particles that t does not contain are taken from the other
  /// triangles.
  std::vector<int> copies(const std::vector<int>& stencil, int t, const std::vector<int>& triangles) const {
    std::vector<int> out;
    for (const int p : stencil) {
      if (p < 0) {
        out.push_back(p);
        continue;
      }
      int sees = t;
      for (const int other : triangles)
        if (!has_corner(object_.triangles[static_cast<std::size_t>(sees)], p)) sees = other;
      out.push_back(copy(p, sees));
    }
    return out;
  }

  const Object& object_;
  const std::set<EdgeEnds>& edges_;
  Around around_;                              ///< at the particles that are looked up
  std::vector<char> is_split_;                 ///< by particle
  std::map<std::pair<int, int>, int> copies_;  ///< copy that a triangle uses of a particle; key: particle and triangle
  std::vector<int> origins_;                   ///< original particle of each copy
};

}  // namespace

void require_triangles(const Object& object) {
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (const int corner : object.triangles[t])
      if (corner < 0 || corner >= static_cast<int>(object.positions.size()))
        throw Error({.object = object.name, .element = "triangle " + std::to_string(t)},
                    "uses a particle that does not exist", "particles count from 0");
}

std::vector<int> triangles_of(const std::vector<int>& stencil, const Object& object, const Around& around) {
  std::set<int> found;
  for (const int particle : stencil) {
    if (particle < 0) continue;
    for (const int t : around[particle]) {
      const std::array<int, 3>& corners = object.triangles[static_cast<std::size_t>(t)];
      const auto inside =
          std::count_if(stencil.begin(), stencil.end(), [&](int other) { return has_corner(corners, other); });
      if (inside >= std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(stencil.size()), 3)) found.insert(t);
    }
  }
  return {found.begin(), found.end()};
}

std::set<EdgeEnds> edges_between(const Object& object, std::span<const int> part) {
  require_triangles(object);
  const std::vector<char> meet = where_parts_meet(object.triangles, part, object.positions.size());
  const auto is_between = [&](const EdgeEnds& edge) {
    return meet[static_cast<std::size_t>(edge.first)] != 0 && meet[static_cast<std::size_t>(edge.second)] != 0;
  };
  std::map<EdgeEnds, int> part_of;  // of edges between two such particles: few
  std::set<EdgeEnds> found;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const auto& [a, b, c] = object.triangles[t];
    for (const EdgeEnds& edge : {edge_of(a, b), edge_of(b, c), edge_of(c, a)})
      if (is_between(edge) && part_of.try_emplace(edge, part[t]).first->second != part[t]) found.insert(edge);
  }
  return found;
}

Edit cut_edges(const Object& object, const std::set<EdgeEnds>& edges, const std::vector<char>& whole) {
  require_masses(object);
  require_triangles(object);
  return Cut(object, edges, whole).make();
}

}  // namespace pliant

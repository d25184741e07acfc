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
  Cut(const Object& object, const std::set<Edge>& edges, const std::vector<char>& whole)
      : object_(object), edges_(edges), around_(triangles_around(object)) {
    std::set<int> ends;
    for (const auto& [a, b] : edges_) ends.insert({a, b});
    for (const int p : ends)
      if (whole.empty() || whole[static_cast<std::size_t>(p)] == 0) split(p);
  }

  Edit make() {
    Edit edit{object_, {}};
    edit.object.skin.reset();
    for (int p = 0; p < particles(); ++p) edit.from.push_back(p);
    edit.from.insert(edit.from.end(), origins_.begin(), origins_.end());
    share_masses(edit.object);
    for (const int origin : origins_) {
      const auto at = static_cast<std::size_t>(origin);
      edit.object.positions.push_back(object_.positions[at]);
      if (!object_.velocities.empty()) edit.object.velocities.push_back(object_.velocities[at]);
    }
    for (std::size_t t = 0; t < object_.triangles.size(); ++t)
      for (int& corner : edit.object.triangles[t]) corner = copy(corner, static_cast<int>(t));
    for (ConstraintGroup& group : edit.object.constraints) group = split(group);
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      hold_like(origins_[i], particles() + static_cast<int>(i), edit.object);
    }
    return edit;
  }

 private:
  int particles() const { return static_cast<int>(around_.size()); }

  bool is_split(int p) const {
    const auto found = copies_.lower_bound({p, -1});
    return found != copies_.end() && found->first.first == p;
  }

  /// The copy of particle p that triangle t uses; p itself if it uses no copy.
  int copy(int p, int t) const {
    const auto found = copies_.find({p, t});
    return found == copies_.end() ? p : found->second;
  }

  /// Splits a particle by its fans of triangles: the first fan keeps it.
  void split(int p) {
    const std::vector<int>& around = around_[static_cast<std::size_t>(p)];
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
      for (const int t : around_[origin]) {
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

  /// Distributes a group's constraints: those on one side of the cut follow it, edges on the cut are doubled, others
  /// are removed.
  ConstraintGroup split(const ConstraintGroup& group) const {
    const ConstraintType& type = type_of(group, object_);
    const int slots = type.stencil_size;
    ConstraintGroup out = empty_like(group);
    for (int c = 0; c < static_cast<int>(group.particles.size()) / slots; ++c) {
      const std::vector<int> stencil = stencil_of(group, slots, c), points = points_of(type, stencil, object_);
      if (std::none_of(points.begin(), points.end(), [&](int p) { return is_split(p); })) {
        append(group, c, stencil, 1, out);
        continue;
      }
      const std::vector<int> triangles = triangles_of(points, object_, around_);
      if (triangles.empty()) {
        append_for_copies(group, c, stencil, out);
        continue;
      }
      std::map<std::vector<int>, double> sides;  // area of the triangles on each side; key: stencil on that side
      double whole = 0;
      for (const int t : triangles) {
        std::vector<int> side = copies(points, t, triangles);
        for (std::size_t slot = 0; slot < side.size(); ++slot)
          if (side[slot] < 0) side[slot] = stencil[slot];
        sides[side] += area_of(object_, t);
        whole += area_of(object_, t);
      }
      if (sides.size() > 1 && slots > 2) continue;
      for (const auto& [side, area] : sides) append(group, c, side, sides.size() > 1 && area > 0 ? whole / area : 1, out);
    }
    return out;
  }

  /// Appends a constraint that belongs to no triangle. What ties a particle to a body also ties its copies.
  void append_for_copies(const ConstraintGroup& group, int number, std::vector<int> stencil, ConstraintGroup& out) const {
    append(group, number, stencil, 1, out);
    if (group.type != "body_anchor") return;
    const int tied = stencil.back();
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      if (origins_[i] != tied) continue;
      stencil.back() = particles() + static_cast<int>(i);
      append(group, number, stencil, 1, out);
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
  const std::set<Edge>& edges_;
  Around around_;
  std::map<std::pair<int, int>, int> copies_;  ///< copy that a triangle uses of a particle; key: particle and triangle
  std::vector<int> origins_;                   ///< original particle of each copy
};

}  // namespace

Around triangles_around(const Object& object, const std::vector<char>* present) {
  Around around(object.positions.size());
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    if (present != nullptr && (*present)[t] == 0) continue;
    for (const int corner : object.triangles[t]) {
      if (corner < 0 || corner >= static_cast<int>(around.size()))
        throw Error({.object = object.name, .element = "triangle " + std::to_string(t)},
                    "uses a particle that does not exist", "particles count from 0");
      around[static_cast<std::size_t>(corner)].push_back(static_cast<int>(t));
    }
  }
  return around;
}

std::vector<int> triangles_of(const std::vector<int>& stencil, const Object& object, const Around& around) {
  std::set<int> found;
  for (const int particle : stencil) {
    if (particle < 0) continue;
    for (const int t : around[static_cast<std::size_t>(particle)]) {
      const std::array<int, 3>& corners = object.triangles[static_cast<std::size_t>(t)];
      const auto inside =
          std::count_if(stencil.begin(), stencil.end(), [&](int other) { return has_corner(corners, other); });
      if (inside >= std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(stencil.size()), 3)) found.insert(t);
    }
  }
  return {found.begin(), found.end()};
}

std::set<Edge> edges_between(const Object& object, std::span<const int> part) {
  std::map<Edge, int> part_of;
  std::set<Edge> found;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const auto& [a, b, c] = object.triangles[t];
    for (const Edge& edge : {edge_of(a, b), edge_of(b, c), edge_of(c, a)})
      if (part_of.try_emplace(edge, part[t]).first->second != part[t]) found.insert(edge);
  }
  return found;
}

Edit cut_edges(const Object& object, const std::set<Edge>& edges, const std::vector<char>& whole) {
  require_masses(object);
  return Cut(object, edges, whole).make();
}

}  // namespace pliant

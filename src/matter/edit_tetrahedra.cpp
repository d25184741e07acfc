// Edits of soft bodies: removes tetrahedra, and parts them along faces.
//
// At each particle that the edit reaches, tetrahedra of one part that share faces form a fan. The first fan keeps the particle, every
// other fan gets a copy of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "constraints/distance_limit.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "matter/cut_faces.h"
#include "matter/edit_parts.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "topology/sort_by_first.h"

namespace pliant {

namespace {

using Corners = std::array<int, 4>;

bool holds(const Corners& t, int particle) { return std::find(t.begin(), t.end(), particle) != t.end(); }

/// The corners that two tetrahedra share; nothing if these are not three.
std::optional<Face> shared_face(const Corners& a, const Corners& b) {
  Face face{};
  std::size_t count = 0;
  for (const int corner : a) {
    if (!holds(b, corner)) continue;
    if (count == 3) return {};
    face[count++] = corner;
  }
  if (count < 3) return {};
  std::sort(face.begin(), face.end());
  return face;
}

double volume_of(const Object& object, const Corners& t) {
  const auto at = [&](std::size_t i) {
    const Vec3f& p = object.positions[static_cast<std::size_t>(t[i])];
    return Vec3d{p.x, p.y, p.z};
  };
  return std::fabs(dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0))) / 6;
}

/// A soft body that comes apart along some faces, or loses some tetrahedra.
class Parting {
 public:
  /// Fans are formed around the particles of `reached`.
  Parting(const Object& object, std::vector<Corners> tetrahedra, std::set<int> removed, std::set<Face> open,
          const std::set<int>& reached)
      : object_(object),
        tetrahedra_(std::move(tetrahedra)),
        removed_(std::move(removed)),
        open_(std::move(open)),
        around_(object.positions.size()) {
    for (int t = 0; t < static_cast<int>(tetrahedra_.size()); ++t)
      for (const int corner : at(t)) around_[static_cast<std::size_t>(corner)].push_back(t);
    after_ = tetrahedra_;
    for (const int p : reached) split(p);
  }

  Edit make() {
    Edit edit = unchanged(object_);
    edit.object.skin.reset();
    edit.from.insert(edit.from.end(), origins_.begin(), origins_.end());
    for (const int origin : origins_) {
      const auto from = static_cast<std::size_t>(origin);
      edit.object.positions.push_back(object_.positions[from]);
      if (!object_.velocities.empty()) edit.object.velocities.push_back(object_.velocities[from]);
    }
    edit.object.masses.resize(edit.object.positions.size());
    for (const auto& [particle, share] : shares_) {
      const float mass = object_.masses[static_cast<std::size_t>(origin_of(particle))];
      edit.object.masses[static_cast<std::size_t>(particle)] =
          share > 0 ? static_cast<float>(double(mass) * share) : std::numeric_limits<float>::infinity();
    }
    for (ConstraintGroup& group : edit.object.constraints) group = follow(group);
    for (Cluster& cluster : edit.object.clusters) leave_out_left_over(cluster);
    for (std::size_t i = 0; i < origins_.size(); ++i)
      hold_like(origins_[i], static_cast<int>(object_.positions.size() + i), edit.object);
    std::erase_if(edit.object.triangles, [&](const std::array<int, 3>& triangle) { return is_of_tetrahedron(triangle); });
    const std::vector<std::array<int, 3>> border = border_triangles({edit.object.positions, kept()});
    edit.object.triangles.insert(edit.object.triangles.end(), border.begin(), border.end());
    return edit;
  }

 private:
  const Corners& at(int t) const { return tetrahedra_[static_cast<std::size_t>(t)]; }
  bool is_removed(int t) const { return removed_.count(t) != 0; }
  int origin_of(int particle) const {
    const auto first = static_cast<int>(object_.positions.size());
    return particle < first ? particle : origins_[static_cast<std::size_t>(particle - first)];
  }

  /// True if a particle had tetrahedra, and all of them are removed.
  bool is_left_over(int p) const {
    const auto share = shares_.find(p);
    return share != shares_.end() && !(share->second > 0);
  }

  void leave_out_left_over(Cluster& cluster) const {
    for (std::size_t i = cluster.particles.size(); i-- > 0;) {
      if (!is_left_over(cluster.particles[i])) continue;
      cluster.particles.erase(cluster.particles.begin() + static_cast<std::ptrdiff_t>(i));
      if (!cluster.rest.empty()) cluster.rest.erase(cluster.rest.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  /// True if a triangle has the corners of a tetrahedron; others are of cloth in the same object.
  bool is_of_tetrahedron(const std::array<int, 3>& triangle) const {
    const std::vector<int>& around = around_[static_cast<std::size_t>(triangle[0])];
    return std::any_of(around.begin(), around.end(),
                       [&](int t) { return holds(at(t), triangle[1]) && holds(at(t), triangle[2]); });
  }

  /// The fans of tetrahedra around a particle, without those that are removed.
  std::vector<std::vector<int>> fans_of(int p) const {
    std::vector<int> left;
    for (const int t : around_[static_cast<std::size_t>(p)])
      if (!is_removed(t)) left.push_back(t);
    std::vector<std::vector<int>> fans;
    while (!left.empty()) {
      std::vector<int> fan{left.front()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (auto other = left.begin(); other != left.end();) {
          const std::optional<Face> face = shared_face(at(*other), at(fan[i]));
          if (!face || open_.count(*face) != 0) {
            ++other;
            continue;
          }
          fan.push_back(*other);
          other = left.erase(other);
        }
      fans.push_back(std::move(fan));
    }
    return fans;
  }

  void split(int p) {
    double whole = 0;
    for (const int t : around_[static_cast<std::size_t>(p)]) whole += volume_of(object_, at(t));
    int particle = p;
    shares_[p] = 0;
    for (const std::vector<int>& fan : fans_of(p)) {
      double volume = 0;
      for (const int t : fan) {
        volume += volume_of(object_, at(t));
        Corners& after = after_[static_cast<std::size_t>(t)];
        std::replace(after.begin(), after.end(), p, particle);
      }
      if (particle != p) origins_.push_back(p);
      shares_[particle] = whole > 0 ? volume / whole : 1;
      particle = static_cast<int>(object_.positions.size() + origins_.size());
    }
  }

  std::vector<Corners> kept() const {
    std::vector<Corners> out;
    for (std::size_t t = 0; t < after_.size(); ++t)
      if (!is_removed(static_cast<int>(t))) out.push_back(after_[t]);
    return out;
  }

  /// A group's constraints after the edit: those on particles of a tetrahedron follow it.
  ConstraintGroup follow(const ConstraintGroup& group) const {
    const int slots = slots_of(group, object_);
    const auto type = std::find_if(constraint_types().begin(), constraint_types().end(),
                                   [&](const ConstraintType& one) { return one.name == group.type; });
    ConstraintGroup out = empty_like(group);
    for (int c = 0; c < static_cast<int>(group.particles.size()) / slots; ++c) {
      std::vector<int> stencil = stencil_of(group, slots, c);
      if (std::none_of(stencil.begin(), stencil.end(), [&](int slot) { return shares_.count(slot) != 0; })) {
        append(group, c, stencil, 1, out);
        continue;
      }
      const std::vector<int> with = tetrahedra_with(stencil, *type);
      if (group.type == DistanceLimit::name && !with.empty()) {
        append_to_all(group, c, stencil, *type, with, out);
        continue;
      }
      const auto left = std::find_if(with.begin(), with.end(), [&](int t) { return !is_removed(t); });
      if (!with.empty() ? left == with.end() : uses_left_over(stencil, *type)) continue;
      if (!with.empty()) replace_corners(*left, *type, stencil);
      append(group, c, stencil, 1, out);
      if (group.type == "body_anchor" && with.empty()) tie_copies(group, c, stencil, out);
    }
    return out;
  }

  /// A limit of an edge holds for all of its copies.
  void append_to_all(const ConstraintGroup& group, int constraint, const std::vector<int>& stencil,
                     const ConstraintType& type, const std::vector<int>& with, ConstraintGroup& out) const {
    std::set<std::vector<int>> copies;
    for (const int t : with) {
      if (is_removed(t)) continue;
      std::vector<int> copy = stencil;
      replace_corners(t, type, copy);
      if (copies.insert(copy).second) append(group, constraint, copy, 1, out);
    }
  }

  bool uses_left_over(const std::vector<int>& stencil, const ConstraintType& type) const {
    for (std::size_t slot = 0; slot < stencil.size(); ++slot)
      if (type.slots[slot] == SlotKind::point && is_left_over(stencil[slot])) return true;
    return false;
  }

  /// The tetrahedra that have all points of a constraint as corners, of a tie those that it ties to; none for a constraint of one point.
  std::vector<int> tetrahedra_with(const std::vector<int>& stencil, const ConstraintType& type) const {
    std::vector<int> points, out;
    for (std::size_t slot = 0; slot < stencil.size(); ++slot)
      if (type.slots[slot] == SlotKind::point) points.push_back(stencil[slot]);
    if (type.name == PointOnTriangle::name || type.name == PointInTetrahedron::name) points.erase(points.begin());
    if (points.size() < 2) return out;
    for (const int t : around_[static_cast<std::size_t>(points.back())])
      if (std::all_of(points.begin(), points.end(), [&](int p) { return holds(at(t), p); })) out.push_back(t);
    return out;
  }

  void replace_corners(int t, const ConstraintType& type, std::vector<int>& stencil) const {
    for (std::size_t slot = 0; slot < stencil.size(); ++slot) {
      if (type.slots[slot] != SlotKind::point) continue;
      const auto corner = std::find(at(t).begin(), at(t).end(), stencil[slot]) - at(t).begin();
      if (corner == 4) continue;
      stencil[slot] = after_[static_cast<std::size_t>(t)][static_cast<std::size_t>(corner)];
    }
  }

  /// What ties a particle to a body also ties its copies.
  void tie_copies(const ConstraintGroup& group, int number, std::vector<int> stencil, ConstraintGroup& out) const {
    const int tied = stencil.back();
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      if (origins_[i] != tied) continue;
      stencil.back() = static_cast<int>(object_.positions.size() + i);
      append(group, number, stencil, 1, out);
    }
  }

  const Object& object_;
  std::vector<Corners> tetrahedra_, after_;  ///< corners before and after the edit
  std::set<int> removed_;
  std::set<Face> open_;
  std::vector<std::vector<int>> around_;  ///< tetrahedra at each particle
  std::vector<int> origins_;              ///< original particle of each copy
  std::map<int, double> shares_;          ///< of particles that the edit reaches: share of the original's mass
};

}  // namespace

std::vector<std::array<int, 4>> required_tetrahedra(const Object& object, const std::string& advice) {
  require_masses(object);
  std::vector<Corners> out = tetrahedra_of(object);
  if (out.empty()) throw Error({.object = object.name}, "has no tetrahedra", advice);
  for (const Corners& t : out)
    for (const int corner : t)
      if (corner < 0 || corner >= static_cast<int>(object.positions.size()))
        throw Error({.object = object.name, .element = "particle " + std::to_string(corner)}, "does not exist",
                    "particles count from 0");
  return out;
}

std::vector<InnerFace> inner_faces(const std::vector<std::array<int, 4>>& tetrahedra) {
  std::vector<std::pair<Face, int>> sides;
  sides.reserve(4 * tetrahedra.size());
  for (int t = 0; t < static_cast<int>(tetrahedra.size()); ++t) {
    const auto& [a, b, c, d] = tetrahedra[static_cast<std::size_t>(t)];
    for (Face face : {Face{b, c, d}, Face{a, c, d}, Face{a, b, d}, Face{a, b, c}}) {
      std::sort(face.begin(), face.end());
      sides.emplace_back(face, t);
    }
  }
  const auto first = [](const std::pair<Face, int>& side) { return side.first[0]; };
  int particles = 0;
  for (const auto& side : sides) particles = std::max(particles, first(side) + 1);
  sort_by_first(sides, static_cast<std::size_t>(particles), first, std::less<>());
  std::vector<InnerFace> found;
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].first == sides[i - 1].first) found.push_back({sides[i].first, sides[i - 1].second, sides[i].second});
  return found;
}

Edit cut_faces(const Object& object, const std::set<Face>& faces, const std::vector<char>& whole) {
  std::set<int> reached;
  for (const Face& face : faces)
    for (const int p : face)
      if (whole.empty() || whole[static_cast<std::size_t>(p)] == 0) reached.insert(p);
  return Parting(object, required_tetrahedra(object), {}, faces, reached).make();
}

Edit remove_tetrahedra(const Object& object, std::span<const int> tetrahedra) {
  std::vector<Corners> all = required_tetrahedra(object);
  std::set<int> removed, reached;
  for (const int t : tetrahedra) {
    if (t < 0 || t >= static_cast<int>(all.size()))
      throw Error({.object = object.name, .element = "tetrahedron " + std::to_string(t)},
                  "does not exist; there are " + std::to_string(all.size()), "tetrahedra count from 0");
    removed.insert(t);
    reached.insert(all[static_cast<std::size_t>(t)].begin(), all[static_cast<std::size_t>(t)].end());
  }
  if (removed.size() == all.size())
    throw Error({.object = object.name}, "would lose all its tetrahedra", "remove the object with World::remove");
  return Parting(object, std::move(all), removed, {}, reached).make();
}

Edit part_tetrahedra(const Object& object, std::span<const int> part) {
  std::vector<Corners> all = required_tetrahedra(object);
  if (part.size() != all.size())
    throw Error({.object = object.name},
                "has " + std::to_string(all.size()) + " tetrahedra and is given " + std::to_string(part.size()) +
                    " numbers of parts",
                "give one for each of tetrahedra_of");
  std::map<int, int> part_at;  // of the first tetrahedron at each particle
  std::set<int> reached;       // where parts meet, be it in an edge or a point alone
  for (std::size_t t = 0; t < all.size(); ++t)
    for (const int corner : all[t])
      if (part_at.try_emplace(corner, part[t]).first->second != part[t]) reached.insert(corner);
  std::set<Face> open;
  for (const InnerFace& inner : inner_faces(all))
    if (part[static_cast<std::size_t>(inner.a)] != part[static_cast<std::size_t>(inner.b)]) open.insert(inner.face);
  return Parting(object, std::move(all), {}, open, reached).make();
}

}  // namespace pliant

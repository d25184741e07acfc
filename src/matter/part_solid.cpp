// At each particle that the edit reaches, tetrahedra of one part that share faces form a fan. The first fan keeps the
// particle, every other fan gets a copy of it.
#include "matter/part_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "constraints/distance_limit.h"
#include "matter/around.h"
#include "matter/edit_parts.h"
#include "matter/solid_border.h"
#include "matter/tetrahedron_faces.h"

namespace pliant {

namespace {

using Corners = std::array<int, 4>;

/// The corners that two tetrahedra share; nothing if these are not three.
std::optional<Face> shared_face(const Corners& a, const Corners& b) {
  Face face{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (count + 1 < i) return {};  // two of them are not shared
    if (!has_corner(b, a[i])) continue;
    if (count == 3) return {};
    face[count++] = a[i];
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
  Parting(const Object& object, SolidParting parting)
      : object_(object),
        before_(std::move(parting)),
        after_(before_.tetrahedra),
        around_(before_.tetrahedra, before_.reached) {
    for (std::size_t p = 0; p < before_.reached.size(); ++p)
      if (before_.reached[p] != 0) split(static_cast<int>(p));
  }

  Edit make() {
    Edit edit = edit_to(object_);
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
    follow(edit.object.constraints);
    for (Cluster& cluster : edit.object.clusters) leave_out_left_over(cluster);
    hold_like(origins_, static_cast<int>(object_.positions.size()), edit.object);
    edit.object.triangles = surface_after(object_, before_, after_, edit.object.positions);
    return edit;
  }

 private:
  const Corners& at(int t) const { return before_.tetrahedra[static_cast<std::size_t>(t)]; }
  bool is_removed(int t) const { return !before_.removed.empty() && before_.removed[static_cast<std::size_t>(t)] != 0; }
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
    if (before_.removed.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cluster.particles.size(); ++i) {
      if (is_left_over(cluster.particles[i])) continue;
      cluster.particles[kept] = cluster.particles[i];
      if (!cluster.rest.empty()) cluster.rest[kept] = cluster.rest[i];
      ++kept;
    }
    cluster.particles.resize(kept);
    if (!cluster.rest.empty()) cluster.rest.resize(kept);
  }

  /// The fans of tetrahedra around a particle, without those that are removed.
  std::vector<std::vector<int>> fans_of(int p) const {
    std::vector<int> left;
    for (const int t : around_[p])
      if (!is_removed(t)) left.push_back(t);
    std::vector<std::vector<int>> fans;
    while (!left.empty()) {
      std::vector<int> fan{left.front()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (auto other = left.begin(); other != left.end();) {
          const std::optional<Face> face = shared_face(at(*other), at(fan[i]));
          if (!face || before_.open.count(*face) != 0) {
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
    for (const int t : around_[p]) whole += volume_of(object_, at(t));
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

  /// The constraints on reached particles follow the tetrahedra that these are of. Other particles of them may be those
  /// of a tetrahedron farther away, as of a tie.
  void follow(std::vector<ConstraintGroup>& groups) {
    std::vector<std::vector<int>> reached;  // of each group
    std::vector<char> looked_up(object_.positions.size());
    for (const ConstraintGroup& group : groups) {
      const ConstraintType& type = type_of(group, object_);
      reached.push_back(constraints_at(group, before_.reached, object_));
      for (const int c : reached.back())
        for (const int p : points_of(type, stencil_of(group, type.stencil_size, c), object_))
          if (p >= 0) looked_up[static_cast<std::size_t>(p)] = 1;
    }
    around_ = Around(before_.tetrahedra, looked_up);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const ConstraintType& type = type_of(groups[g], object_);
      rewrite(groups[g], type.stencil_size, reached[g],
              [&](int c, ConstraintGroup& out) { follow(groups[g], type, c, out); });
    }
  }

  void follow(const ConstraintGroup& group, const ConstraintType& type, int number, ConstraintGroup& out) const {
    std::vector<int> stencil = stencil_of(group, type.stencil_size, number);
    const std::vector<int> with = tetrahedra_with(stencil, type);
    if (group.type == DistanceLimit::name && !with.empty())
      return append_to_all(group, number, stencil, type, with, out);
    const auto left = std::find_if(with.begin(), with.end(), [&](int t) { return !is_removed(t); });
    if (uses_left_over(stencil, type) || (!with.empty() && left == with.end())) return;
    if (!with.empty()) replace_corners(*left, type, stencil);
    append(group, number, stencil, 1, out);
    append_for_copies(group, number, stencil, type, origins_, static_cast<int>(object_.positions.size()), out);
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

  /// The tetrahedra that have all points of a constraint as corners, of a tie those that it ties to; none for a
  /// constraint of one point.
  std::vector<int> tetrahedra_with(const std::vector<int>& stencil, const ConstraintType& type) const {
    std::vector<int> points, out;
    for (std::size_t slot = 0; slot < stencil.size(); ++slot)
      if (type.slots[slot] == SlotKind::point && static_cast<int>(slot) != tied_slot(type))
        points.push_back(stencil[slot]);
    if (points.size() < 2) return out;
    for (const int t : around_[points.back()])
      if (std::all_of(points.begin(), points.end(), [&](int p) { return has_corner(at(t), p); })) out.push_back(t);
    return out;
  }

  void replace_corners(int t, const ConstraintType& type, std::vector<int>& stencil) const {
    for (std::size_t slot = 0; slot < stencil.size(); ++slot) {
      if (type.slots[slot] != SlotKind::point || static_cast<int>(slot) == tied_slot(type)) continue;
      const auto corner = std::find(at(t).begin(), at(t).end(), stencil[slot]) - at(t).begin();
      if (corner == 4) continue;
      stencil[slot] = after_[static_cast<std::size_t>(t)][static_cast<std::size_t>(corner)];
    }
  }

  const Object& object_;
  SolidParting before_;
  std::vector<Corners> after_;    ///< of tetrahedra after the edit
  Around around_;                 ///< tetrahedra at the particles that are looked up
  std::vector<int> origins_;      ///< original particle of each copy
  std::map<int, double> shares_;  ///< of particles that the edit reaches: share of the original's mass
};

}  // namespace

Edit part_solid(const Object& object, SolidParting parting) { return Parting(object, std::move(parting)).make(); }

}  // namespace pliant

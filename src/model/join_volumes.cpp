#include "model/join_volumes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <utility>

#include "constraints/registry.h"
#include "constraints/tetrahedron_shear.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/volume_around_edge.h"
#include "topology/sort_by_first.h"

namespace pliant {

namespace {

using Corners = std::array<int, 4>;

constexpr std::size_t most_around = VolumeAroundEdge::most_ring;
/// Least ratio of the modulus of volume, lambda, to that of shear, mu: that of a Poisson ratio of 0.4, up to rounding.
constexpr double least_ratio = 3.99;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Corners corners_of(const ConstraintList& list, int i) {
  const std::size_t first = 4 * at(i);
  return {list.stencils[first], list.stencils[first + 1], list.stencils[first + 2], list.stencils[first + 3]};
}

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// The compliance in shear of each tetrahedron that has one, by sorted corners.
using Shear = std::vector<std::pair<Corners, float>>;

Shear shear_of(const std::vector<ConstraintList>& lists) {
  const int type = find_constraint_type(TetrahedronShear::name);
  Shear out;
  for (const ConstraintList& list : lists)
    if (list.type == type && list.law != Law::pbd)
      for (int i = 0; i < list.count(); ++i) out.emplace_back(sorted(corners_of(list, i)), list.response[at(i)]);
  const auto first = [](const Shear::value_type& one) { return one.first[0]; };
  int particles = 0;
  for (const auto& one : out) particles = std::max(particles, first(one) + 1);
  sort_by_first(out, at(particles), first, std::less<>());
  return out;
}

bool is_nearly_incompressible(const Shear& shear, const ConstraintList& volumes, int i) {
  const Corners corners = sorted(corners_of(volumes, i));
  const auto found = std::lower_bound(shear.begin(), shear.end(), std::pair{corners, 0.f});
  return found != shear.end() && found->first == corners && found->second > 0 &&
         static_cast<double>(found->second) >= least_ratio * static_cast<double>(volumes.response[at(i)]);
}

/// A tetrahedron at an edge (a, b): the other corners, so that (a, b, from, to) has a positive volume.
struct AtEdge {
  int a, b;
  int from, to;
  int tetrahedron;
};

/// The six edges of a tetrahedron of positive volume.
void add_edges(const Corners& c, int tetrahedron, std::vector<AtEdge>& out) {
  constexpr int even[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
  for (const auto& e : even) {
    const int a = c[at(e[0])], b = c[at(e[1])], from = c[at(e[2])], to = c[at(e[3])];
    if (a < b)
      out.push_back({a, b, from, to, tetrahedron});
    else
      out.push_back({b, a, to, from, tetrahedron});
  }
}

/// Tetrahedra one after another around an edge.
struct Fan {
  int a = 0, b = 0;
  std::vector<int> ring, tetrahedra;
  bool closes = false;
};

/// Divides tetrahedra among edges, largest fans first.
class Fans {
 public:
  /// Tetrahedra of the list with 1 in `joins`.
  Fans(const ConstraintList& list, std::vector<char> joins) : is_free_(std::move(joins)) {
    edges_.reserve(6 * at(list.count()));
    int particles = 0;
    for (int i = 0; i < list.count(); ++i)
      if (is_free_[at(i)] != 0) add_edges(corners_of(list, i), i, edges_);
    for (const AtEdge& edge : edges_) particles = std::max(particles, edge.a + 1);
    sort_by_first(
        edges_, at(particles), [](const AtEdge& edge) { return edge.a; },
        [](const AtEdge& one, const AtEdge& other) {
          return std::array{one.a, one.b, one.tetrahedron} < std::array{other.a, other.b, other.tetrahedron};
        });
    for (std::size_t wanted = most_around; wanted >= 2; --wanted) take(wanted);
  }

  const std::vector<Fan>& all() const { return fans_; }

 private:
  /// Takes all fans of so many tetrahedra.
  void take(std::size_t wanted) {
    for (std::size_t first = 0, last = 0; first < edges_.size(); first = last) {
      while (last < edges_.size() && edges_[last].a == edges_[first].a && edges_[last].b == edges_[first].b) ++last;
      while (last - first >= wanted) {
        Fan fan = largest_at(first, last, wanted);
        if (fan.tetrahedra.size() < wanted) break;
        for (const int tetrahedron : fan.tetrahedra) is_free_[at(tetrahedron)] = 0;
        fans_.push_back(std::move(fan));
      }
    }
  }

  /// The largest fan of free tetrahedra among those of an edge, [first, last); an empty one if fewer than `wanted` are free.
  Fan largest_at(std::size_t first, std::size_t last, std::size_t wanted) const {
    const auto is_free = [&](const AtEdge& edge) { return is_free_[at(edge.tetrahedron)] != 0; };
    const auto from = edges_.begin() + static_cast<std::ptrdiff_t>(first),
               to = edges_.begin() + static_cast<std::ptrdiff_t>(last);
    Fan best;
    if (static_cast<std::size_t>(std::count_if(from, to, is_free)) < wanted) return best;
    std::vector<AtEdge> free;
    std::copy_if(from, to, std::back_inserter(free), is_free);
    const auto follows = [&](const AtEdge& one) {
      return std::any_of(free.begin(), free.end(), [&](const AtEdge& other) { return other.to == one.from; });
    };
    const bool is_ring = std::all_of(free.begin(), free.end(), follows);
    for (const AtEdge& start : free) {
      if (!is_ring && follows(start)) continue;
      Fan fan = fan_from(start, free);
      if (fan.tetrahedra.size() > best.tetrahedra.size()) best = std::move(fan);
      if (is_ring) break;
    }
    return best;
  }

  static Fan fan_from(const AtEdge& start, const std::vector<AtEdge>& free) {
    Fan fan{start.a, start.b, {start.from}, {}, false};
    for (const AtEdge* next = &start; next != nullptr && !fan.closes;) {
      fan.closes = next->to == start.from;
      const bool is_in_ring = std::find(fan.ring.begin(), fan.ring.end(), next->to) != fan.ring.end();
      if (!fan.closes && (is_in_ring || fan.ring.size() == most_around)) break;
      fan.tetrahedra.push_back(next->tetrahedron);
      if (!fan.closes) fan.ring.push_back(next->to);
      const int from = next->to;
      const auto found = std::find_if(free.begin(), free.end(), [&](const AtEdge& other) { return other.from == from; });
      next = found != free.end() ? &*found : nullptr;
    }
    return fan;
  }

  std::vector<AtEdge> edges_;
  std::vector<char> is_free_;  ///< [tetrahedron]
  std::vector<Fan> fans_;
};

/// Adds a fan's constraint: rest volumes, stiffness and damping are sums of those of its tetrahedra.
void add_fan(const Fan& fan, const ConstraintList& from, int origin, ConstraintList& to) {
  double volume = 0, stiffness = 0, damping = 0;
  bool is_rigid = false;
  for (const int i : fan.tetrahedra) {
    const double compliance = static_cast<double>(from.response[at(i)]);
    volume += static_cast<double>(from.rest[at(i)]);
    damping += static_cast<double>(from.damping[at(i)]);
    is_rigid = is_rigid || !(compliance > 0);
    stiffness += is_rigid ? 0 : 1 / compliance;
  }
  for (std::size_t i = 0; i < most_around; ++i) to.stencils.push_back(i < fan.ring.size() ? fan.ring[i] : fan.a);
  to.stencils.push_back(fan.a);
  to.stencils.push_back(fan.b);
  to.rest.push_back(static_cast<float>(volume));
  to.rest.push_back(static_cast<float>(fan.ring.size()));
  to.rest.push_back(fan.closes ? 1.f : 0.f);
  to.response.push_back(is_rigid ? 0.f : static_cast<float>(1 / stiffness));
  to.damping.push_back(static_cast<float>(damping));
  to.origin.push_back(origin);
}

/// The tetrahedra of a list that no fan has.
ConstraintList left_over(const ConstraintList& list, const std::vector<Fan>& fans) {
  std::vector<char> is_taken(at(list.count()), 0);
  for (const Fan& fan : fans)
    for (const int i : fan.tetrahedra) is_taken[at(i)] = 1;
  ConstraintList out = list.empty();
  for (int i = 0; i < list.count(); ++i) {
    if (is_taken[at(i)] != 0) continue;
    for (const int corner : corners_of(list, i)) out.stencils.push_back(corner);
    out.rest.push_back(list.rest[at(i)]);
    out.response.push_back(list.response[at(i)]);
    out.damping.push_back(list.damping[at(i)]);
    out.origin.push_back(static_cast<int>(list.origin[at(i)]));
  }
  return out;
}

ConstraintList fans_like(const ConstraintList& volumes) {
  ConstraintList out;
  out.type = find_constraint_type(VolumeAroundEdge::name);
  out.law = volumes.law;
  out.size = VolumeAroundEdge::slots::count;
  out.fields = static_cast<int>(VolumeAroundEdge::fields.size());
  return out;
}

std::vector<char> which_join(const Shear& shear, const ConstraintList& volumes) {
  std::vector<char> joins;
  joins.reserve(at(volumes.count()));
  for (int i = 0; i < volumes.count(); ++i)
    joins.push_back(volumes.rest[at(i)] > 0 && is_nearly_incompressible(shear, volumes, i) ? 1 : 0);
  return joins;
}

}  // namespace

void join_volumes(std::vector<ConstraintList>& lists) {
  const int type = find_constraint_type(TetrahedronVolume::name);
  const auto may_join = [type](const ConstraintList& list) {
    return list.type == type && list.law != Law::pbd && !list.changes;
  };
  if (std::none_of(lists.begin(), lists.end(), may_join)) return;
  const Shear shear = shear_of(lists);
  std::vector<ConstraintList> joined;
  int origin = 0;
  for (ConstraintList& list : lists) {
    if (!may_join(list)) continue;
    const Fans fans(list, which_join(shear, list));
    if (fans.all().empty()) continue;
    joined.push_back(fans_like(list));
    for (const Fan& fan : fans.all()) add_fan(fan, list, origin++, joined.back());
    list = left_over(list, fans.all());
  }
  std::erase_if(lists, [](const ConstraintList& list) { return list.count() == 0; });
  for (ConstraintList& list : joined) lists.push_back(std::move(list));
  std::stable_sort(lists.begin(), lists.end(), [](const ConstraintList& one, const ConstraintList& other) {
    return std::pair{one.type, one.law} < std::pair{other.type, other.law};
  });
}

}  // namespace pliant

#include "model/join_volumes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <tuple>
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

Corners corners_of(const std::vector<int>& stencils, int i) {
  const int* const first = &stencils[4 * at(i)];
  return {first[0], first[1], first[2], first[3]};
}

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// The compliance in shear of each tetrahedron that has one, by sorted corners.
using Shear = std::vector<std::pair<Corners, float>>;

/// `is_near`: 1 for particles of tetrahedra that may be joined.
Shear shear_of(std::vector<ConstraintList>& lists, const std::vector<char>& is_near) {
  const int type = find_constraint_type(TetrahedronShear::name);
  const auto has_near = [&](int particle) { return at(particle) < is_near.size() && is_near[at(particle)] != 0; };
  Shear out;
  for (ConstraintList& list : lists) {
    if (list.type != type || list.law == Law::pbd || is_near.empty()) continue;
    const std::vector<int>& stencils = list.stencils.own();
    for (int i = 0; i < list.count(); ++i) {
      const Corners corners = corners_of(stencils, i);
      if (std::all_of(corners.begin(), corners.end(), has_near)) out.emplace_back(sorted(corners), list.response[at(i)]);
    }
  }
  const auto first = [](const Shear::value_type& one) { return one.first[0]; };
  int particles = 0;
  for (const auto& one : out) particles = std::max(particles, first(one) + 1);
  sort_by_first(out, at(particles), first, std::less<>());
  return out;
}

/// `corners`: sorted, of tetrahedron i of `volumes`.
bool is_nearly_incompressible(const Shear& shear, const ConstraintList& volumes, const Corners& corners, int i) {
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

/// Tetrahedra one after another around an edge, by their index in a list.
using Fan = KeptSchedule::Fan;

/// Divides tetrahedra among edges, largest fans first.
class Fans {
 public:
  /// Tetrahedra with these corners that have 1 in `joins`.
  Fans(const std::vector<int>& stencils, std::vector<char> joins) : is_free_(std::move(joins)) {
    edges_.reserve(6 * at(static_cast<int>(std::count(is_free_.begin(), is_free_.end(), 1))));
    int particles = 0;
    for (int i = 0; i < static_cast<int>(is_free_.size()); ++i)
      if (is_free_[at(i)] != 0) add_edges(corners_of(stencils, i), i, edges_);
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
        const Fan fan = largest_at(first, last, wanted);
        if (at(fan.count) < wanted) break;
        for (int i = 0; i < fan.count; ++i) is_free_[at(fan.tetrahedra[at(i)])] = 0;
        fans_.push_back(fan);
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
      const Fan fan = fan_from(start, free);
      if (fan.count > best.count) best = fan;
      if (is_ring) break;
    }
    return best;
  }

  static Fan fan_from(const AtEdge& start, const std::vector<AtEdge>& free) {
    Fan fan{start.a, start.b, 1, 0, {start.from}, {}};
    for (const AtEdge* next = &start; next != nullptr && !fan.closes();) {
      const bool closes = next->to == start.from;
      const auto end = fan.ring.begin() + fan.ring_size;
      const bool is_in_ring = std::find(fan.ring.begin(), end, next->to) != end;
      if (!closes && (is_in_ring || at(fan.ring_size) == most_around)) break;
      fan.tetrahedra[at(fan.count++)] = next->tetrahedron;
      if (!closes) fan.ring[at(fan.ring_size++)] = next->to;
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
  for (int t = 0; t < fan.count; ++t) {
    const std::size_t i = at(fan.tetrahedra[at(t)]);
    const double compliance = static_cast<double>(from.response[i]);
    volume += static_cast<double>(from.rest[i]);
    damping += static_cast<double>(from.damping[i]);
    is_rigid = is_rigid || !(compliance > 0);
    stiffness += is_rigid ? 0 : 1 / compliance;
  }
  for (int i = 0; i < static_cast<int>(most_around); ++i)
    to.stencils.push_back(i < fan.ring_size ? fan.ring[at(i)] : fan.a);
  to.stencils.push_back(fan.a);
  to.stencils.push_back(fan.b);
  to.rest.push_back(static_cast<float>(volume));
  to.rest.push_back(static_cast<float>(fan.ring_size));
  to.rest.push_back(fan.closes() ? 1.f : 0.f);
  to.response.push_back(is_rigid ? 0.f : static_cast<float>(1 / stiffness));
  to.damping.push_back(static_cast<float>(damping));
  to.origin.push_back(origin);
}

/// The tetrahedra of a list that no fan has.
ConstraintList left_over(ConstraintList& list, const std::vector<char>& is_taken) {
  const std::vector<int>& stencils = list.stencils.own();
  ConstraintList out = list.empty();
  for (int i = 0; i < list.count(); ++i) {
    if (is_taken[at(i)] != 0) continue;
    for (const int corner : corners_of(stencils, i)) out.stencils.push_back(corner);
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

/// The tetrahedra of a list, what an earlier schedule says of them, and the fans that they form.
class Joining {
 public:
  explicit Joining(ConstraintList& list)
      : list_(list), stencils_(list.stencils.own()), is_settled_(at(list.count())), is_taken_(at(list.count())) {
    static_assert(std::tuple_size_v<decltype(Fan::ring)> == most_around);
    for (int i = 0; i < list.count(); ++i) {
      const auto origin = at(list.origin[at(i)]);
      if (origin >= index_of_.size()) index_of_.resize(std::max(2 * origin, at(list.count())), -1);
      index_of_[origin] = i;
    }
  }

  /// Takes a fan of an earlier schedule, with its number. False if it is not one of free tetrahedra of this list.
  bool keep(Fan fan, int number) {
    if (fan.count < 1 || fan.count > static_cast<int>(most_around) || fan.ring_size > static_cast<int>(most_around) ||
        (fan.ring_size != fan.count && fan.ring_size != fan.count + 1))
      return false;
    for (int t = 0; t < fan.count; ++t) {
      int& tetrahedron = fan.tetrahedra[at(t)];
      tetrahedron = index_of(tetrahedron);
      if (tetrahedron < 0 || is_taken_[at(tetrahedron)] != 0) return false;
      const Corners corners{fan.a, fan.b, fan.ring[at(t)], fan.ring[at((t + 1) % fan.ring_size)]};
      if (!std::is_permutation(corners.begin(), corners.end(), &stencils_[4 * at(tetrahedron)])) return false;
    }
    take(fan, number);
    return true;
  }

  /// A tetrahedron that has its own constraint in an earlier schedule keeps it.
  void settle(int origin) {
    const int i = index_of(origin);
    if (i >= 0) is_settled_[at(i)] = 1;
  }

  /// Joins those that are left to fans with numbers from `number` on.
  void join(std::vector<ConstraintList>& lists, int number) {
    std::vector<char> joins(at(list_.count())), is_near;
    for (int i = 0; i < list_.count(); ++i) {
      joins[at(i)] = is_taken_[at(i)] == 0 && is_settled_[at(i)] == 0 && list_.rest[at(i)] > 0 ? 1 : 0;
      if (joins[at(i)] == 0) continue;
      for (const int corner : corners_of(stencils_, i)) {
        if (at(corner) >= is_near.size()) is_near.resize(2 * at(corner) + 1);
        is_near[at(corner)] = 1;
      }
    }
    const Shear shear = shear_of(lists, is_near);
    for (int i = 0; i < list_.count(); ++i)
      if (joins[at(i)] != 0 && !is_nearly_incompressible(shear, list_, sorted(corners_of(stencils_, i)), i))
        joins[at(i)] = 0;
    const Fans fans(stencils_, std::move(joins));
    for (const Fan& fan : fans.all()) take(fan, number++);
  }

  /// Each with its number.
  const std::vector<std::pair<Fan, int>>& fans() const { return fans_; }
  const std::vector<char>& taken() const { return is_taken_; }

 private:
  int index_of(int origin) const { return origin >= 0 && at(origin) < index_of_.size() ? index_of_[at(origin)] : -1; }
  void take(const Fan& fan, int number) {
    for (int t = 0; t < fan.count; ++t) is_taken_[at(fan.tetrahedra[at(t)])] = 1;
    fans_.emplace_back(fan, number);
  }

  const ConstraintList& list_;
  const std::vector<int>& stencils_;
  std::vector<int> index_of_;                ///< by number among the constraints of the type
  std::vector<char> is_settled_, is_taken_;  ///< by index in the list
  std::vector<std::pair<Fan, int>> fans_;
};

/// A fan whose tetrahedra are numbered as the constraints of the type are.
Fan by_number(Fan fan, const ConstraintList& list) {
  for (int t = 0; t < fan.count; ++t) fan.tetrahedra[at(t)] = static_cast<int>(list.origin[at(fan.tetrahedra[at(t)])]);
  return fan;
}

/// Replaces the tetrahedra of a list that are joined, and appends the list of their fans.
void join_list(ConstraintList& list, std::vector<ConstraintList>& lists, const KeptSchedule* kept, std::vector<Fan>& fans,
               std::vector<ConstraintList>& joined) {
  Joining joining(list);
  for (std::size_t i = 0; kept != nullptr && i < kept->fans.size(); ++i)
    if (fans[i].count == 0 && joining.keep(kept->fans[i], static_cast<int>(i))) fans[i] = kept->fans[i];
  for (std::size_t c = 0; kept != nullptr && c < kept->colours.size(); ++c)
    if (kept->colours[c].type == list.type && kept->colours[c].law == static_cast<int>(list.law))
      for (const int origin : kept->colours[c].constraints) joining.settle(origin);
  joining.join(lists, static_cast<int>(fans.size()));
  if (joining.fans().empty()) return;
  joined.push_back(fans_like(list));
  for (const auto& [fan, number] : joining.fans()) {
    add_fan(fan, list, number, joined.back());
    if (at(number) == fans.size()) fans.push_back(by_number(fan, list));
  }
  list = left_over(list, joining.taken());
}

}  // namespace

std::vector<KeptSchedule::Fan> join_volumes(std::vector<ConstraintList>& lists, const KeptSchedule* kept) {
  const int type = find_constraint_type(TetrahedronVolume::name);
  std::vector<Fan> fans(kept != nullptr ? kept->fans.size() : 0);
  std::vector<ConstraintList> joined;
  for (ConstraintList& list : lists)
    if (list.type == type && list.law != Law::pbd && !list.changes) join_list(list, lists, kept, fans, joined);
  if (joined.empty()) return fans;
  std::erase_if(lists, [](const ConstraintList& list) { return list.count() == 0; });
  for (ConstraintList& list : joined) lists.push_back(std::move(list));
  std::stable_sort(lists.begin(), lists.end(), [](const ConstraintList& one, const ConstraintList& other) {
    return std::pair{one.type, one.law} < std::pair{other.type, other.law};
  });
  return fans;
}

}  // namespace pliant

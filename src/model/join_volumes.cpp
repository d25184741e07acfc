#include "model/join_volumes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <tuple>
#include <utility>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/volume_around_edge.h"
#include "core/at.h"
#include "topology/sort_by_first.h"

namespace pliant {

namespace {

using Corners = std::array<int, 4>;

constexpr std::size_t most_around = VolumeAroundEdge::most_ring;
/// Least ratio of the modulus of volume, lambda, to that of shear, mu: that of a Poisson ratio of 0.4, up to rounding.
constexpr double least_ratio = 3.99;

Corners corners_of(const std::vector<int>& stencils, int i) {
  const int* const first = &stencils[4 * at(i)];
  return {first[0], first[1], first[2], first[3]};
}

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// True if the compliance in shear, 0 if there is none, is so much greater than that in volume.
bool is_nearly_incompressible(float shear, float volume) {
  return shear > 0 && static_cast<double>(shear) >= least_ratio * static_cast<double>(volume);
}

/// The compliance in shear of tetrahedra. They mostly come in the order in which they are asked for.
class Shear {
 public:
  explicit Shear(std::vector<ConstraintList>& lists) {
    for (ConstraintList& list : lists) {
      if (!gives_shape(list.type) || list.law == Law::pbd) continue;
      const std::vector<int>& stencils = list.stencils.own();
      for (int i = 0; i < list.count(); ++i) all_.emplace_back(corners_of(stencils, i), list.response[at(i)]);
    }
  }

  /// 0 if the tetrahedron has none.
  float compliance_of(const Corners& corners) {
    const std::size_t end = std::min(next_ + most_ahead, all_.size());
    for (std::size_t i = next_; i < end; ++i) {
      if (!std::is_permutation(corners.begin(), corners.end(), all_[i].first.begin())) continue;
      next_ = i + 1;
      return all_[i].second;
    }
    if (sorted_.empty()) sort();
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{sorted(corners), 0.f});
    return found != sorted_.end() && found->first == sorted(corners) ? found->second : 0;
  }

 private:
  using Entry = std::pair<Corners, float>;
  static constexpr std::size_t most_ahead = 8;

  void sort() {
    sorted_ = all_;
    int particles = 0;
    for (Entry& one : sorted_) {
      one.first = sorted(one.first);
      particles = std::max(particles, one.first[0] + 1);
    }
    sort_by_first(
        sorted_, at(particles), [](const Entry& one) { return one.first[0]; }, std::less<>());
  }

  std::vector<Entry> all_, sorted_;
  std::size_t next_ = 0;
};

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

  /// The largest fan of free tetrahedra among those of an edge, [first, last); an empty one if fewer than `wanted` are
  /// free.
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
      const auto found =
          std::find_if(free.begin(), free.end(), [&](const AtEdge& other) { return other.from == from; });
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

/// True if tetrahedra with these corners are the same, and have a volume of the same sign.
bool is_same_tetrahedron(const Corners& one, Corners other) {
  bool is_even = true;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const auto found = std::find(other.begin() + static_cast<std::ptrdiff_t>(i), other.end(), one[i]);
    if (found == other.end()) return false;
    if (found != other.begin() + static_cast<std::ptrdiff_t>(i)) is_even = !is_even;
    std::swap(*found, other[i]);
  }
  return is_even;
}

/// The tetrahedra of a list, and the fans that they form.
class Joining {
 public:
  Joining(ConstraintList& list, Shear& shear)
      : stencils_(list.stencils.own()), may_join_(at(list.count())), is_taken_(at(list.count())) {
    static_assert(std::tuple_size_v<decltype(Fan::ring)> == most_around);
    index_of_.resize(at(list.count()), -1);
    for (int i = 0; i < list.count(); ++i) {
      const auto origin = at(list.origin[at(i)]);
      if (origin >= index_of_.size()) index_of_.resize(2 * origin, -1);
      index_of_[origin] = i;
      if (list.rest[at(i)] > 0)
        may_join_[at(i)] =
            is_nearly_incompressible(shear.compliance_of(corners_of(stencils_, i)), list.response[at(i)]) ? 1 : 0;
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
      if (tetrahedron < 0 || is_taken_[at(tetrahedron)] != 0 || may_join_[at(tetrahedron)] == 0) return false;
      const Corners corners{fan.a, fan.b, fan.ring[at(t)], fan.ring[at((t + 1) % fan.ring_size)]};
      // One after another around the edge, all of the same sign: so none is there twice.
      if (!is_same_tetrahedron(corners, corners_of(stencils_, tetrahedron))) return false;
    }
    take(fan, number);
    return true;
  }

  /// Joins those that are left to fans with numbers from `number` on.
  void join(int number) {
    std::vector<char> joins = may_join_;
    for (std::size_t i = 0; i < joins.size(); ++i)
      if (is_taken_[i] != 0) joins[i] = 0;
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

  const std::vector<int>& stencils_;
  std::vector<int> index_of_;              ///< by number among the constraints of the type
  std::vector<char> may_join_, is_taken_;  ///< by index in the list
  std::vector<std::pair<Fan, int>> fans_;
};

/// A fan whose tetrahedra are numbered as the constraints of the type are.
Fan by_number(Fan fan, const ConstraintList& list) {
  for (int t = 0; t < fan.count; ++t) fan.tetrahedra[at(t)] = static_cast<int>(list.origin[at(fan.tetrahedra[at(t)])]);
  return fan;
}

/// Replaces the tetrahedra of a list that are joined, and appends the list of their fans.
void join_list(ConstraintList& list, Shear& shear, const KeptSchedule* kept, std::vector<Fan>& fans,
               std::vector<ConstraintList>& joined) {
  Joining joining(list, shear);
  for (std::size_t i = 0; kept != nullptr && i < kept->fans.size(); ++i)
    if (fans[i].count == 0 && joining.keep(kept->fans[i], static_cast<int>(i))) fans[i] = kept->fans[i];
  joining.join(static_cast<int>(fans.size()));
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
  const auto may_join = [type](const ConstraintList& list) {
    return list.type == type && list.law != Law::pbd && !list.changes;
  };
  std::vector<Fan> fans(kept != nullptr ? kept->fans.size() : 0);
  if (std::none_of(lists.begin(), lists.end(), may_join)) return fans;
  std::vector<ConstraintList> joined;
  Shear shear(lists);
  for (ConstraintList& list : lists)
    if (may_join(list)) join_list(list, shear, kept, fans, joined);
  if (joined.empty()) return fans;
  std::erase_if(lists, [](const ConstraintList& list) { return list.count() == 0; });
  for (ConstraintList& list : joined) lists.push_back(std::move(list));
  std::stable_sort(lists.begin(), lists.end(), [](const ConstraintList& one, const ConstraintList& other) {
    return std::pair{one.type, one.law} < std::pair{other.type, other.law};
  });
  return fans;
}

}  // namespace pliant

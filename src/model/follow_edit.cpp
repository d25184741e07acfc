// Which constraints an edit leaves as they are: it compares the particles of those before and after.
#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "constraints/registry.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/volume_around_edge.h"
#include "core/at.h"
#include "model/keep_schedule.h"

namespace pliant {

namespace {

/// The constraints of a type: their particles by the user's index, one constraint after another.
struct Constraints {
  std::size_t size = 1;  ///< particles of each
  std::vector<int> particles;
  std::vector<char> are_there;  ///< empty if all are

  std::size_t count() const { return particles.size() / size; }
  const int* stencil(std::size_t i) const { return &particles[i * size]; }
  bool has(std::size_t i) const { return are_there.empty() || are_there[i] != 0; }
};

bool is_same(const int* a, const int* b, std::size_t size) {
  if (std::equal(a, a + size, b)) return true;
  return std::is_permutation(a, a + size, b);
}

/// A hash that does not depend on the order of the particles.
std::uint64_t hash_of(const int* particles, std::size_t size) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < size; ++i) {
    std::uint64_t x = static_cast<std::uint64_t>(particles[i]) + 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    sum += x ^ (x >> 27);
  }
  return sum;
}

/// Finds for each constraint after an edit the one before it that has the same particles. Most are in the same order,
/// so it walks along both.
class Match {
 public:
  /// `is_touched`: 1 for particles that are new, or of which there are copies now.
  Match(const Constraints& before, const Constraints& after, const std::vector<char>& is_touched)
      : before_(before), after_(after), is_touched_(is_touched), out_(before.count(), -1) {}

  /// For each constraint before the number of the one after; -1: it is gone.
  std::vector<int> find() {
    for (std::size_t j = 0; j < after_.count(); ++j) {
      if (!take_near(j) && !is_touched(after_.stencil(j))) take_anywhere(j);
    }
    return std::move(out_);
  }

 private:
  static constexpr int most_ahead = 16;

  bool is_touched(const int* stencil) const {
    return std::any_of(stencil, stencil + after_.size, [&](int p) { return is_touched_[at(p)] != 0; });
  }

  bool take(std::size_t i, std::size_t j) {
    if (!before_.has(i) || out_[i] >= 0 || !is_same(before_.stencil(i), after_.stencil(j), after_.size)) return false;
    out_[i] = static_cast<int>(j);
    next_ = std::max(next_, i + 1);
    return true;
  }

  /// Takes one of the next few constraints before.
  bool take_near(std::size_t j) {
    int tried = 0;
    for (std::size_t i = next_; i < before_.count() && tried < most_ahead; ++i) {
      if (take(i, j)) return true;
      if (before_.has(i)) ++tried;
    }
    return false;
  }

  void take_anywhere(std::size_t j) {
    if (where_.empty())
      for (std::size_t i = 0; i < before_.count(); ++i)
        if (before_.has(i)) where_.emplace(hash_of(before_.stencil(i), before_.size), i);
    const auto [first, last] = where_.equal_range(hash_of(after_.stencil(j), after_.size));
    std::vector<std::size_t> candidates;
    for (auto one = first; one != last; ++one) candidates.push_back(one->second);
    std::sort(candidates.begin(), candidates.end());  // the order in the table depends on the library
    for (const std::size_t i : candidates)
      if (take(i, j)) return;
  }

  const Constraints& before_;
  const Constraints& after_;
  const std::vector<char>& is_touched_;
  std::size_t next_ = 0;
  std::unordered_multimap<std::uint64_t, std::size_t> where_;  ///< made if a constraint is not where it is expected
  std::vector<int> out_;
};

class Following {
 public:
  Following(const CompiledObject& before, const Object& after, const std::vector<int>& from)
      : before_(before), after_(after), out_(schedule_of(before)), is_touched_(from.size() + after.attachments.size()) {
    std::vector<char> is_taken(at(before.user_particles));
    for (std::size_t i = 0; i < from.size(); ++i) {
      const bool is_new = i >= is_taken.size();
      if (is_new) is_touched_[i] = 1;
      if (is_new && from[i] >= 0) is_touched_[at(from[i])] = 1;
    }
  }

  std::optional<KeptSchedule> make() {
    number_particles();
    match_constraints();
    move_fans();
    move_colours();
    const auto particles = static_cast<int>(out_.order.size());
    if (4 * (particles - out_.first_added) > particles) return {};
    return std::move(out_);
  }

 private:
  void number_particles() {
    const int users_before = before_.user_particles, users = static_cast<int>(after_.positions.size());
    for (int& user : out_.order)
      if (user >= users_before) user += users - users_before;
    const auto stored = static_cast<int>(out_.order.size());
    for (int user = users_before; user < users; ++user) out_.order.push_back(user);
    const int targets_before = before_.particles - users_before;
    for (int i = targets_before; i < static_cast<int>(after_.attachments.size()); ++i) out_.order.push_back(users + i);
    int left = static_cast<int>(out_.order.size()) - stored;
    if (out_.first_added < stored && left > 0) {  // the last tile is one of particles that were added
      const std::size_t tiles = out_.tile_ends.size();
      const int first = tiles > 1 ? out_.tile_ends[tiles - 2] : 0, room = std::max(0, largest_tile - (stored - first));
      out_.tile_ends.back() += std::min(room, left);
      left -= std::min(room, left);
    }
    for (; left > 0; left -= largest_tile)
      out_.tile_ends.push_back(out_.tile_ends.back() + std::min(left, largest_tile));
  }

  /// The particles of constraints before, by type, as the compiled object has them.
  std::vector<Constraints> constraints_before() const {
    std::vector<Constraints> out(at(constraint_type_count()));
    for (const Pool& pool : before_.pools)
      if (is_followed(pool)) make_room(pool.type, at(pool.stencil), static_cast<std::size_t>(pool.constraints), out);
    for (const KeptSchedule::Fan& fan : out_.fans) make_room(volume_type_, 4, at(fan.count), out);
    Constraints& volumes = out[at(volume_type_)];
    for (const KeptSchedule::Fan& fan : out_.fans)
      for (int i = 0; i < fan.count; ++i) {
        const std::array<int, 4> corners{fan.a, fan.b, fan.ring[at(i)], fan.ring[at((i + 1) % fan.ring_size)]};
        const std::size_t number = at(fan.tetrahedra[at(i)]);
        volumes.are_there[number] = 1;
        std::copy(corners.begin(), corners.end(), &volumes.particles[4 * number]);
      }
    for (const Segment& segment : before_.segments) add_segment(segment, out);
    return out;
  }

  bool is_followed(const Pool& pool) const { return pool.in_lanes && pool.type != fan_type_; }

  static void make_room(int type, std::size_t size, std::size_t count, std::vector<Constraints>& out) {
    Constraints& constraints = out[at(type)];
    constraints.size = size;
    constraints.particles.resize(constraints.particles.size() + size * count, -1);
    constraints.are_there.resize(constraints.are_there.size() + count, 0);
  }

  void add_segment(const Segment& segment, std::vector<Constraints>& out) const {
    const Pool& pool = before_.pools[at(segment.pool)];
    if (!is_followed(pool)) return;
    Constraints& to = out[at(pool.type)];
    const std::int32_t* indices = &pool.indices[static_cast<std::size_t>(segment.index_offset)];
    for (int batch = 0; batch < segment.batches; ++batch, indices += indices_per_batch(pool, segment)) {
      const std::int32_t* const numbers = &pool.origin[at(segment.first_batch + batch) * batch_width];
      for (int lane = 0; lane < batch_width; ++lane) {
        if (numbers[lane] < 0) continue;
        to.are_there[at(numbers[lane])] = 1;
        for (int slot = 0; slot < pool.stencil; ++slot)
          to.particles[at(numbers[lane]) * to.size + at(slot)] =
              out_.order[at(particle_of(segment, indices, slot, lane))];
      }
    }
  }

  /// The particles of the constraints of a type after the edit.
  Constraints constraints_after(int type) const {
    Constraints out;
    out.size = constraint_type(type).slots.size();
    for (const ConstraintGroup& group : after_.constraints)
      if (group.type == constraint_type(type).name)
        out.particles.insert(out.particles.end(), group.particles.begin(), group.particles.end());
    for (std::size_t i = 0; i < after_.attachments.size() && type == length_type(); ++i)
      out.particles.insert(out.particles.end(),
                           {after_.attachments[i].particle, static_cast<int>(after_.positions.size() + i)});
    return out;
  }

  bool has_all(const Constraints& constraints) const {
    return std::all_of(constraints.particles.begin(), constraints.particles.end(),
                       [&](int p) { return p >= 0 && at(p) < is_touched_.size(); });
  }

  void match_constraints() {
    const std::vector<Constraints> before = constraints_before();
    numbers_after_.resize(before.size());
    for (std::size_t type = 0; type < before.size(); ++type) {
      if (before[type].count() == 0) continue;
      const Constraints after = constraints_after(static_cast<int>(type));
      if (after.particles.size() % after.size == 0 && has_all(after))  // compile() says what is wrong with others
        numbers_after_[type] = Match(before[type], after, is_touched_).find();
    }
  }

  int number_after(int type, int constraint) const {
    const std::vector<int>& numbers = numbers_after_[at(type)];
    return constraint >= 0 && at(constraint) < numbers.size() ? numbers[at(constraint)] : -1;
  }

  /// Keeps the fans of which each tetrahedron is there.
  void move_fans() {
    std::vector<KeptSchedule::Fan> fans;
    std::vector<int>& numbers = numbers_after_[at(fan_type_)];
    numbers.assign(out_.fans.size(), -1);
    for (std::size_t i = 0; i < out_.fans.size(); ++i) {
      KeptSchedule::Fan fan = out_.fans[i];
      bool is_whole = fan.count > 0;
      for (int t = 0; t < fan.count; ++t) {
        fan.tetrahedra[at(t)] = number_after(volume_type_, fan.tetrahedra[at(t)]);
        is_whole = is_whole && fan.tetrahedra[at(t)] >= 0;
      }
      if (!is_whole) continue;
      numbers[i] = static_cast<int>(fans.size());
      fans.push_back(fan);
    }
    out_.fans = std::move(fans);
  }

  /// Those that are gone stay as -1, so that the groups of four around them are still groups.
  void move_colours() {
    for (KeptSchedule::Colour& colour : out_.colours)
      for (int& constraint : colour.constraints) constraint = number_after(colour.type, constraint);
  }

  const int largest_tile = CompileOptions{}.largest_tile;
  const CompiledObject& before_;
  const Object& after_;
  KeptSchedule out_;
  std::vector<char> is_touched_;  ///< by the user's index; 1: there are copies, so its constraints may be gone
  std::vector<std::vector<int>> numbers_after_;  ///< by type and number before: the number after, or -1
  int volume_type_ = find_constraint_type(TetrahedronVolume::name),
      fan_type_ = find_constraint_type(VolumeAroundEdge::name);
};

/// True if the particles and targets of before are the first of those after, in their order.
bool begins_with(const CompiledObject& before, const Object& after, const std::vector<int>& from) {
  const std::size_t users = at(before.user_particles);
  if (from.size() != after.positions.size() || from.size() < users) return false;
  if (after.attachments.size() < at(before.particles - before.user_particles)) return false;
  for (std::size_t i = 0; i < users; ++i)
    if (from[i] != static_cast<int>(i)) return false;
  return true;
}

}  // namespace

std::optional<KeptSchedule> follow_edit(const CompiledObject& before, const Object& after,
                                        const std::vector<int>& from) {
  if (before.tiles.size() < 2 || before.sweep == Sweep::natural || !begins_with(before, after, from)) return {};
  return Following(before, after, from).make();
}

}  // namespace pliant

#include "world/target_origins.h"

#include <map>
#include <tuple>
#include <utility>

#include "constraints/registry.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// What attachments are matched by.
struct Held {
  int particle = -1;  ///< the user's index before the edit
  Record target{};    ///< at time 0
  Law law = Law::compliant;
  float response = 0;
};

std::vector<Held> held_by(const CompiledObject& object) {
  const int users = object.user_particles;
  std::vector<Held> held(static_cast<std::size_t>(object.particles - users));
  if (held.empty()) return held;
  for (int i = users; i < object.particles; ++i)
    held[static_cast<std::size_t>(i - users)].target = object.positions[static_cast<std::size_t>(object.place[i])];
  for_constraints(object, length_type(), [&](const ConstraintPlace& at, const std::int32_t* number) {
    for (int slot = 0; slot < 2; ++slot) {
      const int target = object.order[number[slot]] - users;
      if (target < 0) continue;
      Held& one = held[static_cast<std::size_t>(target)];
      one.particle = object.order[number[1 - slot]];
      one.law = at.pool.law;
      one.response = at.value(at.pool.fields);
    }
  });
  return held;
}

/// Matches attachments after an edit with those before it.
class Matching {
 public:
  enum class By { all, particle_and_target, target };

  Matching(const std::vector<Held>& old, const std::vector<Held>& now)
      : old_(old), now_(now), is_taken_(old.size()), found_(now.size(), -1) {}

  /// Each that has none yet takes the first one left; if they `share`, the last one.
  void match(By by, bool share) {
    std::map<Key, std::vector<int>> left;  // the first is the last of each
    for (int i = static_cast<int>(old_.size()); i-- > 0;)
      if (share || is_taken_[static_cast<std::size_t>(i)] == 0)
        left[key(old_[static_cast<std::size_t>(i)], by)].push_back(i);
    for (std::size_t i = 0; i < now_.size(); ++i) {
      const auto same = left.find(key(now_[i], by));
      if (found_[i] >= 0 || same == left.end() || same->second.empty()) continue;
      found_[i] = share ? same->second.front() : same->second.back();
      if (share) continue;
      is_taken_[static_cast<std::size_t>(found_[i])] = 1;
      same->second.pop_back();
    }
  }

  std::vector<int> take() { return std::move(found_); }

 private:
  using Key = std::tuple<float, float, float, int, Law, float>;

  static Key key(const Held& one, By by) {
    const bool has_particle = by != By::target, has_stiffness = by == By::all;
    return {one.target.x,
            one.target.y,
            one.target.z,
            has_particle ? one.particle : -1,
            has_stiffness ? one.law : Law::compliant,
            has_stiffness ? one.response : 0};
  }

  const std::vector<Held>& old_;
  const std::vector<Held>& now_;
  std::vector<char> is_taken_;
  std::vector<int> found_;
};

}  // namespace

std::vector<int> target_origins(const CompiledObject& old, const CompiledObject& by, const std::vector<int>& from) {
  const std::vector<Held> before = held_by(old);
  std::vector<Held> now = held_by(by);
  if (before.empty()) return std::vector<int>(now.size(), -1);
  for (Held& one : now)
    if (one.particle >= 0) one.particle = from[static_cast<std::size_t>(one.particle)];
  Matching matching(before, now);
  using By = Matching::By;
  matching.match(By::all, false);
  matching.match(By::particle_and_target, false);
  matching.match(By::particle_and_target, true);
  matching.match(By::target, false);
  return matching.take();
}

}  // namespace pliant

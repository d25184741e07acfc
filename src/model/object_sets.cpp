#include "model/object_sets.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace pliant {

namespace {

bool is_converted(const Stiffness& stiffness, bool has_own_values) {
  return stiffness.kind == Stiffness::Kind::pbd && (has_own_values || (stiffness.value > 0 && stiffness.value < 1));
}

bool can_meet(const SetMember& a, const SetMember& b) {
  const bool by_masks = (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
  const bool by_kind = a.is_collider != b.is_collider || (a.collides && b.collides && !a.is_collider);
  return by_masks && by_kind;
}

/// A union-find forest: each member points to an earlier member of its set, the first one to itself.
class Forest {
 public:
  explicit Forest(std::size_t members) : root_(members) { std::iota(root_.begin(), root_.end(), 0); }

  int first_of(int member) {
    while (root_[member] != member) member = root_[member] = root_[root_[member]];
    return member;
  }
  void join(int a, int b) {
    a = first_of(a);
    b = first_of(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> root_;
};

/// Divides members into classes that meet the same members. Scenes with many objects have few classes.
std::vector<std::vector<int>> classes_of(const std::vector<SetMember>& members) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool, bool>, std::size_t> numbers;
  std::vector<std::vector<int>> classes;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const SetMember& m = members[i];
    const std::size_t number =
        numbers.try_emplace({m.groups, m.mask, m.collides, m.is_collider}, classes.size()).first->second;
    if (number == classes.size()) classes.emplace_back();
    classes[number].push_back(i);
  }
  return classes;
}

}  // namespace

int own_substeps(const Object& object, Sweep sweep) {
  if (sweep != Sweep::multigrid || (object.volume && is_converted(object.volume->stiffness, false)))
    return substeps_of_others;
  for (const ConstraintGroup& group : object.constraints)
    if (!group.particles.empty() && is_converted(group.stiffness, !group.compliances.empty())) return substeps_of_others;
  for (const Attachment& attachment : object.attachments)
    if (is_converted(attachment.stiffness, false)) return substeps_of_others;
  return substeps_of_multigrid;
}

SetMember member_of(const Object& object, int substeps) {
  return {object.groups, object.mask, object.collides, false, substeps};
}

SetMember member_of(const MeshCollider& collider) {
  if (collider.as != MeshCollider::As::triangles) return {};
  return {collider.groups, collider.mask, false, true, 0};
}

std::vector<int> find_sets(const std::vector<SetMember>& members) {
  const std::vector<std::vector<int>> classes = classes_of(members);
  Forest forest(members.size());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const int first = classes[i].front();
    if (can_meet(members[first], members[first]))
      for (const int member : classes[i]) forest.join(first, member);
    for (std::size_t j = 0; j < i; ++j) {
      const int other = classes[j].front();
      if (!can_meet(members[first], members[other])) continue;
      for (const int member : classes[i]) forest.join(other, member);
      for (const int member : classes[j]) forest.join(first, member);
    }
  }
  std::vector<int> sets(members.size());
  for (int i = 0; i < static_cast<int>(members.size()); ++i) sets[static_cast<std::size_t>(i)] = forest.first_of(i);
  return sets;
}

std::vector<int> substeps_of_sets(const std::vector<SetMember>& members) {
  const std::vector<int> sets = find_sets(members);
  std::vector<int> most(members.size(), 0), out;
  for (std::size_t i = 0; i < members.size(); ++i) most[sets[i]] = std::max(most[sets[i]], members[i].substeps);
  for (const int set : sets) out.push_back(most[set]);
  return out;
}

}  // namespace pliant

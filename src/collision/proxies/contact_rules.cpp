#include "collision/proxies/contact_rules.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "math/vector.h"
#include "model/object_sets.h"

namespace pliant {

void ContactRules::set(int body, const ContactBody& by) {
  if (body == bodies()) bodies_.emplace_back();
  bodies_[static_cast<std::size_t>(body)] = by;
}

bool ContactRules::meet(int a, int b) const {
  const ContactBody &p = bodies_[static_cast<std::size_t>(a)], &q = bodies_[static_cast<std::size_t>(b)];
  if (a == b) return p.meets_itself;
  if (p.mixes_with(q) || set_of(a) != set_of(b)) return false;
  const bool masks = (p.groups & q.mask) != 0 && (q.groups & p.mask) != 0;
  const bool meant = (p.collides && q.collides) || p.is_collider || q.is_collider;
  return masks && meant && !(p.is_immovable && q.is_immovable);
}

PairMaterial ContactRules::material(int a, int b) const {
  if (!exceptions_.empty())
    if (const auto found = exceptions_.find(std::minmax(a, b)); found != exceptions_.end()) return found->second;
  const ContactBody &p = bodies_[static_cast<std::size_t>(a)], &q = bodies_[static_cast<std::size_t>(b)];
  return {p.thickness + q.thickness, std::sqrt(p.static_friction * q.static_friction),
          std::sqrt(p.kinetic_friction * q.kinetic_friction), max(p.restitution, q.restitution)};
}

/// The bodies that have an exception, ascending.
std::vector<int> ContactRules::excepted() const {
  std::vector<int> bodies;
  for (const auto& [pair, material] : exceptions_) bodies.insert(bodies.end(), {pair.first, pair.second});
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

/// Sorts bodies into classes with equal contact rules; returns the class of each body.
std::vector<int> ContactRules::find_classes(const std::vector<int>& among, std::vector<Class>& classes) const {
  const std::vector<int> alone = excepted();
  using Key = std::tuple<std::uint32_t, std::uint32_t, int, int, float, float, int>;
  std::map<Key, int> numbers;
  const std::pair<const Key, int>* last =
      nullptr;  // cached, because most bodies have the same rules as the previous one
  std::vector<int> class_of;
  class_of.reserve(among.size());
  for (const int number : among) {
    const ContactBody& body = bodies_[static_cast<std::size_t>(number)];
    const int flags = (body.collides ? 1 : 0) + (body.is_collider ? 2 : 0) + (body.is_immovable ? 4 : 0) +
                      (body.is_of_grains ? 8 : 0);
    const bool is_alone = std::binary_search(alone.begin(), alone.end(), number);
    const Key key{body.groups,  body.mask,           flags,         is_alone ? number : -1,
                  body.spacing, body.speed_of_sound, set_of(number)};
    if (last == nullptr || last->first != key)
      last = &*numbers.try_emplace(key, static_cast<int>(classes.size())).first;
    if (static_cast<std::size_t>(last->second) == classes.size()) classes.push_back({.set = set_of(number)});
    class_of.push_back(last->second);
    find_thickest(number, classes[static_cast<std::size_t>(last->second)]);
  }
  return class_of;
}

/// Updates the thickest and second thickest body of a class with a body of that class.
void ContactRules::find_thickest(int body, Class& of) const {
  const auto is_thicker = [&](int than) {
    return than < 0 ||
           bodies_[static_cast<std::size_t>(body)].thickness > bodies_[static_cast<std::size_t>(than)].thickness;
  };
  if (is_thicker(of.thickest)) {
    of.second = of.thickest;
    of.thickest = body;
  } else if (is_thicker(of.second)) {
    of.second = body;
  }
}

std::vector<int> ContactRules::sets(const std::vector<int>& among) const {
  std::vector<SetMember> members;
  members.reserve(among.size());
  for (const int number : among) {
    const ContactBody& body = bodies_[static_cast<std::size_t>(number)];
    members.push_back({body.groups, body.mask, body.collides && !body.is_collider, body.is_collider});
    members.back().place = set_of(number);
  }
  return find_sets(members);
}

float ContactRules::largest_thickness(const std::vector<int>& among) const {
  std::vector<Class> classes;
  find_classes(among, classes);
  float largest = 0;
  const auto consider = [&](int a, int b) {
    if (a >= 0 && b >= 0 && meet(a, b)) largest = max(largest, material(a, b).thickness);
  };
  for (const int body : among) consider(body, body);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    consider(classes[i].thickest, classes[i].second);
    for (std::size_t j = 0; j < i; ++j)
      if (classes[i].set == classes[j].set) consider(classes[i].thickest, classes[j].thickest);
  }
  return largest;
}

std::vector<char> ContactRules::meeting(const std::vector<int>& among) const {
  std::vector<Class> classes;
  const std::vector<int> class_of = find_classes(among, classes);
  std::vector<char> meets(classes.size(), 0);
  const auto consider = [&](std::size_t i, std::size_t j, int a, int b) {
    if (a >= 0 && b >= 0 && meet(a, b)) meets[i] = meets[j] = 1;
  };
  for (std::size_t i = 0; i < classes.size(); ++i) {
    consider(i, i, classes[i].thickest, classes[i].second);
    for (std::size_t j = 0; j < i; ++j)
      if (classes[i].set == classes[j].set) consider(i, j, classes[i].thickest, classes[j].thickest);
  }
  std::vector<char> out;
  out.reserve(among.size());
  for (std::size_t i = 0; i < among.size(); ++i) {
    const bool meets_other = meets[static_cast<std::size_t>(class_of[i])] != 0;
    out.push_back(meets_other || bodies_[static_cast<std::size_t>(among[i])].meets_itself ? 1 : 0);
  }
  return out;
}

}  // namespace pliant

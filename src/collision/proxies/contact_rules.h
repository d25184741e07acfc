// Decides which bodies meet and with which material: by groups and a short list of exceptions, not by a table of pairs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "collision/proxies/pair_stencil.h"

namespace pliant {

/// The contact settings of a body.
struct ContactBody {
  std::uint32_t groups = 1, mask = ~0u;
  bool collides = true;       ///< true if it collides with other bodies that have `collides`
  bool is_collider = false;   ///< also meets bodies that do not collide
  bool is_immovable = false;  ///< static or kinematic: two such bodies never meet
  bool meets_itself = false;
  float thickness = 0;  ///< thickness; two bodies keep the sum of theirs [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
};

class ContactRules {
 public:
  void add(const ContactBody& body) { bodies_.push_back(body); }
  /// Replaces a body, or adds it as the next one.
  void set(int body, const ContactBody& by);
  /// Overrides the combined material of two bodies.
  void set_material(int a, int b, const PairMaterial& material) { exceptions_[std::minmax(a, b)] = material; }

  int bodies() const { return static_cast<int>(bodies_.size()); }
  bool is_immovable(int body) const { return bodies_[static_cast<std::size_t>(body)].is_immovable; }
  bool meet(int a, int b) const;
  PairMaterial material(int a, int b) const;

  /// The largest thickness of any two bodies that meet [m].
  float largest_thickness() const;
  /// For each body: true if it meets any other or itself.
  std::vector<char> meeting() const;

 private:
  /// Bodies that meet the same others; a body with an exception has a class of its own.
  struct Class {
    int thickest = -1, second = -1;  ///< the bodies of largest and second largest thickness; -1: none
  };
  std::vector<int> find_classes(std::vector<Class>& classes) const;
  void find_thickest(int body, Class& of) const;

  std::vector<ContactBody> bodies_;
  std::map<std::pair<int, int>, PairMaterial> exceptions_;  ///< overrides by pair of bodies, the lower one first
};

}  // namespace pliant

// Which bodies meet, and with which material. Groups and a short list of exceptions decide it, not a table of all
// pairs.
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
  bool collides = true;                   ///< meets other bodies whose `collides` is true
  float spacing = 0, speed_of_sound = 0;  ///< of a liquid: liquids that mix do not touch; 0: no liquid
  bool is_of_grains = false;              ///< contacts of grains with one another are found elsewhere (solver/grains/)
  bool is_collider = false;               ///< a collider, which also meets bodies whose `collides` is false
  bool is_immovable = false;              ///< static or kinematic: two such bodies never meet
  bool meets_itself = false;
  float thickness = 0;  ///< distance that the body keeps from others; two bodies keep the sum of theirs [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;

  /// True if what the particles of both do to one another is not contact of this kind.
  bool mixes_with(const ContactBody& other) const {
    if (is_of_grains && other.is_of_grains) return true;
    return spacing > 0 && spacing == other.spacing && speed_of_sound == other.speed_of_sound &&
           groups == other.groups && mask == other.mask;
  }
};

class ContactRules {
 public:
  void add(const ContactBody& body) { bodies_.push_back(body); }
  /// Sets the contact settings of a body; `body` may be one past the last, which adds it.
  void set(int body, const ContactBody& by);
  /// Sets for each body the number of its set (solver/near_sets.h): those of different sets are too far apart to meet
  /// in the frame.
  void set_sets(const std::vector<int>& of_bodies) { set_of_ = of_bodies; }
  /// Replaces the material that the settings of two bodies would combine to.
  void set_material(int a, int b, const PairMaterial& material) { exceptions_[std::minmax(a, b)] = material; }

  int bodies() const { return static_cast<int>(bodies_.size()); }
  bool is_immovable(int body) const { return bodies_[static_cast<std::size_t>(body)].is_immovable; }
  bool meet(int a, int b) const;
  PairMaterial material(int a, int b) const;

  /// The largest thickness of any two of these bodies that meet [m].
  float largest_thickness(const std::vector<int>& among) const;
  /// For each of these bodies the index in `among` of the first body of its set. Bodies that meet are in one set,
  /// directly or through others.
  std::vector<int> sets(const std::vector<int>& among) const;
  /// For each of these bodies: 1 if it meets another of them or itself.
  std::vector<char> meeting(const std::vector<int>& among) const;

 private:
  /// A class of bodies that meet the same others. A body with an exception has a class of its own.
  struct Class {
    int thickest = -1, second = -1;  ///< bodies of largest and second largest thickness in the class; -1: none
    int set = 0;                     ///< of its bodies
  };
  std::vector<int> find_classes(const std::vector<int>& among, std::vector<Class>& classes) const;
  std::vector<int> excepted() const;
  void find_thickest(int body, Class& of) const;

  /// The number of a body's set; 0 where none was given.
  int set_of(int body) const {
    const auto number = static_cast<std::size_t>(body);
    return number < set_of_.size() ? set_of_[number] : 0;
  }

  std::vector<ContactBody> bodies_;
  std::vector<int> set_of_;
  std::map<std::pair<int, int>, PairMaterial> exceptions_;  ///< overrides; key: two bodies, the lower index first
};

}  // namespace pliant

// The contacts of a frame between the bodies of a substep group, and of bodies with colliders: found at its start, and
// again where bodies turn or move so far that normals and arms are no longer true.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/bodies/body_contacts.h"
#include "solver/bodies/body_motions.h"
#include "solver/bodies/body_sleep.h"
#include "solver/bodies/contact_bodies.h"
#include "solver/bodies/deep_overlaps.h"

namespace pliant {

struct Substep;

class FrameContacts {
 public:
  /// Takes the parts of the bodies, and refers to these as long as it lives.
  explicit FrameContacts(ContactBodies& bodies);

  /// Finds the contacts of a frame, for which bodies and sleep have begun. Kept ones come from the State.
  void find(Substep& s, BodySleep& sleep);
  /// Which are no longer true: all of bodies with a contact that have turned far since it was found, or, if some
  /// bounce, moved far; those that touch of discs that have rolled on their rims.
  BodyContacts::Again outdated(const BodyMotions& motions, bool some_bounce) const;
  /// Finds those of such bodies again within a frame. The others stay, with the gaps of now.
  void renew(Substep& s, const BodyMotions& motions, bool some_bounce, BodyContacts::Again most);

  /// The number of dynamic bodies that each dynamic one overlaps deeply, by places.
  void count_overlaps(std::vector<int>& counts) const;
  /// Half of the thickness of the smaller body of a contact [m].
  float size(int contact) const;
  /// Warns of bodies that overlap when the frame begins. `is_separating` is nonzero for contacts that limit_depths has
  /// limited.
  void warn_of_overlaps(Substep& s, const std::vector<char>& is_separating);

  /// In ascending order of parts.
  std::vector<BodyContact>& all() { return contacts_; }
  const std::vector<BodyContact>& all() const { return contacts_; }
  /// The bodies of each, as places of ContactBodies.
  const std::vector<std::pair<int, int>>& bodies() const { return finder_.bodies(); }
  /// [place] when contacts were found.
  const std::vector<BodyState>& states() const { return states_; }
  /// [place] nonzero: fixed.
  std::span<const char> is_fixed() const { return is_fixed_; }

 private:
  void read_states(const Substep& s);
  void update(Substep& s, const std::vector<BodyContact>& before);
  void find_beside_sleepers(Substep& s, BodySleep& sleep);
  void warn(Substep& s);
  /// How far each body may turn until the contacts that it has are found again.
  void limit_rolling();
  bool has_turned_far(const BodyMotions& motions, int body, float share) const;
  bool has_rolled_far(const BodyMotions& motions, int body, float share) const;
  void find_outdated(const BodyMotions& motions, bool some_bounce, BodyContacts::Again most);
  void begin_path(int body);
  /// True if a body has left the path on which its contacts were found.
  bool has_strayed(const BodyMotions& motions, int body) const;
  template <class Visit>
  bool any_moved_far(const BodyMotions& motions, const Visit& visit) const;

  ContactBodies* bodies_;
  BodyContacts finder_{{}};
  std::vector<char> has_rim_;  ///< [place] nonzero: a solid of it is a cylinder
  DeepOverlaps overlaps_;
  std::vector<BodyState> states_;
  /// The path on which the contacts of a body were found, and how far the body has come since.
  struct SearchedPath {
    Vec3f way{};      ///< displacement to the end of the frame that was expected [m]
    Vec3f moved{};    ///< displacement since then, up to the last renewal [m]
    float slack = 0;  ///< by how much gravity changes `way` [m]
  };

  float left_ = 0;                   ///< time to the end of the frame when states were read [s]
  float faster_ = 0;                 ///< by how much gravity changes speeds in that time [m/s]
  std::vector<SearchedPath> paths_;  ///< [place]
  std::vector<char> is_fixed_;
  std::vector<BodyContact> contacts_;
  /// [place] rotation from when a body's contacts were found, and those that it has, to the last renewal [rad].
  std::vector<float> turned_, rolled_;
  std::vector<float> most_rolled_;  ///< [place] how far it may turn until those that it has are found again [rad]
  std::vector<BodyContacts::Again> outdated_;  ///< [place] which are found again
  std::vector<BodyContact> before_;            ///< of the frame before, where bodies sleep
};

}  // namespace pliant

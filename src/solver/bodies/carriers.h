// Contacts on what turns by itself, as turntables and drums do. Contacts are found once a frame, and their bodies would
// follow the chord of a circle in that frame.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/bodies/body_contacts.h"
#include "solver/bodies/manifold_blocks.h"

namespace pliant {

/// Turns the arm of a body that is driven round by half of what it turns across the normal in `left` seconds, so that
/// displacement and friction of linear motion along the arm follow the chord of its circle: what rides in a drum does
/// not drift outward. Such spin moves the surface along itself. It counts only where the surface faces its own centre,
/// as in a drum, and as far as the other body moves with it. `outward`: the normal away from the body.
void turn_arm(const BodyState& body, const BodyState& other, const Vec3f& outward, double left, Vec3f& arm);

/// Contacts of which one body, the carrier, is driven round about the normal, as a turntable is, and carries the other
/// one, the rider. With one chord for a whole frame the rider's velocity would have to turn at once when the next frame
/// begins, for which friction does not suffice: riders slipped outward.
class Carriers {
 public:
  void begin_frame(std::size_t contacts) { carrier_.assign(contacts, 0); }
  /// Notes whether a contact has a carrier. Threads may call it at the same time for different contacts.
  void note(int contact, const BodyState& a, const BodyState& b, const Manifold& m, double left);
  /// Lists the contacts that have one. `bodies` is by contact.
  void list(const ManifoldColours& colours, const std::vector<std::pair<int, int>>& bodies,
            const std::vector<BodyContact>& contacts);
  /// Moves the places of these contacts to where the riders are in the middle of a substep, which begins.
  void move_contacts(std::span<const BodyMotion> motions, float h, ManifoldBlocks& blocks) const;

 private:
  struct Ride {
    int number = 0, carrier = 0, rider = 0;  ///< of the manifold in the order of colours; of bodies
    bool carries_b = false;                  ///< the carrier is a
    Vec3f normal{}, carrier_arm{}, rider_arm{};
  };

  std::vector<char> carrier_;  ///< [contact] 1: a carries b, 2: b carries a
  std::vector<Ride> rides_;
};

}  // namespace pliant

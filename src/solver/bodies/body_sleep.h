// Sleep of rigid bodies: an island of bodies that have been slow for some time rests until something acts on it.
//
// A body that sleeps is held in place while a frame is made (held_bodies.h), so no stage moves it. Its contacts stay in
// the State as they were, and its constraints are left out. What comes near enough to touch wakes it before the
// contacts of the frame are solved. All that lasts is State::rest_times.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/islands.h"
#include "model/model.h"
#include "pliant/state.h"
#include "solver/bodies/body_islands.h"
#include "solver/bodies/contact_bodies.h"
#include "solver/bodies/held_bodies.h"

namespace pliant {

struct Substep;

/// True if a collider moves in the frame.
bool moves(const BodyState& state);
/// True if its surface moves along itself.
bool slides(const BodyState& state);

class BodySleep {
 public:
  BodySleep() = default;
  /// Refers to both as long as it lives.
  BodySleep(const Model& model, const ContactBodies& bodies, const BodyIslands& islands);

  /// Starts a frame: reads which bodies sleep, and wakes those on which something other than a contact acts.
  void begin_frame(Substep& s, std::span<const BodyContact> contacts);
  /// True if a body sleeps.
  bool any() const { return !held_.all().empty(); }
  /// Wakes the islands of bodies that have a contact in this frame. `pairs` are places, `contacts` those of the State.
  /// Returns false if there are none.
  bool wake_touched(Substep& s, std::span<const std::pair<int, int>> pairs, std::span<const BodyContact> contacts);
  /// Keeps the contacts of bodies that sleep, after the last wake_touched. `is_alone`: no other group has bodies in the
  /// list, which is taken if all sleep.
  void keep_contacts(bool is_alone, std::vector<BodyContact>& contacts);
  const std::vector<BodyContact>& kept_contacts() const { return kept_; }
  /// The body of a part; -1: a collider, or a body of another group.
  int body_of(const ContactPart& part) const;

  /// What a frame has found, at its end.
  struct Frame {
    std::span<const std::pair<int, int>> pairs;  ///< places that have a contact
    std::span<const BodyState> states;           ///< [place] at the frame's start
    std::span<const int> pressed;                ///< bodies on which particles press
  };
  /// Ends a frame: puts bodies that sleep back, and decides which fall asleep. Returns the number that sleeps.
  int end_frame(Substep& s, const Frame& frame);
  /// Adds the kept contacts to those of the frame, in order.
  void add_kept_contacts(std::vector<BodyContact>& contacts);

 private:
  int count() const { return static_cast<int>(is_tied_.size()); }
  float& rest_time(Substep& s, int body) const;
  bool is_driven(const Substep& s, int body) const;
  bool moves_fixed_body(const Substep& s) const;
  bool involves_sleeper(const BodyContact& contact) const;
  bool is_broken(const Substep& s, const BodyLink& link) const;
  void find_islands(const Substep& s, std::span<const BodyContact> contacts);
  void wake_pushed(Substep& s, std::span<const BodyContact> contacts);
  void wake(Substep& s, std::span<const BodyContact> contacts, std::vector<char>& is_woken);
  void add_rest(Substep& s, const Frame& frame);
  int fall_asleep(Substep& s, const Frame& frame);

  const Model* model_ = nullptr;
  const ContactBodies* bodies_ = nullptr;
  const BodyIslands* links_ = nullptr;
  std::vector<int> first_body_;  ///< [object] its first body, or -1
  std::vector<char> is_tied_;    ///< [body] a constraint ties it to particles
  bool has_kinematic_ = false;   ///< a body follows keyframes, so that nothing may sleep
  bool is_on_ = false;
  bool is_restless_ = false;  ///< nothing may sleep in this frame
  HeldBodies held_;           ///< those that sleep
  Islands islands_;           ///< of bodies that sleep
  std::vector<BodyContact> kept_, merged_;
};

}  // namespace pliant

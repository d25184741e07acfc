// The motions of the rigid bodies of a substep group, gathered from the State for a pass over their contacts and
// scattered after it, so that constraints, chains and other contact act on bodies as on any particle and frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/bodies/contact_bodies.h"
#include "solver/motion_kernels.h"

namespace pliant {

struct Substep;

class BodyMotions {
 public:
  BodyMotions() = default;
  explicit BodyMotions(const ContactBodies& bodies);

  /// Of the places of ContactBodies. Spins, rotations and inertias of bodies are turned back to the frame's start;
  /// rotations leave out axes about which a body is round.
  std::vector<BodyMotion>& all() { return motions_; }
  const std::vector<BodyMotion>& all() const { return motions_; }

  /// Reads where bodies are at the frame's start, and their masses. Forgets what add_fixed has added.
  void begin_frame(const Substep& s);
  /// Adds the motion of a surface that no place has, of infinite mass, and returns its index. It has moved and turned
  /// so far since contacts were found.
  int add_fixed(const Vec3f& velocity, const Vec3f& spin, const Vec3f& displacement, const Vec3f& rotation);

  /// Reads masses and inertias of bodies by their present orientations, for contact with points.
  void begin_substep(const Substep& s);
  const std::vector<BodyMotion>& present() const { return present_; }

  /// Gathers predicted motions. If `is_first` in the substep, they start with `share` times what contacts did in the
  /// last one.
  void load_predicted(const Substep& s, const ContactBodies& bodies, bool is_first, float share);
  /// Adds what contacts have changed to the prediction.
  void store_predicted(const Substep& s);
  /// What contacts have done to each body in this substep.
  struct Pushes {
    Records linear, angular;
  };
  Pushes pushes() const { return {pushed_, pushed_spin_}; }
  /// Does the same for the bodies with 1 in `of` [body]. For the others, undoes load_predicted with `is_first`, before
  /// which contacts had done `before`.
  void store_predicted(const Substep& s, const std::vector<char>& of, const Pushes& before);
  /// Gathers once more the motions of the bodies with 1 in `of`, without what contacts did in the last substep. In this
  /// one they have done `pushes`.
  void reload_predicted(const Substep& s, const std::vector<char>& of, const Pushes& pushes);
  /// By how much contacts have changed the angular velocity of a body since load_predicted [rad/s].
  float spin_change(int body) const {
    const BodyMotion& motion = motions_[static_cast<std::size_t>(body)];
    return length(motion.spin - motion.kept_spin);
  }
  /// Gathers velocities. `gravity` is what those of an object lack of this frame's gravity [m/s].
  void load_velocities(const Substep& s, FunctionRef<Vec3f(int object)> gravity);
  /// Adds what contacts have changed to velocities.
  void store_velocities(const Substep& s);

  /// By how much a body has turned since the frame's start, but about axes about which it is round [rad].
  float turned(int body) const { return length(motions_[static_cast<std::size_t>(body)].rotation); }

  /// Calls impacts(), whose effect on velocities the next substep does not start with. Impacts act at the substep's
  /// start: bodies with 1 in `restarts` [body] that no constraint has turned show them the spin that they have there,
  /// and then turn freely with what impacts leave of it; but not those that hardly turn in a substep. With the spin of
  /// the substep's middle, and impulses after the gyroscopic torque, each impact of a tilted box would bring or take
  /// energy.
  void bounce(const Substep& s, const std::vector<char>& restarts, FunctionRef<void()> impacts);

 private:
  /// A body whose free turn begins again.
  struct Restart {
    int body = 0;
    Vec3f spin;                                 ///< at the substep's start, in the body's axes [rad/s]
    Vec3f shown;                                ///< the same as contacts see it
    Vec3f shown_velocity;                       ///< as contacts see it [m/s]
    Record orientation, predicted, spin_after;  ///< of the frame, by the new turn
    bool turns = false;                         ///< impacts have changed its spin
  };

  /// Bodies [first, last) of an object.
  struct Range {
    int object = 0, first = 0, last = 0;
  };

  BodyArrays arrays(const Substep& s, std::vector<BodyMotion>& motions);
  void restore(const Pushes& pushes, const std::vector<char>& of, char value);
  void show_spin_at_start(const Substep& s, int body);
  bool turn_anew(const Substep& s, Restart& restart);
  void store_turns(const Substep& s, const std::vector<char>* of);
  BodyArrays arrays(const Substep& s) { return arrays(s, motions_); }
  int bodies() const { return static_cast<int>(particles_.size()); }

  std::vector<BodyMotion> motions_;  ///< of places, then those that add_fixed has added
  std::size_t places_ = 0;
  std::vector<std::int32_t> particles_, frames_;      ///< of each body: indices in the State
  std::vector<Range> ranges_;                         ///< of at most a task's length
  Records start_positions_, start_remainders_;        ///< of each body, at the frame's start [m]
  Records start_orientations_;                        ///< of each body, at the frame's start
  Records round_;                                     ///< of each body (FrameArrays)
  Records pushed_, pushed_spin_;                      ///< of each body (BodyArrays)
  std::vector<BodyMotion> present_;                   ///< masses and inertias by present orientations
  std::vector<Vec3f> before_velocity_, before_spin_;  ///< of bounce
  std::vector<Restart> restarts_;                     ///< not yet stored
};

}  // namespace pliant

// Bodies that sleep, held in place while a frame is made: they have infinite mass, and at its end their poses are put
// back bit by bit.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "parallel/executor.h"
#include "pliant/state.h"
#include "solver/bodies/body_links.h"
#include "solver/bodies/contact_bodies.h"

namespace pliant {

struct Substep;

class HeldBodies {
 public:
  /// What a body had before it was held.
  struct Held {
    int body = 0;
    Record position{}, orientation{}, inverse_inertia{};
  };

  HeldBodies() = default;
  /// Refers to `bodies` as long as it lives.
  HeldBodies(const ContactBodies& bodies, std::span<const BodyLink> links);

  /// Holds none.
  void clear();
  /// Gives a body infinite mass. Call it in ascending order of bodies.
  void hold(State& state, int body);
  /// Gives the bodies their masses back for which is_released(body) is true, and holds them no more.
  void release(State& state, FunctionRef<bool(int body)> is_released);
  /// Puts poses and masses back, at a frame's end.
  void put_back(State& state) const;
  /// Leaves out the constraints of bodies that are held, and no others.
  void leave_out_constraints(Substep& s) const;

  /// Ascending by body.
  const std::vector<Held>& all() const { return held_; }
  bool holds(int body) const { return is_held_[static_cast<std::size_t>(body)] != 0; }
  bool holds_every_body() const { return held_.size() == is_held_.size(); }

 private:
  /// An object with constraints between bodies.
  struct Jointed {
    int object = 0, first_body = 0;
  };

  const BodyPlace& place(int body) const { return bodies_->places()[static_cast<std::size_t>(body)]; }

  const ContactBodies* bodies_ = nullptr;
  std::vector<Jointed> jointed_;
  std::vector<char> is_held_;  ///< [body]
  std::vector<Held> held_, stay_;
};

}  // namespace pliant

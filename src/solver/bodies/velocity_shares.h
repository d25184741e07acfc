// Which share of a substep's corrections becomes velocity, for each rigid body and for the other particles of each
// object.
#pragma once

#include <cstddef>
#include <vector>

#include "model/model.h"

namespace pliant {

class VelocityShares {
 public:
  /// Sets all shares to 1.
  void clear() { of_object_.clear(); }
  bool are_one() const { return of_object_.empty(); }

  void set_points(const Model& model, int object, float share) { of(model, object).points = share; }

  void set_body(const Model& model, int object, int body, float share) {
    OfObject& to = of(model, object);
    const CompiledObject& from = model.objects[static_cast<std::size_t>(object)];
    const CompiledBodies::Body& place = from.bodies.bodies[static_cast<std::size_t>(body)];
    to.particles.resize(static_cast<std::size_t>(from.particles), 1);
    to.frames.resize(from.frames.size(), 1);
    to.particles[static_cast<std::size_t>(place.particle)] = to.frames[static_cast<std::size_t>(place.frame)] = share;
  }

  /// Of the particles of an object that are no centres of bodies, and of the bodies that they touch.
  float of_points(int object) const {
    return of_object_.empty() ? 1 : of_object_[static_cast<std::size_t>(object)].points;
  }

  /// Calls body(first, last, share) for ranges of the particles [first, last) of an object that have one share.
  template <class Body>
  void for_particles(const Model& model, int object, int first, int last, const Body& body) const {
    if (of_object_.empty()) return body(first, last, 1.f);
    const OfObject& shares = of_object_[static_cast<std::size_t>(object)];
    const CompiledBodies& bodies = model.objects[static_cast<std::size_t>(object)].bodies;
    for_ranges(first, last, body, [&](int i) {
      if (!bodies.has_centre(i)) return shares.points;
      return shares.particles.empty() ? 1.f : shares.particles[static_cast<std::size_t>(i)];
    });
  }

  /// The same for its frames.
  template <class Body>
  void for_frames(int object, int first, int last, const Body& body) const {
    if (of_object_.empty() || of_object_[static_cast<std::size_t>(object)].frames.empty())
      return body(first, last, 1.f);
    for_ranges(first, last, body,
               [&](int i) { return of_object_[static_cast<std::size_t>(object)].frames[static_cast<std::size_t>(i)]; });
  }

 private:
  struct OfObject {
    float points = 1;              ///< of particles that are no centres of bodies
    std::vector<float> particles;  ///< [particle] those that are; empty: 1 for all
    std::vector<float> frames;     ///< [frame] likewise
  };

  OfObject& of(const Model& model, int object) {
    of_object_.resize(model.objects.size());
    return of_object_[static_cast<std::size_t>(object)];
  }

  template <class Body, class Share>
  static void for_ranges(int first, int last, const Body& body, const Share& share_of) {
    while (first < last) {
      const float share = share_of(first);
      int end = first + 1;
      while (end < last && share_of(end) == share) ++end;
      body(first, end, share);
      first = end;
    }
  }

  std::vector<OfObject> of_object_;  ///< empty: 1 for all
};

}  // namespace pliant

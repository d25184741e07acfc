// Bodies that are pressed into one another for longer than an impact takes, for the Report.
#pragma once

#include "collision/bodies/body_contacts.h"

namespace pliant {

class ContactBodies;
struct Substep;

/// Bodies that overlap where their contact begins, in a frame.
class StartOverlaps {
 public:
  void add(const BodyOverlap& overlap) {
    ++count_;
    if (overlap.share > deepest_.share) deepest_ = overlap;
  }
  /// Warns if there are any, and names the deepest.
  void warn(Substep& s, const ContactBodies& bodies) const;

 private:
  int count_ = 0;
  BodyOverlap deepest_{};
};

class DeepOverlaps {
 public:
  /// Takes the deepest contact of a frame, and warns if the same two bodies have been as deep for several frames.
  void note(Substep& s, const ContactBodies& bodies, const BodyOverlap& deepest);

 private:
  /// Of the last frame.
  BodyOverlap deepest_{};
  int frames_ = 0;  ///< for how many frames it has been deep
};

}  // namespace pliant

// Bodies that are pressed into one another for longer than an impact takes, for the Report.
#pragma once

#include "collision/bodies/body_contacts.h"

namespace pliant {

class ContactBodies;
struct Substep;

class DeepOverlaps {
 public:
  /// Takes the deepest contact of a frame, and warns if the same two bodies have been as deep for several frames.
  void note(Substep& s, const ContactBodies& bodies, const BodyOverlap& deepest);

 private:
  BodyOverlap deepest_{};  ///< of the last frame
  int frames_ = 0;         ///< for how many frames it has been deep
};

}  // namespace pliant

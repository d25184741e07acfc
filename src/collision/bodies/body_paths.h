// The paths of bodies over a frame: straight, until they first touch something, then along it.
//
// A ball that lands on a floor of two boxes does not go on below it to the side of the second one. So the direction of
// a contact is looked for on paths that end at what is touched first.
#pragma once

#include <vector>

#include "collision/bodies/body_part.h"
#include "geometry/contact_path.h"

namespace pliant {

/// The first touch of two parts of bodies within a frame.
struct FirstTouch {
  int a = 0, b = 0;  ///< bodies
  int pair = 0;      ///< of parts (BodyPairs::pairs)
  double time = 0;   ///< in the frame, from 0 to 1
  Vec3d normal{};    ///< unit vector from a to b, in the world
};

class BodyPaths {
 public:
  /// Takes the touches of a frame of `dt` seconds. Of several of a body at one time, the first one counts.
  void begin(const std::vector<BodyState>& bodies, float dt, const std::vector<FirstTouch>& touches);

  /// When the path of one of two bodies first turns because of another pair of parts than this one; beyond 1 if neither
  /// does in this frame.
  double first_turn(int a, int b, int pair) const;
  /// The path of b against a until this pair of parts touches, in axes that are turned by `axes` against the world.
  ContactPath between(int a, int b, int pair, const Quatd& axes) const;
  /// The same of bodies that touch nothing else.
  static ContactPath straight(const BodyState& a, const BodyState& b, float dt, const Quatd& axes);

  /// True if something other than this pair turns the path of a body.
  bool turns(int body, int pair) const;

 private:
  struct Turn {
    int pair = -1;  ///< that touches; -1: none
    double time = 2;
    Vec3d change{};  ///< of the displacement that the whole frame would bring [m]
  };
  void note(int body, int other, const FirstTouch& touch, const Vec3d& normal);
  bool is_held(int body) const;

  const std::vector<BodyState>* bodies_ = nullptr;
  double dt_ = 0;
  std::vector<Turn> turns_;  ///< [body]
};

}  // namespace pliant

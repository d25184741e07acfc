// The parts of bodies that touch, and where bodies are.
#pragma once

#include "collision/bodies/body_mesh.h"
#include "geometry/convex_shape.h"
#include "pliant/state.h"

namespace pliant {

/// A convex part of a body, a half-space or a mesh.
struct BodyPart {
  ContactPart id;
  int body = 0;
  ConvexShape shape;
  bool is_half_space = false;      ///< y <= 0 of its frame, instead of the shape
  Posed pose{};                    ///< of the shape in the body's frame
  const BodyMesh* mesh = nullptr;  ///< instead of the shape
  int family = -1;                 ///< parts of one family never touch one another; -1: it has none

  bool is_convex() const { return !is_half_space && mesh == nullptr; }
};

/// Where a body is and how it moves at a frame's start.
struct BodyState {
  Posed pose{};                  ///< from the body's frame to the world
  Vec3f velocity{};              ///< [m/s]
  Vec3f spin{};                  ///< in world axes, but about axes about which the body is round [rad/s]
  bool is_fixed = false;         ///< two fixed bodies do not touch
  bool deforms = false;          ///< a mesh that moves by its vertices, so that no contact with it stays
  bool yields = true;            ///< false: nothing that touches it moves it, as if it were fixed
  bool is_driven_round = false;  ///< it turns by itself, whatever touches it
  Vec3f surface_velocity{};      ///< of its surface along itself, in world axes [m/s]
  float deforming = 0;           ///< greatest speed of the vertices of a mesh that deforms, against `velocity` [m/s]
};

}  // namespace pliant

// All constraint types of the library with a fixed stencil. To add one, write its header, include it here and add it to
// the list, or both in in_lanes.h if it has one row over points alone: pools, sweeps, files, tests and docs follow
// (docs/internals/architecture.md, "Adding a constraint").
#pragma once

#include "constraints/ball_joint.h"
#include "constraints/body_anchor.h"
#include "constraints/cylindrical_joint.h"
#include "constraints/fixed_joint.h"
#include "constraints/gear_joint.h"
#include "constraints/hinge_joint.h"
#include "constraints/in_lanes.h"
#include "constraints/joint_angle.h"
#include "constraints/joint_angle_motor.h"
#include "constraints/joint_distance.h"
#include "constraints/joint_offset.h"
#include "constraints/joint_offset_motor.h"
#include "constraints/joint_swing.h"
#include "constraints/planar_joint.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "constraints/pulley_joint.h"
#include "constraints/rack_joint.h"
#include "constraints/rod_joint.h"
#include "constraints/slider_joint.h"
#include "constraints/universal_joint.h"

namespace pliant {

/// The types that are projected one at a time: those with frames, or with more rows than one. Of joints, motors and
/// friction come first, then limits, so that what holds parts together has the last word.
using StencilConstraints =
    TypeList<JointAngleMotor, JointOffsetMotor, JointAngle, JointOffset, JointSwing, JointDistance, PulleyJointRows,
             GearJointRows, RackJointRows, PlanarJointRows, CylindricalJointRows, UniversalJointRows, SliderJointRows,
             BallJointRows, HingeJointRows, RodJointRows, FixedJointRows, BodyAnchor, PointOnTriangle,
             PointInTetrahedron>;

namespace detail {
template <class... Types>
constexpr bool any_in_lanes(TypeList<Types...>) {
  return (in_lanes<Types> || ...);
}
}  // namespace detail
static_assert(!detail::any_in_lanes(StencilConstraints{}),
              "add a type of one row over points to the list of in_lanes.h");

/// The types in the order in which a sweep visits them.
using AllConstraints = Joined<LaneConstraints, StencilConstraints>;

}  // namespace pliant

// What the user set between steps: motions, poses and forces of the next frame.
#pragma once

#include <string>

#include "math/motion.h"
#include "world/world_data.h"

namespace pliant {

/// The present pose of a collider, as set by the user or by its keyframes.
Posed pose_now(const WorldData& world, ColliderId id);
Posed pose_now(const WorldData& world, MeshColliderId id);

/// Sets the times of user motions, before a step of `dt` seconds.
void begin_control(WorldData& world, double dt);
/// Stores poses that stay, and discards the rest, after a step. `was_stopped`: it ended before the frame was complete.
void end_control(WorldData& world, bool was_stopped);

/// True if a setting of a motor comes before another in State::motors.
bool is_earlier(const MotorSetting& a, const MotorSetting& b);

/// Gives the motors with keyframes their targets at `time`, unless set_motor gave them others.
void follow_motors(WorldData& world, double time);

/// Wakes the bodies of an object, so that what is set acts in the next step.
void wake_bodies(WorldData& world, int number);

/// Puts a pose that a collider has from now on into a State's list.
void hold_pose(std::vector<HeldPose>& poses, const HeldPose& pose);
/// Throws an Error if the object has no such body.
const CompiledBodies::Body& body_of(const CompiledObject& object, int body);
/// Throws an Error if not exactly one body has the name.
int body_of_name(const CompiledObject& object, const std::string& name);

/// Discards the pose that the user set for a collider that is removed.
void forget_pose(WorldData& world, bool is_mesh, int slot);

}  // namespace pliant

// Rigid bodies and joints of objects.
#include "memory.h"
#include "object_use.h"

namespace pliant::c {

namespace {

/// "2 bodies", "1 joint".
std::string counted(size_t count, const std::string& what) {
  const std::string many = what == "body" ? "bodies" : what + "s";
  return std::to_string(count) + " " + (count == 1 ? what : many);
}

/// The index of what has that name in a list. Throws a StatusError if nothing has.
template <class Named>
std::int32_t index_of(const std::vector<Named>& list, const char* name, const char* what) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return static_cast<std::int32_t>(i);
  throw StatusError(PLIANT_NOT_FOUND, std::string("the object has no ") + what + " '" + name + "'",
                    "it has " + counted(list.size(), what) + "; pliant_object_" + what + "_name gives their names");
}

/// Throws a StatusError unless an index is one of a list.
template <class Named>
void require_index(const std::vector<Named>& list, std::int32_t index, const char* what) {
  if (index < 0 || static_cast<size_t>(index) >= list.size())
    throw StatusError(PLIANT_NOT_FOUND, std::string("the object has no ") + what + " " + std::to_string(index),
                      "it has " + counted(list.size(), what) + ", counted from 0");
}

template <class Named>
void give_name(const std::vector<Named>& list, std::int32_t index, const char* what, const Room<char>& room) {
  require_index(list, index, what);
  give_text(list[static_cast<size_t>(index)].name, room);
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_object_find_body(const pliant_world* world, pliant_id object, const char* name, int32_t* body) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(name, "name");
    require(body, "body");
    *body = index_of(use.object().description().bodies, name, "body");
  });
}

pliant_status pliant_object_body_name(const pliant_world* world, pliant_id object, int32_t body, char* into,
                                      size_t capacity, size_t* length) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const std::vector<ObjectBody>& bodies = use.object().description().bodies;
    give_name(bodies, body, "body", {into, capacity, length});
  });
}

pliant_status pliant_object_body_pose(const pliant_world* world, pliant_id object, int32_t body, pliant_pose* pose) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require_index(use.object().description().bodies, body, "body");
    give_pose(use.object().pose(body), pose);
  });
}

pliant_status pliant_object_set_body_pose(pliant_world* world, pliant_id object, int32_t body,
                                          const pliant_pose* pose) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require_index(use.object().description().bodies, body, "body");
    use.object().set_pose(body, c::pose_of(pose, "pose"));
  });
}

pliant_status pliant_object_set_body_surface_velocity(pliant_world* world, pliant_id object, int32_t body,
                                                      const float* velocity) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require_index(use.object().description().bodies, body, "body");
    use.object().set_surface_velocity(body, vector_of(velocity, "velocity"));
  });
}

pliant_status pliant_object_body_asleep(const pliant_world* world, pliant_id object, int32_t body, int32_t* is_asleep) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(is_asleep, "asleep");
    require_index(use.object().description().bodies, body, "body");
    *is_asleep = use.object().body_is_asleep(body) ? 1 : 0;
  });
}

pliant_status pliant_object_find_joint(const pliant_world* world, pliant_id object, const char* name, int32_t* joint) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(name, "name");
    require(joint, "joint");
    *joint = index_of(use.object().description().joints, name, "joint");
  });
}

pliant_status pliant_object_joint_name(const pliant_world* world, pliant_id object, int32_t joint, char* into,
                                       size_t capacity, size_t* length) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const std::vector<ObjectJoint>& joints = use.object().description().joints;
    give_name(joints, joint, "joint", {into, capacity, length});
  });
}

pliant_status pliant_object_joint_state(const pliant_world* world, pliant_id object, int32_t joint,
                                        pliant_joint_state* state) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(state, "state");
    require_index(use.object().description().joints, joint, "joint");
    const JointState found = use.object().joint_state(joint);
    put3(found.displacement, state->displacement);
    put3(found.rotation, state->rotation);
    put3(found.velocity, state->velocity);
    put3(found.angular_velocity, state->angular_velocity);
  });
}

pliant_status pliant_object_joint_load(const pliant_world* world, pliant_id object, int32_t joint, float* force,
                                       float* torque, int32_t* broken) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(force, "force");
    require(torque, "torque");
    require_index(use.object().description().joints, joint, "joint");
    const JointLoad load = use.object().joint_load(joint);
    const bool is_broken = use.object().joint_is_broken(joint);
    put3(load.force, force);
    put3(load.torque, torque);
    if (broken != nullptr) *broken = is_broken ? 1 : 0;
  });
}

pliant_status pliant_object_mean_joint_load(const pliant_world* world, pliant_id object, int32_t joint, float* force,
                                            float* torque) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(force, "force");
    require(torque, "torque");
    require_index(use.object().description().joints, joint, "joint");
    if (!use.world().records_joint_loads)
      throw StatusError(PLIANT_REFUSED, "the loads of joints are not recorded",
                        "call pliant_world_record_joint_loads before the step");
    const JointLoad load = use.object().mean_joint_load(joint);
    put3(load.force, force);
    put3(load.torque, torque);
  });
}

pliant_status pliant_object_set_motor(pliant_world* world, pliant_id object, const char* joint, const char* motor,
                                      float target, float most) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(joint, "joint");
    MotorCommand command;
    command.target = target;
    if (most != 0) command.most = most;
    if (motor != nullptr) command.motor = motor;
    use.object().set_motor(joint, command);
  });
}

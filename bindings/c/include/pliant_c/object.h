/* Objects and colliders of a World, between steps. Part of pliant_c.h, which users include. */
#ifndef PLIANT_C_OBJECT_H
#define PLIANT_C_OBJECT_H

#include "types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- objects, between steps */

/* Facts about an object. */
PLIANT_API pliant_status pliant_object_get_info(const pliant_world* world, pliant_id object, pliant_object_info* info);

/* Copies the positions of its particles: 3 * count floats [m]. `count` has to be that of its particles. */
PLIANT_API pliant_status pliant_object_positions(const pliant_world* world, pliant_id object, float* into,
                                                 size_t count);

/* Copies the velocities of its particles: 3 * count floats [m/s]. */
PLIANT_API pliant_status pliant_object_velocities(const pliant_world* world, pliant_id object, float* into,
                                                  size_t count);

/* The particles that are present, ascending: all, unless emitters and drains add and remove particles. */
PLIANT_API pliant_status pliant_object_present(const pliant_world* world, pliant_id object, int32_t* into,
                                               size_t capacity, size_t* count);

/* A number of each particle, such as the "temperature" of a gas [K] or the "water" in wet cloth [kg]. None if it has
 * no such channel. */
PLIANT_API pliant_status pliant_object_channel(const pliant_world* world, pliant_id object, const char* channel,
                                               float* into, size_t capacity, size_t* count);

/* The triangles of its surface: 3 indices of particles each. They change only if it tears. */
PLIANT_API pliant_status pliant_object_triangles(const pliant_world* world, pliant_id object, int32_t* into,
                                                 size_t capacity, size_t* count);

/* The surface that pictures and files show, at its present place: also of rigid bodies, and of a finer skin. It has
 * points of its own [m]. Both arrays are filled, or none. */
PLIANT_API pliant_status pliant_object_mesh(const pliant_world* world, pliant_id object, float* positions,
                                            size_t position_capacity, size_t* position_count, int32_t* triangles,
                                            size_t triangle_capacity, size_t* triangle_count);

/* The orientations of its frames, such as those of rigid bodies: 4 floats each, a unit quaternion x, y, z, w. */
PLIANT_API pliant_status pliant_object_orientations(const pliant_world* world, pliant_id object, float* into,
                                                    size_t capacity, size_t* count);

/* The angular velocities of its frames in world axes: 3 floats each [rad/s]. */
PLIANT_API pliant_status pliant_object_angular_velocities(const pliant_world* world, pliant_id object, float* into,
                                                          size_t capacity, size_t* count);

/* The multipliers of its constraints of a type in the last substep, in the order of its groups, row by row. Those of
 * "distance" with compliance are always stored, others if the scene sets "record_multipliers"; what is not stored has
 * none. A multiplier divided by the square of the substep is the force along the gradient. */
PLIANT_API pliant_status pliant_object_multipliers(const pliant_world* world, pliant_id object, const char* type,
                                                   float* into, size_t capacity, size_t* count);

/* The volume that its triangles enclose [m^3]. */
PLIANT_API pliant_status pliant_object_enclosed_volume(const pliant_world* world, pliant_id object, double* volume);

/* Sets the velocity of each particle [m/s]; pinned ones are skipped. `count` has to be that of its particles. */
PLIANT_API pliant_status pliant_object_set_velocities(pliant_world* world, pliant_id object, const float* velocities,
                                                      size_t count);

/* Adds an impulse to each particle [N s]. */
PLIANT_API pliant_status pliant_object_add_impulses(pliant_world* world, pliant_id object, const float* impulses,
                                                    size_t count);

/* Applies a constant force to each particle during the next step [N]. Replaces the forces of an earlier call. */
PLIANT_API pliant_status pliant_object_set_forces(pliant_world* world, pliant_id object, const float* forces,
                                                  size_t count);

/* Moves `count` pinned particles to positions [m] that they reach, at constant velocity, at the end of the next
 * step. After that they stay, or follow their keyframes. Places more than 1e9 m from the origin are refused here, by
 * pliant_object_teleport and by pliant_object_set_body_pose. */
PLIANT_API pliant_status pliant_object_set_targets(pliant_world* world, pliant_id object, const int32_t* particles,
                                                   const float* positions, size_t count);

/* Moves the targets of `count` attachments, given by their index in the object, in the same way. */
PLIANT_API pliant_status pliant_object_set_attachment_targets(pliant_world* world, pliant_id object,
                                                              const int32_t* attachments, const float* positions,
                                                              size_t count);

/* Moves the whole object at once: a point p gets to by.rotation p + by.position. Velocities turn with it. */
PLIANT_API pliant_status pliant_object_teleport(pliant_world* world, pliant_id object, const pliant_pose* by);

/* Multiplies the rest lengths (rest volumes, rest stretch of muscles) of a group of constraints by `factor`, >= 0,
 * instead of its keyframes. Refused if the group has none. */
PLIANT_API pliant_status pliant_object_set_rest_factor(pliant_world* world, pliant_id object, int32_t group,
                                                       float factor);

/* The index of a rigid body of that name. */
PLIANT_API pliant_status pliant_object_find_body(const pliant_world* world, pliant_id object, const char* name,
                                                 int32_t* body);

/* The name of a rigid body. */
PLIANT_API pliant_status pliant_object_body_name(const pliant_world* world, pliant_id object, int32_t body, char* into,
                                                 size_t capacity, size_t* length);

/* The present pose of a rigid body: of the frame in which it was described. */
PLIANT_API pliant_status pliant_object_body_pose(const pliant_world* world, pliant_id object, int32_t body,
                                                 pliant_pose* pose);

/* Moves a kinematic body to a pose that it reaches at the end of the next step. */
PLIANT_API pliant_status pliant_object_set_body_pose(pliant_world* world, pliant_id object, int32_t body,
                                                     const pliant_pose* pose);

/* Sets the velocity with which the surface of a body moves along itself, as that of a track: 3 floats in the frame
 * in which the body was described [m/s], up to 1e6. */
PLIANT_API pliant_status pliant_object_set_body_surface_velocity(pliant_world* world, pliant_id object, int32_t body,
                                                                 const float* velocity);

/* `asleep` receives 1 if a rigid body sleeps, else 0. */
PLIANT_API pliant_status pliant_object_body_asleep(const pliant_world* world, pliant_id object, int32_t body,
                                                   int32_t* asleep);

/* The index of a joint of that name. */
PLIANT_API pliant_status pliant_object_find_joint(const pliant_world* world, pliant_id object, const char* name,
                                                  int32_t* joint);

/* The name of a joint. */
PLIANT_API pliant_status pliant_object_joint_name(const pliant_world* world, pliant_id object, int32_t joint,
                                                  char* into, size_t capacity, size_t* length);

/* Angles, displacements and speeds of a joint, as they are now; of a broken one, too. */
PLIANT_API pliant_status pliant_object_joint_state(const pliant_world* world, pliant_id object, int32_t joint,
                                                   pliant_joint_state* state);

/* What a joint did to its second body in the last substep: 3 floats of force [N] and 3 of torque about the anchor [N
 * m], in world axes. `broken`, which may be NULL, receives 1 if the joint is broken. */
PLIANT_API pliant_status pliant_object_joint_load(const pliant_world* world, pliant_id object, int32_t joint,
                                                  float* force, float* torque, int32_t* broken);

/* The mean of the load over the last step, as control and plots want it: that of one substep oscillates. Refused unless
 * pliant_world_record_joint_loads is on. Zero before the first step. */
PLIANT_API pliant_status pliant_object_mean_joint_load(const pliant_world* world, pliant_id object, int32_t joint,
                                                       float* force, float* torque);

/* Gives a motor of the joint of that name a new target: an angle [rad], displacement [m] or speed [rad/s or m/s], as
 * its kind says. `motor` may be NULL if the joint has only one. `most` is its greatest torque [N m] or force [N], >
 * 0; 0: as before. */
PLIANT_API pliant_status pliant_object_set_motor(pliant_world* world, pliant_id object, const char* joint,
                                                 const char* motor, float target, float most);

/* ---------------------------------------------------------------- colliders, between steps */

/* The present pose of a primitive collider. */
PLIANT_API pliant_status pliant_collider_pose(const pliant_world* world, pliant_id collider, pliant_pose* pose);

/* Moves a collider of either kind to a pose that it reaches at the end of the next step. */
PLIANT_API pliant_status pliant_collider_set_pose(pliant_world* world, pliant_id collider, const pliant_pose* pose);

/* Moves it at once: a point p gets to by.rotation p + by.position. What it touches gets no velocity. */
PLIANT_API pliant_status pliant_collider_teleport(pliant_world* world, pliant_id collider, const pliant_pose* by);

/* Sets the velocity with which its surface moves along itself, as that of a conveyor belt: 3 floats in its own frame
 * [m/s]. */
PLIANT_API pliant_status pliant_collider_set_surface_velocity(pliant_world* world, pliant_id collider,
                                                              const float* velocity);

/* The present positions of the vertices of a mesh collider: 3 floats each [m]. */
PLIANT_API pliant_status pliant_collider_positions(const pliant_world* world, pliant_id collider, float* into,
                                                   size_t capacity, size_t* count);

/* Moves the vertices of a mesh collider to positions [m] that they reach at the end of the next step. `count` has to
 * be that of its vertices. */
PLIANT_API pliant_status pliant_collider_set_positions(pliant_world* world, pliant_id collider, const float* positions,
                                                       size_t count);

#ifdef __cplusplus
}
#endif

#endif

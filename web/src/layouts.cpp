// The places of members that web/package/layouts.js reads and writes: where one moves, this no longer compiles.
#include <cstddef>

#include "pliant_web.h"

#define PLIANT_AT(type, member, place) static_assert(offsetof(type, member) == place)

static_assert(sizeof(pliant_id) == 12 && sizeof(pliant_pose) == 28 && sizeof(pliant_value) == 8);
static_assert(sizeof(pliant_array) == 28 && sizeof(pliant_scene_options) == 32 && sizeof(pliant_scene_info) == 56);
static_assert(sizeof(pliant_finding) == 16 && sizeof(pliant_error_parts) == 36 && sizeof(pliant_world_info) == 72);
static_assert(sizeof(pliant_object_info) == 64 && sizeof(pliant_web_mesh) == 20);
static_assert(sizeof(pliant_contact) == 88 && sizeof(pliant_joint_state) == 48);
PLIANT_AT(pliant_contact, contacts, 28);
PLIANT_AT(pliant_contact, impulse, 32);
PLIANT_AT(pliant_contact, position, 40);
PLIANT_AT(pliant_contact, normal, 52);
PLIANT_AT(pliant_contact, push_on_first, 64);
PLIANT_AT(pliant_scene_options, arrays, 16);
PLIANT_AT(pliant_scene_options, value_count, 28);
PLIANT_AT(pliant_scene_info, frame_time, 8);
PLIANT_AT(pliant_scene_info, frames, 16);
PLIANT_AT(pliant_scene_info, particles, 48);
PLIANT_AT(pliant_error_parts, file, 16);
PLIANT_AT(pliant_error_parts, advice, 32);
PLIANT_AT(pliant_world_info, time, 8);
PLIANT_AT(pliant_world_info, frame, 16);
PLIANT_AT(pliant_world_info, frame_time, 24);
PLIANT_AT(pliant_world_info, frames, 32);
PLIANT_AT(pliant_world_info, threads, 64);
PLIANT_AT(pliant_object_info, particles, 8);
PLIANT_AT(pliant_object_info, substeps, 56);

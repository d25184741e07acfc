// What pictures in a browser need besides pliant_c.h. Not part of the C library: the module of WebAssembly alone has
// it.
#pragma once

#include "pliant_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A surface. The arrays belong to the module, and are valid until the next call of it.
typedef struct pliant_web_mesh {
  const float* positions; /* 3 * count floats [m] */
  const float* normals;   /* 3 * count floats, unit vectors */
  size_t count;
  const int32_t* triangles; /* 3 * triangle_count indices */
  size_t triangle_count;
} pliant_web_mesh;

/// The constant facts that pictures need of everything in a World, as JSON: kinds, colours and sizes of objects, solids
/// of bodies, shapes of colliders (web/package/index.d.ts, Parts).
PLIANT_API pliant_status pliant_web_parts(const pliant_world* world, char* into, size_t capacity, size_t* length);

/// The surface of an object's particles, or its finer skin, at present. Without that of rigid bodies.
PLIANT_API pliant_status pliant_web_surface(const pliant_world* world, pliant_id object, pliant_web_mesh* mesh);

/// The surface of a solid of an object's bodies, in the body's principal axes.
PLIANT_API pliant_status pliant_web_solid(const pliant_world* world, pliant_id object, int32_t solid,
                                          pliant_web_mesh* mesh);

/// The present surface of a mesh collider.
PLIANT_API pliant_status pliant_web_mesh_collider(const pliant_world* world, pliant_id collider, pliant_web_mesh* mesh);

/// The surface that a liquid shows: that of its particles that are there.
PLIANT_API pliant_status pliant_web_liquid(const pliant_world* world, pliant_id object, pliant_web_mesh* mesh);

/// The lines of an object, as pairs of particles: links of ropes and of rods.
PLIANT_API pliant_status pliant_web_lines(const pliant_world* world, pliant_id object, int32_t* into, size_t capacity,
                                          size_t* count);

/// The poses of the solids of its bodies: 7 floats each, position [m] and unit quaternion x, y, z, w.
PLIANT_API pliant_status pliant_web_poses(const pliant_world* world, pliant_id object, float* into, size_t capacity,
                                          size_t* count);

/// The inverse masses of its particles [1/kg]; 0: pinned.
PLIANT_API pliant_status pliant_web_inverse_masses(const pliant_world* world, pliant_id object, float* into,
                                                   size_t capacity, size_t* count);

/// Pulls particles towards places during the next step (ObjectHandle::set_pulls): frequencies [1/s].
PLIANT_API pliant_status pliant_web_set_pulls(pliant_world* world, pliant_id object, const int32_t* particles,
                                              const float* places, const float* frequencies, size_t count);

#ifdef __cplusplus
}
#endif

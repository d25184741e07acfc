/* Pliant for C: the engine behind functions that every language can call. docs/guide/c.md is a tutorial.
 *
 *   pliant_scene *scene = NULL;
 *   pliant_world *world = NULL;
 *   if (pliant_scene_read("drape.json", NULL, &scene) || pliant_world_create(scene, 0, &world)) {
 *     fprintf(stderr, "%s\n", pliant_last_error());
 *     return 1;
 *   }
 *   pliant_world_step(world, 0);
 *
 * Statuses. Every function that can fail returns a pliant_status: PLIANT_OK is 0. pliant_last_error() then says what
 * is wrong and what to do. A call that fails changes nothing and leaves the caller's memory as it was, unless its
 * comment says otherwise.
 *
 * Handles. A pliant_scene, pliant_world, pliant_state or pliant_writer is a number in the guise of a pointer. Free
 * each by its function. NULL gives PLIANT_NULL. A handle that was freed, twice or too early, or that never was one,
 * gives PLIANT_STALE: it is never followed.
 *
 * Ids. A pliant_id is plain data. After a removal its slot is used again with the next generation, so that a stale
 * id gives PLIANT_STALE.
 *
 * Arrays are a pointer and a count of elements. A point, velocity, force or impulse is three floats and counts as
 * one element; so does a triangle, of three integers. Where the count is known, as that of an object's particles, it
 * has to be exact. Particles are in the order in which the user described them.
 *
 * Texts and lists of unknown length go to the caller's memory: `into` has room for `capacity` bytes (with the 0 at
 * the end) or elements, and `*length` or `*count` receives how many there are (of a text without the 0). With too
 * little room the call gives PLIANT_TOO_SMALL, and *length or *count is set. `into` may be NULL if `capacity` is 0,
 * which asks for the length alone and succeeds; `length` may be NULL. The text or list is made at each call: where
 * it is large, begin with enough memory.
 *
 * Structures that may grow begin with `size`: set it to sizeof the structure. The others stay as they are.
 *
 * Units are SI: metres, kilograms, seconds, newtons, radians. Quaternions are x, y, z, w. Texts are UTF-8. Paths
 * without a leading '/' are relative to the working directory.
 *
 * Threads. A World, a scene, a state and a writer each belong to one thread at a time; different ones may be used at
 * the same time. While a World steps or runs, other calls with it give PLIANT_BUSY, but pliant_world_stop, which any
 * thread and signal handlers may call. That finds most mistakes and is no lock: a call that has begun when a step
 * begins is not seen. Keep to one thread at a time.
 *
 * Until Pliant 1.0 a minor version may change this interface; the library's SOVERSION then grows. */
#ifndef PLIANT_C_H
#define PLIANT_C_H

#include "pliant_c/object.h"
#include "pliant_c/scene.h"
#include "pliant_c/types.h"
#include "pliant_c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that is linked, as "0.1.0". Never NULL. */
PLIANT_API const char* pliant_version(void);

/* The name of a status, as "PLIANT_STALE"; "unknown status" for other numbers. Never NULL. */
PLIANT_API const char* pliant_status_name(pliant_status status);

/* The message of the last call of this thread that failed: what is wrong, where, and what to do. Empty before any call
 * failed. Valid until the next call that fails. Never NULL. */
PLIANT_API const char* pliant_last_error(void);

/* The parts of that message. */
PLIANT_API pliant_status pliant_last_error_parts(pliant_error_parts* parts);

/* The scene format as a JSON Schema (2020-12). */
PLIANT_API pliant_status pliant_schema(char* into, size_t capacity, size_t* length);

/* The built-in materials as JSON: "fabrics", "liquids", "grains", "solids" and "rods", each a list of {"name",
 * "source"}. */
PLIANT_API pliant_status pliant_materials(char* into, size_t capacity, size_t* length);

#ifdef __cplusplus
}
#endif

#endif

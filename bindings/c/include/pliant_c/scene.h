/* Scenes: reading, adding to, setting and checking. Part of pliant_c.h, which users include. */
#ifndef PLIANT_C_SCENE_H
#define PLIANT_C_SCENE_H

#include "types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads a scene from JSON text (docs/reference/scene-format.md). `options` may be NULL. "{\"objects\": []}" is a
 * scene without contents, which pliant_scene_add_object fills. Refused with line, column and JSON pointer if the
 * text is not such a scene. */
PLIANT_API pliant_status pliant_scene_parse(const char* text, const pliant_scene_options* options,
                                            pliant_scene** scene);

/* Reads a scene file. Paths of meshes in it are relative to its folder. `options` may be NULL. */
PLIANT_API pliant_status pliant_scene_read(const char* path, const pliant_scene_options* options, pliant_scene** scene);

/* Reads what pliant_scene_json wrote. Such a scene cannot be set by pointers; objects and colliders can be added. */
PLIANT_API pliant_status pliant_scene_from_json(const char* text, pliant_scene** scene);

/* Copies a scene. */
PLIANT_API pliant_status pliant_scene_copy(const pliant_scene* scene, pliant_scene** copy);

/* Frees a scene; worlds made from it stay. NULL is accepted. */
PLIANT_API pliant_status pliant_scene_free(pliant_scene* scene);

/* Adds an object: JSON as an item of "objects" of the scene format, and the arrays that it refers to by name.
 * `arrays` may be NULL if `count` is 0; arrays of earlier calls are there, too, and their names cannot be used for
 * others. `id`, which may be NULL, receives the id that the object will have in a World. */
PLIANT_API pliant_status pliant_scene_add_object(pliant_scene* scene, const char* json, const pliant_array* arrays,
                                                 size_t count, pliant_id* id);

/* Adds a collider in the same way: JSON as an item of "colliders". A mesh becomes a mesh collider. */
PLIANT_API pliant_status pliant_scene_add_collider(pliant_scene* scene, const char* json, const pliant_array* arrays,
                                                   size_t count, pliant_id* id);

/* Adds a force on all objects. `user` is passed on to it, and may be NULL. A World with forces cannot be saved. */
PLIANT_API pliant_status pliant_scene_add_force(pliant_scene* scene, pliant_force force, void* user);

/* Sets a member by JSON pointer: pliant_scene_set(scene, "/settings/substeps", "20"). `value` is JSON, or text that
 * is no JSON and stands for itself. The scene is read again, from its file too if it came from one: set many members
 * by pliant_scene_options. */
PLIANT_API pliant_status pliant_scene_set(pliant_scene* scene, const char* pointer, const char* value);

/* Facts about a scene. */
PLIANT_API pliant_status pliant_scene_get_info(const pliant_scene* scene, pliant_scene_info* info);

/* Inspects a scene: problems of its contents, repairs of its meshes, solids that a fill left out. `findings`
 * receives their number and `grave` how many of them keep a World from being made; both may be NULL.
 * pliant_scene_get_finding reads them. */
PLIANT_API pliant_status pliant_scene_check(pliant_scene* scene, size_t* findings, size_t* grave);

/* A finding of the last check: `index` from 0. Not found if there is no such one. */
PLIANT_API pliant_status pliant_scene_get_finding(const pliant_scene* scene, size_t index, pliant_finding* finding);

/* A whole scene as JSON: every particle and constraint, to print, compare and send. It is no scene file. Refused if
 * it has forces. */
PLIANT_API pliant_status pliant_scene_json(const pliant_scene* scene, char* into, size_t capacity, size_t* length);

/* A summary of the contents of a scene for people, in a few lines. */
PLIANT_API pliant_status pliant_scene_describe(const pliant_scene* scene, char* into, size_t capacity, size_t* length);

#ifdef __cplusplus
}
#endif

#endif

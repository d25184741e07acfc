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
 * Statuses. Every function that can fail returns a pliant_status: PLIANT_OK is 0. pliant_last_error() then says what is wrong and what to
 * do. A call that fails changes nothing and leaves the caller's memory as it was, unless its comment says otherwise.
 *
 * Handles. A pliant_scene, pliant_world, pliant_state or pliant_writer is a number in the guise of a pointer. Free each by its function.
 * NULL gives PLIANT_NULL. A handle that was freed, twice or too early, or that never was one, gives PLIANT_STALE: it is never followed.
 *
 * Ids. A pliant_id is plain data. After a removal its slot is used again with the next generation, so that a stale id gives PLIANT_STALE.
 *
 * Arrays are a pointer and a count of elements. A point, velocity, force or impulse is three floats and counts as one element; so does a
 * triangle, of three integers. Where the count is known, as that of an object's particles, it has to be exact. Particles are in the order
 * in which the user described them.
 *
 * Texts and lists of unknown length go to the caller's memory: `into` has room for `capacity` bytes (with the 0 at the end) or elements,
 * and `*length` or `*count` receives how many there are (of a text without the 0). With too little room the call gives PLIANT_TOO_SMALL,
 * and *length or *count is set. `into` may be NULL if `capacity` is 0, which asks for the length alone and succeeds; `length` may be NULL.
 * The text or list is made at each call: where it is large, begin with enough memory.
 *
 * Structures that may grow begin with `size`: set it to sizeof the structure. The others stay as they are.
 *
 * Units are SI: metres, kilograms, seconds, newtons, radians. Quaternions are x, y, z, w. Texts are UTF-8. Paths without a leading '/' are
 * relative to the working directory.
 *
 * Threads. A World, a scene, a state and a writer each belong to one thread at a time; different ones may be used at the same time.
 * While a World steps or runs, other calls with it give PLIANT_BUSY, but pliant_world_stop, which any thread and signal handlers may call.
 * That finds most mistakes and is no lock: a call that has begun when a step begins is not seen. Keep to one thread at a time.
 *
 * Until Pliant 1.0 a minor version may change this interface; the library's SOVERSION then grows. */
#ifndef PLIANT_C_H
#define PLIANT_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PLIANT_API __attribute__((visibility("default")))
#else
#define PLIANT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- types */

/* What became of a call. */
typedef int32_t pliant_status;
enum {
  PLIANT_OK = 0,
  PLIANT_NULL = 1,       /* a pointer is null that must not be */
  PLIANT_STALE = 2,      /* a handle or id refers to nothing: it was freed or removed, or never was one */
  PLIANT_REFUSED = 3,    /* the text, file, size or value is wrong; pliant_last_error() says where and what to do */
  PLIANT_TOO_SMALL = 4,  /* the caller's memory is too small; the length needed is told */
  PLIANT_NOT_FOUND = 5,  /* nothing has that name or number */
  PLIANT_STOPPED = 6,    /* pliant_world_stop ended the step */
  PLIANT_NOT_FINITE = 7, /* the step met a value that is not finite */
  PLIANT_NO_MEMORY = 8,
  PLIANT_INTERNAL = 9, /* a fault of the library: please report it */
  PLIANT_BUSY = 10     /* the World is in a step: called by its own force, or by another thread */
};

/* What an id refers to. */
enum { PLIANT_OBJECT = 0, PLIANT_COLLIDER = 1, PLIANT_MESH_COLLIDER = 2 };

/* An object or collider of a World. What a scene held has generation 0 and as slot its index among those of its kind. */
typedef struct pliant_id {
  int32_t kind; /* PLIANT_OBJECT, PLIANT_COLLIDER or PLIANT_MESH_COLLIDER */
  int32_t slot;
  int32_t generation;
} pliant_id;

/* The pose of a body or collider: a point p of its frame is at rotation p + position. */
typedef struct pliant_pose {
  float position[3]; /* [m] */
  float rotation[4]; /* quaternion x, y, z, w of any length but 0; as output a unit quaternion */
} pliant_pose;

/* Contacts between two things in the last step. Only active contacts count. */
typedef struct pliant_contact {
  int32_t change;  /* 0: they began, 1: they persist, 2: they ended */
  pliant_id first; /* equal to `second` for self-contact */
  pliant_id second;
  int32_t contacts;        /* largest number of active contacts in a substep */
  double impulse;          /* sum of the magnitudes of the normal impulses over the frame [N s] */
  float position[3];       /* mean position, weighted by impulse [m] */
  float normal[3];         /* mean direction of the push on `first`, a unit vector; zero if pushes cancel */
  double push_on_first[3]; /* sum of the normal impulses on `first` over the frame [N s] */
} pliant_contact;

/* An array in memory that a scene, object or collider refers to by {"array": "NAME"}: a mesh of triangles, of tetrahedra, or points. It is
 * copied during the call. In a list of arrays each has the same `size`. */
typedef struct pliant_array {
  size_t size;             /* sizeof(pliant_array) */
  const char* name;        /* what the JSON calls it */
  int32_t corners;         /* of an element: 3 for triangles, 4 for tetrahedra, 0 for points alone */
  const float* positions;  /* 3 * position_count floats [m] */
  size_t position_count;   /* number of points */
  const int32_t* elements; /* corners * element_count indices of points; triangles counter-clockwise seen from outside */
  size_t element_count;    /* number of triangles or tetrahedra; 0 for points alone */
} pliant_array;

/* A member of a scene to set: a JSON pointer (RFC 6901), and a value in JSON, or text that is no JSON and stands for itself. */
typedef struct pliant_value {
  const char* pointer; /* "/settings/substeps", "/objects/0/cloth/material"; "/objects/-" appends */
  const char* json;    /* "20", "\"silk\"" or "silk" */
} pliant_value;

/* Options of pliant_scene_parse and pliant_scene_read. What is zero is as without options. */
typedef struct pliant_scene_options {
  size_t size;            /* sizeof(pliant_scene_options) */
  const char* name;       /* stands for the file in errors; NULL: "scene". Not of pliant_scene_read */
  const char* folder;     /* of the paths in the text; NULL: the working directory. Not of pliant_scene_read */
  int32_t refuse_outside; /* 1: mesh files may not lie outside the folder */
  const pliant_array* arrays;
  size_t array_count;
  const pliant_value* values; /* to set before the scene is checked */
  size_t value_count;
} pliant_scene_options;

/* Facts about a scene. */
typedef struct pliant_scene_info {
  size_t size;       /* sizeof(pliant_scene_info) */
  double frame_time; /* duration of a frame [s] */
  int64_t frames;    /* number of frames of a run, as the scene wants it */
  int64_t objects;
  int64_t colliders; /* primitive ones */
  int64_t mesh_colliders;
  int64_t particles; /* of all objects */
} pliant_scene_info;

/* What pliant_scene_check found. The texts are valid until the scene is checked again, changed or freed. */
typedef struct pliant_finding {
  size_t size;         /* sizeof(pliant_finding) */
  int32_t is_grave;    /* 1: no World can be made */
  const char* message; /* what is wrong and where */
  const char* advice;  /* what to do; may be empty */
} pliant_finding;

/* The parts of an error. Texts may be empty; they are valid until the next call of this thread that fails. */
typedef struct pliant_error_parts {
  size_t size;          /* sizeof(pliant_error_parts) */
  pliant_status status; /* of that call */
  int32_t line;         /* in the file or text, from 1; 0: none */
  int32_t column;       /* byte within the line, from 1; 0: none */
  const char* file;     /* path or name */
  const char* object;   /* name of the object in the scene */
  const char* element;  /* "vertex 12", "/objects/0/mesh" (a JSON pointer) */
  const char* problem;  /* what is wrong */
  const char* advice;   /* what to do */
} pliant_error_parts;

/* Facts about a World. */
typedef struct pliant_world_info {
  size_t size;       /* sizeof(pliant_world_info) */
  double time;       /* simulated time [s] */
  int64_t frame;     /* number of complete steps */
  double frame_time; /* of its scene [s] */
  int64_t frames;    /* of its scene: the length of a run */
  int64_t objects;
  int64_t colliders; /* primitive ones */
  int64_t mesh_colliders;
  int32_t threads; /* that a step uses */
} pliant_world_info;

/* Facts about an object. */
typedef struct pliant_object_info {
  size_t size; /* sizeof(pliant_object_info) */
  int64_t particles;
  int64_t triangles; /* of its surface, between its particles */
  int64_t bodies;    /* rigid bodies */
  int64_t joints;
  int64_t attachments;
  int64_t constraints; /* groups of constraints */
  int32_t substeps;    /* per frame; 0: they follow the state */
  int32_t is_flow;     /* 1: its particles come and go */
} pliant_object_info;

/* Handles. */
typedef struct pliant_scene pliant_scene;
typedef struct pliant_world pliant_world;
typedef struct pliant_state pliant_state;
typedef struct pliant_writer pliant_writer;

/* A force on all particles of an object. Called once for each object and substep, always on the thread that steps. Arrays are valid during
 * the call and have three floats for each of `count` particles, but `masses` one; `forces` is zero at the call. Use no function of libm but
 * sqrt if a run must give the same bits on other machines.
 *   user        what was given to pliant_scene_add_force
 *   object      its name
 *   positions   [m]
 *   velocities  [m/s]
 *   masses      [kg]; infinite for pinned particles, whose force has no effect
 *   time        [s]
 *   forces      to be set [N]; what is not finite is left out, and the report warns */
typedef void (*pliant_force)(void* user, const char* object, const float* positions, const float* velocities,
                             const float* masses, size_t count, double time, float* forces);

/* ---------------------------------------------------------------- library */

/* The version of the library that is linked, as "0.1.0". Never NULL. */
PLIANT_API const char* pliant_version(void);

/* The name of a status, as "PLIANT_STALE"; "unknown status" for other numbers. Never NULL. */
PLIANT_API const char* pliant_status_name(pliant_status status);

/* What is wrong, where, and what to do: of the last call of this thread that failed. Empty before any did. Valid until the next one that
 * fails. Never NULL. */
PLIANT_API const char* pliant_last_error(void);

/* The parts of the same. */
PLIANT_API pliant_status pliant_last_error_parts(pliant_error_parts* parts);

/* The scene format as a JSON Schema (2020-12). */
PLIANT_API pliant_status pliant_schema(char* into, size_t capacity, size_t* length);

/* The built-in materials as JSON: "fabrics", "liquids", "grains", "solids" and "rods", each a list of {"name", "source"}. */
PLIANT_API pliant_status pliant_materials(char* into, size_t capacity, size_t* length);

/* ---------------------------------------------------------------- scenes */

/* Reads a scene from JSON text (docs/reference/scene-format.md). `options` may be NULL. "{\"objects\": []}" is a scene without contents,
 * which pliant_scene_add_object fills. Refused with line, column and JSON pointer if the text is not such a scene. */
PLIANT_API pliant_status pliant_scene_parse(const char* text, const pliant_scene_options* options, pliant_scene** scene);

/* Reads a scene file. Paths of meshes in it are relative to its folder. `options` may be NULL. */
PLIANT_API pliant_status pliant_scene_read(const char* path, const pliant_scene_options* options, pliant_scene** scene);

/* Reads what pliant_scene_json wrote. Such a scene cannot be set by pointers; objects and colliders can be added. */
PLIANT_API pliant_status pliant_scene_from_json(const char* text, pliant_scene** scene);

/* Copies a scene. */
PLIANT_API pliant_status pliant_scene_copy(const pliant_scene* scene, pliant_scene** copy);

/* Frees a scene; worlds made from it stay. NULL is accepted. */
PLIANT_API pliant_status pliant_scene_free(pliant_scene* scene);

/* Adds an object: JSON as an item of "objects" of the scene format, and the arrays that it refers to by name. `arrays` may be NULL if
 * `count` is 0; arrays of earlier calls are there, too, and their names cannot be used for others. `id`, which may be NULL, receives the id
 * that the object will have in a World. */
PLIANT_API pliant_status pliant_scene_add_object(pliant_scene* scene, const char* json, const pliant_array* arrays,
                                                 size_t count, pliant_id* id);

/* Adds a collider in the same way: JSON as an item of "colliders". A mesh becomes a mesh collider. */
PLIANT_API pliant_status pliant_scene_add_collider(pliant_scene* scene, const char* json, const pliant_array* arrays,
                                                   size_t count, pliant_id* id);

/* Adds a force on all objects. `user` is passed on to it, and may be NULL. A World with forces cannot be saved. */
PLIANT_API pliant_status pliant_scene_add_force(pliant_scene* scene, pliant_force force, void* user);

/* Sets a member by JSON pointer: pliant_scene_set(scene, "/settings/substeps", "20"). `value` is JSON, or text that is no JSON and stands for
 * itself. The scene is read again, from its file too if it came from one: set many members by pliant_scene_options. */
PLIANT_API pliant_status pliant_scene_set(pliant_scene* scene, const char* pointer, const char* value);

/* Facts about a scene. */
PLIANT_API pliant_status pliant_scene_get_info(const pliant_scene* scene, pliant_scene_info* info);

/* Inspects a scene: problems of its contents, repairs of its meshes, solids that a fill left out. `findings` receives their number and
 * `grave` how many of them keep a World from being made; both may be NULL. pliant_scene_get_finding reads them. */
PLIANT_API pliant_status pliant_scene_check(pliant_scene* scene, size_t* findings, size_t* grave);

/* A finding of the last check: `index` from 0. Not found if there is no such one. */
PLIANT_API pliant_status pliant_scene_get_finding(const pliant_scene* scene, size_t index, pliant_finding* finding);

/* A whole scene as JSON: every particle and constraint, to print, compare and send. It is no scene file. Refused if it has forces. */
PLIANT_API pliant_status pliant_scene_json(const pliant_scene* scene, char* into, size_t capacity, size_t* length);

/* What a scene holds, in a few lines for people. */
PLIANT_API pliant_status pliant_scene_describe(const pliant_scene* scene, char* into, size_t capacity, size_t* length);

/* ---------------------------------------------------------------- worlds */

/* Makes a World of a scene, which stays as it is. `threads`, 0..1024: 0 for as many as the scene says, which is all of the machine's unless
 * it names a number. Refused if the scene cannot be simulated; pliant_scene_check says so, too. */
PLIANT_API pliant_status pliant_world_create(const pliant_scene* scene, int32_t threads, pliant_world** world);

/* Frees a World. Its writers and states stay. PLIANT_BUSY while another thread steps it, which then keeps its handle. A force of its own may
 * free it: the step under way ends first. NULL is accepted. */
PLIANT_API pliant_status pliant_world_free(pliant_world* world);

/* Advances by `dt` seconds, > 0; 0: by the frame time of its scene. Keep it constant. Refused if it is negative, not finite or too short. PLIANT_NOT_FINITE if the step met a value that is not
 * finite: the World then stays within the frame and refuses steps until a state is restored. PLIANT_STOPPED if pliant_world_stop ended it.
 * pliant_report_json and the like tell how it went, in these cases too. */
PLIANT_API pliant_status pliant_world_step(pliant_world* world, float dt);

/* Makes `frames` steps of the scene's frame time, and ends at the first that does not give PLIANT_OK, with its status. `done`, which may be
 * NULL, receives the number of complete ones. */
PLIANT_API pliant_status pliant_world_run(pliant_world* world, int64_t frames, int64_t* done);

/* 1: ends the step under way after its substep, and all later ones before they begin, until 0 is given. Other threads and signal handlers
 * may call it. It does not change pliant_last_error(). */
PLIANT_API pliant_status pliant_world_stop(pliant_world* world, int32_t stop);

/* Facts about a World: time, frame and counts. */
PLIANT_API pliant_status pliant_world_get_info(const pliant_world* world, pliant_world_info* info);

/* The SHA-256 hash of its state, of 64 hexadecimal digits: the same on every machine and by every number of threads. */
PLIANT_API pliant_status pliant_world_hash(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* What it holds, in a few lines for people. */
PLIANT_API pliant_status pliant_world_describe(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* Finds an object or collider by its kind (PLIANT_OBJECT, ...) and name; the first by slot if several have it. */
PLIANT_API pliant_status pliant_world_find(const pliant_world* world, int32_t kind, const char* name, pliant_id* id);

/* The ids of all things of a kind, ordered by slot. */
PLIANT_API pliant_status pliant_world_ids(const pliant_world* world, int32_t kind, pliant_id* into, size_t capacity,
                                          size_t* count);

/* The name of an object or collider. */
PLIANT_API pliant_status pliant_world_name(const pliant_world* world, pliant_id id, char* into, size_t capacity,
                                           size_t* length);

/* Adds an object between steps, at the current time: JSON and arrays as of pliant_scene_add_object. */
PLIANT_API pliant_status pliant_world_add_object(pliant_world* world, const char* json, const pliant_array* arrays,
                                                 size_t count, pliant_id* id);

/* Adds a collider in the same way. */
PLIANT_API pliant_status pliant_world_add_collider(pliant_world* world, const char* json, const pliant_array* arrays,
                                                   size_t count, pliant_id* id);

/* Removes an object or collider. Other ids stay valid. */
PLIANT_API pliant_status pliant_world_remove(pliant_world* world, pliant_id id);

/* Measures the present state: "kinetic_energy" and "potential_energy" (heights from the origin) [J]; "stretch.mean", "stretch.p99" and
 * "stretch.largest", length over rest length; "overstretch.p99" and "overstretch.largest", the share by which constraints are longer than
 * their force explains; "tetrahedra.inverted", "tetrahedra.least_ratio" and "tetrahedra.volume_ratio". Not found for other names. */
PLIANT_API pliant_status pliant_world_measure(const pliant_world* world, const char* name, double* value);

/* Starts (1) or ends (0) the recording of contacts, which is off at first. It costs one more pass over the contacts of a step. */
PLIANT_API pliant_status pliant_world_record_contacts(pliant_world* world, int32_t on);

/* The contacts of the last step, ordered by participants: those that began, persist or ended. */
PLIANT_API pliant_status pliant_world_contacts(const pliant_world* world, pliant_contact* into, size_t capacity,
                                               size_t* count);

/* A scene of what the World holds: as given and added, and torn objects as they are now. As pliant_scene_from_json gives it. */
PLIANT_API pliant_status pliant_world_scene(const pliant_world* world, pliant_scene** scene);

/* Writes the World to a file. After loading, the next step gives the same bits. Forces and targets that were set for the next step, and what
 * is recorded, are not in it. If writing fails, a file that was there stays as it was. Refused if the World has forces. */
PLIANT_API pliant_status pliant_world_save(const pliant_world* world, const char* path);

/* Reads such a file. All ids that were valid are valid in it. */
PLIANT_API pliant_status pliant_world_load(const char* path, pliant_world** world);

/* The bytes of such a file. `into` has room for `capacity` bytes. */
PLIANT_API pliant_status pliant_world_bytes(const pliant_world* world, void* into, size_t capacity, size_t* count);

/* Makes a World of such bytes. */
PLIANT_API pliant_status pliant_world_from_bytes(const void* bytes, size_t count, pliant_world** world);

/* ---------------------------------------------------------------- objects, between steps */

/* Facts about an object. */
PLIANT_API pliant_status pliant_object_get_info(const pliant_world* world, pliant_id object, pliant_object_info* info);

/* Copies the positions of its particles: 3 * count floats [m]. `count` has to be that of its particles. */
PLIANT_API pliant_status pliant_object_positions(const pliant_world* world, pliant_id object, float* into, size_t count);

/* Copies the velocities of its particles: 3 * count floats [m/s]. */
PLIANT_API pliant_status pliant_object_velocities(const pliant_world* world, pliant_id object, float* into, size_t count);

/* Which particles are there, ascending: all, unless particles come and go. */
PLIANT_API pliant_status pliant_object_present(const pliant_world* world, pliant_id object, int32_t* into, size_t capacity,
                                               size_t* count);

/* A number of each particle, such as the "temperature" of a gas [K] or the "water" in wet cloth [kg]. None if it has no such channel. */
PLIANT_API pliant_status pliant_object_channel(const pliant_world* world, pliant_id object, const char* channel,
                                               float* into, size_t capacity, size_t* count);

/* The triangles of its surface: 3 indices of particles each. They change only if it tears. */
PLIANT_API pliant_status pliant_object_triangles(const pliant_world* world, pliant_id object, int32_t* into,
                                                 size_t capacity, size_t* count);

/* The surface that pictures and files show, at its present place: also of rigid bodies, and of a finer skin. It has points of its own [m].
 * Both arrays are filled, or none. */
PLIANT_API pliant_status pliant_object_mesh(const pliant_world* world, pliant_id object, float* positions,
                                            size_t position_capacity, size_t* position_count, int32_t* triangles,
                                            size_t triangle_capacity, size_t* triangle_count);

/* Sets the velocity of each particle [m/s]; pinned ones are skipped. `count` has to be that of its particles. */
PLIANT_API pliant_status pliant_object_set_velocities(pliant_world* world, pliant_id object, const float* velocities,
                                                      size_t count);

/* Adds an impulse to each particle [N s]. */
PLIANT_API pliant_status pliant_object_add_impulses(pliant_world* world, pliant_id object, const float* impulses,
                                                    size_t count);

/* Applies a constant force to each particle during the next step [N]. Replaces the forces of an earlier call. */
PLIANT_API pliant_status pliant_object_set_forces(pliant_world* world, pliant_id object, const float* forces, size_t count);

/* Moves `count` pinned particles to positions [m] that they reach, at constant velocity, at the end of the next step. After that they stay,
 * or follow their keyframes. */
PLIANT_API pliant_status pliant_object_set_targets(pliant_world* world, pliant_id object, const int32_t* particles,
                                                   const float* positions, size_t count);

/* Moves the targets of `count` attachments, given by their index in the object, in the same way. */
PLIANT_API pliant_status pliant_object_set_attachment_targets(pliant_world* world, pliant_id object,
                                                              const int32_t* attachments, const float* positions,
                                                              size_t count);

/* Moves the whole object at once: a point p gets to by.rotation p + by.position. Velocities turn with it. */
PLIANT_API pliant_status pliant_object_teleport(pliant_world* world, pliant_id object, const pliant_pose* by);

/* Multiplies the rest lengths (rest volumes, rest stretch of muscles) of a group of constraints by `factor`, >= 0, instead of its keyframes.
 * Refused if the group has none. */
PLIANT_API pliant_status pliant_object_set_rest_factor(pliant_world* world, pliant_id object, int32_t group, float factor);

/* The index of a rigid body of that name. */
PLIANT_API pliant_status pliant_object_find_body(const pliant_world* world, pliant_id object, const char* name,
                                                 int32_t* body);

/* The present pose of a rigid body: of the frame in which it was described. */
PLIANT_API pliant_status pliant_object_body_pose(const pliant_world* world, pliant_id object, int32_t body,
                                                 pliant_pose* pose);

/* Moves a kinematic body to a pose that it reaches at the end of the next step. */
PLIANT_API pliant_status pliant_object_set_body_pose(pliant_world* world, pliant_id object, int32_t body,
                                                     const pliant_pose* pose);

/* Sets the velocity with which the surface of a body moves along itself, as that of a track: 3 floats in the frame in which the body was
 * described [m/s], up to 1e6. */
PLIANT_API pliant_status pliant_object_set_body_surface_velocity(pliant_world* world, pliant_id object, int32_t body,
                                                                 const float* velocity);

/* `asleep` receives 1 if a rigid body sleeps, else 0. */
PLIANT_API pliant_status pliant_object_body_asleep(const pliant_world* world, pliant_id object, int32_t body,
                                                   int32_t* asleep);

/* The index of a joint of that name. */
PLIANT_API pliant_status pliant_object_find_joint(const pliant_world* world, pliant_id object, const char* name,
                                                  int32_t* joint);

/* What a joint did to its second body in the last substep: 3 floats of force [N] and 3 of torque about the anchor [N m], in world axes.
 * `broken`, which may be NULL, receives 1 if the joint is broken. */
PLIANT_API pliant_status pliant_object_joint_load(const pliant_world* world, pliant_id object, int32_t joint, float* force,
                                                  float* torque, int32_t* broken);

/* Gives a motor of the joint of that name a new target: an angle [rad], displacement [m] or speed [rad/s or m/s], as its kind says. `motor`
 * may be NULL if the joint has only one. `most` is its greatest torque [N m] or force [N], > 0; 0: as before. */
PLIANT_API pliant_status pliant_object_set_motor(pliant_world* world, pliant_id object, const char* joint,
                                                 const char* motor, float target, float most);

/* ---------------------------------------------------------------- colliders, between steps */

/* The present pose of a primitive collider. */
PLIANT_API pliant_status pliant_collider_pose(const pliant_world* world, pliant_id collider, pliant_pose* pose);

/* Moves a collider of either kind to a pose that it reaches at the end of the next step. */
PLIANT_API pliant_status pliant_collider_set_pose(pliant_world* world, pliant_id collider, const pliant_pose* pose);

/* Moves it at once, from its present place: what it touches gets no velocity. */
PLIANT_API pliant_status pliant_collider_teleport(pliant_world* world, pliant_id collider, const pliant_pose* by);

/* Sets the velocity with which its surface moves along itself, as that of a conveyor belt: 3 floats in its own frame [m/s]. */
PLIANT_API pliant_status pliant_collider_set_surface_velocity(pliant_world* world, pliant_id collider,
                                                              const float* velocity);

/* The present positions of the vertices of a mesh collider: 3 floats each [m]. */
PLIANT_API pliant_status pliant_collider_positions(const pliant_world* world, pliant_id collider, float* into,
                                                   size_t capacity, size_t* count);

/* Moves the vertices of a mesh collider to positions [m] that they reach at the end of the next step. `count` has to be that of its
 * vertices. */
PLIANT_API pliant_status pliant_collider_set_positions(pliant_world* world, pliant_id collider, const float* positions,
                                                       size_t count);

/* ---------------------------------------------------------------- states */

/* Copies the state of a World: all that changes with time. */
PLIANT_API pliant_status pliant_state_copy(const pliant_world* world, pliant_state** state);

/* Gives a World a state of its own again; the next step gives the bits that it gave then. Refused if it does not fit, as after objects were
 * added or removed. */
PLIANT_API pliant_status pliant_state_restore(pliant_world* world, const pliant_state* state);

/* A state as bytes. */
PLIANT_API pliant_status pliant_state_bytes(const pliant_state* state, void* into, size_t capacity, size_t* count);

/* Makes a state of such bytes. */
PLIANT_API pliant_status pliant_state_from_bytes(const void* bytes, size_t count, pliant_state** state);

/* Frees a state. NULL is accepted. */
PLIANT_API pliant_status pliant_state_free(pliant_state* state);

/* ---------------------------------------------------------------- the report of a World's last step */

/* `ok` receives 1 unless the step met a value that is not finite. Also 1 before the first step. */
PLIANT_API pliant_status pliant_report_ok(const pliant_world* world, int32_t* ok);

/* A number of the report by its name, as "milliseconds" or "pairs.contacts". The names are those of pliant_report_json, with a point before
 * a member of a member; pliant_report_number_name lists them. Not found for other names. */
PLIANT_API pliant_status pliant_report_number(const pliant_world* world, const char* name, double* value);

/* The name of a number: `index` from 0. NULL after the last. */
PLIANT_API const char* pliant_report_number_name(size_t index);

/* Problems and warnings as text; empty if there are none. */
PLIANT_API pliant_status pliant_report_explain(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* Where the solve fell short, by how much, and what to do; empty if it did not. */
PLIANT_API pliant_status pliant_report_advice(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* The whole report as one line of JSON. */
PLIANT_API pliant_status pliant_report_json(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* ---------------------------------------------------------------- files */

/* Begins a file of the frames of a World: .obj or .ply (a file for each frame), .glb, .usda, .pc2, .pvd. It is complete after
 * pliant_writer_finish. */
PLIANT_API pliant_status pliant_writer_open(const pliant_world* world, const char* path, pliant_writer** writer);

/* Adds the present state as a frame: once at the start and once after each step. Refused if the writer was opened for another World. */
PLIANT_API pliant_status pliant_writer_add(pliant_writer* writer, const pliant_world* world);

/* Completes the file. Nothing can be added after that. */
PLIANT_API pliant_status pliant_writer_finish(pliant_writer* writer);

/* Frees a writer. One that was not finished leaves no file, or, of formats with a file for each frame, those that it wrote. NULL is
 * accepted. */
PLIANT_API pliant_status pliant_writer_free(pliant_writer* writer);

#ifdef __cplusplus
}
#endif

#endif

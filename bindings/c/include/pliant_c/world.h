/* Worlds: making, stepping, saving; their states, reports and files. Part of pliant_c.h, which users include. */
#ifndef PLIANT_C_WORLD_H
#define PLIANT_C_WORLD_H

#include "types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- worlds */

/* Makes a World of a scene, which stays as it is. `threads`, 0..1024: 0 for as many as the scene says, which is all
 * of the machine's unless it names a number. Refused if the scene cannot be simulated; pliant_scene_check says so,
 * too. */
PLIANT_API pliant_status pliant_world_create(const pliant_scene* scene, int32_t threads, pliant_world** world);

/* Frees a World. Its writers and states stay. PLIANT_BUSY while it is in a step, also from a force of its own: the
 * handle then stays. NULL is accepted. */
PLIANT_API pliant_status pliant_world_free(pliant_world* world);

/* Advances by `dt` seconds, > 0; 0: by the frame time of its scene. Keep it constant. Refused if it is negative, not
 * finite or too short. PLIANT_NOT_FINITE if the step met a value that is not finite: the World then stays within the
 * frame, which counts in its info, and refuses steps until a state is restored. PLIANT_STOPPED if pliant_world_stop
 * ended it.
 * pliant_report_json and the like tell how it went, in these cases too. */
PLIANT_API pliant_status pliant_world_step(pliant_world* world, float dt);

/* Makes `frames` steps of the scene's frame time, and ends at the first that does not give PLIANT_OK, with its
 * status. `done`, which may be NULL, receives the number of complete ones. */
PLIANT_API pliant_status pliant_world_run(pliant_world* world, int64_t frames, int64_t* done);

/* 1: ends the step under way after its substep, and all later ones before they begin, until 0 is given. Other
 * threads and signal handlers may call it. It does not change pliant_last_error(). */
PLIANT_API pliant_status pliant_world_stop(pliant_world* world, int32_t stop);

/* Facts about a World: time, frame and counts. */
PLIANT_API pliant_status pliant_world_get_info(const pliant_world* world, pliant_world_info* info);

/* The SHA-256 hash of its state, of 64 hexadecimal digits: the same on every machine and by every number of threads. */
PLIANT_API pliant_status pliant_world_hash(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* A summary of its contents for people, in a few lines. */
PLIANT_API pliant_status pliant_world_describe(const pliant_world* world, char* into, size_t capacity, size_t* length);

/* Finds an object or collider by its kind (PLIANT_OBJECT, ...) and name; the first by slot if several have it. */
PLIANT_API pliant_status pliant_world_find(const pliant_world* world, int32_t kind, const char* name, pliant_id* id);

/* The ids of all things of a kind, ordered by slot. */
PLIANT_API pliant_status pliant_world_ids(const pliant_world* world, int32_t kind, pliant_id* into, size_t capacity,
                                          size_t* count);

/* The name of an object or collider. */
PLIANT_API pliant_status pliant_world_name(const pliant_world* world, pliant_id id, char* into, size_t capacity,
                                           size_t* length);

/* Adds an object between steps, at the current time: JSON and arrays as of pliant_scene_add_object. Paths are relative
 * to the folder of the scene; to the working directory if the World was loaded. */
PLIANT_API pliant_status pliant_world_add_object(pliant_world* world, const char* json, const pliant_array* arrays,
                                                 size_t count, pliant_id* id);

/* Adds a collider in the same way. */
PLIANT_API pliant_status pliant_world_add_collider(pliant_world* world, const char* json, const pliant_array* arrays,
                                                   size_t count, pliant_id* id);

/* Removes an object or collider. Other ids stay valid. */
PLIANT_API pliant_status pliant_world_remove(pliant_world* world, pliant_id id);

/* Measures the present state: "kinetic_energy" and "potential_energy" (heights from the origin) [J]; "stretch.mean",
 * "stretch.p99" and "stretch.largest", length over rest length; "overstretch.p99" and "overstretch.largest", the
 * share by which constraints are longer than their force explains; "tetrahedra.inverted", "tetrahedra.least_ratio"
 * and "tetrahedra.volume_ratio". Not found for other names. */
PLIANT_API pliant_status pliant_world_measure(const pliant_world* world, const char* name, double* value);

/* Starts (1) or ends (0) the recording of contacts, which is off at first. It costs one more pass over the contacts
 * of a step. */
PLIANT_API pliant_status pliant_world_record_contacts(pliant_world* world, int32_t on);

/* The contacts of the last step, ordered by participants: those that began, persist or ended. Refused unless
 * pliant_world_record_contacts is on. */
PLIANT_API pliant_status pliant_world_contacts(const pliant_world* world, pliant_contact* into, size_t capacity,
                                               size_t* count);

/* The contacts of each rigid body in the last step, ordered by participants. Refused unless
 * pliant_world_record_contacts is on. */
PLIANT_API pliant_status pliant_world_body_touches(const pliant_world* world, pliant_body_touch* into, size_t capacity,
                                                   size_t* count);

/* Starts (1) or ends (0) the recording of joint loads for pliant_object_mean_joint_load, which is off at first. It
 * costs one evaluation of all joints in each substep. */
PLIANT_API pliant_status pliant_world_record_joint_loads(pliant_world* world, int32_t on);

/* Makes a scene of the present contents of a World: objects as they were added, and torn ones as they are now. Like one
 * of pliant_scene_from_json, it has no members to set. */
PLIANT_API pliant_status pliant_world_scene(const pliant_world* world, pliant_scene** scene);

/* Writes the World to a file. After loading, the next step gives the same bits: also that of a World which stopped at a
 * value that is not finite fails again, so save after good steps. Forces and targets that were set for
 * the next step, and what is recorded, are not in it. If writing fails, a file that was there stays as it was.
 * Refused if the World has forces. */
PLIANT_API pliant_status pliant_world_save(const pliant_world* world, const char* path);

/* Reads such a file. All ids that were valid are valid in it. */
PLIANT_API pliant_status pliant_world_load(const char* path, pliant_world** world);

/* The bytes of such a file. `into` has room for `capacity` bytes. */
PLIANT_API pliant_status pliant_world_bytes(const pliant_world* world, void* into, size_t capacity, size_t* count);

/* Makes a World from such bytes. */
PLIANT_API pliant_status pliant_world_from_bytes(const void* bytes, size_t count, pliant_world** world);

/* ---------------------------------------------------------------- states */

/* Copies the state of a World: all that changes with time. */
PLIANT_API pliant_status pliant_state_copy(const pliant_world* world, pliant_state** state);

/* Gives a World a state of its own again; the next step gives the bits that it gave then. Refused if it does not
 * fit, as after objects were added or removed. */
PLIANT_API pliant_status pliant_state_restore(pliant_world* world, const pliant_state* state);

/* The SHA-256 hash of a state, of 64 hexadecimal digits, as pliant_world_hash. */
PLIANT_API pliant_status pliant_state_hash(const pliant_state* state, char* into, size_t capacity, size_t* length);

/* A state as bytes. */
PLIANT_API pliant_status pliant_state_bytes(const pliant_state* state, void* into, size_t capacity, size_t* count);

/* Makes a state from such bytes. */
PLIANT_API pliant_status pliant_state_from_bytes(const void* bytes, size_t count, pliant_state** state);

/* Frees a state. NULL is accepted. */
PLIANT_API pliant_status pliant_state_free(pliant_state* state);

/* ---------------------------------------------------------------- the report of a World's last step */

/* `ok` receives 1 unless the step met a value that is not finite. Also 1 before the first step. */
PLIANT_API pliant_status pliant_report_ok(const pliant_world* world, int32_t* ok);

/* A number of the report by its name, as "milliseconds" or "pairs.contacts". The names are those of
 * pliant_report_json, with a point before a member of a member; pliant_report_number_name lists them. Not found for
 * other names. */
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

/* Begins a file of the frames of a World: .glb, .usda, .pc2, .pvd, complete after pliant_writer_finish; or .obj or
 * .ply, a file for each frame: "run.obj" becomes "run_0000.obj" for frame 0. */
PLIANT_API pliant_status pliant_writer_open(const pliant_world* world, const char* path, pliant_writer** writer);

/* Receives a complete file in memory: its path as it would be on disk, and its bytes, which are valid during the call.
 * It returns PLIANT_OK; another status ends the call of the writer with that status. It must not call the writer. */
typedef pliant_status (*pliant_file_sink)(void* user, const char* path, const void* bytes, size_t count);

/* The same in memory: every file goes to `sink` instead of to disk, as soon as it is complete and with the bytes that
 * it would have there. `path` names the format and the files: "run.glb" and "run.usda" give one file in
 * pliant_writer_finish, "run.pc2" also "run.obj"; "run.obj" and "run.ply" give "run_0000.obj", ... in each
 * pliant_writer_add; "run.pvd" gives "run/OBJECT_0000.vtp", ... in each pliant_writer_add, and itself at the end.
 * `user` is passed on to `sink`. */
PLIANT_API pliant_status pliant_writer_open_sink(const pliant_world* world, const char* path, pliant_file_sink sink,
                                                 void* user, pliant_writer** writer);

/* Adds the present state as a frame: once at the start and once after each step. Refused if the writer was opened
 * for another World. */
PLIANT_API pliant_status pliant_writer_add(pliant_writer* writer, const pliant_world* world);

/* Completes the file. Nothing can be added after that. */
PLIANT_API pliant_status pliant_writer_finish(pliant_writer* writer);

/* Frees a writer. One that was not finished leaves no file, or, of formats with a file for each frame, those that it
 * wrote. NULL is accepted. */
PLIANT_API pliant_status pliant_writer_free(pliant_writer* writer);

#ifdef __cplusplus
}
#endif

#endif

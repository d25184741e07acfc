/* What is wrong gives a status: null pointers, stale handles and ids, wrong sizes, values that are not finite. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static float floats[81];
static int32_t integers[9];
static pliant_pose pose = {{0, 0, 0}, {0, 0, 0, 1}};

static pliant_status no_sink(void* user, const char* path, const void* bytes, size_t count) {
  (void)user, (void)path, (void)bytes, (void)count;
  return PLIANT_OK;
}

/* Every function of a World with this handle. */
static void with_world(pliant_world* world, pliant_status expected) {
  const pliant_id id = object_at(0);
  char text[8];
  size_t count = 0;
  double value;
  int32_t one;
  int64_t many;
  pliant_id found;
  pliant_world_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0, 0};
  pliant_scene* scene = NULL;
  pliant_state* state = NULL;
  pliant_writer* writer = NULL;
  GIVES(expected, pliant_world_step(world, 0));
  GIVES(expected, pliant_world_run(world, 1, &many));
  GIVES(expected, pliant_world_stop(world, 1));
  GIVES(expected, pliant_world_get_info(world, &info));
  GIVES(expected, pliant_world_hash(world, text, 8, &count));
  GIVES(expected, pliant_world_describe(world, text, 8, &count));
  GIVES(expected, pliant_world_find(world, PLIANT_OBJECT, "flag", &found));
  GIVES(expected, pliant_world_ids(world, PLIANT_OBJECT, &found, 1, &count));
  GIVES(expected, pliant_world_name(world, id, text, 8, &count));
  GIVES(expected, pliant_world_add_object(world, "{}", NULL, 0, NULL));
  GIVES(expected, pliant_world_add_collider(world, "{}", NULL, 0, NULL));
  GIVES(expected, pliant_world_remove(world, id));
  GIVES(expected, pliant_world_measure(world, "stretch.mean", &value));
  GIVES(expected, pliant_world_record_contacts(world, 1));
  GIVES(expected, pliant_world_contacts(world, NULL, 0, &count));
  GIVES(expected, pliant_world_body_touches(world, NULL, 0, &count));
  GIVES(expected, pliant_world_record_joint_loads(world, 1));
  GIVES(expected, pliant_world_scene(world, &scene));
  GIVES(expected, pliant_world_save(world, "never.world"));
  GIVES(expected, pliant_world_bytes(world, NULL, 0, &count));
  GIVES(expected, pliant_state_copy(world, &state));
  GIVES(expected, pliant_report_ok(world, &one));
  GIVES(expected, pliant_report_number(world, "frame", &value));
  GIVES(expected, pliant_report_explain(world, text, 8, &count));
  GIVES(expected, pliant_report_advice(world, text, 8, &count));
  GIVES(expected, pliant_report_json(world, text, 8, &count));
  GIVES(expected, pliant_writer_open(world, "never.obj", &writer));
  GIVES(expected, pliant_writer_open_sink(world, "never.obj", no_sink, NULL, &writer));
  CHECK(scene == NULL && state == NULL && writer == NULL);
}

/* Every function of an object with this World and id. */
static void with_object(pliant_world* world, pliant_id id, pliant_status expected) {
  pliant_object_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0, 0};
  pliant_joint_state state;
  size_t count = 0;
  int32_t one;
  double volume;
  GIVES(expected, pliant_object_get_info(world, id, &info));
  GIVES(expected, pliant_object_positions(world, id, floats, 9));
  GIVES(expected, pliant_object_velocities(world, id, floats, 9));
  GIVES(expected, pliant_object_present(world, id, NULL, 0, &count));
  GIVES(expected, pliant_object_channel(world, id, "water", NULL, 0, &count));
  GIVES(expected, pliant_object_triangles(world, id, NULL, 0, &count));
  GIVES(expected, pliant_object_mesh(world, id, NULL, 0, &count, NULL, 0, &count));
  GIVES(expected, pliant_object_orientations(world, id, NULL, 0, &count));
  GIVES(expected, pliant_object_angular_velocities(world, id, NULL, 0, &count));
  GIVES(expected, pliant_object_multipliers(world, id, "distance", NULL, 0, &count));
  GIVES(expected, pliant_object_enclosed_volume(world, id, &volume));
  GIVES(expected, pliant_object_set_velocities(world, id, floats, 9));
  GIVES(expected, pliant_object_add_impulses(world, id, floats, 9));
  GIVES(expected, pliant_object_set_forces(world, id, floats, 9));
  GIVES(expected, pliant_object_set_targets(world, id, integers, floats, 1));
  GIVES(expected, pliant_object_set_attachment_targets(world, id, integers, floats, 1));
  GIVES(expected, pliant_object_teleport(world, id, &pose));
  GIVES(expected, pliant_object_set_rest_factor(world, id, 0, 1));
  GIVES(expected, pliant_object_find_body(world, id, "leaf", &one));
  GIVES(expected, pliant_object_body_name(world, id, 0, NULL, 0, &count));
  GIVES(expected, pliant_object_body_pose(world, id, 0, &pose));
  GIVES(expected, pliant_object_set_body_pose(world, id, 0, &pose));
  GIVES(expected, pliant_object_set_body_surface_velocity(world, id, 0, floats));
  GIVES(expected, pliant_object_body_asleep(world, id, 0, &one));
  GIVES(expected, pliant_object_find_joint(world, id, "hinge", &one));
  GIVES(expected, pliant_object_joint_name(world, id, 0, NULL, 0, &count));
  GIVES(expected, pliant_object_joint_state(world, id, 0, &state));
  GIVES(expected, pliant_object_joint_load(world, id, 0, floats, floats, NULL));
  GIVES(expected, pliant_object_mean_joint_load(world, id, 0, floats, floats));
  GIVES(expected, pliant_object_set_motor(world, id, "hinge", NULL, 0, 0));
}

/* Every function of a collider with this World and id. */
static void with_collider(pliant_world* world, pliant_id id, pliant_id mesh, pliant_status expected) {
  size_t count = 0;
  GIVES(expected, pliant_collider_pose(world, id, &pose));
  GIVES(expected, pliant_collider_set_pose(world, id, &pose));
  GIVES(expected, pliant_collider_teleport(world, id, &pose));
  GIVES(expected, pliant_collider_set_surface_velocity(world, id, floats));
  GIVES(expected, pliant_collider_positions(world, mesh, NULL, 0, &count));
  GIVES(expected, pliant_collider_set_positions(world, mesh, floats, 9));
}

static void with_scene(pliant_scene* scene, pliant_status expected) {
  pliant_scene_info info = {sizeof info, 0, 0, 0, 0, 0, 0};
  pliant_finding finding = {sizeof finding, 0, NULL, NULL};
  pliant_scene* copy = NULL;
  pliant_world* world = NULL;
  size_t count = 0;
  GIVES(expected, pliant_scene_copy(scene, &copy));
  GIVES(expected, pliant_scene_add_object(scene, "{}", NULL, 0, NULL));
  GIVES(expected, pliant_scene_add_collider(scene, "{}", NULL, 0, NULL));
  GIVES(expected, pliant_scene_add_force(scene, NULL, NULL));
  GIVES(expected, pliant_scene_set(scene, "/frames", "1"));
  GIVES(expected, pliant_scene_get_info(scene, &info));
  GIVES(expected, pliant_scene_check(scene, &count, &count));
  GIVES(expected, pliant_scene_get_finding(scene, 0, &finding));
  GIVES(expected, pliant_scene_json(scene, NULL, 0, &count));
  GIVES(expected, pliant_scene_describe(scene, NULL, 0, &count));
  GIVES(expected, pliant_world_create(scene, 0, &world));
}

static void test_null(void) {
  const pliant_id none = {PLIANT_COLLIDER, 0, 0}, no_mesh = {PLIANT_MESH_COLLIDER, 0, 0};
  pliant_scene* scene = empty_scene();
  pliant_world* world = sheet_world();
  pliant_state* state = NULL;
  size_t count = 0;
  with_world(NULL, PLIANT_NULL);
  with_object(NULL, object_at(0), PLIANT_NULL);
  with_collider(NULL, none, no_mesh, PLIANT_NULL);
  with_scene(NULL, PLIANT_NULL);
  OK(pliant_scene_free(NULL));
  OK(pliant_world_free(NULL));
  OK(pliant_state_free(NULL));
  OK(pliant_writer_free(NULL));
  SAYS(PLIANT_NULL, "'parts'", pliant_last_error_parts(NULL));
  SAYS(PLIANT_NULL, "'text'", pliant_scene_parse(NULL, NULL, &scene));
  SAYS(PLIANT_NULL, "'scene'", pliant_scene_parse("{}", NULL, NULL));
  SAYS(PLIANT_NULL, "'path'", pliant_scene_read(NULL, NULL, &scene));
  GIVES(PLIANT_NULL, pliant_scene_from_json(NULL, &scene));
  GIVES(PLIANT_NULL, pliant_scene_copy(scene, NULL));
  GIVES(PLIANT_NULL, pliant_scene_add_object(scene, NULL, NULL, 0, NULL));
  SAYS(PLIANT_NULL, "'arrays'", pliant_scene_add_object(scene, "{}", NULL, 1, NULL));
  GIVES(PLIANT_NULL, pliant_scene_add_force(scene, NULL, NULL));
  GIVES(PLIANT_NULL, pliant_scene_set(scene, NULL, "1"));
  GIVES(PLIANT_NULL, pliant_scene_set(scene, "/frames", NULL));
  GIVES(PLIANT_NULL, pliant_scene_get_info(scene, NULL));
  GIVES(PLIANT_NULL, pliant_schema(NULL, 10, &count));
  GIVES(PLIANT_NULL, pliant_world_create(scene, 0, NULL));
  GIVES(PLIANT_NULL, pliant_world_find(world, 0, NULL, NULL));
  GIVES(PLIANT_NULL, pliant_world_measure(world, "stretch.mean", NULL));
  GIVES(PLIANT_NULL, pliant_world_save(world, NULL));
  GIVES(PLIANT_NULL, pliant_world_load(NULL, &world));
  GIVES(PLIANT_NULL, pliant_world_from_bytes(NULL, 3, &world));
  GIVES(PLIANT_NULL, pliant_state_from_bytes(NULL, 3, &state));
  GIVES(PLIANT_NULL, pliant_state_restore(world, NULL));
  GIVES(PLIANT_NULL, pliant_state_bytes(NULL, NULL, 0, &count));
  GIVES(PLIANT_NULL, pliant_object_positions(world, object_at(0), NULL, 9));
  GIVES(PLIANT_NULL, pliant_object_set_targets(world, object_at(0), NULL, floats, 1));
  GIVES(PLIANT_NULL, pliant_object_teleport(world, object_at(0), NULL));
  GIVES(PLIANT_NULL, pliant_object_multipliers(world, object_at(0), NULL, NULL, 0, &count));
  GIVES(PLIANT_NULL, pliant_object_enclosed_volume(world, object_at(0), NULL));
  SAYS(PLIANT_NULL, "'state'", pliant_object_joint_state(world, object_at(0), 0, NULL));
  SAYS(PLIANT_NULL, "'force'", pliant_object_mean_joint_load(world, object_at(0), 0, NULL, floats));
  SAYS(PLIANT_NULL, "'torque'", pliant_object_mean_joint_load(world, object_at(0), 0, floats, NULL));
  OK(pliant_world_record_contacts(world, 1));
  GIVES(PLIANT_NULL, pliant_world_body_touches(world, NULL, 1, &count));
  GIVES(PLIANT_NULL, pliant_state_hash(NULL, NULL, 0, &count));
  GIVES(PLIANT_NULL, pliant_writer_add(NULL, world));
  GIVES(PLIANT_NULL, pliant_writer_finish(NULL));
  OK(pliant_world_free(world));
  OK(pliant_scene_free(scene));
}

/* What is finite but farther from the origin than scenes may have it is refused, too. */
static void test_far_places(void) {
  pliant_world* world = sheet_world();
  pliant_id wall = object_at(0);
  const pliant_pose far = {{2e9f, 0, 0}, {0, 0, 0, 1}};
  const int32_t pinned = 0;
  float there[27];
  char before[65] = "1", after[65] = "2";
  for (int i = 0; i < 27; ++i) there[i] = -1e30f;
  OK(pliant_world_add_collider(
      world, "{\"name\": \"wall\", \"mesh\": {\"grid\": {\"columns\": 3, \"rows\": 3, \"width\": 1, \"depth\": 1}}}",
      NULL, 0, &wall));
  hash_of(world, before);
  SAYS(PLIANT_REFUSED, "particle 0: its target is more than 1e9 m from the origin; give metres",
       pliant_object_set_targets(world, object_at(0), &pinned, there, 1));
  SAYS(PLIANT_REFUSED, "1e9 m", pliant_object_teleport(world, object_at(0), &far));
  SAYS(PLIANT_REFUSED, "1e9 m", pliant_collider_teleport(world, wall, &far));
  SAYS(PLIANT_REFUSED, "vertex 0: its target is more", pliant_collider_set_positions(world, wall, there, 9));
  SAYS(PLIANT_REFUSED, "are 8 for 9 vertices; give one per vertex",
       pliant_collider_set_positions(world, wall, there, 8));
  hash_of(world, after);
  CHECK(strcmp(before, after) == 0);
  OK(pliant_world_step(world, 0));
  OK(pliant_world_free(world));
}

static void test_values(void) {
  pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  pliant_world* world = sheet_world();
  pliant_world_info small = {8, 0, 0, 0, 0, 0, 0, 0, 0};
  pliant_pose nowhere = {{0, NAN, 0}, {0, 0, 0, 1}};
  const char* json = "{\"cloth\": {\"mesh\": {\"array\": \"sheet\"}}}";
  char before[65] = "1", after[65] = "2";
  const int32_t beyond = 9;
  hash_of(world, before);
  memset(floats, 0, sizeof floats);
  floats[4] = NAN;
  SAYS(PLIANT_REFUSED, "particle 1", pliant_object_set_velocities(world, object_at(0), floats, 9));
  SAYS(PLIANT_REFUSED, "flag", pliant_object_add_impulses(world, object_at(0), floats, 9));
  GIVES(PLIANT_REFUSED, pliant_object_set_forces(world, object_at(0), floats, 9));
  floats[4] = 0;
  GIVES(PLIANT_REFUSED, pliant_object_set_forces(world, object_at(0), floats, 8));
  SAYS(PLIANT_REFUSED, "give room for 9 points; a point of three numbers counts as one",
       pliant_object_positions(world, object_at(0), floats, 27));
  GIVES(PLIANT_REFUSED, pliant_object_set_targets(world, object_at(0), &beyond, floats, 1));
  GIVES(PLIANT_REFUSED, pliant_object_teleport(world, object_at(0), &nowhere));
  GIVES(PLIANT_REFUSED, pliant_object_set_rest_factor(world, object_at(0), 99, 1));
  GIVES(PLIANT_REFUSED, pliant_world_add_object(world, "{\"cloth\"", NULL, 0, NULL));
  SAYS(PLIANT_REFUSED, "'info' has the size 8", pliant_world_get_info(world, &small));
  GIVES(PLIANT_REFUSED, pliant_world_run(world, -1, NULL));
  GIVES(PLIANT_REFUSED, pliant_world_create(scene, -1, &world));
  GIVES(PLIANT_REFUSED, pliant_world_from_bytes(floats, sizeof floats, &world));
  hash_of(world, after);
  CHECK(strcmp(before, after) == 0);

  array.size = 3;
  SAYS(PLIANT_REFUSED, "'arrays' has the size 3", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array.size = sizeof array + 1;
  SAYS(PLIANT_REFUSED, "no multiple of its alignment", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  array.position_count = (size_t)-1;
  SAYS(PLIANT_REFUSED, "position_count", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  array.element_count = (size_t)-1 / 2;
  SAYS(PLIANT_REFUSED, "element_count", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  array.corners = 5;
  SAYS(PLIANT_REFUSED, "5 corners", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  array.position_count = 8;
  SAYS(PLIANT_REFUSED, "/mesh", pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  array.corners = 0;
  array.element_count = 0;
  SAYS(PLIANT_REFUSED, "array sheet has points alone, but triangles are needed here; give it with triangles",
       pliant_scene_add_object(scene, json, &array, 1, NULL));
  array = sheet_array();
  floats[4] = NAN;
  array.positions = floats;
  SAYS(PLIANT_REFUSED, "vertex 1 is not finite", pliant_scene_add_object(scene, json, &array, 1, NULL));
  floats[4] = 0;
  OK(pliant_world_free(world));
  OK(pliant_scene_free(scene));
}

void test_misuse(void) {
  test_null();
  test_far_places();
  test_values();
}

/* Handles that were freed, were never handles, or are of another kind; ids that were removed, never were, or are of
 * another kind. */
void test_stale(void) {
  const pliant_id mesh = {PLIANT_MESH_COLLIDER, 0, 0}, no_such = {PLIANT_COLLIDER, -5, 2}, no_kind = {7, 0, 0};
  pliant_id old = object_at(0);
  pliant_world *freed = sheet_world(), *world;
  pliant_scene* scene = empty_scene();
  pliant_state* state = NULL;
  pliant_writer* writer = NULL;
  void* memory = malloc(64);
  size_t count = 0;
  OK(pliant_state_copy(freed, &state));
  OK(pliant_writer_open(freed, "never.obj", &writer));
  OK(pliant_world_free(freed));
  world = sheet_world(); /* in the slot of the one that was freed */
  CHECK(world != freed);
  SAYS(PLIANT_STALE, "'world' refers to nothing; it was freed", pliant_world_free(freed));
  SAYS(PLIANT_NULL, "'world' is a null pointer", pliant_world_step(NULL, 0));
  SAYS(PLIANT_STALE, "'world' is a handle of another kind", pliant_world_step((pliant_world*)(void*)scene, 0));
  SAYS(PLIANT_NULL, "'scene' is a null pointer", pliant_scene_set(NULL, "/gravity", "[0, 0, 0]"));
  with_world(freed, PLIANT_STALE);
  with_world((pliant_world*)memory, PLIANT_STALE);
  with_world((pliant_world*)(void*)scene, PLIANT_STALE);
  with_object(freed, old, PLIANT_STALE);
  with_collider(freed, no_such, mesh, PLIANT_STALE);
  OK(pliant_scene_free(scene));
  with_scene(scene, PLIANT_STALE);
  GIVES(PLIANT_STALE, pliant_scene_free(scene));
  OK(pliant_state_free(state));
  GIVES(PLIANT_STALE, pliant_state_free(state));
  GIVES(PLIANT_STALE, pliant_state_hash(state, NULL, 0, &count));
  GIVES(PLIANT_STALE, pliant_state_bytes(state, NULL, 0, &count));
  GIVES(PLIANT_STALE, pliant_state_restore(world, state));
  GIVES(PLIANT_STALE, pliant_writer_add(writer, freed));
  OK(pliant_writer_free(writer));
  GIVES(PLIANT_STALE, pliant_writer_finish(writer));
  GIVES(PLIANT_STALE, pliant_writer_free(writer));

  OK(pliant_world_remove(world, old));
  with_object(world, old, PLIANT_STALE);
  with_collider(world, no_such, mesh, PLIANT_STALE);
  with_object(world, no_kind, PLIANT_REFUSED);
  with_object(world, mesh, PLIANT_REFUSED);
  SAYS(PLIANT_REFUSED, "that of a mesh collider; pass that of an object", pliant_object_teleport(world, mesh, &pose));
  GIVES(PLIANT_REFUSED, pliant_world_remove(world, no_kind));
  OK(pliant_world_free(world));
  free(memory);
}

/* The library and scenes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static const char* cloth =
    "{\"name\": \"flag\", \"cloth\": {\"mesh\": {\"array\": \"sheet\"}}, \"pins\": [{\"particles\": [0]}]}";

void test_library(void) {
  size_t length = 0;
  char small[8], *text;
  pliant_error_parts parts;
  CHECK(strcmp(pliant_version(), "0.") > 0);
  CHECK(strcmp(pliant_status_name(PLIANT_STALE), "PLIANT_STALE") == 0);
  CHECK(strcmp(pliant_status_name(77), "unknown status") == 0);
  CHECK(strcmp(pliant_last_error(), "") == 0);

  OK(pliant_schema(NULL, 0, &length));
  CHECK(length > 10000);
  text = malloc(length + 1);
  GIVES(PLIANT_TOO_SMALL, pliant_schema(text, length, NULL));
  OK(pliant_schema(text, length + 1, &length));
  CHECK(strlen(text) == length && strstr(text, "\"$schema\"") != NULL);
  free(text);

  strcpy(small, "before");
  length = 0;
  SAYS(PLIANT_TOO_SMALL, "memory for 8", pliant_materials(small, sizeof small, &length));
  CHECK(length > 100 && strcmp(small, "before") == 0);
  text = malloc(length + 1);
  OK(pliant_materials(text, length + 1, NULL));
  CHECK(strstr(text, "\"fabrics\": [{\"name\": \"cotton\", \"source\": ") != NULL);
  CHECK(strstr(text, "\"name\": \"steel wire\"") != NULL && strstr(text, "\"name\": \"water\"") != NULL);
  free(text);

  parts.size = sizeof parts;
  OK(pliant_last_error_parts(&parts));
  CHECK(parts.status == PLIANT_TOO_SMALL && strcmp(parts.advice, "give more memory") == 0);
}

static void test_reading(void) {
  pliant_scene* scene = NULL;
  pliant_error_parts parts;
  SAYS(PLIANT_REFUSED, "/objects/0/cloht", pliant_scene_parse("{\"objects\": [\n{\"cloht\": {}}]}", NULL, &scene));
  CHECK(scene == NULL);
  parts.size = sizeof parts;
  OK(pliant_last_error_parts(&parts));
  CHECK(parts.status == PLIANT_REFUSED && parts.line == 2 && parts.column == 2);
  CHECK(strcmp(parts.file, "scene") == 0 && strcmp(parts.element, "/objects/0/cloht") == 0);
  CHECK(strstr(parts.problem, "unknown") != NULL && strstr(parts.advice, "'cloth'") != NULL);
  SAYS(PLIANT_REFUSED, "no_such.json: the file does not exist", pliant_scene_read("no_such.json", NULL, &scene));
}

static void test_options(void) {
  const pliant_array array = sheet_array();
  const pliant_value values[] = {
      {"/frames", "7"}, {"/objects/0/cloth/material", "silk"}, {"/colliders/-", "{\"plane\": {}}"}};
  pliant_scene_options options;
  pliant_scene_info info;
  pliant_scene* scene = NULL;
  char text[1000];
  memset(&options, 0, sizeof options);
  options.size = sizeof options;
  options.name = "mine";
  options.arrays = &array;
  options.array_count = 1;
  options.values = values;
  options.value_count = 3;
  OK(pliant_scene_parse("{\"objects\": [{\"cloth\": {\"mesh\": {\"array\": \"sheet\"}}}]}", &options, &scene));
  info.size = sizeof info;
  OK(pliant_scene_get_info(scene, &info));
  CHECK(info.frames == 7 && info.objects == 1 && info.particles == 9 && info.colliders == 1 &&
        info.mesh_colliders == 0);
  CHECK(is_near(info.frame_time, 1.0 / 60, 1e-7));
  OK(pliant_scene_describe(scene, text, sizeof text, NULL));
  CHECK(strstr(text, "9 particles") != NULL);
  OK(pliant_scene_free(scene));
  SAYS(PLIANT_REFUSED, "mine:1:", pliant_scene_parse("[]", &options, &scene));
}

/* What is added is as if the file had it: the same bits, also after another member is set and all is read again. */
static void test_adding(void) {
  const pliant_array array = sheet_array();
  pliant_array other = array;
  pliant_scene *scene = empty_scene(), *copy = NULL;
  pliant_id id = {9, 9, 9};
  char first[65] = "1", second[65] = "2";
  pliant_world* world;
  OK(pliant_scene_add_object(scene, cloth, &array, 1, &id));
  CHECK(id.kind == PLIANT_OBJECT && id.slot == 0 && id.generation == 0);
  OK(pliant_scene_add_collider(scene, "{\"name\": \"ground\", \"plane\": {}, \"position\": [0, -0.1, 0]}", NULL, 0,
                               &id));
  CHECK(id.kind == PLIANT_COLLIDER && id.slot == 0);
  OK(pliant_scene_add_collider(scene, "{\"mesh\": {\"array\": \"sheet\", \"translate\": [0, -1, 0]}}", &array, 1, &id));
  CHECK(id.kind == PLIANT_MESH_COLLIDER && id.slot == 0);
  other.position_count = 8;
  SAYS(PLIANT_REFUSED, "'sheet' is taken", pliant_scene_add_object(scene, cloth, &other, 1, NULL));
  other.name = "small";
  GIVES(PLIANT_REFUSED,
        pliant_scene_add_object(scene, "{\"cloth\": {\"mesh\": {\"array\": \"small\"}}}", &other, 1, NULL));

  OK(pliant_scene_set(scene, "/gravity", "[0, -5, 0]"));
  OK(pliant_scene_copy(scene, &copy));
  SAYS(PLIANT_REFUSED, "/settings/substeps", pliant_scene_set(scene, "/settings/substeps", "-3"));
  world = world_of(scene);
  OK(pliant_world_run(world, 5, NULL));
  hash_of(world, first);
  OK(pliant_world_free(world));
  OK(pliant_scene_set(copy, "/frames", "3"));
  world = world_of(copy);
  OK(pliant_world_run(world, 5, NULL));
  hash_of(world, second);
  OK(pliant_world_free(world));
  CHECK(strcmp(first, second) == 0);
}

static void test_listing(void) {
  const pliant_array array = sheet_array();
  pliant_scene *scene = empty_scene(), *again = NULL;
  pliant_scene_info info;
  size_t length = 0;
  char *text, *same;
  OK(pliant_scene_add_object(scene, cloth, &array, 1, NULL));
  OK(pliant_scene_json(scene, NULL, 0, &length));
  text = malloc(length + 1);
  same = malloc(length + 1);
  OK(pliant_scene_json(scene, text, length + 1, NULL));
  OK(pliant_scene_from_json(text, &again));
  OK(pliant_scene_json(again, same, length + 1, NULL));
  CHECK(strcmp(text, same) == 0);
  SAYS(PLIANT_REFUSED, "has no members to set", pliant_scene_set(again, "/frames", "3"));
  OK(pliant_scene_add_object(again, cloth, &array, 1, NULL));
  info.size = sizeof info;
  OK(pliant_scene_get_info(again, &info));
  CHECK(info.objects == 2 && info.particles == 18);
  free(text);
  free(same);
  OK(pliant_scene_free(scene));
  OK(pliant_scene_free(again));
}

static void test_checking(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  pliant_finding finding;
  size_t findings = 99, grave = 99;
  OK(pliant_scene_add_object(scene, cloth, &array, 1, NULL));
  OK(pliant_scene_check(scene, &findings, &grave));
  CHECK(grave == 0);
  OK(pliant_scene_add_object(
      scene,
      "{\"particles\": {\"positions\": [[0, 0, 0], [0, 0, 0]], \"masses\": 1, \"constraints\": [{\"type\":"
      " \"distance\", \"particles\": [[0, 0]]}]}}",
      NULL, 0, NULL));
  finding.size = sizeof finding;
  GIVES(PLIANT_NOT_FOUND, pliant_scene_get_finding(scene, 0, &finding));
  OK(pliant_scene_check(scene, &findings, &grave));
  if (CHECK(findings > 0 && grave > 0)) {
    OK(pliant_scene_get_finding(scene, 0, &finding));
    CHECK(strlen(finding.message) > 0 && finding.advice != NULL);
  }
  GIVES(PLIANT_NOT_FOUND, pliant_scene_get_finding(scene, findings, &finding));
  OK(pliant_scene_free(scene));
}

/* Twice the weight of each particle upwards. */
static void lift(void* user, const char* object, const float* positions, const float* velocities, const float* masses,
                 size_t count, double time, float* forces) {
  ++*(int*)user;
  CHECK(strcmp(object, "flag") == 0 && count == 9 && time >= 0 && positions != NULL && velocities != NULL);
  for (size_t i = 0; i < count; ++i) forces[3 * i + 1] = i == 0 ? 0 : masses[i] * 3;
}

static void test_force(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  int calls = 0;
  float velocities[27];
  size_t length = 0;
  pliant_world* world;
  OK(pliant_scene_add_object(scene, "{\"name\": \"flag\", \"cloth\": {\"mesh\": {\"array\": \"sheet\"}}}", &array, 1,
                             NULL));
  OK(pliant_scene_add_force(scene, lift, &calls));
  SAYS(PLIANT_REFUSED, "force fields", pliant_scene_json(scene, NULL, 0, &length));
  OK(pliant_scene_set(scene, "/frames", "5"));
  world = world_of(scene);
  OK(pliant_world_step(world, 0.1f));
  CHECK(calls == 2);
  OK(pliant_object_velocities(world, object_at(0), velocities, 9));
  CHECK(is_near(velocities[3 * 8 + 1], 0.3, 1e-5));
  SAYS(PLIANT_REFUSED, "force field", pliant_world_bytes(world, NULL, 0, &length));
  OK(pliant_world_free(world));
}

static void burst(void* user, const char* object, const float* positions, const float* velocities, const float* masses,
                  size_t count, double time, float* forces) {
  const float* strength = user;
  if (object != NULL && positions != velocities && masses != NULL && count > 3 && time >= 0) forces[10] = *strength;
}

static void test_not_finite(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  char text[400];
  float strength = NAN;
  int64_t done = 99;
  int32_t ok = 9;
  OK(pliant_scene_add_object(scene, cloth, &array, 1, NULL));
  OK(pliant_scene_add_force(scene, burst, &strength));
  world = world_of(scene);
  OK(pliant_world_step(world, 0));
  OK(pliant_report_explain(world, text, sizeof text, NULL));
  CHECK(strstr(text, "force field 0 is not finite at particle 3 of object 'flag'") != NULL);
  strength = 3e38f;
  SAYS(PLIANT_NOT_FINITE, "'flag'", pliant_world_run(world, 3, &done));
  CHECK(done == 0);
  OK(pliant_report_ok(world, &ok));
  CHECK(ok == 0);
  OK(pliant_report_explain(world, text, sizeof text, NULL));
  CHECK(strstr(text, "flag") != NULL);
  GIVES(PLIANT_NOT_FINITE, pliant_world_step(world, 0));
  OK(pliant_world_free(world));
}

/* What a force may do to its own World: stop it. */
static pliant_world* own = NULL;

static void meddle(void* user, const char* object, const float* positions, const float* velocities, const float* masses,
                   size_t count, double time, float* forces) {
  char hash[65];
  (void)user, (void)object, (void)positions, (void)velocities, (void)masses, (void)count, (void)time, (void)forces;
  GIVES(PLIANT_BUSY, pliant_world_step(own, 0));
  GIVES(PLIANT_BUSY, pliant_world_remove(own, object_at(0)));
  GIVES(PLIANT_BUSY, pliant_world_hash(own, hash, 65, NULL));
  GIVES(PLIANT_BUSY, pliant_world_free(own));
  OK(pliant_world_stop(own, 1));
}

static void test_meddling(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  pliant_world_info info;
  OK(pliant_scene_add_object(scene, cloth, &array, 1, NULL));
  OK(pliant_scene_add_force(scene, meddle, NULL));
  own = world_of(scene);
  GIVES(PLIANT_STOPPED, pliant_world_step(own, 0));
  info.size = sizeof info;
  OK(pliant_world_get_info(own, &info));
  CHECK(info.frame == 0 && is_near(info.time, 0.5 / 60, 1e-7));
  OK(pliant_world_stop(own, 0));
  GIVES(PLIANT_STOPPED, pliant_world_step(own, 0));
  OK(pliant_world_free(own));
  GIVES(PLIANT_STALE, pliant_world_step(own, 0));
}

void test_scene(void) {
  test_reading();
  test_options();
  test_adding();
  test_listing();
  test_checking();
  test_force();
  test_not_finite();
  test_meddling();
}

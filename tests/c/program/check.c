#include "check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed = 0;

int failures(void) { return failed; }

int check(int holds, const char* what, const char* file, int line) {
  if (!holds) {
    printf("%s:%d: does not hold: %s\n", file, line, what);
    ++failed;
  }
  return holds;
}

int check_status(pliant_status given, pliant_status expected, const char* call, const char* file, int line) {
  if (given != expected) {
    printf("%s:%d: %s instead of %s: %s\n  %s\n", file, line, pliant_status_name(given), pliant_status_name(expected),
           call, pliant_last_error());
    ++failed;
  }
  return given == expected;
}

int check_words(pliant_status given, pliant_status expected, const char* words, const char* call, const char* file,
                int line) {
  if (!check_status(given, expected, call, file, line)) return 0;
  if (strstr(pliant_last_error(), words) != NULL) return 1;
  printf("%s:%d: no '%s' in '%s': %s\n", file, line, words, pliant_last_error(), call);
  ++failed;
  return 0;
}

int is_near(double a, double b, double within) { return fabs(a - b) <= within; }

pliant_scene* empty_scene(void) {
  pliant_scene* scene = NULL;
  OK(pliant_scene_parse("{\"gravity\": [0, 0, 0], \"settings\": {\"substeps\": 2, \"threads\": 1}, \"objects\": []}",
                        NULL, &scene));
  return scene;
}

pliant_world* world_of(pliant_scene* scene) {
  pliant_world* world = NULL;
  OK(pliant_world_create(scene, 1, &world));
  OK(pliant_scene_free(scene));
  return world;
}

pliant_array sheet_array(void) {
  static float positions[27];
  static const int32_t triangles[] = {0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5, 3, 6, 4, 4, 6, 7, 4, 7, 5, 5, 7, 8};
  pliant_array array;
  for (int i = 0; i < 9; ++i) {
    positions[3 * i] = 0.5f * (float)(i % 3);
    positions[3 * i + 1] = 0;
    positions[3 * i + 2] = 0.5f * (float)(i / 3);
  }
  array.size = sizeof array;
  array.name = "sheet";
  array.corners = 3;
  array.positions = positions;
  array.position_count = 9;
  array.elements = triangles;
  array.element_count = 8;
  return array;
}

pliant_world* sheet_world(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  OK(pliant_scene_add_object(
      scene,
      "{\"name\": \"flag\", \"cloth\": {\"mesh\": {\"array\": \"sheet\"}, \"material\": \"cotton\"},"
      " \"pins\": [{\"particles\": [0]}], \"attachments\": [{\"particles\": [8]}]}",
      &array, 1, NULL));
  return world_of(scene);
}

pliant_id object_at(int slot) {
  pliant_id id;
  id.kind = PLIANT_OBJECT;
  id.slot = slot;
  id.generation = 0;
  return id;
}

void hash_of(const pliant_world* world, char into[65]) { OK(pliant_world_hash(world, into, 65, NULL)); }

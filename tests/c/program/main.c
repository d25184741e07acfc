/* hash SCENE FRAMES: prints the hash after so many frames.
 * report SCENE FRAMES: prints the report of the last one as JSON, then its numbers.
 * check FOLDER: calls every function, and prints what does not hold. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

/* A World of a scene after so many frames; NULL if one failed. */
static pliant_world* run(const char* path, const char* frames) {
  pliant_scene* scene = NULL;
  pliant_world* world = NULL;
  if (!OK(pliant_scene_read(path, NULL, &scene))) return NULL;
  world = world_of(scene);
  return OK(pliant_world_run(world, atoi(frames), NULL)) ? world : NULL;
}

static int print_hash(const char* path, const char* frames) {
  pliant_world* world = run(path, frames);
  char hash[65] = "";
  if (world == NULL) return 1;
  hash_of(world, hash);
  OK(pliant_world_free(world));
  printf("%s\n", hash);
  return failures() > 0;
}

static int print_report(const char* path, const char* frames) {
  pliant_world* world = run(path, frames);
  static char text[1 << 16];
  if (world == NULL || !OK(pliant_report_json(world, text, sizeof text, NULL))) return 1;
  printf("%s\n", text);
  for (size_t i = 0; pliant_report_number_name(i) != NULL; ++i) {
    double value = 0;
    OK(pliant_report_number(world, pliant_report_number_name(i), &value));
    printf("%s %.17g\n", pliant_report_number_name(i), value);
  }
  OK(pliant_world_free(world));
  return failures() > 0;
}

static int check_all(const char* folder) {
  test_library();
  test_scene();
  test_world(folder);
  test_contents();
  test_objects();
  test_bodies();
  test_colliders();
  test_states();
  test_reports();
  test_files(folder);
  test_misuse();
  test_stale();
  printf("%d checks failed\n", failures());
  return failures() > 0;
}

int main(int count, char** words) {
  if (count == 4 && strcmp(words[1], "hash") == 0) return print_hash(words[2], words[3]);
  if (count == 4 && strcmp(words[1], "report") == 0) return print_report(words[2], words[3]);
  if (count == 3 && strcmp(words[1], "check") == 0) return check_all(words[2]);
  return 2;
}

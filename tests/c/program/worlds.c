/* Worlds, their contents, states, reports and files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static char text[1 << 16];
static char bytes[1 << 18];

static const char* path_in(const char* folder, const char* name) {
  static char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void test_saving(const char* folder) {
  pliant_world *world = sheet_world(), *loaded = NULL, *copied = NULL;
  char hash[65] = "1", of_loaded[65] = "2", of_copied[65] = "3";
  size_t count = 0;
  OK(pliant_world_run(world, 3, NULL));
  OK(pliant_world_save(world, path_in(folder, "c.world")));
  OK(pliant_world_load(path_in(folder, "c.world"), &loaded));
  OK(pliant_world_bytes(world, NULL, 0, &count));
  if (CHECK(count > 1000 && count <= sizeof bytes)) {
    GIVES(PLIANT_TOO_SMALL, pliant_world_bytes(world, bytes, count - 1, NULL));
    OK(pliant_world_bytes(world, bytes, sizeof bytes, &count));
    OK(pliant_world_from_bytes(bytes, count, &copied));
    OK(pliant_world_run(world, 3, NULL));
    OK(pliant_world_run(loaded, 3, NULL));
    OK(pliant_world_run(copied, 3, NULL));
    hash_of(world, hash);
    hash_of(loaded, of_loaded);
    hash_of(copied, of_copied);
    CHECK(strcmp(hash, of_loaded) == 0 && strcmp(hash, of_copied) == 0);
    bytes[count / 2] ^= 1;
    SAYS(PLIANT_REFUSED, "bytes", pliant_world_from_bytes(bytes, count, &copied));
  }
  SAYS(PLIANT_REFUSED, "no.world", pliant_world_load(path_in(folder, "no.world"), &loaded));
  OK(pliant_world_free(world));
  OK(pliant_world_free(loaded));
  OK(pliant_world_free(copied));
}

static void test_stopping(void) {
  pliant_world* world = sheet_world();
  int64_t done = 99;
  int32_t ok = 0;
  pliant_state* state = NULL;
  OK(pliant_world_stop(world, 1));
  GIVES(PLIANT_STOPPED, pliant_world_run(world, 4, &done));
  CHECK(done == 0);
  OK(pliant_world_stop(world, 0));
  OK(pliant_world_run(world, 4, &done));
  CHECK(done == 4);

  OK(pliant_state_copy(world, &state));
  SAYS(PLIANT_REFUSED, "nothing moved", pliant_world_step(world, NAN));
  GIVES(PLIANT_REFUSED, pliant_world_step(world, -1));
  OK(pliant_state_restore(world, state));
  OK(pliant_world_step(world, 0));
  OK(pliant_report_ok(world, &ok));
  CHECK(ok == 1);
  OK(pliant_state_free(state));
  OK(pliant_world_free(world));
}

void test_world(const char* folder) {
  pliant_world* world = sheet_world();
  pliant_world_info info;
  pliant_scene* scene = NULL;
  pliant_scene_info contents;
  double energy = -1, stretch = 0;
  size_t length = 0;
  info.size = sizeof info;
  OK(pliant_world_step(world, 0));
  OK(pliant_world_get_info(world, &info));
  CHECK(info.frame == 1 && is_near(info.time, 1.0 / 60, 1e-7) && info.objects == 1 && info.threads == 1 &&
        info.frames == 120);
  OK(pliant_world_describe(world, text, sizeof text, &length));
  CHECK(strlen(text) == length && strstr(text, "flag") != NULL);
  OK(pliant_world_measure(world, "kinetic_energy", &energy));
  OK(pliant_world_measure(world, "stretch.largest", &stretch));
  CHECK(energy == 0 && is_near(stretch, 1, 1e-6));
  SAYS(PLIANT_NOT_FOUND, "no measure 'size'", pliant_world_measure(world, "size", &energy));
  OK(pliant_world_scene(world, &scene));
  contents.size = sizeof contents;
  OK(pliant_scene_get_info(scene, &contents));
  CHECK(contents.particles == 9 && contents.frames == 120);
  OK(pliant_scene_free(scene));
  OK(pliant_world_free(world));
  test_saving(folder);
  test_stopping();
}

/* A ball of cloth's sheet falls on the ground, which is a collider that was added late. */
static void test_contacts(pliant_world* world, pliant_id ground) {
  pliant_contact contacts[8];
  size_t count = 0;
  double all = 0;
  float down[27];
  for (int i = 0; i < 27; ++i) down[i] = i % 3 == 1 ? -1 : 0;
  SAYS(PLIANT_REFUSED, "call pliant_world_record_contacts", pliant_world_contacts(world, contacts, 8, &count));
  OK(pliant_world_record_contacts(world, 1));
  OK(pliant_object_set_velocities(world, object_at(0), down, 9));
  OK(pliant_world_run(world, 3, NULL));
  OK(pliant_world_contacts(world, contacts, 8, &count));
  if (CHECK(count == 1)) {
    CHECK(contacts[0].first.kind == PLIANT_OBJECT && contacts[0].first.slot == 0 && contacts[0].contacts > 0);
    CHECK(memcmp(&contacts[0].second, &ground, sizeof ground) == 0);
    CHECK(is_near(contacts[0].normal[1], 1, 1e-6));
  }
  OK(pliant_report_number(world, "contacts", &all));
  CHECK(all > 0);
  OK(pliant_world_record_contacts(world, 0));
}

void test_contents(void) {
  const pliant_array array = sheet_array();
  pliant_world* world = sheet_world();
  pliant_id ground, second, third, found, ids[4];
  size_t count = 0;
  OK(pliant_world_find(world, PLIANT_OBJECT, "flag", &found));
  CHECK(found.kind == PLIANT_OBJECT && found.slot == 0 && found.generation == 0);
  SAYS(PLIANT_NOT_FOUND, "no mesh collider 'flag'; it is an object",
       pliant_world_find(world, PLIANT_MESH_COLLIDER, "flag", &found));
  OK(pliant_world_add_collider(world, "{\"name\": \"ground\", \"plane\": {}, \"position\": [0, -0.01, 0]}", NULL, 0,
                               &ground));
  test_contacts(world, ground);
  OK(pliant_world_add_object(
      world, "{\"name\": \"kite\", \"cloth\": {\"mesh\": {\"array\": \"sheet\", \"translate\": [0, 3, 0]}}}", &array, 1,
      &second));
  OK(pliant_world_ids(world, PLIANT_OBJECT, ids, 4, &count));
  CHECK(count == 2 && memcmp(&ids[1], &second, sizeof second) == 0);
  GIVES(PLIANT_TOO_SMALL, pliant_world_ids(world, PLIANT_OBJECT, ids, 1, &count));
  OK(pliant_world_name(world, second, text, sizeof text, NULL));
  CHECK(strcmp(text, "kite") == 0);
  OK(pliant_world_name(world, ground, text, sizeof text, NULL));
  CHECK(strcmp(text, "ground") == 0);

  OK(pliant_world_remove(world, second));
  SAYS(PLIANT_STALE, "no object 1 of generation 0", pliant_world_remove(world, second));
  OK(pliant_world_add_object(world, "{\"cloth\": {\"mesh\": {\"array\": \"sheet\", \"translate\": [0, 3, 0]}}}", &array,
                             1, &third));
  CHECK(third.slot == second.slot && third.generation == second.generation + 1);
  OK(pliant_world_remove(world, ground));
  GIVES(PLIANT_STALE, pliant_world_name(world, ground, text, sizeof text, NULL));
  OK(pliant_world_free(world));
}

void test_states(void) {
  pliant_world* world = sheet_world();
  pliant_state *state = NULL, *copy = NULL;
  char first[65] = "1", again[65] = "2";
  size_t count = 0;
  OK(pliant_state_copy(world, &state));
  OK(pliant_state_hash(state, again, sizeof again, NULL));
  hash_of(world, first);
  CHECK(strcmp(first, again) == 0);
  OK(pliant_state_bytes(state, bytes, sizeof bytes, &count));
  OK(pliant_state_from_bytes(bytes, count, &copy));
  OK(pliant_world_run(world, 4, NULL));
  hash_of(world, first);
  OK(pliant_state_restore(world, copy));
  OK(pliant_world_run(world, 4, NULL));
  hash_of(world, again);
  CHECK(strcmp(first, again) == 0);
  OK(pliant_world_remove(world, object_at(0)));
  GIVES(PLIANT_REFUSED, pliant_state_restore(world, state));
  OK(pliant_state_free(state));
  OK(pliant_state_free(copy));
  OK(pliant_world_free(world));
}

void test_reports(void) {
  pliant_world* world = sheet_world();
  double frame = 0;
  size_t length = 0;
  OK(pliant_world_run(world, 2, NULL));
  OK(pliant_report_number(world, "frame", &frame));
  CHECK(frame == 2 && strcmp(pliant_report_number_name(0), "frame") == 0);
  CHECK(pliant_report_number_name(1000) == NULL);
  SAYS(PLIANT_NOT_FOUND, "no number 'pair'", pliant_report_number(world, "pair", &frame));
  OK(pliant_report_json(world, text, sizeof text, &length));
  CHECK(strlen(text) == length && strstr(text, "\"frame\":2") != NULL);
  OK(pliant_report_explain(world, text, sizeof text, &length));
  CHECK(length == 0 && text[0] == 0);
  OK(pliant_report_advice(world, text, sizeof text, &length));
  CHECK(length == 0);
  OK(pliant_world_free(world));
}

/* Files of a writer in memory, their number, and what it does beside keeping them. */
struct kept {
  char path[64];
  char bytes[16384];
  size_t count;
  int files;
  pliant_status gives;      /* what the sink returns */
  pliant_writer* reentered; /* the writer to be called from its own sink, or null */
  const pliant_world* world;
};

static pliant_status keep(void* user, const char* path, const void* bytes, size_t count) {
  struct kept* into = (struct kept*)user;
  if (into->reentered != NULL) {
    SAYS(PLIANT_BUSY, "to its sink", pliant_writer_add(into->reentered, into->world));
    GIVES(PLIANT_BUSY, pliant_writer_finish(into->reentered));
  }
  into->count = 0;
  ++into->files;
  if (!CHECK(strlen(path) < sizeof into->path && count <= sizeof into->bytes)) return PLIANT_TOO_SMALL;
  strcpy(into->path, path);
  memcpy(into->bytes, bytes, count);
  into->count = count;
  return into->gives;
}

/* The bytes of the file "c.glb" that test_files wrote of the same frames. */
static void test_sink(const char* folder) {
  static struct kept kept;
  static char from_disk[16384];
  pliant_world* world = sheet_world();
  pliant_writer* writer = NULL;
  FILE* file = fopen(path_in(folder, "c.glb"), "rb");
  OK(pliant_writer_open_sink(world, "c.glb", keep, &kept, &writer));
  for (int i = 0; i < 3; ++i) {
    OK(pliant_writer_add(writer, world));
    OK(pliant_world_step(world, 0));
  }
  CHECK(kept.files == 0);
  OK(pliant_writer_finish(writer));
  OK(pliant_writer_free(writer));
  CHECK(kept.files == 1 && strcmp(kept.path, "c.glb") == 0 && fopen("c.glb", "rb") == NULL);
  if (CHECK(file != NULL)) {
    CHECK(fread(from_disk, 1, sizeof from_disk, file) == kept.count && memcmp(from_disk, kept.bytes, kept.count) == 0);
    fclose(file);
  }
  kept.gives = PLIANT_NO_MEMORY;
  OK(pliant_writer_open_sink(world, "run.obj", keep, &kept, &writer));
  kept.reentered = writer;
  kept.world = world;
  SAYS(PLIANT_NO_MEMORY, "did not take the file 'run_0003.obj'; it returned 8", pliant_writer_add(writer, world));
  CHECK(kept.files == 2 && memcmp(kept.bytes, "# time ", 7) == 0);
  kept.gives = PLIANT_OK;
  OK(pliant_writer_free(writer));
  writer = NULL;
  SAYS(PLIANT_NULL, "'sink' is a null pointer", pliant_writer_open_sink(world, "run.obj", NULL, NULL, &writer));
  SAYS(PLIANT_REFUSED, "'.gif' is not a geometry format",
       pliant_writer_open_sink(world, "run.gif", keep, &kept, &writer));
  GIVES(PLIANT_NULL, pliant_writer_open_sink(world, NULL, keep, &kept, &writer));
  CHECK(writer == NULL);
  OK(pliant_world_free(world));
}

/* Paths in what is added to a World are relative to the folder of its scene. */
static void test_folder(const char* folder) {
  pliant_scene_options options;
  pliant_scene* scene = NULL;
  pliant_world* world = NULL;
  pliant_id id;
  FILE* file = fopen(path_in(folder, "piece.obj"), "w");
  memset(&options, 0, sizeof options);
  options.size = sizeof options;
  options.folder = folder;
  if (!CHECK(file != NULL)) return;
  fputs("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n", file);
  fclose(file);
  OK(pliant_scene_parse("{\"objects\": []}", &options, &scene));
  world = world_of(scene);
  OK(pliant_world_add_object(world, "{\"name\": \"a\", \"cloth\": {\"mesh\": {\"file\": \"piece.obj\"}}}", NULL, 0,
                             &id));
  OK(pliant_world_add_collider(world, "{\"mesh\": {\"file\": \"piece.obj\"}, \"position\": [0, -1, 0]}", NULL, 0, &id));
  OK(pliant_world_free(world));
}

void test_files(const char* folder) {
  const pliant_array array = sheet_array();
  pliant_world* world = sheet_world();
  pliant_world* other = sheet_world();
  pliant_writer *writer = NULL, *dropped = NULL;
  FILE* file;
  SAYS(PLIANT_REFUSED, ".txt", pliant_writer_open(world, path_in(folder, "c.txt"), &writer));
  OK(pliant_writer_open(world, path_in(folder, "c.glb"), &writer));
  for (int i = 0; i < 3; ++i) {
    OK(pliant_writer_add(writer, world));
    OK(pliant_world_step(world, 0));
  }
  OK(pliant_world_remove(other, object_at(0)));
  SAYS(PLIANT_REFUSED, "another World", pliant_writer_add(writer, other));
  OK(pliant_world_free(other));
  OK(pliant_writer_finish(writer));
  SAYS(PLIANT_REFUSED, "finished", pliant_writer_add(writer, world));
  OK(pliant_writer_free(writer));
  file = fopen(path_in(folder, "c.glb"), "rb");
  if (CHECK(file != NULL)) {
    CHECK(fread(text, 1, 4, file) == 4 && memcmp(text, "glTF", 4) == 0);
    fclose(file);
  }
  test_sink(folder);
  test_folder(folder);
  /* The ids of what was added later are not those of a scene. */
  OK(pliant_world_add_object(world, "{\"name\": \"late\", \"cloth\": {\"mesh\": {\"array\": \"sheet\"}}}", &array, 1,
                             NULL));
  OK(pliant_world_remove(world, object_at(0)));
  OK(pliant_writer_open(world, path_in(folder, "never.glb"), &dropped));
  OK(pliant_writer_add(dropped, world));
  OK(pliant_writer_free(dropped));
  CHECK(fopen(path_in(folder, "never.glb"), "rb") == NULL);
  OK(pliant_world_free(world));
}

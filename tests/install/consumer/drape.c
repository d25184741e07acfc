// The example of docs/guide/c.md (tests/docs).
#include <pliant_c.h>
#include <stdio.h>
#include <stdlib.h>

enum { side = 41, points = side * side, cells = (side - 1) * (side - 1) };

static float positions[3 * points];       // x, y, z of each point [m]
static int32_t triangles[3 * 2 * cells];  // three points each

static void must(pliant_status status) {
  if (status == PLIANT_OK) return;
  fprintf(stderr, "%s\n", pliant_last_error());
  exit(1);
}

// A square of 0.8 m, 0.9 m above the ground.
static void make_sheet(void) {
  int32_t* t = triangles;
  for (int i = 0; i < points; ++i) {
    positions[3 * i] = 0.02f * (float)(i % side) - 0.4f;
    positions[3 * i + 1] = 0.9f;
    positions[3 * i + 2] = 0.02f * (float)(i / side) - 0.4f;
    if (i % side == side - 1 || i / side == side - 1) continue;
    *t++ = i, *t++ = i + side, *t++ = i + 1;
    *t++ = i + 1, *t++ = i + side, *t++ = i + side + 1;
  }
}

int main(void) {
  pliant_scene* scene = NULL;
  pliant_world* world = NULL;
  pliant_writer* file = NULL;
  pliant_id cloth;
  float lowest = 1;

  make_sheet();
  const pliant_array sheet = {sizeof sheet, "sheet", 3, positions, points, triangles, 2 * cells};
  must(pliant_scene_parse("{\"objects\": []}", NULL, &scene));
  must(pliant_scene_add_object(scene,
                               "{\"name\": \"scarf\", \"self_collision\": true,"
                               " \"cloth\": {\"mesh\": {\"array\": \"sheet\"}, \"material\": \"silk\"}}",
                               &sheet, 1, &cloth));
  must(pliant_scene_add_collider(scene, "{\"plane\": {}}", NULL, 0, NULL));
  must(pliant_scene_add_collider(scene, "{\"sphere\": {\"radius\": 0.3}, \"position\": [0, 0.5, 0]}", NULL, 0, NULL));

  must(pliant_world_create(scene, 0, &world));
  must(pliant_writer_open(world, "draped.glb", &file));
  for (int frame = 0; frame < 120; ++frame) {
    must(pliant_world_step(world, 0));
    must(pliant_writer_add(file, world));
  }
  must(pliant_writer_finish(file));

  must(pliant_object_positions(world, cloth, positions, points));
  for (int i = 0; i < points; ++i)
    if (positions[3 * i + 1] < lowest) lowest = positions[3 * i + 1];
  printf("the scarf hangs down to %.3f m; its frames are in draped.glb\n", lowest);

  must(pliant_writer_free(file));
  must(pliant_world_free(world));
  must(pliant_scene_free(scene));
  return 0;
}

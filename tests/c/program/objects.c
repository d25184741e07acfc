/* Objects, bodies, joints and colliders. */
#include <string.h>

#include "check.h"

static void test_reading(pliant_world* world) {
  pliant_object_info info;
  float positions[27], mesh[27], none[1];
  int32_t triangles[24], of_mesh[24], present[9];
  size_t count = 0, more = 0;
  info.size = sizeof info;
  OK(pliant_object_get_info(world, object_at(0), &info));
  CHECK(info.particles == 9 && info.triangles == 8 && info.bodies == 0 && info.attachments == 1 && info.substeps == 2);
  CHECK(info.constraints > 0 && info.is_flow == 0);
  OK(pliant_object_positions(world, object_at(0), positions, 9));
  CHECK(positions[3 * 5] == 1 && positions[3 * 5 + 1] == 0 && positions[3 * 5 + 2] == 0.5f);
  OK(pliant_object_triangles(world, object_at(0), triangles, 8, &count));
  CHECK(count == 8 && triangles[0] == 0 && triangles[1] == 3 && triangles[23] == 8);
  GIVES(PLIANT_TOO_SMALL, pliant_object_triangles(world, object_at(0), triangles, 7, &count));
  OK(pliant_object_mesh(world, object_at(0), NULL, 0, &count, NULL, 0, &more));
  CHECK(count == 9 && more == 8);
  OK(pliant_object_mesh(world, object_at(0), mesh, 9, &count, of_mesh, 8, &more));
  CHECK(memcmp(mesh, positions, sizeof mesh) == 0 && memcmp(of_mesh, triangles, sizeof of_mesh) == 0);
  memset(mesh, 0, sizeof mesh);
  GIVES(PLIANT_TOO_SMALL, pliant_object_mesh(world, object_at(0), mesh, 9, &count, of_mesh, 7, &more));
  CHECK(mesh[3 * 8] == 0);
  OK(pliant_object_present(world, object_at(0), present, 9, &count));
  CHECK(count == 9 && present[8] == 8);
  OK(pliant_object_channel(world, object_at(0), "temperature", none, 1, &count));
  CHECK(count == 0);
}

/* An impulse of 1 mN s on each particle, which gives its mass; then velocities of 0. */
static void test_pushing(pliant_world* world) {
  float pushes[27], velocities[27];
  double mass, once;
  for (int i = 0; i < 27; ++i) pushes[i] = i % 3 == 0 ? 0.001f : 0;
  OK(pliant_object_add_impulses(world, object_at(0), pushes, 9));
  OK(pliant_object_velocities(world, object_at(0), velocities, 9));
  once = velocities[3 * 4];
  mass = 0.001 / once; /* of the middle: a quarter of the sheet of cotton, which has some 0.1 to 0.3 kg/m^2 */
  CHECK(mass > 0.02 && mass < 0.1);
  CHECK(velocities[0] == 0);
  memset(velocities, 0, sizeof velocities);
  OK(pliant_object_set_velocities(world, object_at(0), velocities, 9));
  OK(pliant_object_velocities(world, object_at(0), velocities, 9));
  CHECK(velocities[3 * 4] == 0);
}

static void test_moving(pliant_world* world) {
  const int32_t pin = 0, attachment = 0;
  const float place[3] = {0, 0.01f, 0}, target[3] = {1, 0.02f, 1};
  float positions[27], before[27], forces[27];
  pliant_pose by = {{0, 5, 0}, {0, 0, 0, 1}};
  memset(forces, 0, sizeof forces);
  OK(pliant_object_set_forces(world, object_at(0), forces, 9));
  OK(pliant_object_set_targets(world, object_at(0), &pin, place, 1));
  OK(pliant_object_set_attachment_targets(world, object_at(0), &attachment, target, 1));
  SAYS(PLIANT_REFUSED, "keyframes", pliant_object_set_rest_factor(world, object_at(0), 0, 1));
  OK(pliant_world_step(world, 0));
  OK(pliant_object_positions(world, object_at(0), positions, 9));
  CHECK(is_near(positions[1], 0.01, 1e-7) && is_near(positions[3 * 8 + 1], 0.02, 1e-4));
  memcpy(before, positions, sizeof before);
  OK(pliant_object_teleport(world, object_at(0), &by));
  OK(pliant_object_positions(world, object_at(0), positions, 9));
  CHECK(is_near(positions[3 * 4 + 1], before[3 * 4 + 1] + 5, 1e-6));
}

/* A link whose one end is pinned becomes half as long. */
static void test_rest_factor(void) {
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  float positions[6];
  OK(pliant_scene_add_object(
      scene,
      "{\"particles\": {\"positions\": [[0, 0, 0], [1, 0, 0]], \"masses\": 1, \"constraints\": [{\"type\": "
      "\"distance\","
      " \"particles\": [[0, 1]], \"keyframes\": [{\"time\": 0, \"factor\": 1}]}]}, \"pins\": [{\"particles\": [0]}]}",
      NULL, 0, NULL));
  world = world_of(scene);
  OK(pliant_object_set_rest_factor(world, object_at(0), 0, 0.5f));
  OK(pliant_world_run(world, 4, NULL));
  OK(pliant_object_positions(world, object_at(0), positions, 2));
  CHECK(is_near(positions[3], 0.5, 1e-3));
  OK(pliant_world_free(world));
}

/* A mass of 1 kg hangs on a thread: its multiplier over the square of the substep is the weight. */
static void test_multipliers(void) {
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  float multipliers[1];
  double h = 1.0 / 120, volume = 9;
  size_t count = 0;
  OK(pliant_scene_add_object(
      scene,
      "{\"particles\": {\"positions\": [[0, 0, 0], [0, -1, 0]], \"masses\": 1, \"constraints\": [{\"type\":"
      " \"distance\", \"particles\": [[0, 1]], \"compliances\": [1e-6]}]}, \"pins\": [{\"particles\": [0]}]}",
      NULL, 0, NULL));
  OK(pliant_scene_set(scene, "/gravity", "[0, -10, 0]"));
  world = world_of(scene);
  OK(pliant_world_run(world, 30, NULL));
  OK(pliant_object_multipliers(world, object_at(0), "distance", multipliers, 1, &count));
  CHECK(count == 1 && is_near(multipliers[0] / (h * h), -10, 0.1));
  GIVES(PLIANT_TOO_SMALL, pliant_object_multipliers(world, object_at(0), "distance", multipliers, 0, &count));
  OK(pliant_object_enclosed_volume(world, object_at(0), &volume));
  CHECK(volume == 0);
  OK(pliant_world_free(world));
}

void test_objects(void) {
  pliant_world* world = sheet_world();
  test_reading(world);
  test_pushing(world);
  test_moving(world);
  test_rest_factor();
  test_multipliers();
  OK(pliant_world_free(world));
}

/* A leaf of 2 kg that hangs on a hinge, and a shelf that a program moves. */
static const char* door =
    "{\"name\": \"door\", \"bodies\": ["
    "{\"name\": \"leaf\", \"solids\": [{\"box\": {\"half_extents\": [0.4, 1, 0.02]}}], \"mass\": 2, \"position\": "
    "[0.4, 1, "
    "0]},"
    "{\"name\": \"shelf\", \"solids\": [{\"box\": {\"half_extents\": [0.4, 0.02, 0.4]}}], \"kinematic\": true, "
    "\"position\": [5, 0, 0]}],"
    "\"joints\": [{\"name\": \"hinge\", \"between\": [\"world\", \"leaf\"], \"hinge\": {\"anchor\": [0, 1, 0], "
    "\"axis\": "
    "[0, 1, 0],"
    " \"motor\": {\"position\": 0, \"most\": 50}}}]}";

/* The hinge bears the leaf's weight, and the leaf has not turned. Frames are those of the leaf, the shelf and the
 * world. */
static void test_joint_state(pliant_world* world) {
  const pliant_id id = object_at(0);
  pliant_joint_state state;
  float force[3] = {9, 9, 9}, torque[3], orientations[12], spins[9];
  size_t count = 0;
  char name[20];
  OK(pliant_object_joint_name(world, id, 0, name, sizeof name, NULL));
  CHECK(strcmp(name, "hinge") == 0);
  OK(pliant_object_body_name(world, id, 1, name, sizeof name, NULL));
  CHECK(strcmp(name, "shelf") == 0);
  SAYS(PLIANT_NOT_FOUND, "no body 3", pliant_object_body_name(world, id, 3, name, sizeof name, NULL));
  SAYS(PLIANT_REFUSED, "not recorded", pliant_object_mean_joint_load(world, id, 0, force, torque));
  CHECK(force[0] == 9);
  OK(pliant_world_record_joint_loads(world, 1));
  OK(pliant_object_mean_joint_load(world, id, 0, force, torque));
  CHECK(force[1] == 0);
  OK(pliant_world_run(world, 10, NULL));
  OK(pliant_object_mean_joint_load(world, id, 0, force, torque));
  /* 2 kg at 10 m/s^2, and their middle is 0.4 m from the anchor. */
  CHECK(is_near(force[1], 20, 0.01) && is_near(force[0], 0, 0.1) && is_near(torque[2], 8, 0.1));
  OK(pliant_object_joint_state(world, id, 0, &state));
  CHECK(is_near(state.rotation[0], 0, 1e-4) && is_near(state.displacement[1], 0, 1e-4) &&
        is_near(state.velocity[1], 0, 1e-3));
  OK(pliant_world_record_joint_loads(world, 0));
  OK(pliant_object_orientations(world, id, orientations, 3, &count));
  CHECK(count == 3 && is_near(orientations[3], 1, 1e-4) && is_near(orientations[7], 1, 1e-6));
  OK(pliant_object_angular_velocities(world, id, spins, 3, &count));
  CHECK(count == 3 && is_near(spins[1], 0, 1e-3));
  GIVES(PLIANT_TOO_SMALL, pliant_object_angular_velocities(world, id, spins, 2, &count));
}

/* Two boxes of 1 and 2 kg, one on the other and on the ground: what each bears is what lies on it. */
static void test_touches(void) {
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  pliant_body_touch touches[4];
  size_t count = 9;
  OK(pliant_scene_add_object(scene,
                             "{\"name\": \"pile\", \"self_collision\": true, \"collides\": true, \"bodies\": ["
                             "{\"solids\": [{\"box\": {\"half_extents\": [0.2, 0.2, 0.2]}}], \"mass\": 1,"
                             " \"position\": [0, 0.2, 0]},"
                             "{\"solids\": [{\"box\": {\"half_extents\": [0.2, 0.2, 0.2]}}], \"mass\": 2,"
                             " \"position\": [0, 0.6, 0]}]}",
                             NULL, 0, NULL));
  OK(pliant_scene_add_collider(scene, "{\"plane\": {}}", NULL, 0, NULL));
  OK(pliant_scene_set(scene, "/gravity", "[0, -10, 0]"));
  world = world_of(scene);
  OK(pliant_world_run(world, 30, NULL));
  SAYS(PLIANT_REFUSED, "contacts are not recorded", pliant_world_body_touches(world, touches, 4, &count));
  OK(pliant_world_record_contacts(world, 1));
  OK(pliant_world_step(world, 0));
  OK(pliant_world_body_touches(world, touches, 4, &count));
  if (CHECK(count == 2)) {
    const pliant_body_touch *boxes = &touches[0], *ground = &touches[1];
    CHECK(boxes->first_body == 0 && boxes->second_body == 1 && boxes->second.kind == PLIANT_OBJECT);
    CHECK(is_near(boxes->push_on_first[1] * 60, -20, 0.4) && is_near(boxes->position[1], 0.4, 0.02));
    CHECK(ground->first_body == 0 && ground->second_body == -1 && ground->second.kind == PLIANT_COLLIDER);
    CHECK(is_near(ground->push_on_first[1] * 60, 30, 0.6) && ground->contacts >= 1 && ground->impulse > 0.4);
  }
  GIVES(PLIANT_TOO_SMALL, pliant_world_body_touches(world, touches, 1, &count));
  OK(pliant_world_free(world));
}

void test_bodies(void) {
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  pliant_pose pose, target = {{5, 0.5f, 0}, {0, 0, 0, 2}};
  const float along[3] = {1, 0, 0};
  pliant_joint_state state;
  float force[3], torque[3];
  int32_t body = -1, joint = -1, asleep = 9, broken = 9;
  OK(pliant_scene_add_object(scene, door, NULL, 0, NULL));
  OK(pliant_scene_set(scene, "/gravity", "[0, -10, 0]"));
  world = world_of(scene);
  OK(pliant_object_find_body(world, object_at(0), "shelf", &body));
  CHECK(body == 1);
  SAYS(PLIANT_NOT_FOUND, "no body 'lid'; it has 3 bodies; pliant_object_body_name",
       pliant_object_find_body(world, object_at(0), "lid", &body));
  OK(pliant_object_find_joint(world, object_at(0), "hinge", &joint));
  CHECK(joint == 0);
  SAYS(PLIANT_NOT_FOUND, "no joint 'lid'", pliant_object_find_joint(world, object_at(0), "lid", &joint));
  OK(pliant_object_set_body_pose(world, object_at(0), 1, &target));
  OK(pliant_object_set_body_surface_velocity(world, object_at(0), 1, along));
  OK(pliant_world_step(world, 0));
  OK(pliant_object_body_pose(world, object_at(0), 1, &pose));
  CHECK(is_near(pose.position[1], 0.5, 1e-6) && is_near(pose.rotation[3], 1, 1e-6));
  OK(pliant_object_joint_load(world, object_at(0), 0, force, torque, &broken));
  CHECK(is_near(force[1], 20, 0.5) && broken == 0);
  test_joint_state(world);
  OK(pliant_object_body_asleep(world, object_at(0), 0, &asleep));
  CHECK(asleep == 0);
  OK(pliant_object_set_motor(world, object_at(0), "hinge", NULL, 1.0f, 0));
  OK(pliant_world_run(world, 120, NULL));
  OK(pliant_object_body_pose(world, object_at(0), 0, &pose));
  CHECK(is_near(pose.position[2], -0.4 * 0.8415, 0.02)); /* sin(1 rad) of the way to its middle */
  OK(pliant_object_joint_state(world, object_at(0), 0, &state));
  CHECK(is_near(state.rotation[0], 1, 1e-3) && is_near(state.angular_velocity[0], 0, 1e-3));
  SAYS(PLIANT_REFUSED, "no motor", pliant_object_set_motor(world, object_at(0), "hinge", "turbine", 1.0f, 0));
  SAYS(PLIANT_NOT_FOUND, "no body 3", pliant_object_body_pose(world, object_at(0), 3, &pose));
  SAYS(PLIANT_NOT_FOUND, "no joint 1; it has 1 joint, counted",
       pliant_object_joint_state(world, object_at(0), 1, &state));
  SAYS(PLIANT_NOT_FOUND, "no joint -1", pliant_object_joint_load(world, object_at(0), -1, force, torque, NULL));
  OK(pliant_world_free(world));
  test_touches();
}

void test_colliders(void) {
  const pliant_array array = sheet_array();
  pliant_scene* scene = empty_scene();
  pliant_world* world;
  pliant_id ball, mesh;
  pliant_pose pose, up = {{0, 1, 0}, {0, 0, 0, 1}};
  const float along[3] = {0, 0, 1}, too_fast[3] = {0, 0, 1e7f};
  float positions[27];
  size_t count = 0;
  OK(pliant_scene_add_collider(scene, "{\"name\": \"ball\", \"sphere\": {\"radius\": 1}, \"position\": [0, 2, 0]}",
                               NULL, 0, &ball));
  OK(pliant_scene_add_collider(scene, "{\"name\": \"mesh\", \"mesh\": {\"array\": \"sheet\"}}", &array, 1, &mesh));
  world = world_of(scene);
  OK(pliant_collider_set_pose(world, ball, &up));
  OK(pliant_collider_set_pose(world, mesh, &up));
  OK(pliant_world_step(world, 0));
  OK(pliant_collider_pose(world, ball, &pose));
  CHECK(is_near(pose.position[1], 1, 1e-6) && pose.rotation[3] == 1);
  OK(pliant_collider_positions(world, mesh, NULL, 0, &count));
  CHECK(count == 9);
  OK(pliant_collider_positions(world, mesh, positions, 9, NULL));
  CHECK(is_near(positions[1], 1, 1e-6) && positions[3 * 8] == 1);
  OK(pliant_collider_teleport(world, ball, &up));
  OK(pliant_collider_pose(world, ball, &pose));
  CHECK(is_near(pose.position[1], 2, 1e-6));
  for (int i = 0; i < 9; ++i) positions[3 * i + 1] = 3;
  OK(pliant_collider_set_positions(world, mesh, positions, 9));
  OK(pliant_collider_set_surface_velocity(world, ball, along));
  OK(pliant_world_step(world, 0));
  OK(pliant_collider_positions(world, mesh, positions, 9, NULL));
  CHECK(is_near(positions[1], 3, 1e-6));
  GIVES(PLIANT_REFUSED, pliant_collider_set_surface_velocity(world, ball, too_fast));
  SAYS(PLIANT_REFUSED, "that of a mesh collider", pliant_collider_pose(world, mesh, &pose));
  SAYS(PLIANT_REFUSED, "that of a primitive collider", pliant_collider_set_positions(world, ball, positions, 9));
  OK(pliant_world_free(world));
}

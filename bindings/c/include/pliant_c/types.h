/* Statuses, structures and handles. Part of pliant_c.h, which users include. */
#ifndef PLIANT_C_TYPES_H
#define PLIANT_C_TYPES_H

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

/* The result of a call. */
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

/* The kinds of things that an id refers to. */
enum { PLIANT_OBJECT = 0, PLIANT_COLLIDER = 1, PLIANT_MESH_COLLIDER = 2 };

/* An object or collider of a World. Those of its scene have generation 0, and as slot their index among those of the
 * same kind. */
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

/* The contacts of a rigid body with another one, a collider or particles in the last step. Friction is not in it; the
 * pressure of liquids is. `push_on_first` divided by the duration of the step is the mean force. */
typedef struct pliant_body_touch {
  pliant_id first;
  int32_t first_body; /* index of a rigid body of `first`; -1: a collider, or particles */
  pliant_id second;
  int32_t second_body;
  int32_t contacts;        /* largest number of active contacts in a substep; can be 0 for a liquid */
  double impulse;          /* sum of the magnitudes of the normal impulses over the frame [N s] */
  float position[3];       /* mean position, weighted by impulse [m] */
  double push_on_first[3]; /* sum of the normal impulses on `first` over the frame [N s] */
} pliant_body_touch;

/* The relative pose and velocity of the two bodies of a joint. Axes are those of the joint, fixed in its
 * first body: x along the axis of a hinge, slider or cylindrical joint (docs/guide/joints.md). All is 0 at time 0. */
typedef struct pliant_joint_state {
  float displacement[3]; /* of the second body's anchor from its place in the first body [m] */
  float rotation[3]; /* of the second body: a vector along its axis, as long as the angle, up to half a turn [rad] */
  float velocity[3]; /* of that anchor, as seen from the first body [m/s] */
  float angular_velocity[3]; /* of the second body against the first [rad/s] */
} pliant_joint_state;

/* An array in memory that a scene, object or collider refers to by {"array": "NAME"}: a mesh of triangles, of
 * tetrahedra, or points. It is copied during the call. In a list of arrays each has the same `size`. */
typedef struct pliant_array {
  size_t size;            /* sizeof(pliant_array) */
  const char* name;       /* what the JSON calls it */
  int32_t corners;        /* of an element: 3 for triangles, 4 for tetrahedra, 0 for points alone */
  const float* positions; /* 3 * position_count floats [m] */
  size_t position_count;  /* number of points */
  const int32_t*
      elements;         /* corners * element_count indices of points; triangles counter-clockwise seen from outside */
  size_t element_count; /* number of triangles or tetrahedra; 0 for points alone */
} pliant_array;

/* A member of a scene to set: a JSON pointer (RFC 6901), and a value in JSON, or text that is no JSON and stands for
 * itself. */
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

/* A finding of pliant_scene_check. The texts are valid until the scene is checked again, changed or freed. */
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
  int64_t frame;     /* number of steps that were not stopped; one that met a value that is not finite counts */
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

/* A force on all particles of an object. Called once for each object and substep, always on the thread that steps.
 * Arrays are valid during the call and have three floats for each of `count` particles, but `masses` one; `forces`
 * is zero at the call. Use no function of libm but sqrt if a run must give the same bits on other machines.
 *   user        what was given to pliant_scene_add_force
 *   object      its name
 *   positions   [m]
 *   velocities  [m/s]
 *   masses      [kg]; infinite for pinned particles, whose force has no effect
 *   time        [s]
 *   forces      to be set [N]; what is not finite is left out, and the report warns */
typedef void (*pliant_force)(void* user, const char* object, const float* positions, const float* velocities,
                             const float* masses, size_t count, double time, float* forces);

#ifdef __cplusplus
}
#endif

#endif

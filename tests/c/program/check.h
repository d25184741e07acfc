/* Checks of a program in C99 that calls every function of the C library. */
#ifndef CHECK_H
#define CHECK_H

#include "pliant_c.h"

/* The condition holds. */
#define CHECK(condition) check((condition) != 0, #condition, __FILE__, __LINE__)
/* The call gives this status. */
#define GIVES(status, call) check_status((call), (status), #call, __FILE__, __LINE__)
#define OK(call) GIVES(PLIANT_OK, call)
/* The call gives this status, and pliant_last_error() holds these words. */
#define SAYS(status, words, call) check_words((call), (status), (words), #call, __FILE__, __LINE__)

int check(int holds, const char* what, const char* file, int line);
int check_status(pliant_status given, pliant_status expected, const char* call, const char* file, int line);
int check_words(pliant_status given, pliant_status expected, const char* words, const char* call, const char* file,
                int line);
/* How many checks have failed. */
int failures(void);

int is_near(double a, double b, double within);

/* A scene without contents and without gravity, two substeps a frame; a World of a scene, which is freed. */
pliant_scene* empty_scene(void);
pliant_world* world_of(pliant_scene* scene);
/* A flat sheet of 3 x 3 points in the plane y = 0, 1 m wide, as the array "sheet"; its memory is static. */
pliant_array sheet_array(void);
/* A World of one such sheet of cotton, "flag", with particle 0 pinned. */
pliant_world* sheet_world(void);
pliant_id object_at(int slot);
void hash_of(const pliant_world* world, char into[65]);

/* The tests; `folder` is where files may be written. */
void test_library(void);
void test_scene(void);
void test_world(const char* folder);
void test_contents(void);
void test_objects(void);
void test_bodies(void);
void test_colliders(void);
void test_states(void);
void test_reports(void);
void test_files(const char* folder);
void test_misuse(void);
void test_stale(void);

#endif

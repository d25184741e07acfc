// The header in C++98.
#include "pliant_c.h"

extern "C" int header_in_cpp98(void);

int header_in_cpp98(void) {
  pliant_world* world = 0;
  const pliant_id id = {PLIANT_OBJECT, 0, 0};
  return pliant_world_remove(world, id) == PLIANT_NULL && pliant_version()[0] == '0';
}

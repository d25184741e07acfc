// pliant version: prints the version.
#include "command.h"
#include "output.h"

namespace pliant::command {

int version() {
  print("pliant " PLIANT_VERSION "\n");
  return 0;
}

}  // namespace pliant::command

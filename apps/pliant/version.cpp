// pliant version: prints the version.
#include "pliant/version.h"
#include "apps/command_line/output.h"
#include "command.h"

namespace pliant::command {

int version() {
  print("pliant " PLIANT_VERSION "\n");
  return 0;
}

}  // namespace pliant::command

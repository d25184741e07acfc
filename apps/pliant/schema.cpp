// pliant schema: prints the scene format as a JSON Schema for editors.
#include "apps/command_line/output.h"
#include "command.h"
#include "pliant/io.h"

namespace pliant::command {

int schema() {
  std::string text = scene_schema();
  if (text.empty() || text.back() != '\n') text += '\n';
  print(text);
  return 0;
}

}  // namespace pliant::command

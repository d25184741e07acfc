// pliant check: reads a scene or a mesh and says, in words, what is wrong or doubtful and what to do about it.
#include "command.h"
#include "output.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "simulate.h"

namespace pliant::command {

namespace {

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// One line a finding, the grave ones first; whether there was a grave one.
bool print_findings(const std::vector<Finding>& findings) {
  std::string text;
  bool grave = false;
  for (const bool wanted : {true, false}) {
    for (const Finding& finding : findings) {
      if (finding.grave != wanted) continue;
      grave = grave || finding.grave;
      text += (finding.grave ? "wrong: " : "doubtful: ") + one_line(finding.message);
      if (!finding.advice.empty()) text += "; " + one_line(finding.advice);
      text += "\n";
    }
  }
  print(text.empty() ? "nothing wrong, nothing doubtful\n" : text);
  return grave;
}

std::vector<Finding> check_mesh(const std::string& path) {
  const MeshFile file = read_mesh_file(path);
  print(one_line(path) + ": " + std::to_string(file.mesh.positions.size()) + " vertices" + ", " +
        counted(file.mesh.triangles.size(), "triangle") + "\n");
  for (const std::string& repair : file.repairs) print("mended: " + one_line(repair) + "\n");
  return inspect(file.mesh);
}

std::vector<Finding> check_scene(const std::string& path) {
  const Scene scene = read_scene(path);
  std::size_t particles = 0;
  for (const Object& object : scene.objects) particles += object.positions.size();
  print(one_line(path) + ": " + counted(scene.objects.size(), "object") + " of " + counted(particles, "particle") + ", " +
        counted(scene.colliders.size(), "collider") + ", " + counted(static_cast<std::size_t>(scene.frames), "frame") +
        "\n");
  return inspect(scene);
}

}  // namespace

int check(const CheckOptions& options) {
  const bool grave =
      print_findings(has_suffix(options.path, ".json") ? check_scene(options.path) : check_mesh(options.path));
  if (!grave) return 0;
  Location where;
  where.file = options.path;
  throw Error(where, "can't be simulated as it is", "mend what is called wrong above");
}

}  // namespace pliant::command

// pliant check: reads a scene or a mesh, and prints errors and warnings with advice. A scene without errors is also
// simulated, to test whether its solve converges.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "apps/command_line/figure.h"
#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/render/matrix.h"
#include "command.h"
#include "pliant/advise.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"

namespace pliant::command {

namespace {

// The size for messages: ", 1 x 0 x 0.8 m", which reveals a mesh in centimetres.
std::string extent(const std::vector<Vec3f>& positions) {
  if (positions.empty()) return {};
  Vec3f low = positions.front(), high = low;
  for (const Vec3f& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  char text[80];
  std::snprintf(text, sizeof text, ", %.4g x %.4g x %.4g m", static_cast<double>(size.x), static_cast<double>(size.y),
                static_cast<double>(size.z));
  return text;
}

constexpr std::size_t longest_line = 120;

/// Adds the words of a clause to text whose last line has `used` characters; lines that it begins are indented by four.
void add_wrapped(const std::string& clause, std::string& text, std::size_t& used) {
  for (std::size_t begin = 0; begin < clause.size();) {
    const std::size_t space = clause.find(' ', begin), end = space == std::string::npos ? clause.size() : space + 1;
    if (used > 4 && used + end - begin > longest_line) {
      text.back() = '\n';  // was the space before the word
      text += "    ";
      used = 4;
    }
    text += clause.substr(begin, end - begin);
    used += end - begin;
    begin = end;
  }
}

/// Breaks a long line after semicolons, and clauses that are too long between words; further lines are indented.
std::string broken(const std::string& line) {
  std::string text;
  std::size_t begin = 0, used = 0;
  while (begin < line.size()) {
    const std::size_t mark = line.find("; ", begin), end = mark == std::string::npos ? line.size() : mark + 2;
    if (used > 0 && used + end - begin > longest_line) {
      text.back() = '\n';  // was the space after the semicolon
      text += "  ";
      used = 2;
    }
    add_wrapped(line.substr(begin, end - begin), text, used);
    begin = end;
  }
  return text;
}

/// What a check found.
struct Checked {
  std::vector<Finding> findings;
  std::string within = {};  ///< for example " in 19 of 120 frames", if not all were tried
};

// Prints a line for each finding, grave ones first, others with the label `lesser`. Returns true if any is grave.
bool print_findings(const Checked& checked, const std::string& lesser) {
  std::string text;
  bool grave = false;
  for (const bool wanted : {true, false}) {
    for (const Finding& finding : checked.findings) {
      if (finding.grave != wanted) continue;
      grave = grave || finding.grave;
      const std::string advice = finding.advice.empty() ? "" : "; " + one_line(finding.advice);
      text += broken((finding.grave ? "wrong: " : lesser + ": ") + one_line(finding.message) + advice) + "\n";
    }
  }
  print(text.empty() ? "nothing wrong, nothing doubtful" + checked.within + "\n" : text);
  return grave;
}

Checked check_mesh(const std::string& path) {
  const MeshFile file = read_mesh_file(path);
  print(one_line(path) + ": " + std::to_string(file.mesh.positions.size()) + " vertices, " +
        counted(file.mesh.triangles.size(), "triangle") + extent(file.mesh.positions) + "; indices count from 0\n");
  print_repairs(file.repairs);
  if (!file.repairs.empty()) print("the indices below refer to the repaired mesh\n");
  return {inspect(file.mesh)};
}

/// The time limit to suggest: enough for all frames with the scene's own settings, or otherwise for more trials.
double more_seconds(const Advice& advice, double seconds) {
  const double missing = static_cast<double>(advice.frames) / std::max(1, advice.own.frames);
  return std::min(86400., seconds * std::max(10., std::ceil(1.5 * missing)));
}

/// Simulates the scene with its own and other settings, unless it has grave findings or `seconds` is 0.
void try_out(const Scene& scene, double seconds, Checked& checked) {
  std::vector<Finding>& findings = checked.findings;
  const bool grave = std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.grave; });
  if (grave || seconds <= 0 || scene.frames < 1) return;
  const auto stops = [] {
    throw_if_interrupted();
    return false;
  };
  const Advice advice = advise(scene, {seconds, 120, stops});
  const std::string more_time =
      advice.cut_short ? "; --seconds " + figure(more_seconds(advice, seconds), 3) + " tries more" : "";
  for (const std::string& warning : advice.warnings) findings.push_back({false, "in a trial run, " + warning, ""});
  if (!advice.words.empty()) findings.push_back({false, advice.words, advice.what_to_do + more_time});
  if (!advice.words.empty() || !advice.cut_short) return;
  const std::string tried =
      std::to_string(advice.own.frames) + " of " + counted(static_cast<std::size_t>(advice.frames), "frame");
  checked.within = " in " + tried;
  print("tried " + tried + " within the time limit; --seconds " + figure(more_seconds(advice, seconds), 3) +
        " gives more\n");
}

/// For example "20 substeps a frame", or where objects differ "10 substeps a frame for 'flag', 20 for 'sock' and 2
/// more".
std::string substeps_in_words(const Scene& scene, const Settings& chosen) {
  if (chosen.substeps != 0)
    return counted(static_cast<std::size_t>(std::max(chosen.substeps, 0)), "substep") + " a frame";
  std::map<int, std::vector<std::string>> names;
  const std::vector<int> substeps = chosen_substeps(scene);
  for (std::size_t o = 0; o < substeps.size(); ++o) names[substeps[o]].push_back(scene.objects[o].name);
  std::string text;
  for (const auto& [number, of] : names) {
    const std::string count = number == 0    ? "substeps that follow its strain and motion"
                              : text.empty() ? counted(static_cast<std::size_t>(number), "substep") + " a frame"
                                             : std::to_string(number);
    text += (text.empty() ? "" : ", ") + count;
    if (names.size() > 1 || of.size() < scene.objects.size())
      text += " for '" + of.front() + "'" + (of.size() > 1 ? " and " + std::to_string(of.size() - 1) + " more" : "");
  }
  return text;
}

/// True of a liquid or grains, whose constraints no sweep projects.
bool has_no_sweep(const Object& object) { return object.fluid || object.grains || object.tracers; }

/// One line; the caller breaks it.
std::string how_it_is_solved(const Scene& scene) {
  std::string reason;
  const Settings settings = chosen_settings(scene, &reason);
  const std::string substeps = substeps_in_words(scene, settings);
  if (!scene.objects.empty() && std::all_of(scene.objects.begin(), scene.objects.end(), has_no_sweep))
    return "solved with " + substeps + "; liquids and grains need no sweep";
  if (settings.sweep == Sweep::automatic) return "solved with " + substeps + ": " + one_line(reason);
  std::string sweeps;  // an object's own sweep replaces that of the settings
  for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) {
    if (has_no_sweep(scene.objects[static_cast<std::size_t>(o)])) continue;
    const std::string name = "'" + sweep_name(chosen_sweep(scene, o)) + "'";
    if (sweeps.find(name) == std::string::npos) sweeps += (sweeps.empty() ? "" : ", ") + name;
  }
  if (sweeps.empty()) sweeps = "'" + sweep_name(settings.sweep) + "'";
  return "solved by the sweep " + sweeps + " with " + substeps +
         (reason.empty() ? "" : "; the scene leaves the sweep open and has " + one_line(reason));
}

/// Adds the vertices of a body's solids. Bodies with a defect have no mesh; inspect() names it.
void add_solids(const Object& object, int body, std::vector<Vec3f>& points) {
  constexpr int segments = 16;
  const ObjectBody& of = object.bodies[static_cast<std::size_t>(body)];
  const Vec3f& centre = object.positions[static_cast<std::size_t>(of.particle)];
  const Quatf& axes = object.frames[static_cast<std::size_t>(of.frame)].orientation;
  try {
    for (const Vec3f& p : mesh_of(of.solids, segments).positions) points.push_back(centre + render::rotate(axes, p));
  } catch (const Error&) {
    return;
  }
}

Checked check_scene(const std::string& path, double seconds, const std::vector<std::string>& values) {
  SceneReadOptions reading;
  command::add_values(values, reading);
  const SceneFile file = read_scene_file(path, reading);
  const Scene& scene = file.scene;
  std::size_t particles = 0;
  std::vector<Vec3f> points;
  for (const Object& object : scene.objects) {
    particles += object.positions.size();
    std::vector<char> is_world(
        object.positions.size());  // a fixed body without solids: what joints to the world hold on to
    for (const ObjectBody& body : object.bodies)
      if (body.solids.empty() && std::isinf(object.masses[static_cast<std::size_t>(body.particle)]))
        is_world[static_cast<std::size_t>(body.particle)] = 1;
    for (std::size_t i = 0; i < object.positions.size(); ++i)
      if (is_world[i] == 0) points.push_back(object.positions[i]);
    for (int body = 0; body < static_cast<int>(object.bodies.size()); ++body) add_solids(object, body, points);
  }
  print(one_line(path) + ": " + counted(scene.objects.size(), "object") + " of " + counted(particles, "particle") +
        extent(points) + ", " + counted(scene.colliders.size() + scene.mesh_colliders.size(), "collider") + ", " +
        counted(static_cast<std::size_t>(scene.frames), "frame") + "\n");
  print(broken(how_it_is_solved(scene)) + "\n");
  Checked checked{inspect(scene)};
  std::vector<std::string> of_meshes;
  for (const std::string& repair : file.repairs) {
    if (is_of_robot(repair))
      checked.findings.push_back({false, repair, ""});
    else
      of_meshes.push_back(repair);
  }
  print_repairs(of_meshes);
  print_left_out(file.left_out);
  try_out(scene, seconds, checked);
  return checked;
}

}  // namespace

int check(const CheckOptions& options) {
  // What is doubtful in a mesh is often usual for cloth, so such findings are called notes.
  const bool is_scene = has_suffix(options.path, ".json");
  const bool grave =
      print_findings(is_scene ? check_scene(options.path, options.seconds, options.values) : check_mesh(options.path),
                     is_scene ? "doubtful" : "note");
  if (!grave) return 0;
  Location where;
  where.file = options.path;
  throw Error(where, "can't be simulated as it is", "correct the errors listed above");
}

}  // namespace pliant::command

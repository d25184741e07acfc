// The command line of `pliant`: parses it, calls a subcommand, and turns an exception into one line of text and an exit
// status.
//
// Exit status: 0 done, 1 an error or a grave finding, 2 a command line error, 128 + N ended by signal N.
#include <algorithm>
#include <iterator>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/measure_subcommands.h"
#include "apps/command_line/parse.h"
#include "command.h"
#include "measure_program.h"

namespace {

using namespace pliant::command;

void add_set(CLI::App& app, std::vector<std::string>& values) {
  app.add_option("--set", values, "set a member of the scene by its JSON pointer: /settings/substeps=20; repeatable")
      ->type_name("POINTER=VALUE")
      ->allow_extra_args(false);
}

/// Adds the options that run and render share.
void add_settings(CLI::App& app, Overrides& overrides) {
  app.add_option("--mesh", overrides.meshes, "replace the mesh of the object or collider NAME; repeatable")
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
  add_set(app, overrides.values);
  app.add_option("--cache", overrides.cache, "folder for distance grids, which later runs reuse")->type_name("FOLDER");
  app.add_option("--threads", overrides.threads, "number of threads; 0: all hardware threads")
      ->type_name("N")
      ->check(range(0, most_threads));
  app.add_option("--substeps", overrides.substeps, "substeps per frame (default: the scene's)")
      ->type_name("N")
      ->check(range(1, 10000));
  app.add_option("--iterations", overrides.iterations, "iterations per substep (default: the scene's)")
      ->type_name("N")
      ->check(range(1, 10000));
  app.add_option("--sweep", overrides.sweep,
                 "sweep and options, such as chains or chains+tethers (default: the scene's)")
      ->type_name("NAME");
}

void add_overrides(CLI::App& app, Overrides& overrides) {
  add_settings(app, overrides);
  app.add_option("--frames", overrides.frames, "number of frames (default: the scene's)")
      ->type_name("N")
      ->check(range(0, most));
  app.add_option("--isa", overrides.isa, "instruction set; changes the speed, never the result")
      ->type_name("NAME")
      ->check(CLI::IsMember({"x86-64-v2", "x86-64-v3", "x86-64-v4", "generic"}));
  app.add_flag("--sequential", overrides.sequential, "use the scalar reference code: slow, with the same bits")
      ->excludes("--sweep");
}

void add_run(CLI::App& app, RunOptions& options, Chosen& chosen) {
  CLI::App* run_app = app.add_subcommand("run", "Simulate a scene");
  run_app->add_option("SCENE", options.scene, "scene file (JSON)")->required();
  add_overrides(*run_app, options.overrides);
  run_app->add_option("--out", options.out, "geometry file (.obj, .ply, .glb, .usda, .pc2 or .pvd); repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
  run_app->add_flag("--liquid-surfaces", options.liquid_surfaces,
                    "write liquids as surfaces instead of particles (.obj, .ply, .usda or .pvd)");
  run_app->add_option("--gauges", options.gauges, "write the readings of the scene's gauges to this CSV file")
      ->type_name("FILE");
  run_app->add_option("--report", options.report, "write hashes, times, residuals and stretch to this JSON file")
      ->type_name("FILE");
  CLI::Option* checkpoint =
      run_app
          ->add_option("--checkpoint", options.checkpoint, "save the state to this file, from which --resume continues")
          ->type_name("FILE");
  run_app->add_option("--every", options.every, "frames between checkpoints; the end and Ctrl-C also save one")
      ->type_name("N")
      ->check(range(1, most))
      ->capture_default_str()
      ->needs(checkpoint);
  run_app->add_option("--resume", options.resume, "continue from this checkpoint of the scene")->type_name("FILE");
  run_app->add_flag("--hash-frames", options.hash_frames, "add the hash of the state after every frame to the report");
  run_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  run_app->callback([&] { chosen = [&] { return run(options); }; });
}

/// Adds the options of a camera.
void add_camera(CLI::App& app, pliant::SceneCamera& camera) {
  app.add_option("--azimuth", camera.azimuth,
                 "camera angle from the front towards the right, -360 to 360 [degrees] (default: the scene's, or 28)")
      ->type_name("A")
      ->check(range(-360.f, 360.f));
  app.add_option("--elevation", camera.elevation,
                 "camera angle above the horizon, -89 to 89 [degrees] (default: the scene's, or 18)")
      ->type_name("A")
      ->check(range(-89.f, 89.f));
  app.add_option_function<std::vector<float>>(
         "--look-at",
         [&](const std::vector<float>& at) {
           camera.look_at = pliant::Vec3f{at[0], at[1], at[2]};
         },
         "point in the middle of the picture [m] (default: the scene's, or its middle)")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->check(range(-1e9f, 1e9f));
  app.add_option("--distance", camera.distance,
                 "of the camera from that point [m] (default: the scene's, or so that it fits)")
      ->type_name("D")
      ->check(range(1e-6f, 1e9f));
  app.add_option("--fov", camera.field_of_view,
                 "vertical angle of view, 5 to 120 [degrees] (default: the scene's, or 30)")
      ->type_name("A")
      ->check(range(5.f, 120.f));
}

void add_render(CLI::App& app, RenderOptions& options, Chosen& chosen) {
  CLI::App* render_app = app.add_subcommand("render", "Draw a scene as a picture or movie, without a display");
  render_app->add_option("SCENE", options.scene, "scene file (JSON), or an animation (.glb)")->required();
  render_app->add_option("--out", options.out, "picture (.png) or movie (.mp4)")->type_name("FILE")->required();
  render_app
      ->add_option("--frame", options.frame, "frame to draw, or last frame of a movie (default: the scene's last)")
      ->type_name("N")
      ->check(range(0, most));
  render_app->add_option("--size", options.size, "width and height in pixels (default: 1280x720, with --draft 640x360)")
      ->type_name("WxH");
  render_app->add_flag("--draft", options.draft, "draw quickly: a small picture, and 15 of a movie a second");
  add_camera(*render_app, options.camera);
  render_app->add_option("--strip", options.strip, "frames to draw side by side in one picture, such as 0,30,60")
      ->type_name("FRAMES")
      ->delimiter(',')
      ->check(range(0, most));
  render_app->add_option("--resume", options.resume, "draw this checkpoint of the scene, or go on from it to --frame")
      ->type_name("FILE");
  add_settings(*render_app, options.overrides);
  render_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  render_app->callback([&] { chosen = [&] { return render(options); }; });
}

void add_study(CLI::App& app, StudyOptions& options, Chosen& chosen) {
  CLI::App* study_app = app.add_subcommand("study", "Simulate a scene with many values of its members, into a table");
  study_app->add_option("SCENE", options.scene, "scene file (JSON)")->required();
  study_app->add_option("--vary", options.vary, "values of a member of the scene: /settings/substeps=10,20; repeatable")
      ->type_name("POINTER=VALUES")
      ->allow_extra_args(false)
      ->required();
  study_app->add_option("--out", options.out, "table (CSV) with a row for each combination; rows that it has are kept")
      ->type_name("FILE")
      ->required();
  study_app
      ->add_option("--measure", options.measures, "member of the report of a run as a column: /contacts; repeatable")
      ->type_name("POINTER")
      ->allow_extra_args(false);
  study_app->add_option("--pictures", options.pictures, "picture (.png) of the last frame of each variant")
      ->type_name("FILE");
  study_app->add_option("--jobs", options.jobs, "variants that run side by side; 0: one for each hardware thread")
      ->type_name("N")
      ->check(range(0, most_threads))
      ->capture_default_str();
  add_overrides(*study_app, options.overrides);
  study_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  study_app->callback([&] { chosen = [&] { return study(options); }; });
}

void add_check(CLI::App& app, CheckOptions& options, Chosen& chosen) {
  CLI::App* check_app = app.add_subcommand("check", "Report errors and doubtful settings of a scene or a mesh");
  check_app->add_option("FILE", options.path, "scene (.json) or mesh (.obj, .ply, .stl)")->required();
  check_app
      ->add_option("--seconds", options.seconds, "time for trial runs that test whether the solver converges; 0: none")
      ->type_name("S")
      ->check(range(0.0, 86400.0))
      ->capture_default_str();
  add_set(*check_app, options.values);
  check_app->callback([&] { chosen = [&] { return check(options); }; });
}

/// Adds subcommands of pliant-measure, so that the help lists them.
void add_measure_subcommands(CLI::App& app) {
  for (const MeasureSubcommand& one : measure_subcommands) app.add_subcommand(one.name, one.description);
}

/// The subcommand that the command line names: its first word that is one. Empty if there is none.
std::string named_subcommand(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> names = subcommand_names(app);
  for (int i = 1; i < argc; ++i)
    if (std::find(names.begin(), names.end(), argv[i]) != names.end()) return argv[i];
  return "";
}

bool is_of_measure_program(const std::string& name) {
  return std::any_of(std::begin(measure_subcommands), std::end(measure_subcommands),
                     [&](const MeasureSubcommand& one) { return name == one.name; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  set_up(app);
  Chosen chosen;
  RunOptions run_options;
  RenderOptions render_options;
  StudyOptions study_options;
  CheckOptions check_options;
  add_run(app, run_options, chosen);
  add_render(app, render_options, chosen);
  add_study(app, study_options, chosen);
  add_check(app, check_options, chosen);
  add_measure_subcommands(app);
  app.add_subcommand("schema", "Print the JSON Schema of the scene format")->callback([&] { chosen = schema; });
  app.add_subcommand("version", "Print the version")->callback([&] { chosen = version; });

  // Before signals are handled: the other program would inherit those that are ignored.
  if (const std::string named = named_subcommand(app, argc, argv); is_of_measure_program(named)) {
    complain(replace_by_measure_program(named, argv));
    return 1;
  }
  catch_signals();
  return parse_and_run(app, chosen, argc, argv);
}

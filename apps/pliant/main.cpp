// The command line: parses it, calls a subcommand, and turns an exception into one line of text and an exit status.
//
// Exit status: 0 done, 1 an error or a grave finding, 2 a command line error, 128 + N ended by signal N.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <new>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "command.h"
#include "pliant/error.h"
#include "scene_hints.h"

namespace {

using namespace pliant::command;

constexpr int most = std::numeric_limits<int>::max();
constexpr int most_threads = 1024;  // limit of threads, as in scene files

void complain(const std::string& message) { std::fprintf(stderr, "pliant: %s\n", one_line(message).c_str()); }

/// Checks a range, with a message; unlike CLI11's check it adds nothing to the help.
template <class Number>
CLI::Validator range(Number least, Number largest) {
  return CLI::Validator(CLI::Range(least, largest)).description("");
}

/// Adds the options that run and render share.
void add_settings(CLI::App& app, Overrides& overrides) {
  app.add_option("--mesh", overrides.meshes, "replace the mesh of the object or collider NAME; repeatable")
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
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
  app.add_option("--sweep", overrides.sweep, "sweep and options, such as chains or chains+tethers (default: the scene's)")
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

// Each subcommand stores the function that main will call.
using Chosen = std::function<int()>;

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
      run_app->add_option("--checkpoint", options.checkpoint, "save the state to this file, from which --resume continues")
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

void add_render(CLI::App& app, RenderOptions& options, Chosen& chosen) {
  CLI::App* render_app = app.add_subcommand("render", "Draw a scene as a picture or movie, without a display");
  render_app->add_option("SCENE", options.scene, "scene file (JSON)")->required();
  render_app->add_option("--out", options.out, "picture (.png) or movie (.mp4)")->type_name("FILE")->required();
  render_app->add_option("--frame", options.frame, "frame to draw, or last frame of a movie (default: the scene's last)")
      ->type_name("N")
      ->check(range(0, most));
  render_app->add_option("--size", options.size, "width and height in pixels")->type_name("WxH")->capture_default_str();
  render_app
      ->add_option("--azimuth", options.azimuth, "camera angle from the front towards the right, -360 to 360 [degrees]")
      ->type_name("A")
      ->check(range(-360.f, 360.f))
      ->capture_default_str();
  render_app->add_option("--elevation", options.elevation, "camera angle above the horizon, -89 to 89 [degrees]")
      ->type_name("A")
      ->check(range(-89.f, 89.f))
      ->capture_default_str();
  render_app->add_option("--strip", options.strip, "frames to draw side by side in one picture, such as 0,30,60")
      ->type_name("FRAMES")
      ->delimiter(',')
      ->check(range(0, most));
  add_settings(*render_app, options.overrides);
  render_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  render_app->callback([&] { chosen = [&] { return render(options); }; });
}

void add_check(CLI::App& app, CheckOptions& options, Chosen& chosen) {
  CLI::App* check_app = app.add_subcommand("check", "Report errors and doubtful settings of a scene or a mesh");
  check_app->add_option("FILE", options.path, "scene (.json) or mesh (.obj, .ply, .stl)")->required();
  check_app->add_option("--seconds", options.seconds, "time for trial runs that test whether the solver converges; 0: none")
      ->type_name("S")
      ->check(range(0.0, 86400.0))
      ->capture_default_str();
  check_app->callback([&] { chosen = [&] { return check(options); }; });
}

void add_validate(CLI::App& app, ValidateOptions& options, Chosen& chosen) {
  CLI::App* validate_app = app.add_subcommand("validate", "Compare the engine with known answers of mechanics");
  validate_app->add_option("NAME", options.group, "group of answers (default: all)");
  validate_app->add_flag("--slow", options.slow, "include rows that take minutes");
  validate_app
      ->add_option("--queries", options.queries, "folder of query sets for continuous collision tests (group `collision`)")
      ->type_name("FOLDER");
  validate_app
      ->add_option("--json", options.json,
                   "write the rows to this JSON file; without FILE, print JSON instead of the table")
      ->type_name("FILE")
      ->expected(0, 1)
      ->default_str("-");
  validate_app->add_option("--plot", options.plot, "draw the curves to this picture (.png)")->type_name("FILE");
  validate_app->callback([&] { chosen = [&] { return validate(options); }; });
}

void add_bench(CLI::App& app, BenchOptions& options, Chosen& chosen) {
  CLI::App* bench_app =
      app.add_subcommand("bench", "Measure the time of frames, compared with a plain loop and another engine");
  bench_app->add_option("NAME", options.workload, "workload (default: all)");
  bench_app->add_option("--against", options.against, "also measure this engine")
      ->type_name("NAME")
      ->check(CLI::IsMember({"bullet"}));
  bench_app->add_option("--sizes", options.sizes, "particles per side, of W5 particles, or size of a pile, such as 64,128")
      ->type_name("SIZES")
      ->delimiter(',')
      ->check(range(1, 10000000));
  bench_app->add_option("--frames", options.frames, "measured frames, after 20 unmeasured ones")
      ->type_name("N")
      ->check(range(1, 1000000))
      ->capture_default_str();
  bench_app->add_option("--limit", options.limit, "time limit for a row of W3 [s]")
      ->type_name("S")
      ->check(range(1.0, 86400.0))
      ->capture_default_str();
  bench_app
      ->add_option("--threads", options.threads,
                   "threads of a second run, after one with a single thread; 0: all hardware threads")
      ->type_name("N")
      ->check(range(0, most_threads));
  bench_app->add_option("--scenes", options.scenes, "of 'default': scene files to measure")->type_name("FILES");
  bench_app->add_option("--settings", options.settings, "of 'default': also measure these, such as \"chains 40,multigrid\"")
      ->type_name("SETTINGS")
      ->delimiter(',');
  bench_app->add_option("--meshes", options.meshes, "of 'default': let a cotton sheet fall over each mesh of this folder")
      ->type_name("FOLDER");
  bench_app->add_option("--json", options.json, "write the rows to this JSON file")->type_name("FILE");
  bench_app->callback([&] { chosen = [&] { return bench(options); }; });
}

void add_compare(CLI::App& app, CompareOptions& options, Chosen& chosen) {
  CLI::App* compare_app = app.add_subcommand("compare", "Compare how fast sweeps solve a scene");
  compare_app->add_option("SCENE", options.scene, "scene file (JSON)")->required();
  compare_app
      ->add_option("--sweeps", options.sweeps,
                   "sweeps to compare, such as tiled,chains,tiled+chebyshev,chains+tethers (default: all)")
      ->type_name("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false);
  compare_app->add_option("--frame", options.frame, "frames before the measured substep (default: half of the scene's)")
      ->type_name("N")
      ->check(range(0, most));
  compare_app->add_option("--iterations", options.iterations, "maximum number of iterations in the curves")
      ->type_name("N")
      ->check(range(1, 10000))
      ->capture_default_str();
  compare_app
      ->add_option("--budget-ms", options.budget, "also compare the stretch that sweeps reach in this time per frame [ms]")
      ->type_name("T")
      ->check(range(1e-3, 1e6));
  compare_app->add_option("--frames", options.overrides.frames, "number of frames of the scene (default: its own)")
      ->type_name("N")
      ->check(range(0, most));
  compare_app->add_option("--substeps", options.substeps, "substeps per frame for the curves (default: the scene's)")
      ->type_name("N")
      ->check(range(1, 10000));
  compare_app->add_option("--threads", options.overrides.threads, "number of threads; 0: all hardware threads")
      ->type_name("N")
      ->check(range(0, most_threads));
  compare_app->add_option("--out", options.out, "picture (.png) or all numbers (.json); repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
  compare_app->callback([&] { chosen = [&] { return compare(options); }; });
}

/// "did you mean '--frames'? see " if the subcommand has an option like the first unknown one; else "see ".
std::string nearest_option(const CLI::App& subcommand) {
  std::vector<std::string> names;
  for (const CLI::Option* option : subcommand.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::vector<std::string> unknown = subcommand.remaining();
  const auto first =
      std::find_if(unknown.begin(), unknown.end(), [](const std::string& word) { return word.rfind("--", 0) == 0; });
  const std::string near = first == unknown.end() ? "" : pliant::scene_file::nearest_name(*first, names);
  return near.empty() ? "see " : "did you mean '" + near + "'? see ";
}

/// Advice for a wrong command line: the list of subcommands if one is unknown, otherwise how to get help.
std::string usage_advice(const CLI::App& app, const std::string& wanted) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  if (!given.empty()) return nearest_option(*given.front()) + "pliant " + given.front()->get_name() + " --help";
  std::vector<std::string> names;
  std::string list;
  for (const CLI::App* subcommand : app.get_subcommands(nullptr)) {
    names.push_back(subcommand->get_name());
    list += (list.empty() ? "" : ", ") + subcommand->get_name();
  }
  const std::string near = wanted.empty() ? "" : pliant::scene_file::nearest_name(wanted, names);
  return (near.empty() ? "" : "did you mean '" + near + "'? ") + "the subcommands are " + list + "; see pliant --help";
}

int run_guarded(const Chosen& chosen) {
  try {
    return chosen();
  } catch (const Interrupted& interrupted) {
    complain(interrupted.what());
    return interrupted.exit_status();
  } catch (const std::bad_alloc&) {
    complain("out of memory; simulate fewer particles, or close other programs");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  catch_signals();
  CLI::App app{
      "A position based dynamics engine: cloth, ropes, rods, soft and rigid bodies, joints, liquids, gases, grains",
      "pliant"};
  app.set_version_flag("--version", "pliant " PLIANT_VERSION);
  app.require_subcommand(0, 1);  // so that an unknown subcommand is named instead of reported missing

  Chosen chosen;
  RunOptions run_options;
  RenderOptions render_options;
  CheckOptions check_options;
  ValidateOptions validate_options;
  BenchOptions bench_options;
  CompareOptions compare_options;
  add_run(app, run_options, chosen);
  add_render(app, render_options, chosen);
  add_check(app, check_options, chosen);
  add_validate(app, validate_options, chosen);
  add_bench(app, bench_options, chosen);
  add_compare(app, compare_options, chosen);
  app.add_subcommand("schema", "Print the JSON Schema of the scene format")->callback([&] { chosen = schema; });
  app.add_subcommand("version", "Print the version")->callback([&] { chosen = version; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const bool unknown = app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
    const std::string problem = unknown ? "there is no subcommand '" + std::string(argv[1]) + "'" : error.what();
    complain(problem + "; " + usage_advice(app, unknown ? argv[1] : ""));
    return 2;
  }
  if (!chosen) {
    complain("no subcommand is given; " + usage_advice(app, ""));
    return 2;
  }
  return run_guarded(chosen);
}

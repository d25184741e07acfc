// The command line: parses it, calls a subcommand, and turns exceptions into one line and an exit status.
//
// Exit status: 0 done, 1 an error or a grave finding, 2 a command line error, 128 + N ended by signal N.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <limits>
#include <new>

#include "command.h"
#include "interrupt.h"
#include "output.h"
#include "pliant/error.h"

namespace {

using namespace pliant::command;

constexpr int most = std::numeric_limits<int>::max();
constexpr int most_threads = 1024;  // as in a scene

void complain(const std::string& message) { std::fprintf(stderr, "pliant: %s\n", one_line(message).c_str()); }

/// A range check with a message, but without text in the help.
template <class Number>
CLI::Validator range(Number least, Number largest) {
  return CLI::Validator(CLI::Range(least, largest)).description("");
}

/// The options common to run and render.
void add_settings(CLI::App& app, Overrides& overrides) {
  app.add_option("--mesh", overrides.meshes,
                 "a mesh file for the object or collider of that name; may be given more than once")
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
  app.add_option("--cache", overrides.cache, "a folder where distance grids are kept from run to run")->type_name("FOLDER");
  app.add_option("--threads", overrides.threads, "threads; 0: as many as the machine has")
      ->type_name("N")
      ->check(range(0, most_threads));
  app.add_option("--substeps", overrides.substeps, "substeps a frame, instead of the scene's")
      ->type_name("N")
      ->check(range(1, 10000));
  app.add_option("--iterations", overrides.iterations, "iterations a substep, instead of the scene's")
      ->type_name("N")
      ->check(range(1, 10000));
  app.add_option("--sweep", overrides.sweep, "the sweep, instead of the scene's, as chains or chains+tethers")
      ->type_name("NAME");
}

void add_overrides(CLI::App& app, Overrides& overrides) {
  add_settings(app, overrides);
  app.add_option("--frames", overrides.frames, "frames to simulate, instead of the scene's number")
      ->type_name("N")
      ->check(range(0, most));
  app.add_option("--isa", overrides.isa, "code path; the same bits at another speed")
      ->type_name("NAME")
      ->check(CLI::IsMember({"x86-64-v2", "x86-64-v3", "x86-64-v4", "generic"}));
  app.add_flag("--sequential", overrides.sequential, "in plain code; the same bits, slowly")->excludes("--sweep");
}

// Each subcommand sets `chosen`, which main then calls.
using Chosen = std::function<int()>;

void add_run(CLI::App& app, RunOptions& options, Chosen& chosen) {
  CLI::App* run_app = app.add_subcommand("run", "Simulate a scene");
  run_app->add_option("SCENE", options.scene, "scene file, JSON")->required();
  add_overrides(*run_app, options.overrides);
  run_app->add_option("--out", options.out, "geometry: .obj, .ply, .glb, .usda, .pc2 or .pvd; may be given more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  run_app->add_option("--report", options.report, "write hashes, times, residuals and stretch as JSON")->type_name("FILE");
  CLI::Option* checkpoint =
      run_app->add_option("--checkpoint", options.checkpoint, "save the state there, to go on from with --resume")
          ->type_name("FILE");
  run_app->add_option("--every", options.every, "frames from one --checkpoint to the next; also at the end and on Ctrl-C")
      ->type_name("N")
      ->check(range(1, most))
      ->capture_default_str()
      ->needs(checkpoint);
  run_app->add_option("--resume", options.resume, "go on from this checkpoint of the scene")->type_name("FILE");
  run_app->add_flag("--hash-frames", options.hash_frames, "the state's hash of every frame in the report");
  run_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  run_app->callback([&] { chosen = [&] { return run(options); }; });
}

void add_render(CLI::App& app, RenderOptions& options, Chosen& chosen) {
  CLI::App* render_app = app.add_subcommand("render", "Draw a scene, without a screen");
  render_app->add_option("SCENE", options.scene, "scene file, JSON")->required();
  render_app->add_option("--out", options.out, "picture (.png) or movie (.mp4)")->type_name("FILE")->required();
  render_app->add_option("--frame", options.frame, "the frame drawn, the last by default; a movie ends with it")
      ->type_name("N")
      ->check(range(0, most));
  render_app->add_option("--size", options.size, "width and height in pixels, as 1280x720")
      ->type_name("WxH")
      ->capture_default_str();
  render_app->add_option("--azimuth", options.azimuth, "camera from the front to the right, -360 to 360 [degrees]")
      ->type_name("A")
      ->check(range(-360.f, 360.f))
      ->capture_default_str();
  render_app->add_option("--elevation", options.elevation, "camera above the horizon, -89 to 89 [degrees]")
      ->type_name("A")
      ->check(range(-89.f, 89.f))
      ->capture_default_str();
  render_app->add_option("--strip", options.strip, "frames drawn side by side in one picture by one camera, as 0,30,60")
      ->type_name("FRAMES")
      ->delimiter(',')
      ->check(range(0, most));
  add_settings(*render_app, options.overrides);
  render_app->add_flag("--quiet", options.quiet, "print nothing unless something goes wrong");
  render_app->callback([&] { chosen = [&] { return render(options); }; });
}

void add_check(CLI::App& app, CheckOptions& options, Chosen& chosen) {
  CLI::App* check_app = app.add_subcommand("check", "Say what is wrong or doubtful in a scene or a mesh");
  check_app->add_option("FILE", options.path, "scene (.json) or mesh (.obj, .ply, .stl)")->required();
  check_app
      ->add_option("--seconds", options.seconds, "for running a scene to see whether its solve keeps up; 0: not at all")
      ->type_name("S")
      ->check(range(0.0, 86400.0))
      ->capture_default_str();
  check_app->callback([&] { chosen = [&] { return check(options); }; });
}

void add_validate(CLI::App& app, ValidateOptions& options, Chosen& chosen) {
  CLI::App* validate_app = app.add_subcommand("validate", "Compare with known answers of mechanics");
  validate_app->add_option("NAME", options.group, "the group of answers, all by default");
  validate_app->add_flag("--slow", options.slow, "also what takes minutes");
  validate_app->add_option("--queries", options.queries, "a folder of query sets for the continuous tests of `collision`")
      ->type_name("FOLDER");
  validate_app->add_option("--json", options.json, "write the rows as JSON; without a file in place of the table")
      ->type_name("FILE")
      ->expected(0, 1)
      ->default_str("-");
  validate_app->add_option("--plot", options.plot, "draw the curves as a picture (.png)")->type_name("FILE");
  validate_app->callback([&] { chosen = [&] { return validate(options); }; });
}

void add_bench(CLI::App& app, BenchOptions& options, Chosen& chosen) {
  CLI::App* bench_app = app.add_subcommand("bench", "Measure whole frames, beside plain loops and another engine");
  bench_app->add_option("NAME", options.workload, "the workload, all by default");
  bench_app->add_option("--against", options.against, "another engine in the same run")
      ->type_name("NAME")
      ->check(CLI::IsMember({"bullet"}));
  bench_app->add_option("--sizes", options.sizes, "particles along a side, as 64,128")
      ->type_name("SIZES")
      ->delimiter(',')
      ->check(range(2, 4096));
  bench_app->add_option("--frames", options.frames, "frames measured, after 20 that are not")
      ->type_name("N")
      ->check(range(1, 1000000))
      ->capture_default_str();
  bench_app->add_option("--limit", options.limit, "of W3: seconds that a row may take")
      ->type_name("S")
      ->check(range(1.0, 86400.0))
      ->capture_default_str();
  bench_app->add_option("--threads", options.threads, "of the run beside that with one thread; 0: all")
      ->type_name("N")
      ->check(range(0, most_threads));
  bench_app->add_option("--json", options.json, "write the rows as JSON")->type_name("FILE");
  bench_app->callback([&] { chosen = [&] { return bench(options); }; });
}

void add_compare(CLI::App& app, CompareOptions& options, Chosen& chosen) {
  CLI::App* compare_app = app.add_subcommand("compare", "Show how fast each sweep solves a scene");
  compare_app->add_option("SCENE", options.scene, "scene file, JSON")->required();
  compare_app
      ->add_option("--sweeps", options.sweeps,
                   "sweeps compared, as tiled,chains,tiled+chebyshev,chains+tethers; all by default")
      ->type_name("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false);
  compare_app
      ->add_option("--frame", options.frame, "frames before the substep that is solved; by default half of the scene's")
      ->type_name("N")
      ->check(range(0, most));
  compare_app->add_option("--iterations", options.iterations, "the most iterations of the curves")
      ->type_name("N")
      ->check(range(1, 10000))
      ->capture_default_str();
  compare_app->add_option("--budget-ms", options.budget, "also say what each sweep reaches in so many milliseconds a frame")
      ->type_name("T")
      ->check(range(1e-3, 1e6));
  compare_app->add_option("--frames", options.overrides.frames, "the scene's frames, instead of its own number")
      ->type_name("N")
      ->check(range(0, most));
  compare_app->add_option("--substeps", options.substeps, "substeps a frame in the curves, instead of the scene's")
      ->type_name("N")
      ->check(range(1, 10000));
  compare_app->add_option("--threads", options.overrides.threads, "threads; 0: as many as the machine has")
      ->type_name("N")
      ->check(range(0, most_threads));
  compare_app->add_option("--out", options.out, "picture (.png) or all numbers (.json); may be given twice")
      ->type_name("FILE")
      ->allow_extra_args(false);
  compare_app->callback([&] { chosen = [&] { return compare(options); }; });
}

/// Advice for an invalid command line: the list of subcommands for an unknown one, otherwise a pointer to the help.
std::string usage_advice(const CLI::App& app) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  if (!given.empty()) return "see pliant " + given.front()->get_name() + " --help";
  std::string names;
  for (const CLI::App* subcommand : app.get_subcommands(nullptr))
    names += (names.empty() ? "" : ", ") + subcommand->get_name();
  return "the subcommands are " + names + "; see pliant --help";
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
  CLI::App app{"A position based dynamics engine: cloth, soft bodies, ropes", "pliant"};
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
    complain(problem + "; " + usage_advice(app));
    return 2;
  }
  if (!chosen) {
    complain("name what to do, as pliant run; " + usage_advice(app));
    return 2;
  }
  return run_guarded(chosen);
}

// The command line of `pliant-measure`, which `pliant` runs for its subcommands validate, bench and compare. Messages
// and help name `pliant`, and exit statuses are its own.
#include "apps/command_line/interrupt.h"
#include "apps/command_line/measure_subcommands.h"
#include "apps/command_line/parse.h"
#include "apps/measure/measure.h"

namespace {

using namespace pliant::command;

void add_validate(CLI::App& app, ValidateOptions& options, Chosen& chosen) {
  CLI::App* validate_app = app.add_subcommand(validate_subcommand.name, validate_subcommand.description);
  validate_app->add_option("NAME", options.group, "group of answers (default: all)");
  validate_app->add_flag("--slow", options.slow, "include rows that take minutes");
  validate_app
      ->add_option("--queries", options.queries,
                   "folder of query sets for continuous collision tests (group `collision`)")
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
  CLI::App* bench_app = app.add_subcommand(bench_subcommand.name, bench_subcommand.description);
  bench_app->add_option("NAME", options.workload, "workload (default: all)");
  bench_app->add_option("--against", options.against, "also measure this engine")
      ->type_name("NAME")
      ->check(CLI::IsMember({"bullet"}));
  bench_app
      ->add_option("--sizes", options.sizes, "particles per side, of W5 particles, or size of a pile, such as 64,128")
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
  bench_app
      ->add_option("--settings", options.settings, "of 'default': also measure these, such as \"chains 40,multigrid\"")
      ->type_name("SETTINGS")
      ->delimiter(',');
  bench_app
      ->add_option("--meshes", options.meshes, "of 'default': let a cotton sheet fall over each mesh of this folder")
      ->type_name("FOLDER");
  bench_app->add_option("--json", options.json, "write the rows to this JSON file")->type_name("FILE");
  bench_app->callback([&] { chosen = [&] { return bench(options); }; });
}

void add_compare(CLI::App& app, CompareOptions& options, Chosen& chosen) {
  CLI::App* compare_app = app.add_subcommand(compare_subcommand.name, compare_subcommand.description);
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
      ->add_option("--budget-ms", options.budget,
                   "also compare the stretch that sweeps reach in this time per frame [ms]")
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

}  // namespace

int main(int argc, char** argv) {
  catch_signals();
  CLI::App app;
  set_up(app);
  Chosen chosen;
  ValidateOptions validate_options;
  BenchOptions bench_options;
  CompareOptions compare_options;
  add_validate(app, validate_options, chosen);
  add_bench(app, bench_options, chosen);
  add_compare(app, compare_options, chosen);
  return parse_and_run(app, chosen, argc, argv);
}

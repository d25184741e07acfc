// Tests the command as users see it: exit status, the one line on standard error, files that are complete or do not
// exist.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "command/command_fixture.h"

namespace pliant {
namespace {

TEST_F(Command, HelpAndVersion) {
  EXPECT_EQ(pliant("--help").status, 0);
  EXPECT_NE(pliant("run --help").out.find("--hash-frames"), std::string::npos);
  EXPECT_EQ(pliant("version").out.rfind("pliant ", 0), 0u);
  EXPECT_EQ(pliant("--version").out, pliant("version").out);
}

TEST_F(Command, NamesTheFileOfASceneThatNoWorldIsMadeOf) {
  std::ofstream(folder_ / "shut_up.json") << R"({"frames": 2, "settings": {"initial_intersections": "refuse"},
    "objects": [{"name": "sheet", "cloth": {"mesh": {"grid": {"columns": 4, "rows": 4, "width": 0.2, "depth": 0.2}}}}],
    "colliders": [{"name": "ball", "mesh": {"sphere": {"subdivisions": 2, "radius": 0.5}}}]})";
  const std::string word = "shut_up.json: object 'sheet', particle 0 and 15 more: is inside of closed collider 'ball'";
  expect_refused("run shut_up.json", 1, word);
  expect_refused("render shut_up.json --out a.png", 1, word);
  expect_refused("compare shut_up.json", 1, word);
  EXPECT_NE(pliant("check shut_up.json").out.find("wrong: object 'sheet', particle 0 and 15 more"), std::string::npos);
}

TEST_F(Command, SetsMembersOfAScene) {
  expect_refused("run small.json --set /settings/substep=3", 1, "/settings/substep: 'substep' is unknown in settings");
  expect_refused("run small.json --set /frames", 1, "'/frames' sets nothing; write POINTER=VALUE");
  expect_refused("check small.json --set frames=2", 1, "'frames' is no JSON pointer");
  EXPECT_NE(pliant("run small.json --set /frames=2").out.find("2 frames"), std::string::npos);
  EXPECT_NE(pliant("check small.json --seconds 0 --set /frames=2").out.find("2 frames"), std::string::npos);
}

TEST_F(Command, UsageErrorsGiveTwo) {
  expect_refused("", 2, "no subcommand");
  expect_refused("fly", 2, "fly");
  expect_refused("rnu small.json", 2,
                 "did you mean 'run'? the subcommands are run, render, study, check, validate, bench, ");
  expect_refused("run small.json --frame 3", 2, "did you mean '--frames'? see pliant run --help");
  expect_refused("run small.json --zzz 3", 2, "--zzz; see pliant run --help");
  expect_refused("bench W1-bendin", 1, "did you mean 'W1-bending'? the workloads are ");
  expect_refused("bench defaul", 1, "did you mean 'default'? ");
  expect_refused("bench bodies-pyramid --sizes 200000", 1,
                 "is more than 100000; give a smaller size; only W5 takes more");
  expect_refused("render small.json", 2, "see pliant render --help");
  expect_refused("run", 2, "SCENE");
  expect_refused("run small.json --frames -1", 2, "frames");
  expect_refused("run small.json --frames many", 2, "frames");
  expect_refused("run small.json --wings", 2, "wings");
  expect_refused("run small.json --isa 6502", 2, "isa");
}

TEST_F(Command, ErrorsGiveOneAndOneLine) {
  expect_refused("run missing.json", 1, "missing.json");
  expect_refused("run small.json --out cloth.doc", 1, "cloth.doc");
  expect_refused("run small.json --out small.json/cloth.glb", 1, "small.json/cloth.glb: cannot write: ");
  expect_refused("run small.json --report small.json/report.json", 1, "small.json' is not a folder");
  expect_refused("render small.json --out small.json/a.png", 1, "small.json' is not a folder");
  expect_refused("render small.json --out small.json", 1, "neither .png nor .mp4");
  expect_refused("run small.json --report /proc/self/nowhere/report.json", 1, "/proc/self/nowhere/report.json: cannot");
  expect_refused("run small.json --report small.json", 1, "twice");
  expect_refused("run small.json --report ./small.json", 1, "twice");
  fs::create_symlink("small.json", folder_ / "link.json");
  expect_refused("run small.json --report link.json", 1, "twice");
  expect_refused("run link.json --report small.json", 1, "twice");
  fs::remove(folder_ / "link.json");
  EXPECT_EQ(slurp(folder_ / "small.json"), small_scene(4)) << "what was read is written over";
  expect_refused("check missing.obj", 1, "missing.obj");
  expect_refused("render small.json --out picture.gif", 1, "picture.gif");
  for (const char* change : {"--set /settings/substeps=2", "--mesh a=b.obj", "--substeps 2", "--sweep chains"})
    expect_refused(std::string("render small.glb --out picture.png ") + change, 1, "nothing is simulated");
  expect_refused("render small.json --out picture.png --size big", 1, "big");
  expect_refused("render small.json --out picture.mp4 --strip 0,2", 1, "--strip");
  expect_refused("render small.json --out picture.png --strip 0,2 --frame 3", 1, "--strip");
  std::ofstream(folder_ / "bad.json") << "{\"frames\": 3,}";
  expect_refused("run bad.json", 1, "bad.json:1");
  expect_refused("run 'no\nsuch.json'", 1, "no\\nsuch.json");
  EXPECT_EQ(files(), 2) << "an error left a file behind";
}

TEST_F(Command, AStripIsOnePictureOfSeveralFrames) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const Result result = pliant("render small.json --out strip.png --strip 2,0,4 --size 200x50 --quiet");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string bytes = slurp(folder_ / "strip.png");
  ASSERT_GT(bytes.size(), 24u);
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\xc8\0\0\0\x32", 8))
      << "width and height in the header of the file";
  expect_refused("render small.json --out strip.png --strip 0,1,2,3 --size 60x50", 1, "pixels");
}

TEST_F(Command, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const std::string line = "'" PLIANT_COMMAND "' schema >/dev/full 2>/dev/null";
  const int status = std::system(line.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  expect_refused("run small.json --quiet --report /dev/full", 1, "/dev/full");
}

TEST_F(Command, SchemaIsJson) {
  const Json schema = Json::parse(pliant("schema").out);
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
}

TEST_F(Command, ReportHoldsWhatIsPromised) {
  const Json json = report("--hash-frames --threads 2");
  for (const char* key : {"state_hash", "frames", "particles", "constraints", "ms_per_frame", "phases_ms", "residual",
                          "max_stretch", "mean_stretch", "nonfinite", "threads", "isa"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json.at("frames"), 4);
  EXPECT_EQ(json.at("particles"), 144);
  EXPECT_EQ(json.at("constraints").at("distance"), 385);  // 2 * 11 * 12 edges along the grid, 11 * 11 diagonals
  EXPECT_EQ(json.at("frame_hashes").size(), 4u);
  EXPECT_EQ(json.at("frame_hashes").back(), json.at("state_hash"));
  EXPECT_TRUE(json.at("nonfinite").is_null());
  EXPECT_GT(json.at("ms_per_frame").at("p95").get<double>(), 0);
}

TEST_F(Command, OverridesChangeTheRunAndNotItsBits) {
  const auto hash = [&](const std::string& arguments) { return report(arguments).at("state_hash").get<std::string>(); };
  const std::string plain = hash("");
  EXPECT_EQ(plain.size(), 64u);
  EXPECT_EQ(hash("--threads 1"), plain);
  EXPECT_EQ(hash("--threads 3"), plain);
  EXPECT_EQ(hash("--sequential"), plain);
  EXPECT_EQ(hash("--isa " + report("").at("isa").get<std::string>()), plain);
  EXPECT_NE(hash("--frames 3"), plain);
  EXPECT_NE(hash("--substeps 5"), plain);
  EXPECT_EQ(report("--frames 0").at("frames"), 0);
}

TEST_F(Command, ASweepMayBeNamedAndTheReportIsThatOfASceneThatNamesIt) {
  const std::string hanging = R"("pins": [{"particles": [0]}], "cloth": {"mesh")";
  std::string scene = small_scene(4);
  scene.replace(scene.find(R"("cloth": {"mesh")"), std::string(R"("cloth": {"mesh")").size(), hanging);
  const auto hash = [&](const std::string& settings, const std::string& arguments) {
    std::string with = scene;
    with.replace(with.find("\"substeps\": 4"), 13, settings);
    std::ofstream(folder_ / "small.json") << with;
    return report(arguments).at("state_hash").get<std::string>();
  };
  const std::string plain = hash(R"("substeps": 4, "sweep": "tiled")", ""),
                    named = hash(
                        R"("substeps": 3, "iterations": 2, "sweep": "chains", "sweep_options": {"tethers": true})", "");
  EXPECT_NE(plain, named);
  EXPECT_EQ(hash("\"substeps\": 4", "--sweep chains+tethers --substeps 3 --iterations 2"), named);
  EXPECT_EQ(hash(R"("substeps": 4, "sweep": "jacobi")", "--sweep tiled"), plain);
  EXPECT_EQ(hash(R"("substeps": 4, "sweep_options": {"tethers": true})", "--sweep chains --substeps 3 --iterations 2"),
            named)
      << "what the name does not say is the scene's";
  // An object's own sweep replaces that of the settings, and the command's replaces both; the report has what is used.
  const auto of_object = [&](const std::string& arguments) {
    std::string with = scene;
    with.replace(with.find(hanging), hanging.size(), R"("sweep": "jacobi", )" + hanging);
    std::ofstream(folder_ / "small.json") << with;
    return report(arguments);
  };
  EXPECT_EQ(of_object("").at("sweep"), "jacobi");
  EXPECT_EQ(of_object("--sweep tiled").at("sweep"), "tiled");
  EXPECT_EQ(of_object("--sweep tiled").at("state_hash"), plain);
  expect_refused("run small.json --sweep tilde", 1, "tiled, sequential, symmetric");
  expect_refused("run small.json --sweep tiled+lasers", 1, "tethers, chebyshev, average");
  expect_refused("run small.json --sweep chains --sequential", 2, "sequential");
  expect_refused("render small.json --out a.png --sweep tilde", 1, "tilde");
  expect_refused("render small.json --out a.png --substeps 0", 2, "substeps");
}

TEST_F(Command, PlainCodeGivesTheBitsOfTheSweepThatIsChosen) {
  std::ofstream(folder_ / "small.json") << R"({"frames": 3, "objects": [{"name": "sheet", "pins": [{"particles": [0]}],
      "cloth": {"mesh": {"grid": {"columns": 12, "rows": 12, "width": 1, "depth": 1}}}}]})";
  const nlohmann::json lanes = report(""), plain = report("--sequential");
  EXPECT_EQ(lanes.at("sweep"), "tethered_chains");
  EXPECT_EQ(plain.at("sweep"), "tethered_chains");
  EXPECT_EQ(plain.at("isa"), "sequential");
  EXPECT_EQ(plain.at("state_hash"), lanes.at("state_hash"));
}

TEST_F(Command, RenderDrawsWithTheSettingsThatAreGiven) {
  std::ofstream(folder_ / "sagging.json")
      << R"({"frames": 20, "settings": {"substeps": 4, "sweep": "tiled"}, "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 12, "rows": 12, "width": 1, "depth": 1}}, "stretch": {"compliance": 0}},
      "pins": [{"particles": [0, 11]}]}]})";
  const auto picture = [&](const std::string& arguments) {
    const Result result = pliant("render sagging.json --out picture.png --size 160x120 --quiet " + arguments);
    EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
    return slurp(folder_ / "picture.png");
  };
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const std::string plain = picture("");
  ASSERT_EQ(plain.substr(1, 3), "PNG");
  EXPECT_TRUE(picture("--sweep tiled --substeps 4 --iterations 1") == plain) << "what the scene says";
  for (const char* other : {"--substeps 8", "--iterations 4", "--sweep chains+tethers"})
    EXPECT_FALSE(picture(other) == plain) << other;
}

TEST_F(Command, SaysNothingInAPipeThatIsNoResult) {
  const Result result = pliant("run small.json");
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("state "), std::string::npos);
  EXPECT_EQ(pliant("run small.json --quiet").out, "");
}

TEST_F(Command, WritesEveryFormatThatWasAskedFor) {
  EXPECT_EQ(pliant("run small.json --quiet --out a.glb --out b.usda").status, 0);
  EXPECT_GT(fs::file_size(folder_ / "a.glb"), 144u * 12);
  EXPECT_GT(fs::file_size(folder_ / "b.usda"), 144u * 12);
}

/// The lines of a text that begin with "wrote ".
std::vector<std::string> wrote_lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("wrote ", 0) == 0) lines.push_back(line);
  return lines;
}

TEST_F(Command, RunSaysWhatItWrote) {
  const Result result = pliant("run small.json --frames 2 --out a.pc2 --out b.ply --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> lines = wrote_lines(result.out);
  ASSERT_EQ(lines.size(), 4U) << result.out;
  EXPECT_EQ(lines[0], "wrote a.pc2 (5.2 kB)") << "32 bytes, and three times 144 places of 12 bytes";
  EXPECT_EQ(lines[1].rfind("wrote a.obj (", 0), 0U) << lines[1];
  EXPECT_EQ(lines[2].rfind("wrote 3 files, b_0000.ply to b_0002.ply (", 0), 0U) << lines[2];
  EXPECT_EQ(lines[3].rfind("wrote r.json (", 0), 0U) << lines[3];
  EXPECT_EQ(fs::file_size(folder_ / "a.pc2"), 32U + 3 * 144 * 12);
  EXPECT_TRUE(wrote_lines(pliant("run small.json --frames 2").out).empty());
  const std::string none = pliant("run small.json --frames 0 --threads 1").out;
  EXPECT_EQ(none.rfind("small.json: 0 frames, 1 thread, ", 0), 0U) << none;
}

TEST_F(Command, AFrameThatIsNotThereIsRefused) {
  const std::string says = "small.json: there is no frame 5, it has 4 frames; name one from 0, the start, to 4";
  expect_refused("render small.json --out a.png --frame 5", 1, says);
  expect_refused("render small.json --out a.mp4 --frame 5", 1, says);
  expect_refused("render small.json --out a.png --strip 0,5", 1, says);
  expect_refused("compare small.json --frame 5", 1, says);
  EXPECT_EQ(files(), 1);
}

TEST_F(Command, AMeshForNobodyNamesThoseWhoHaveOne) {
  std::ofstream(folder_ / "a.obj") << "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n";
  expect_refused("run small.json --mesh clot=a.obj", 1, "did you mean 'cloth'? the scene has meshes for 'cloth'");
}

TEST_F(Command, KeepsDistanceGridsWhereItIsTold) {
  std::ofstream(folder_ / "grid.json") << R"({"frames": 2, "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 4, "rows": 4, "width": 1, "depth": 1}}}}],
      "colliders": [{"name": "ball", "mesh": {"sphere": {"radius": 0.3, "subdivisions": 1}},
                     "as": "distance_grid", "grid_spacing": 0.1}]})";
  const Result first = pliant("run grid.json --cache kept"), again = pliant("run grid.json --cache kept");
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "kept"), fs::directory_iterator{}), 1);
  const auto state = [](const Result& of) { return of.out.substr(of.out.find("state "), 70); };
  EXPECT_EQ(state(first), state(again));
  EXPECT_EQ(state(first), state(pliant("run grid.json")));
}

TEST_F(Command, AReportSaysHowManyIterationsATolerancePermitted) {
  const Json plain = report("--iterations 6").at("iterations_used");
  EXPECT_EQ(plain.at("smallest"), 6);
  EXPECT_EQ(plain.at("largest"), 6);
  std::string scene = small_scene(4);
  scene.replace(scene.find("\"substeps\""), 0, "\"iterations\": 50, \"tolerance\": 1000, ");
  std::ofstream(folder_ / "small.json") << scene;
  const Json json = report("");
  EXPECT_EQ(json.at("iterations"), 50);
  EXPECT_EQ(json.at("iterations_used").at("largest"), 1);
  EXPECT_EQ(json.at("iterations_used").at("mean"), 1);
}

TEST_F(Command, RunSaysWhatTore) {
  const auto write =
      [&](double force) {
        std::ofstream(folder_ / "hung.json")
            << R"({"frames": 4, "objects": [{"particles": {"positions": [[0, 0, 0], [0, -1, 0]], "masses": ["fixed", 2],
               "constraints": [{"type": "distance", "particles": [[0, 1]], "stiffness": {"compliance": 1e-4},
                                "break_force": )"
            << force << "}]}}]}";
      };
  write(1);
  const Result breaks = pliant("run hung.json");
  EXPECT_EQ(breaks.status, 0) << breaks.err;
  EXPECT_NE(breaks.out.find("tears: 1 constraint lost and 0 new particles, the first in frame 1"), std::string::npos)
      << breaks.out;
  write(1000);
  EXPECT_EQ(pliant("run hung.json").out.find("tears"), std::string::npos);
}

TEST_F(Command, AnInterruptedRunLeavesNothingHalfWritten) {
  std::ofstream(folder_ / "long.json") << small_scene(10000000);
  const int before = files();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (chdir(folder_.c_str()) != 0 || std::freopen("/dev/null", "w", stderr) == nullptr) _exit(99);
    execl(PLIANT_COMMAND, PLIANT_COMMAND, "run", "long.json", "--out", "long.pc2", "--report", "long-report.json",
          "--checkpoint", "c", "--every", "1", nullptr);
    _exit(98);
  }
  // Only once the run has begun, which the checkpoint shows, is there something to leave behind.
  for (int wait = 0; wait < 3000 && files() == before; ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GT(files(), before);
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGINT);
  EXPECT_EQ(files(), before + 1) << "the checkpoint alone";
}

/// One box lies on the ground and sleeps, another is thrown.
TEST_F(Command, SaysHowManyBodiesSleep) {
  std::ofstream(folder_ / "small.json") << R"({"frames": 90, "settings": {"sleep": {"on": true}},
    "objects": [{"name": "boxes", "bodies": [
      {"name": "still", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [0, 0.2, 0]},
      {"name": "thrown", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [4, 0.2, 0], "velocity": [0, 20, 0]}]}],
    "colliders": [{"plane": {}}]})";
  const Json json = report("");
  EXPECT_EQ(json.at("bodies"), 2);
  EXPECT_EQ(json.at("sleeping_bodies"), 1);
  EXPECT_EQ(json.at("widest_tie"), nullptr);
}

}  // namespace
}  // namespace pliant

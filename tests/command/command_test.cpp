// Tests the command as users see it: exit status, the one line on standard error, files that are complete or do not exist.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A temporary folder for one test.
class Command : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "pliant_command_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    std::ofstream(folder_ / "small.json") << small_scene(4);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A scene of a 12 x 12 cloth over a sphere.
  static std::string small_scene(int frames) {
    return R"({"frames": )" + std::to_string(frames) + R"(, "settings": {"substeps": 4},
      "objects": [{"cloth": {"mesh": {"grid": {"columns": 12, "rows": 12, "width": 1, "depth": 1}}, "material": "cotton"}}],
      "colliders": [{"sphere": {"radius": 0.3}, "position": [0, -0.4, 0]}]})";
  }

  struct Result {
    int status;
    std::string out, err;
  };

  /// Runs `pliant ARGUMENTS` through the shell in the test's folder.
  Result pliant(const std::string& arguments) {
    const std::string line = "cd '" + folder_.string() + "' && '" PLIANT_COMMAND "' " + arguments + " >stdout 2>stderr";
    const int status = std::system(line.c_str());
    Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder_ / "stdout"), slurp(folder_ / "stderr")};
    fs::remove(folder_ / "stdout");
    fs::remove(folder_ / "stderr");
    return result;
  }

  /// Why nothing can be drawn on this machine, found by the simplest picture. Empty if it can, or if that fails for
  /// another reason; then the tests must succeed in drawing.
  std::string why_nothing_is_drawn() {
    const Result probe = pliant("render small.json --out probe.png --frame 0 --size 16x16 --quiet");
    fs::remove(folder_ / "probe.png");
    for (const char* lack :
         {"pliant: pictures need EGL", "pliant: pictures need OpenGL", "pliant: EGL gives no OpenGL 3.3 context"})
      if (probe.status != 0 && probe.err.rfind(lack, 0) == 0) return probe.err;
    return "";
  }

  /// Expects that the command fails with this status and one line that contains `word`.
  void expect_refused(const std::string& arguments, int status, const std::string& word) {
    SCOPED_TRACE(arguments);
    const Result result = pliant(arguments);
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.err.rfind("pliant: ", 0), 0u) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  }

  Json report(const std::string& arguments) {
    const Result result = pliant("run small.json --quiet --report report.json " + arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(slurp(folder_ / "report.json"));
  }

  int files() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator())); }

  fs::path folder_;
};

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

TEST_F(Command, UsageErrorsGiveTwo) {
  expect_refused("", 2, "no subcommand");
  expect_refused("fly", 2, "fly");
  expect_refused("rnu small.json", 2, "did you mean 'run'? the subcommands are run, render, check, validate, bench, ");
  expect_refused("run small.json --frame 3", 2, "did you mean '--frames'? see pliant run --help");
  expect_refused("run small.json --zzz 3", 2, "--zzz; see pliant run --help");
  expect_refused("bench W1-bendin", 1, "did you mean 'W1-bending'? the workloads are ");
  expect_refused("bench defaul", 1, "did you mean 'default'? ");
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
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\xc8\0\0\0\x32", 8)) << "width and height in the header of the file";
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
  EXPECT_EQ(hash("--isa x86-64-v2"), plain);
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
                    named = hash(R"("substeps": 3, "iterations": 2, "sweep": "chains", "sweep_options": {"tethers": true})",
                                 "");
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

class Mended : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    std::ofstream(folder_ / "patch.obj") << "v 0 0 0\nv 0 0 2\nv 3 0 0\nv 9 9 9\nf 1 2 3\n";
    std::ofstream(folder_ / "patch.json")
        << R"({"frames": 1, "objects": [{"name": "p", "cloth": {"mesh": {"file": "patch.obj"}}}]})";
  }
  const std::string line = "repaired: object 'p', patch.obj: dropped 1 vertex of no triangle, the first 3\n";
};

TEST_F(Mended, IsSaidByRunAsByCheck) {
  EXPECT_NE(pliant("check patch.json").out.find(line), std::string::npos);
  const Result run = pliant("run patch.json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.rfind(line, 0), 0u) << run.out;
  EXPECT_EQ(pliant("run patch.json --quiet").out, "");
}

TEST_F(Mended, IsSaidByRender) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const Result drawn = pliant("render patch.json --out patch.png --size 64x48");
  EXPECT_EQ(drawn.out, line + "wrote patch.png\n") << drawn.err;
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

TEST_F(Command, CheckFindsNothingWrongInASoundScene) {
  const Result result = pliant("check small.json");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("1 object of 144 particles, 1 x 0 x 1 m"), std::string::npos) << result.out;
}

TEST_F(Command, CheckRunsASceneAndNamesTheDefaultThatWouldMendIt) {
  std::ofstream(folder_ / "sagging.json") << R"({"frames": 20, "settings": {"sweep": "tiled", "substeps": 2},
      "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 12, "rows": 12, "width": 1, "depth": 1}}, "stretch": {"compliance": 0}},
      "pins": [{"particles": [0, 11]}]}]})";
  const Result result = pliant("check sagging.json --seconds 600");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("doubtful: in frame "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("object 'sheet': stretched "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" keeps all edges within 10 % and 99 in 100 within 2 % of the length"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("remove \"sweep\" and \"substeps\" from the scene's \"settings\"\n"), std::string::npos)
      << result.out;
  EXPECT_EQ(result.out.find("--seconds"), std::string::npos) << "there was time enough";
  EXPECT_LE(longest_line(result.out), 180u) << result.out;
  EXPECT_EQ(pliant("check sagging.json --seconds 0").out.find("stretched"), std::string::npos) << "not run at all";

  Json scene = Json::parse(slurp(folder_ / "sagging.json"));
  scene["gravity"] = {0, -1e5, 0};
  std::ofstream(folder_ / "heavy.json") << scene.dump();
  const std::string hasty = pliant("check heavy.json --seconds 1e-3").out;
  EXPECT_NE(hasty.find(" --seconds 0.03 tries more\n"), std::string::npos) << hasty;
  scene.erase("gravity");
  scene["settings"].erase("sweep");
  scene["settings"].erase("substeps");
  std::ofstream(folder_ / "mended.json") << scene.dump();
  const std::string short_run = pliant("check mended.json --seconds 1e-6").out;
  EXPECT_NE(short_run.find("\nnothing wrong, nothing doubtful in 1 of 20 frames\n"), std::string::npos) << short_run;
  EXPECT_NE(pliant("check mended.json --seconds 600").out.find("nothing wrong, nothing doubtful"), std::string::npos);
  expect_refused("check sagging.json --seconds -1", 2, "seconds");
}

/// A default that does not suffice: several iterations make it `tiled` with 20 substeps.
TEST_F(Command, CheckNamesSettingsWhereTheDefaultDoesNotSuffice) {
  std::ofstream(folder_ / "sagging.json") << R"({"frames": 20, "settings": {"iterations": 2}, "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 32, "rows": 32, "width": 1, "depth": 1}}, "stretch": {"compliance": 0}},
      "pins": [{"particles": [0, 31]}]}]})";
  const Result result = pliant("check sagging.json --seconds 600");
  const std::string mark = "add to the scene's \"settings\": ";
  const std::size_t at = result.out.find(mark);
  ASSERT_NE(at, std::string::npos) << result.out;
  const std::size_t end = result.out.find('\n', at);
  Json scene = Json::parse(slurp(folder_ / "sagging.json"));
  scene["settings"].update(Json::parse(result.out.substr(at + mark.size(), end - at - mark.size())));
  std::ofstream(folder_ / "mended.json") << scene.dump();
  EXPECT_NE(pliant("check mended.json --seconds 600").out.find("nothing wrong, nothing doubtful"), std::string::npos);
}

TEST_F(Command, CheckTellsAMeshItsSizeAndWhatWasMended) {
  std::ofstream(folder_ / "patch.obj") << "v 0 0 0\nv 0 0 20\nv 30 0 0\nv 9 9 9\nf 1 2 3\n";
  const Result result = pliant("check patch.obj");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.rfind("patch.obj: 3 vertices, 1 triangle, 30 x 0 x 20 m", 0), 0u) << result.out;
  EXPECT_NE(result.out.find("\nrepaired: dropped 1 vertex of no triangle, the first 3\nthe indices below"),
            std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("\nnote: open, with 1 border of 3 edges"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("doubtful"), std::string::npos) << "a border is right for a cloth:\n" << result.out;
  std::ofstream(folder_ / "patch.json") << R"({"objects": [{"cloth": {"mesh": {"file": "patch.obj"}}}]})";
  EXPECT_NE(pliant("check patch.json").out.find("dropped 1 vertex of no triangle"), std::string::npos);
}

TEST_F(Command, CompareShowsEverySweepAndWritesPictureAndNumbers) {
  const Result result = pliant("compare small.json --iterations 3 --out curves.png --out curves.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("small.json after 2 frames"), std::string::npos) << result.out;
  for (const char* sweep : {"\ntiled ", "\nsymmetric ", "\njacobi ", "\nnatural ", "\nchains ", "\ntiled+chebyshev "})
    EXPECT_NE(result.out.find(sweep), std::string::npos) << sweep << result.out;
  EXPECT_NE(result.out.find("; its curve is that of its sweep, and --budget-ms runs it too\n"), std::string::npos)
      << result.out;
  EXPECT_EQ(result.out.find("almost at rest"), std::string::npos) << result.out;
  EXPECT_EQ(slurp(folder_ / "curves.png").substr(1, 3), "PNG");
  const Json json = Json::parse(slurp(folder_ / "curves.json"));
  EXPECT_EQ(json.at("iterations"), 3);
  EXPECT_GE(json.at("curves").size(), 6u);
  const Result few =
      pliant("compare small.json --iterations 2 --sweeps tiled,natural+chebyshev --frame 1 --frames 2 --budget-ms 100000");
  EXPECT_EQ(few.status, 0) << few.err;
  EXPECT_NE(few.out.find("left out: natural+chebyshev: "), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("within 100000 ms per frame, 2 frames"), std::string::npos) << few.out;
}

TEST_F(Command, CompareSaysThatASceneIsAtRest) {
  Json scene = Json::parse(small_scene(4));
  scene["gravity"] = {0, 0, 0};
  std::ofstream(folder_ / "small.json") << scene.dump();
  const std::string out = pliant("compare small.json --iterations 2 --sweeps tiled").out;
  EXPECT_NE(out.find("the scene is almost at rest there, at 0 m/s in the mean: choose a --frame in motion\n"),
            std::string::npos)
      << out;
}

TEST_F(Command, CompareRefusesWhatItCannotDo) {
  expect_refused("compare", 2, "SCENE");
  expect_refused("compare small.json --iterations 0", 2, "iterations");
  expect_refused("compare small.json --budget-ms -1", 2, "budget-ms");
  expect_refused("compare small.json --sweeps tilde", 1, "tilde");
  expect_refused("compare small.json --sweeps natural+chebyshev", 1, "natural order");
  expect_refused("compare small.json --out curves.gif", 1, "curves.gif");
  expect_refused("compare small.json --out small.json", 1, "twice");
  expect_refused("compare small.json --out a.png --out b.png", 1, "b.png");
  expect_refused("compare small.json --out nowhere/a.json", 1, "nowhere");
  expect_refused("compare small.json --frames 0 --budget-ms 1", 1, "--frames");
  EXPECT_EQ(slurp(folder_ / "small.json"), small_scene(4)) << "what was read is written over";
  EXPECT_EQ(files(), 1) << "an error left a file behind";
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
  for (int wait = 0; wait < 3000 && files() == before; ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(10));
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

/// Two boxes of 0.2 m x 0.4 m x 0.6 m, 4 m apart along x.
TEST_F(Command, CheckCountsSolidsInTheSize) {
  std::ofstream(folder_ / "boxes.json") << R"({"frames": 1, "objects": [{"name": "boxes", "bodies": [
      {"name": "a", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [0, 0.2, 0]},
      {"name": "b", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [4, 0.2, 0]}]}]})";
  const Result result = pliant("check boxes.json");
  EXPECT_NE(result.out.find("of 2 particles, 4.2 x 0.4 x 0.6 m"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("moves freely"), std::string::npos) << result.out;
}

}  // namespace

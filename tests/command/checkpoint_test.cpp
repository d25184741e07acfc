// Tests pliant run --checkpoint and --resume: the bits of a run that never stopped, however and whenever it was
// stopped.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/save.h"

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// A temporary folder with a scene, for one test.
class Checkpoint : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "pliant_checkpoint_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    write_scene("small.json", 12, 30);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_scene(const std::string& name, int side, int frames) const {
    const std::string count = std::to_string(side);
    std::ofstream(folder_ / name) << R"({"frames": )" << frames
                                  << R"(, "settings": {"substeps": 4}, "objects": [{"cloth":
      {"mesh": {"grid": {"columns": )"
                                  << count << R"(, "rows": )" << count << R"(, "width": 1, "depth": 1}}}}],
      "colliders": [{"sphere": {"radius": 0.3}, "position": [0, -0.4, 0]}]})";
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Starts `pliant run` with these arguments in the test's folder. Its output goes to the file "said".
  pid_t start(std::vector<std::string> arguments, const char* subcommand = "run") const {
    arguments.insert(arguments.begin(), {"pliant", subcommand});
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder_.c_str()) != 0 || std::freopen("said", "w", stderr) == nullptr) _exit(99);
    if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(99);
    execv(PLIANT_COMMAND, words.data());
    _exit(98);
  }

  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  int run(const std::vector<std::string>& arguments) const { return wait_for(start(arguments)); }

  std::string said() const {
    std::ifstream file(folder_ / "said");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  fs::path folder_;
};

/// The hash of the State of a scene after a number of frames; ask for increasing numbers.
class Uninterrupted {
 public:
  explicit Uninterrupted(const pliant::Scene& scene) : scene_(scene), world_(scene) {}
  std::string after(std::int64_t frame) {
    while (world_.state().frame < frame) world_.step(scene_.frame_time);
    return world_.state_hash();
  }

 private:
  pliant::Scene scene_;
  pliant::World world_;
};

TEST_F(Checkpoint, GoesOnInTheBitsOfTheRunThatNeverStopped) {
  Uninterrupted whole(pliant::read_scene(path("small.json")));
  for (const int frames : {7, 10, 29}) {
    ASSERT_EQ(run({"small.json", "--frames", std::to_string(frames), "--checkpoint", "kept/a", "--every", "4"}), 0)
        << said();
    ASSERT_EQ(pliant::load_state(path("kept/a")).frame, frames) << "also at the end";
    ASSERT_EQ(run({"small.json", "--resume", "kept/a", "--checkpoint", "kept/b", "--threads", "1"}), 0) << said();
    const pliant::State end = pliant::load_state(path("kept/b"));
    EXPECT_EQ(end.frame, 30);
  }
  EXPECT_EQ(hash(pliant::load_state(path("kept/b"))), whole.after(30));
}

TEST_F(Checkpoint, GeometryIsNumberedByTheFramesOfTheWholeRun) {
  ASSERT_EQ(run({"small.json", "--frames", "3", "--checkpoint", "a", "--out", "g/f.ply"}), 0) << said();
  ASSERT_EQ(run({"small.json", "--frames", "5", "--resume", "a", "--out", "g/f.ply"}), 0) << said();
  for (const char* name : {"0000", "0003", "0004", "0005"})
    EXPECT_TRUE(fs::exists(folder_ / "g" / ("f_" + std::string(name) + ".ply")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "g"), fs::directory_iterator()), 6);
}

/// Cloth of more than one tile, whose schedule is kept when it is cut, and rods that lose joints.
void write_cut_scene(const fs::path& to) {
  std::ofstream(to) << R"({"frames": 24, "settings": {"substeps": 2}, "objects": [
    {"name": "sheet", "cloth": {"mesh": {"grid": {"columns": 50, "rows": 50, "width": 1, "depth": 1}}},
     "pins": [{"particles": [0, 49]}],
     "cuts": [{"start": 0.05, "end": 0.3, "point": [0, 0, -0.6], "normal": [1, 0, 0], "along": [0, 0, 2]}]},
    {"name": "wire", "rod": {"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 9}, "radius": 0.01, "material": "rubber cord",
     "start": {"clamped": "world"}},
     "cuts": [{"start": 0.1, "end": 0.2, "point": [2.5, 0, -0.1], "normal": [1, 0, 0], "along": [0, 0, 2]}]}]})";
}

TEST_F(Checkpoint, ObjectsThatWereCutGoOnInTheSameBits) {
  write_cut_scene(folder_ / "cut.json");
  Uninterrupted whole(pliant::read_scene(path("cut.json")));
  for (const int frames : {2, 12, 20}) {
    ASSERT_EQ(run({"cut.json", "--frames", std::to_string(frames), "--checkpoint", "a"}), 0) << said();
    ASSERT_EQ(run({"cut.json", "--resume", "a", "--checkpoint", "b", "--threads", "1", "--out", "end/f.ply"}), 0)
        << said();
  }
  const pliant::LoadedWorld end = pliant::load_world(path("b"));
  EXPECT_EQ(end.world.state_hash(), whole.after(24));
  EXPECT_GT(end.world.object(0).info().particles, 2500) << "it was cut";
  EXPECT_FALSE(end.world.state().broken_joints.empty());
  EXPECT_EQ(run({"cut.json", "--resume", "b", "--frames", "30", "--substeps", "3"}), 1);
  EXPECT_NE(said().find("pliant: b: was saved with other settings"), std::string::npos) << said();
  EXPECT_EQ(run({"small.json", "--resume", "b"}), 1);
  EXPECT_NE(said().find("pliant: b: "), std::string::npos) << said();
}

TEST_F(Checkpoint, ASignalLeavesTheLastWholeFrameOfObjectsThatWereCut) {
  write_cut_scene(folder_ / "cut.json");
  const pid_t child = start({"cut.json", "--frames", "100000", "--checkpoint", "a", "--every", "100000"});
  std::this_thread::sleep_for(2s);
  kill(child, SIGINT);
  ASSERT_EQ(wait_for(child), 128 + SIGINT) << said();
  const pliant::LoadedWorld found = pliant::load_world(path("a"));
  Uninterrupted whole(pliant::read_scene(path("cut.json")));
  EXPECT_EQ(found.world.state_hash(), whole.after(found.world.state().frame));
}

TEST_F(Checkpoint, WhatDoesNotFitIsRefusedWithTheReason) {
  ASSERT_EQ(run({"small.json", "--frames", "5", "--checkpoint", "a"}), 0) << said();
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    EXPECT_EQ(run(arguments), 1);
    EXPECT_NE(said().find(why), std::string::npos) << said();
  };
  write_scene("other.json", 13, 30);
  refused({"other.json", "--resume", "a"}, "pliant: a: was saved with another scene");
  refused({"small.json", "--resume", "a", "--substeps", "5"}, "pliant: a: was saved with other settings");
  refused({"small.json", "--resume", "a", "--frames", "4"}, "is of frame 5, beyond the 4 frames");
  refused({"small.json", "--resume", "a", "--report", "a"}, "a: is named twice");
  refused({"small.json", "--resume", "small.json"}, "small.json: is not a file saved by Pliant");
  refused({"small.json", "--resume", "."}, "is a folder");
  refused({"small.json", "--checkpoint", "."}, "cannot write: it is a folder");
  refused({"small.json", "--checkpoint", "small.json/a"}, "is not a folder");
  fs::resize_file(folder_ / "a", 1000);
  refused({"small.json", "--resume", "a"}, "pliant: a: is incomplete");
}

/// A frame of 10000 substeps of 1000 iterations takes an hour.
TEST_F(Checkpoint, ASignalEndsAFrameThatTakesAnHour) {
  write_scene("slow.json", 60, 30);
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = start({"slow.json", "--checkpoint", "c", "--substeps", "10000", "--iterations", "1000"});
    std::this_thread::sleep_for(1s);
    kill(child, signal);
    EXPECT_EQ(wait_for(child), 128 + signal) << said();
    EXPECT_NE(said().find("pliant: ended by "), std::string::npos) << said();
    if (fs::exists(folder_ / "c")) {
      EXPECT_EQ(pliant::load_state(path("c")).frame, 0);
    }
  }
}

/// A signal must also end a program that does not read the flag.
TEST_F(Checkpoint, ASignalEndsWhatLooksAtNoFlag) {
  const pid_t child = start({"W1-stretching", "--frames", "1000000", "--sizes", "64", "--json", "rows.json"}, "bench");
  std::this_thread::sleep_for(1s);
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 128 + SIGTERM) << said();
  EXPECT_NE(said().find("pliant: ended by SIGTERM; no unfinished file is left behind"), std::string::npos) << said();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2)
      << "the scene and what was said";
}

/// The environment variable PLIANT_KILLS sets how many kills are made; 30 by default.
TEST_F(Checkpoint, AKillAtAnyMomentLeavesAWholeFile) {
  const char* const wanted = std::getenv("PLIANT_KILLS");
  const int kills = wanted != nullptr ? std::atoi(wanted) : 30;
  Uninterrupted whole(pliant::read_scene(path("small.json")));
  std::mt19937 random(11);
  std::int64_t frame = 0, most = 0;
  int moved = 0;
  for (int kill_number = 0; kill_number < kills; ++kill_number) {
    std::vector<std::string> arguments{"small.json", "--frames",  "100000000", "--checkpoint", "c", "--every",
                                       "1",          "--threads", "1"};
    if (fs::exists(folder_ / "c")) arguments.insert(arguments.end(), {"--resume", "c"});
    const pid_t child = start(arguments);
    std::this_thread::sleep_for(std::chrono::microseconds(10000 + random() % 60000));
    kill(child, SIGKILL);
    ASSERT_EQ(wait_for(child), -SIGKILL) << said();
    if (!fs::exists(folder_ / "c")) continue;
    pliant::State state;
    ASSERT_NO_THROW(state = pliant::load_state(path("c"))) << "after kill " << kill_number;
    ASSERT_GE(state.frame, frame);
    ASSERT_EQ(hash(state), whole.after(state.frame)) << "after kill " << kill_number;
    moved += state.frame > frame ? 1 : 0;
    most = std::max(most, state.frame - frame);
    frame = state.frame;
  }
  EXPECT_GT(moved, kills / 10) << "too few kills fell where there was anything to spoil";
  std::printf("%d kills, %d after at least one file of their run, at most %d files of a run; frame %d reached\n", kills,
              moved, static_cast<int>(most), static_cast<int>(frame));
}

TEST_F(Checkpoint, AFullDiskEndsTheRunAndLeavesTheOldFile) {
  ASSERT_EQ(run({"small.json", "--frames", "3", "--checkpoint", "c"}), 0) << said();
  const std::string before = hash(pliant::load_state(path("c")));
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(run({"small.json", "--resume", "c", "--checkpoint", "c"}));
  }
  EXPECT_EQ(wait_for(child), 1);
  EXPECT_EQ(said().rfind("pliant: c: cannot write: ", 0), 0u) << said();
  EXPECT_EQ(hash(pliant::load_state(path("c"))), before);
}

}  // namespace

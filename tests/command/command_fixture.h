// Runs the command in a temporary folder, as a user's shell does.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace pliant {

namespace fs = std::filesystem;
using Json = nlohmann::json;

inline std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
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

  Result pliant(const std::string& arguments) { return run_program(PLIANT_COMMAND, arguments); }

  /// Runs `PROGRAM ARGUMENTS` through the shell in the test's folder.
  Result run_program(const std::string& program, const std::string& arguments) {
    const std::string line = "cd '" + folder_.string() + "' && '" + program + "' " + arguments + " >stdout 2>stderr";
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

  int files() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

}  // namespace pliant

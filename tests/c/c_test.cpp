// The C library from a program in C99: all its functions, and the bits of the C++ library.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pliant/io.h"
#include "support/paths.h"

namespace pliant {
namespace {

struct Output {
  int status = 0;
  std::string text;
};

/// Runs the program in C and reads what it prints.
Output called(const std::string& arguments) {
  Output output;
  FILE* pipe = popen((PLIANT_C_CALLS " " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    output.text.append(block.data(), n);
  output.status = pclose(pipe);
  return output;
}

class CBits : public ::testing::TestWithParam<const char*> {};

TEST_P(CBits, AreThoseOfTheCppLibrary) {
  constexpr int frames = 5;
  const std::string path = test::in_tree(std::string("scenes/") + GetParam() + ".json");
  const Scene scene = read_scene(path);
  World world(scene);
  for (int i = 0; i < frames; ++i) world.step(scene.frame_time);
  const Output output = called("hash " + path + " " + std::to_string(frames));
  EXPECT_EQ(output.status, 0);
  EXPECT_EQ(output.text, world.state_hash() + "\n");
}

INSTANTIATE_TEST_SUITE_P(Scenes, CBits,
                         ::testing::Values("rope", "hanging_cloth", "box_edge", "bodies/cradle", "joints/gear",
                                           "contact/heightfield", "gas/balloon"),
                         [](const auto& of) {
                           std::string name = of.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

TEST(C, EveryFunctionDoesWhatItsCommentSays) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("pliant_c_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const Output output = called("check " + folder.string());
  std::filesystem::remove_all(folder);
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_EQ(output.text, "0 checks failed\n");
}

/// The member of a tree that a path with points names.
nlohmann::json member(const nlohmann::json& of, const std::string& path) {
  std::string pointer = "/" + path;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return of.at(nlohmann::json::json_pointer(pointer));
}

TEST(C, NumbersOfAReportAreThoseOfItsJson) {
  const Output output = called("report " + test::in_tree("scenes/box_edge.json") + " 20");
  ASSERT_EQ(output.status, 0) << output.text;
  std::istringstream lines(output.text);
  std::string line, name;
  std::getline(lines, line);
  const nlohmann::json report = nlohmann::json::parse(line);
  int numbers = 0, of_contact = 0;
  for (double value = 0; lines >> name >> value; ++numbers) {
    of_contact += name.rfind("pairs.", 0) == 0;
    if (name.rfind("widest_tie.", 0) == 0) continue;  // null in this scene
    EXPECT_EQ(member(report, name).get<double>(), value) << name;
  }
  EXPECT_EQ(of_contact, static_cast<int>(report["pairs"].size()));
  EXPECT_GE(numbers, 40);
}

}  // namespace
}  // namespace pliant

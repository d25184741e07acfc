// Tests that `pliant` runs pliant-measure for bench, compare and validate, and what it says where that program is
// missing.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "command/command_fixture.h"

namespace pliant {
namespace {

using Measure = Command;

TEST_F(Measure, HelpIsThatOfTheSubcommand) {
  const std::string all = pliant("--help").out;
  const auto expect_help = [&](const std::string& subcommand, const std::string& option) {
    SCOPED_TRACE(subcommand);
    const Result help = pliant(subcommand + " --help");
    EXPECT_EQ(help.status, 0) << help.err;
    EXPECT_NE(help.out.find("Usage: pliant " + subcommand + " [OPTIONS]"), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("\n  " + option + " "), std::string::npos) << help.out;
    EXPECT_EQ(pliant("--help " + subcommand).out, help.out);
    const std::string description = help.out.substr(0, help.out.find('\n'));
    const std::size_t listed = all.find("\n  " + subcommand + " ");
    ASSERT_NE(listed, std::string::npos) << all;
    EXPECT_NE(all.substr(listed, all.find('\n', listed + 1) - listed).find(description), std::string::npos) << all;
  };
  expect_help("bench", "--against");
  expect_help("compare", "--budget-ms");
  expect_help("validate", "--queries");
}

TEST_F(Measure, ArgumentsAndExitStatusesPassThrough) {
  expect_refused("bench --frame 3", 2, "did you mean '--frames'? see pliant bench --help");
  expect_refused("validate --slo", 2, "did you mean '--slow'? see pliant validate --help");
  expect_refused("compare small.json --frames -1", 2, "see pliant compare --help");
  expect_refused("compare 'no such\nscene.json'", 1, "no such\\nscene.json");
  expect_refused("bench default --scenes small.json --settings 'chains 0'", 1, "'chains 0'");
  expect_refused("fly bench --frame 3", 2, "did you mean '--frames'? see pliant bench --help");
  fs::rename(folder_ / "small.json", folder_ / "bench");
  EXPECT_EQ(pliant("run bench --quiet --frames 0").status, 0) << "a scene, which is no subcommand";
}

/// True once a process handles SIGINT.
bool catches_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
  return false;
}

TEST_F(Measure, CtrlCEndsAComparisonAndLeavesNoFile) {
  std::ofstream(folder_ / "long.json") << small_scene(10000000);
  const int before = files();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (chdir(folder_.c_str()) != 0 || std::freopen("/dev/null", "w", stderr) == nullptr) _exit(99);
    execl(PLIANT_COMMAND, PLIANT_COMMAND, "compare", "long.json", "--out", "curves.json", nullptr);
    _exit(98);
  }
  for (int wait = 0; wait < 3000 && !catches_interrupts(child); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGINT);
  EXPECT_EQ(files(), before);
}

TEST_F(Measure, IsFoundThroughASymbolicLink) {
  fs::create_symlink(PLIANT_COMMAND, folder_ / "linked");
  EXPECT_EQ(run_program((folder_ / "linked").string(), "bench --help").out, pliant("bench --help").out);
}

/// A copy of `pliant` without pliant-measure.
class Alone : public Command {
 protected:
  void copy_to(const fs::path& folder) {
    fs::create_directories(folder);
    program_ = folder / "pliant";
    fs::copy_file(PLIANT_COMMAND, program_);
  }

  void expect_missing(const std::string& arguments, const std::string& word) {
    SCOPED_TRACE(arguments);
    const Result result = run_program(program_.string(), arguments);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.err.rfind("pliant: '" + arguments.substr(0, arguments.find(' ')), 0), 0U) << result.err;
    EXPECT_NE(result.err.find("' is in the program pliant-measure, which is not " + word), std::string::npos)
        << result.err;
  }

  fs::path program_;
};

TEST_F(Alone, SaysHowToBuildWhatIsMissing) {
  copy_to(folder_ / "prefix" / "bin");
  const std::string elsewhere =
      "installed; build it where pliant was built, with cmake --build FOLDER --target pliant_measure, and install "
      "again\n";
  for (const char* arguments : {"bench", "validate contact", "compare --help"}) expect_missing(arguments, elsewhere);
}

TEST_F(Alone, NamesTheBuildFolderThatItLiesIn) {
  copy_to(folder_ / "build" / "bin");
  std::ofstream(folder_ / "build" / "CMakeCache.txt") << "";
  expect_missing("bench W1", "built; build it with: cmake --build " + (fs::canonical(folder_) / "build").string() +
                                 " --target pliant_measure\n");
}

TEST_F(Alone, DoesAllElse) {
  copy_to(folder_ / "bin");
  const auto out = [&](const std::string& arguments) { return run_program(program_.string(), arguments).out; };
  EXPECT_EQ(out("version"), pliant("version").out);
  EXPECT_EQ(out("--help"), pliant("--help").out);
  EXPECT_NE(out("run small.json").find("\nstate "), std::string::npos);
}

TEST_F(Alone, SaysWhyTheOtherProgramCannotRun) {
  copy_to(folder_ / "bin");
  std::ofstream(folder_ / "bin" / "pliant-measure") << "not executable";
  const Result result = run_program(program_.string(), "bench");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("/bin/pliant-measure: cannot run it for 'bench': Permission denied\n"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace pliant

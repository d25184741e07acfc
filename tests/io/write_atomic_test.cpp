// Tests that a file is written completely, or the old one stays and an Error names the path.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "io/atomic_file.h"
#include "io/write_spool.h"
#include "pliant/error.h"
#include "write_support.h"

namespace pliant {
namespace {

using test::Folder;

/// The text of the Error that `action` throws; empty if it throws none.
template <class Action>
std::string problem(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const Folder folder;
  const std::string path = folder / "file";
  {
    AtomicFile file(path);
    file.write("one ");
    file.write(std::string(1 << 20, 'x'));
    file.write("two");
    file.overwrite(0, "ONE", 3);
    EXPECT_EQ(file.size(), (1u << 20) + 7);
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  const std::string text = test::read(path);
  EXPECT_EQ(text.size(), (1u << 20) + 7);
  EXPECT_EQ(text.substr(0, 5), "ONE x");
  EXPECT_EQ(text.substr(text.size() - 4), "xtwo");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, LeavesTheOldFileWhenDropped) {
  const Folder folder;
  test::put(folder / "file", "old");
  { AtomicFile(folder / "file").write("new"); }
  EXPECT_EQ(test::read(folder / "file"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
  const Folder folder;
  test::put(folder / "file", "old");
  ASSERT_EQ(chmod((folder / "file").c_str(), 0640), 0);
  std::filesystem::create_symlink("file", folder / "link");
  AtomicFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(test::read(folder / "file"), "new");
  struct stat status {};
  ASSERT_EQ(stat((folder / "file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(AtomicFile, NamesThePathThatCannotBe) {
  const Folder folder;
  for (const std::string& path : {folder / "missing/file", folder.path(), std::string("/proc/pliant/file")}) {
    const std::string text = problem([&] { AtomicFile file(path); });
    EXPECT_NE(text.find(path), std::string::npos) << text;
  }
  EXPECT_NE(problem([] { AtomicFile file(""); }), "");
}

TEST(AtomicFile, ReportsAFullDevice) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const std::string text = problem([] {
    AtomicFile file("/dev/full");
    file.write("anything");
    file.commit();
  });
  EXPECT_NE(text.find("/dev/full"), std::string::npos) << text;
  EXPECT_NE(text.find("space"), std::string::npos) << text;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

/// The exit status of `action` in a child process.
template <class Action>
int in_child(Action action) {
  const pid_t child = fork();
  if (child == 0) _exit(action());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(AtomicFile, RefusesAFolderOrFileThatIsReadOnly) {
  const Folder open, folder;
  test::put(open / "file", "old");
  ASSERT_EQ(chmod((open / "file").c_str(), 0444), 0);
  ASSERT_EQ(chmod(open.path().c_str(), 0777), 0);
  ASSERT_EQ(chmod(folder.path().c_str(), 0555), 0);
  // Root may write anywhere, so the child runs as the user nobody.
  const int refused = in_child([&] {
    if (geteuid() == 0 && setuid(65534) != 0) return 0;
    int count = 0;
    for (const std::string& path : {open / "file", folder / "file"}) {
      if (problem([&] { AtomicFile file(path); }).find(path) != std::string::npos) ++count;
    }
    return count;
  });
  EXPECT_EQ(refused, 2);
  EXPECT_EQ(test::read(open / "file"), "old");
  EXPECT_EQ(open.names().size(), 1u);
}

/// Runs `action` in a child process in which no file may grow longer than `bytes`.
template <class Action>
int with_a_full_disk(rlim_t bytes, Action action) {
  return in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    return action();
  });
}

TEST(AtomicFile, LeavesTheOldFileWhenTheDiskIsFull) {
  const Folder folder;
  const std::string path = folder / "file";
  test::put(path, "old");
  for (const std::size_t size : {std::size_t{5000}, std::size_t{1} << 20}) {
    const int status = with_a_full_disk(4096, [&] {
      const std::string text = problem([&] {
        AtomicFile file(path);
        file.write(std::string(size, 'x'));
        file.commit();
      });
      return text.find(path) != std::string::npos ? 42 : 1;
    });
    EXPECT_EQ(status, 42);
    EXPECT_EQ(test::read(path), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
  }
}

TEST(Spool, GivesBackWhatWasWritten) {
  const Folder folder;
  output::Spool spool(folder / "file");
  std::string all;
  for (int i = 0; i < 1000; ++i) {
    const std::string piece(static_cast<std::size_t>(i), static_cast<char>('a' + i % 26));
    spool.write(piece);
    all += piece;
  }
  EXPECT_EQ(spool.size(), all.size());
  EXPECT_TRUE(folder.names().empty());
  AtomicFile file(folder / "file");
  spool.copy_to(file);
  file.commit();
  EXPECT_EQ(test::read(folder / "file"), all);
}

/// While it exists no file can be opened. Sanitizers open files of their own, so it must end before the test fails.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(Spool, SaysWhatToDoWhereNoMoreFilesMayBeOpen) {
  const Folder folder;
  const std::string text = problem([&] {
    const NoMoreFiles none;
    output::Spool spool(folder / "file");
  });
  EXPECT_NE(text.find("ulimit -n"), std::string::npos) << text;
}

TEST(FormatWriters, LeaveTheOldFilesWhenTheDiskIsFull) {
  for (const std::string suffix : {"obj", "ply", "glb", "usda", "pc2", "pvd"}) {
    const Folder folder;
    const std::string old = "# the mesh that was there before";  // a point cache may replace it
    test::put(folder / ("run." + suffix), old);
    test::put(folder / "run.obj", old);
    const int status = with_a_full_disk(64, [&] {
      const std::string text = problem([&] { test::write_sample(folder / ("run." + suffix), 9); });
      return text.find(folder / "run") != std::string::npos ? 42 : 1;
    });
    EXPECT_EQ(status, 42) << suffix;
    EXPECT_EQ(test::read(folder / ("run." + suffix)), old) << suffix;
    EXPECT_EQ(test::read(folder / "run.obj"), old) << suffix;
    for (const std::string& name : folder.names()) EXPECT_EQ(name[0], 'r') << suffix << " left " << name;
  }
}

TEST(FormatWriters, NameTheFolderThatIsMissing) {
  const Folder folder;
  for (const std::string suffix : {"obj", "ply", "glb", "usda", "pc2", "pvd"}) {
    const std::string text = problem([&] { test::write_sample(folder / ("missing/run." + suffix), 2); });
    EXPECT_NE(text.find("missing/run"), std::string::npos) << suffix << ": " << text;
  }
}

TEST(FormatWriters, RefuseWhatTheyCannotWrite) {
  const Folder folder;
  EXPECT_NE(problem([&] { test::write_sample(folder / "run.fbx", 1); }).find(".glb"), std::string::npos);
  EXPECT_NE(problem([&] { test::write_sample(folder / "run", 1); }), "");
  for (const std::string suffix : {"obj", "ply", "glb", "usda", "pc2", "pvd"}) {
    const auto writer = output::make_format_writer(folder / ("run." + suffix), test::sample_objects(), 1. / 60);
    output::Frame frame = test::sample_frame(0);
    frame.positions[1][2].y = NAN;
    const std::string text = problem([&] { writer->add(frame); });
    EXPECT_NE(text.find("object 'rope', particle 2"), std::string::npos) << text;
    frame = test::sample_frame(0);
    frame.positions[0].pop_back();
    EXPECT_NE(problem([&] { writer->add(frame); }), "") << suffix;
    writer->add(test::sample_frame(0));
    EXPECT_NE(problem([&] { writer->add(test::sample_frame(0)); }), "") << suffix << " took two frames of one time";
  }
}

TEST(Describe, TakesTheFirstDistancesOfWhatHasNoTriangles) {
  Object rope;
  rope.name = "rope";
  rope.positions.resize(4);
  rope.constraints.push_back(
      {.type = "distance", .particles = {2, 3, 0, 1, 1, 2}, .rest = {}, .stiffness = {}, .compliances = {}});
  rope.constraints.push_back(
      {.type = "distance", .particles = {0, 2, 1, 3}, .rest = {}, .stiffness = {}, .compliances = {}});
  EXPECT_EQ(output::describe(rope).lines, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
  rope.triangles = {{0, 1, 2}};
  EXPECT_TRUE(output::describe(rope).lines.empty());
}

TEST(JoinLines, WalksForksAndLoops) {
  using Lines = std::vector<std::vector<int>>;
  EXPECT_EQ(output::join_lines({{0, 1}, {1, 2}, {2, 0}}), (Lines{{0, 1, 2, 0}}));
  EXPECT_EQ(output::join_lines({{5, 4}, {4, 3}}), (Lines{{3, 4, 5}}));
  EXPECT_EQ(output::join_lines({{0, 1}, {1, 2}, {1, 3}, {3, 4}}), (Lines{{0, 1}, {1, 2}, {1, 3, 4}}));
  EXPECT_TRUE(output::join_lines({}).empty());
}

TEST(JoinLines, TakesTimeInProportionAlsoAtAHub) {
  std::vector<std::array<int, 2>> spokes;
  for (int i = 1; i <= 1000000; ++i) spokes.push_back({0, i});
  const auto lines = output::join_lines(spokes);  // would take half an hour if each spoke searched all before it
  EXPECT_EQ(lines.size(), spokes.size());
  EXPECT_EQ(lines.back(), (std::vector<int>{0, 1000000}));
}

}  // namespace
}  // namespace pliant

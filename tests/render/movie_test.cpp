// Tests picture files: a PNG by its chunks, a movie by ffprobe's counts, and that a failed write leaves nothing
// behind.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "pliant/error.h"
#include "render/render.h"

namespace pliant::render {
namespace {

class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "pliant-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string at(const std::string& name) const { return folder + "/" + name; }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }
  static std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static bool has_program(const std::string& name) {
    return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
  }

  std::string folder;
};

std::vector<std::uint8_t> picture(int width, int height, int shade) {
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = static_cast<std::uint8_t>(i % 3 == 0 ? shade : static_cast<int>(i) % 251);
  return rgb;
}

TEST_F(Files, PngSaysItsSize) {
  write_png(at("a.png"), 30, 20, picture(30, 20, 7));
  const std::string bytes = read(at("a.png"));
  ASSERT_GT(bytes.size(), 33u);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(12, 4), "IHDR");
  EXPECT_EQ(bytes.substr(16, 10), std::string("\0\0\0\x1e\0\0\0\x14\x8\x2", 10));
  EXPECT_EQ(bytes.substr(bytes.size() - 8, 4), "IEND");
}

TEST_F(Files, PngNamesThePathThatFails) {
  try {
    write_png(at("missing/a.png"), 30, 20, picture(30, 20, 7));
    FAIL() << "wrote into a folder that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.where().file, at("missing/a.png"));
  }
  EXPECT_THROW(write_png(at("a.png"), 31, 20, picture(30, 20, 7)), Error);
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, MovieHasEveryFrame) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "there is no ffmpeg here";
  MovieWriter movie(at("a.mp4"), 65, 48, 24);
  for (int i = 0; i < 12; ++i) movie.add(picture(65, 48, 20 * i));
  EXPECT_FALSE(std::filesystem::exists(at("a.mp4")));
  movie.finish();
  movie.finish();
  EXPECT_EQ(count(), 1u);
  const std::string bytes = read(at("a.mp4"));
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "a page can't play it while it loads";
  // The MP4 box `stsz` has the sizes of the samples: version, common size (0: none), count.
  const std::size_t sizes = bytes.find("stsz");
  ASSERT_NE(sizes, std::string::npos);
  EXPECT_EQ(static_cast<int>(bytes[sizes + 15]), 12);
}

TEST_F(Files, MovieLeavesNothingWhenDropped) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "there is no ffmpeg here";
  {
    MovieWriter movie(at("a.mp4"), 64, 48, 24);
    movie.add(picture(64, 48, 0));
    EXPECT_THROW(movie.add(picture(64, 47, 0)), Error);
  }
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, MovieNamesThePathThatFails) {
  for (const std::string& path : {at("missing/a.mp4"), folder}) {
    try {
      MovieWriter movie(path, 64, 48, 24);
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.where().file, path);
    }
  }
  EXPECT_THROW(MovieWriter(at("a.mp4"), 64, 48, 0), Error);
}

TEST_F(Files, MovieSaysWhichPackageIsMissing) {
  const char* const path = std::getenv("PATH");
  const std::string old = path != nullptr ? path : "";
  setenv("PATH", folder.c_str(), 1);
  try {
    MovieWriter movie(at("a.mp4"), 64, 48, 24);
    ADD_FAILURE() << "started an ffmpeg that is not there";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("Debian package ffmpeg"), std::string::npos) << error.what();
  }
  setenv("PATH", old.c_str(), 1);
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, MovieRepeatsWhatFfmpegSays) {
  // A fake ffmpeg that prints an error and exits.
  std::ofstream(at("ffmpeg")) << "#!/bin/sh\necho 'no such encoder' >&2\nexit 1\n";
  std::filesystem::permissions(at("ffmpeg"), std::filesystem::perms::owner_all);
  const std::string old = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  setenv("PATH", (folder + ":" + old).c_str(), 1);
  try {
    MovieWriter movie(at("a.mp4"), 64, 48, 24);
    for (int i = 0; i < 100; ++i) movie.add(picture(64, 48, i));
    movie.finish();
    ADD_FAILURE() << "did not notice that ffmpeg failed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no such encoder"), std::string::npos) << error.what();
  }
  setenv("PATH", old.c_str(), 1);
  EXPECT_EQ(count(), 1u);
}

}  // namespace
}  // namespace pliant::render

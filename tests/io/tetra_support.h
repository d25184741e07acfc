// What the tests of files of tetrahedra share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant::test {

/// Writes a file into a folder of temporary files. Returns its path.
inline std::string write_temporary(const std::string& folder, const std::string& name, const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / folder;
  std::filesystem::create_directories(path);
  std::ofstream(path / name, std::ios::binary) << text;
  return (path / name).string();
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// The message by which read_tetrahedral_mesh refuses a file; "accepted" if it does not.
inline std::string tetrahedra_message(const std::string& path) {
  try {
    read_tetrahedral_mesh(path);
  } catch (const Error& error) {
    EXPECT_FALSE(error.where().file.empty()) << error.what();
    EXPECT_FALSE(error.problem().empty()) << path;
    return error.what();
  }
  return "accepted";
}

}  // namespace pliant::test

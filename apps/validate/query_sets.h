// Reads sets of queries for continuous collision tests. A query is eight lines of rational numbers: the corners at both
// ends of their motion, and the answer. The format is that of the sample queries of B. Wang et al., "A large-scale
// benchmark and an inclusion-based algorithm for continuous collision detection", 2021.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::validate {

/// A vertex and a triangle, or two edges, in linear motion.
struct CollisionQuery {
  std::array<Vec3d, 4> from, to;
  bool hits = false;
};

inline double quotient(const std::string& numerator, const std::string& denominator) {
  return std::strtod(numerator.c_str(), nullptr) / std::strtod(denominator.c_str(), nullptr);
}

/// Reads the queries of one file; none if it cannot be read.
inline std::vector<CollisionQuery> read_queries(const std::filesystem::path& file) {
  std::vector<CollisionQuery> queries;
  std::ifstream in(file);
  std::string field[7];
  CollisionQuery query;
  for (int row = 0;; ++row) {
    for (int i = 0; i < 7; ++i)
      if (!std::getline(in, field[i], i < 6 ? ',' : '\n')) return queries;
    std::array<Vec3d, 4>& corners = row % 8 < 4 ? query.from : query.to;
    corners[static_cast<std::size_t>(row % 4)] =
        Vec3d{quotient(field[0], field[1]), quotient(field[2], field[3]), quotient(field[4], field[5])};
    query.hits = field[6][0] == '1';
    if (row % 8 == 7) queries.push_back(query);
  }
}

/// Reads all queries of one kind ("vertex-face" or "edge-edge", the name of a folder) below `root`, in the order of
/// file names; none if there is no such folder.
inline std::vector<CollisionQuery> read_query_sets(const std::filesystem::path& root, const std::string& kind) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root, none))
    if (entry.path().extension() == ".csv" && entry.path().parent_path().filename() == kind)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<CollisionQuery> queries;
  for (const auto& file : files) {
    const std::vector<CollisionQuery> more = read_queries(file);
    queries.insert(queries.end(), more.begin(), more.end());
  }
  return queries;
}

}  // namespace pliant::validate

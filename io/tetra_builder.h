// Collects the nodes and tetrahedra of a file. Nodes have any numbers, and may follow the tetrahedra.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pliant/io.h"

namespace pliant {

class TetraBuilder {
 public:
  explicit TetraBuilder(std::string name) : name_(std::move(name)) {}

  void add_node(std::int64_t number, const Vec3f& at, int line);
  void add_tetrahedron(const std::array<std::int64_t, 4>& nodes, int line);
  void note(std::string repair) { repairs_.push_back(std::move(repair)); }

  /// The mesh: tetrahedra of negative volume are turned, nodes of none left out, touching parts noted. Throws an Error
  /// if there is no tetrahedron, a node is there twice, a tetrahedron uses one that does not exist, or floats are too
  /// coarse so far from the origin.
  TetrahedralMeshFile result();

 private:
  struct Node {
    std::int64_t number;
    Vec3f at;
    int line;
  };
  struct Corners {
    std::array<std::int64_t, 4> nodes;
    int line;
  };

  [[noreturn]] void fail(int line, const std::string& problem, const std::string& advice) const;
  std::size_t place_of(std::int64_t number, int line) const;
  void sort_nodes();

  std::string name_;
  std::vector<Node> nodes_;
  std::vector<Corners> tetrahedra_;
  std::vector<std::string> repairs_;
};

}  // namespace pliant

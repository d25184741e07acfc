// Bending of fine sheets by default settings: cantilevers of the fabrics against the beam's formula q L^4 / (8 B), on
// meshes that are coarse and fine, regular and not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr double sag_over_length = 0.05;  // small enough for the beam's linear formula

struct Cantilever {
  const Fabric& material;
  int edges = 12;  // in the free length
  double moved = 0;
  bool alternates = false;
  int columns = 9;
  double length() const {
    const double weight = double(material.area_density) * standard_gravity;
    return std::cbrt(8 * sag_over_length * double(material.bending_stiffness) / weight);
  }
};

// Rows along x, of which the first two are clamped; inner vertices are moved by up to a share of an edge.
TriangleMesh strip_of(const Cantilever& of) {
  std::mt19937 random(1);
  const auto uniform = [&] { return of.moved * (static_cast<double>(random() % 65536) / 32768 - 1); };
  const int rows = of.edges + 2, columns = of.columns;
  const double edge = of.length() / of.edges;
  TriangleMesh mesh;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const bool is_inner = i > 1 && j > 0 && i + 1 < rows && j + 1 < columns;
      const double x = i - 1 + (is_inner ? uniform() : 0), z = j + (is_inner ? uniform() : 0);
      mesh.positions.push_back({static_cast<float>(x * edge), 0, static_cast<float>(z * edge)});
    }
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < columns; ++j) {
      const int a = i * columns + j, b = a + columns, c = b + 1, d = a + 1;
      const bool crosses = of.alternates && (i + j) % 2 == 1;
      mesh.triangles.push_back(crosses ? std::array<int, 3>{a, d, b} : std::array<int, 3>{a, c, b});
      mesh.triangles.push_back(crosses ? std::array<int, 3>{b, d, c} : std::array<int, 3>{a, d, c});
    }
  return mesh;
}

// The sag of the tip at rest over that of the beam, with so many frames a second.
double sag_of(const Cantilever& of, int substeps, int rate = 60) {
  ClothOptions options;
  options.material = of.material;
  Object object = make_cloth(strip_of(of), options);
  object.damping = 10;
  for (int i = 0; i < 2 * of.columns; ++i) object.pins.push_back({i, {}});
  World world(scene_with(std::move(object), standard_gravity, substeps, 1));
  for (int frame = 0; frame < 3 * rate / 2; ++frame) world.step(1.f / static_cast<float>(rate));
  const std::vector<Vec3f> end = world.object(0).positions();
  const auto columns = static_cast<std::size_t>(of.columns);
  double tip = 0;
  for (std::size_t j = end.size() - columns; j < end.size(); ++j) tip -= static_cast<double>(end[j].y) / of.columns;
  return tip / (sag_over_length * of.length());
}

}  // namespace

void bending_rows(Result& result, bool slow) {
  const std::vector<int> meshes = slow ? std::vector<int>{6, 12, 24, 48, 96} : std::vector<int>{6, 24};
  for (const Fabric& material : fabrics()) {
    std::vector<double> regular, irregular;
    for (const int edges : meshes) {
      regular.push_back(sag_of({material, edges}, 0));
      irregular.push_back(sag_of({material, edges, 0.25, true}, 0));
    }
    const std::string note =
        "cantilevers of " + brief(meshes.front()) + " to " + brief(meshes.back()) + " edges, default settings";
    result.rows.push_back(relative("bending: engine, " + material.name + ", sag over the beam's, grids, worst", 1,
                                   farthest(1, regular), 0.05, "", note));
    result.rows.push_back(relative("bending: engine, " + material.name + ", irregular meshes, worst", 1,
                                   farthest(1, irregular), 0.05, "", note + ", vertices moved, diagonals alternate"));
  }
  std::vector<double> by_substeps;
  const Fabric& cotton = fabric("cotton");
  for (const int substeps : {10, 20, 40, 80}) by_substeps.push_back(sag_of({cotton}, substeps) / sag_of({cotton}, 0));
  result.rows.push_back(relative("bending: engine, cotton, 10 to 80 substeps over the default, worst", 1,
                                 farthest(1, by_substeps), 0.03, "", "12 edges"));
  std::vector<double> by_frames, small;
  for (const int rate : {30, 120, 250, 500, 1000})
    by_frames.push_back(sag_of({cotton, 6}, 10, rate) / sag_of({cotton, 6}, 10));
  result.rows.push_back(relative("bending: engine, cotton, frames of 1/30 to 1/1000 s over 1/60 s, worst", 1,
                                 farthest(1, by_frames), 0.03, "", "6 edges, 10 substeps"));
  for (const auto& [edges, columns] : {std::array{6, 2}, {3, 5}, {2, 7}, {5, 4}})
    small.push_back(sag_of({cotton, edges, 0, false, columns}, 0));
  result.rows.push_back(relative("bending: engine, cotton, sag over the beam's, 16 to 28 particles, worst", 1,
                                 farthest(1, small), 0.15, "", "2 x 8, 5 x 5, 7 x 4, 4 x 7 particles"));
}

}  // namespace pliant::validate

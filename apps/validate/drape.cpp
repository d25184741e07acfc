// The drape coefficient of the fabrics by Cusick's test: a disc of cloth of 30 cm, clamped between two discs of 18 cm,
// hangs down all around. The coefficient is the share of the overhanging ring that its shadow covers.
//
// Measured: plain weave of 221 g/m^2 80.4 %, twill 3/1 79.8 %, with 5 to 8 folds. The bending stiffness of the presets
// that are woven so is chosen by these numbers; what the rows test is that default settings reach them on every mesh.
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr double specimen_radius = 0.15, disc_radius = 0.09;  ///< of the specimen and of the supporting disc [m]
constexpr int drape_frames = 360;
constexpr float air_damping = 2;  ///< rate at which air slows the cloth [1/s]

/// A disc of `rings` rings, of which the k-th has 6 k vertices. With a multiple of 5 rings one lies on the rim of the
/// support. Irregular: each vertex between the rims is displaced at random, by up to 0.3 of the distance of two rings.
TriangleMesh disc_mesh(int rings, bool irregular) {
  TriangleMesh mesh{{Vec3f{}}, {}};
  Random random(7);
  const auto first = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  const auto vertex = [&](int ring, int i) { return ring == 0 ? 0 : first(ring) + i % (6 * ring); };
  const double step = specimen_radius / rings;
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      double r = step * ring, turn = 2 * pi * i / (6 * ring);
      const double sideways = random.uniform(-0.3, 0.3) * step / r, outwards = random.uniform(-0.3, 0.3) * step;
      const bool is_rim = ring == rings || 5 * ring == 3 * rings;
      if (irregular) turn += sideways;
      if (irregular && !is_rim) r += outwards;
      mesh.positions.push_back({static_cast<float>(r * std::cos(turn)), 0, static_cast<float>(r * std::sin(turn))});
    }
  for (int ring = 1; ring <= rings; ++ring)
    for (int sector = 0; sector < 6; ++sector)
      for (int i = 0; i < ring; ++i) {
        const int outer = sector * ring + i, inner = sector * (ring - 1) + i;
        mesh.triangles.push_back({vertex(ring, outer + 1), vertex(ring, outer), vertex(ring - 1, inner)});
        if (i + 1 < ring)
          mesh.triangles.push_back({vertex(ring - 1, inner), vertex(ring - 1, inner + 1), vertex(ring, outer + 1)});
      }
  return mesh;
}

/// The area of the shadow of triangles under vertical light [m^2], counted in squares of half a millimetre.
double shadow_of(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles) {
  constexpr double cell = 0.0005;
  constexpr int cells = 640;
  std::vector<char> dark(std::size_t{cells} * cells, 0);
  const auto column_of = [](double x) { return x / cell + cells / 2.0 - 0.5; };
  for (const auto& [a, b, c] : triangles) {
    std::array<double, 3> x{}, z{};
    const std::array<int, 3> corners{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f& p = positions[static_cast<std::size_t>(corners[k])];
      x[k] = column_of(p.x);
      z[k] = column_of(p.z);
    }
    const auto [x_low, x_high] = std::minmax_element(x.begin(), x.end());
    const auto [z_low, z_high] = std::minmax_element(z.begin(), z.end());
    const double turn = (x[1] - x[0]) * (z[2] - z[0]) - (x[2] - x[0]) * (z[1] - z[0]);
    const auto first = [](double low) { return std::max(0, static_cast<int>(std::ceil(low))); };
    const auto last = [](double high) { return std::min(cells - 1, static_cast<int>(std::floor(high))); };
    for (int row = first(*z_low); row <= last(*z_high); ++row)
      for (int column = first(*x_low); column <= last(*x_high); ++column) {
        const auto is_inside = [&](std::size_t k) {
          const std::size_t next = (k + 1) % 3;
          return ((x[next] - x[k]) * (row - z[k]) - (column - x[k]) * (z[next] - z[k])) * turn >= 0;
        };
        if (is_inside(0) && is_inside(1) && is_inside(2))
          dark[std::size_t{cells} * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)] = 1;
      }
  }
  return cell * cell * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
}

/// The number of folds: the harmonic of the hem's height with the largest amplitude.
int folds_of(const std::vector<Vec3f>& positions, int rings) {
  const int count = 6 * rings;
  const std::vector<Vec3f> hem(positions.end() - count, positions.end());
  double most = -1;
  int folds = 0;
  for (int harmonic = 2; harmonic <= 16; ++harmonic) {
    double c = 0, s = 0;
    for (int i = 0; i < count; ++i) {
      const double y = hem[static_cast<std::size_t>(i)].y, turn = 2 * pi * harmonic * i / count;
      c += y * std::cos(turn);
      s += y * std::sin(turn);
    }
    if (c * c + s * s > most) {
      most = c * c + s * s;
      folds = harmonic;
    }
  }
  return folds;
}

/// The share of the overhanging ring that the shadow of the specimen covers [%].
double coefficient_of(const std::vector<Vec3f>& positions, const TriangleMesh& mesh) {
  const double held = pi * disc_radius * disc_radius, whole = pi * specimen_radius * specimen_radius;
  return 100 * (shadow_of(positions, mesh.triangles) - held) / (whole - held);
}

struct Drape {
  double coefficient = 0;  ///< [%]
  int folds = 0;
};

/// Lets a specimen come to rest by default settings.
Drape drape(const Fabric& fabric, int rings, bool irregular) {
  ClothOptions options;
  options.material = fabric;
  const TriangleMesh mesh = disc_mesh(rings, irregular);
  Object object = make_cloth(mesh, options);
  object.damping = air_damping;
  object.self_collision = true;
  Scene scene;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  std::vector<int> held;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (length(mesh.positions[i]) < disc_radius + 1e-4) held.push_back(static_cast<int>(i));
  scene.pin(0, held);
  World world(scene);
  for (int frame = 0; frame < drape_frames; ++frame) world.step(scene.frame_time);
  const std::vector<Vec3f> positions = world.object(0).positions();
  return {coefficient_of(positions, mesh), folds_of(positions, rings)};
}

}  // namespace

void drape_rows(Result& result, bool slow) {
  struct Measured {
    const char* fabric;
    const char* weave;
    double coefficient;
  };
  const TriangleMesh flat = disc_mesh(30, true);
  result.rows.push_back(absolute("drape: coefficient of the flat disc", 100, coefficient_of(flat.positions, flat), 0.5,
                                 "%", "shadow counted in squares of 0.5 mm"));
  for (const Measured& known : {Measured{"cotton", "plain weave", 80.4}, Measured{"denim", "twill 3/1", 79.8}})
    for (int rings : slow ? std::vector<int>{20, 30, 40} : std::vector<int>{20, 30})
      for (bool irregular : {false, true}) {
        const Drape found = drape(fabric(known.fabric), rings, irregular);
        const std::string name = std::string("drape: engine, ") + known.fabric + ", edges of " + brief(150.0 / rings) +
                                 " mm, " + (irregular ? "irregular" : "regular");
        const std::string note = std::string(known.weave) + ", default settings, self-collision, 6 s";
        result.rows.push_back(absolute(name + ", coefficient", known.coefficient, found.coefficient, 5, "%", note));
        result.rows.push_back(absolute(name + ", folds", 6.5, found.folds, 1.5, "", "5 to 8 are measured"));
      }
}

}  // namespace pliant::validate

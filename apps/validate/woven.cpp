// Woven cloth by default settings: sheets that hang by an edge stretch, and sheets that are held at one side shear, as
// their moduli say, on meshes that are coarse and fine, regular and not.
#include <algorithm>
#include <cmath>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr double sheet_width = 0.25, sheet_height = 1;  // [m]

struct WovenSheet {
  const Fabric& material;
  int rows = 41;            // over the height, along the warp
  bool is_sheared = false;  // held at one side, not at the upper edge
  double moved = 0;         // inner vertices, as a share of an edge
};

TriangleMesh mesh_of(const WovenSheet& of) {
  TriangleMesh mesh = grid_mesh((of.rows - 1) / 4 + 1, of.rows, float(sheet_width), float(sheet_height));
  Random random(3);
  const double edge = sheet_height / (of.rows - 1);
  for (Vec3f& p : mesh.positions) {
    const bool is_inner = std::fabs(double(p.x)) < 0.499 * sheet_width && std::fabs(double(p.z)) < 0.499 * sheet_height;
    const double by = is_inner ? of.moved * edge : 0;
    p = {p.x + float(random.uniform(-by, by)), -p.z - float(random.uniform(-by, by)), 0};
  }
  return mesh;
}

bool is_held(const WovenSheet& of, const Vec3f& p) {
  return of.is_sheared ? double(p.x) < -0.4999 * sheet_width : double(p.y) > 0.4999 * sheet_height;
}
bool is_end(const WovenSheet& of, const Vec3f& p) {
  return of.is_sheared ? double(p.x) > 0.4999 * sheet_width : double(p.y) < -0.4999 * sheet_height;
}

// The mean sag of the free edge at rest [m]. The sheet stretches by rho g L^2 / (2 Y). Held at one side it shears by
// rho g W^2 / (2 G), and bends in its plane.
double known_sag(const WovenSheet& of) {
  const Fabric& m = of.material;
  const double weight = double(m.area_density) * standard_gravity, warp = double(m.stretch_stiffness);
  const double weft = m.weft_stiffness > 0 ? double(m.weft_stiffness) : warp, shear = double(m.shear_stiffness);
  if (of.is_sheared)
    return weight * sheet_width * sheet_width *
           (1 / (2 * shear) + 1.5 * sheet_width * sheet_width / (weft * sheet_height * sheet_height));
  return weight * sheet_height * sheet_height / (2 * warp);
}

// That of the engine over the known one. `share`: of the default substeps.
double sag_over_known(const WovenSheet& of, double share = 1) {
  ClothOptions options;
  options.material = of.material;
  options.bending_model = ClothOptions::Bending::none;
  options.stretch_model = ClothOptions::Stretching::woven;
  options.warp = {0, 1, 0};
  Object object = make_cloth(mesh_of(of), options);
  object.damping = 6;
  const std::vector<Vec3f> start = object.positions;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (is_held(of, start[i])) object.pins.push_back({static_cast<int>(i), {}});
  Scene scene;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  if (share != 1) scene.settings.substeps = static_cast<int>(std::lround(share * chosen_substeps(scene)[0]));
  World world(scene);
  for (int frame = 0; frame < 150; ++frame) world.step(frame_time);
  const std::vector<Vec3f> end = world.object(0).positions();
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (is_end(of, start[i])) {
      sum += double(start[i].y) - double(end[i].y);
      ++count;
    }
  return sum / count / known_sag(of);
}

}  // namespace

void woven_rows(Result& result, bool slow) {
  const std::vector<int> meshes = slow ? std::vector<int>{41, 81, 161} : std::vector<int>{41, 81};
  const std::string rows = brief(meshes.front()) + " to " + brief(meshes.back()) + " rows";
  const auto worst = [&](const std::string& what, double tolerance, const std::string& note, const auto& sag) {
    std::vector<double> sags;
    for (const int mesh : meshes) sags.push_back(sag(mesh));
    result.rows.push_back(relative("woven: engine, " + what + " over the known one, " + rows + ", worst", 1,
                                   farthest(1, sags), tolerance, "", note));
  };
  for (const char* name : {"cotton", "denim", "silk", "wool"}) {
    const Fabric& m = fabric(name);
    worst(std::string(name) + ", shear", 0.03, "rho g W^2 / (2 G), held at one side, default settings", [&](int n) {
      return sag_over_known({m, n, true});
    });
  }
  worst("cotton, twice the substeps, shear", 0.03, "twice the default substeps", [&](int n) {
    return sag_over_known({fabric("cotton"), n, true}, 2);
  });
  Fabric soft = fabric("cotton");  // what is stiffer stretches by its weight less than a ten-thousandth
  soft.stretch_stiffness = soft.weft_stiffness = 200;
  worst("200 N/m, stretch by its weight", 0.03, "rho g L^2 / (2 Y), default settings", [&](int n) {
    return sag_over_known({soft, n});
  });
  worst("200 N/m, irregular, stretch by its weight", 0.03, "vertices moved by up to 0.25 edges, default settings",
        [&](int n) {
          return sag_over_known({soft, n, false, 0.25});
        });
}

}  // namespace pliant::validate

// Long runs with contact in which no intersection is allowed: 600 frames, all audited. They take minutes, so they need
// `--slow`.
#include "apps/validate/long_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr float thickness_of_edge = 0.1f;  // thickness over edge length, as docs/guide/contact.md recommends

/// Self-colliding cotton, for a sheet with edges of length `edge`.
Object sheet_of(const TriangleMesh& mesh, float edge, const std::string& name = "sheet") {
  ClothOptions options;
  options.name = name;
  options.material = fabric("cotton");
  Object object = make_cloth(mesh, options);
  object.thickness = thickness_of_edge * edge;
  object.self_collision = object.collides = true;
  return object;
}

TriangleMesh square(int side, float edge) {
  const float width = edge * static_cast<float>(side - 1);
  return grid_mesh(side, side, width, width);
}

Scene scene_of(int substeps) {
  Scene scene;
  scene.settings.substeps = substeps;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.threads = 1;
  return scene;
}

/// The particles at one border of a sheet: `axis` is x or y, `end` is -1 or 1.
std::vector<int> border(const Object& sheet, int end, float Vec3f::*axis) {
  float farthest = 0;
  for (const Vec3f& p : sheet.positions) farthest = std::max(farthest, p.*axis * static_cast<float>(end));
  std::vector<int> found;
  for (std::size_t i = 0; i < sheet.positions.size(); ++i)
    if (sheet.positions[i].*axis * static_cast<float>(end) > 0.9999f * farthest) found.push_back(static_cast<int>(i));
  return found;
}

}  // namespace

Scene folded_scene(int side) {
  constexpr float edge = 0.01f;
  TriangleMesh mesh = square(side, edge);
  const float half = 0.5f * edge * static_cast<float>(side - 1), radius = 0.06f * half,
              flat = half - std::numbers::pi_v<float> / 2 * radius;
  for (Vec3f& p : mesh.positions) {
    const float along = p.x + half, angle = std::clamp((along - flat) / radius, 0.f, std::numbers::pi_v<float>);
    const float back = std::max(0.f, along - flat - std::numbers::pi_v<float> * radius);
    p.x = std::min(along, flat) + radius * std::sin(angle) - back;
    p.y = 0.2f + radius * (1 - std::cos(angle));
  }
  Scene scene = scene_of(20);
  scene.add(sheet_of(mesh, edge));
  scene.add(Collider{});
  return scene;
}

Scene layered_scene(int side) {
  constexpr float width = 0.72f;
  const float edge = width / static_cast<float>(side - 1);
  Scene scene = scene_of(20);
  for (int layer = 0; layer < 10; ++layer) {
    TriangleMesh mesh = square(side, edge);
    const double angle = layer * 9 * double(std::numbers::pi_v<float>) / 180;
    const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    for (Vec3f& p : mesh.positions)
      p = {c * p.x + s * p.z, 0.44f + 0.015f * static_cast<float>(layer), c * p.z - s * p.x};
    scene.add(sheet_of(mesh, edge, "layer_" + std::to_string(layer + 1)));
  }
  Collider ball;
  ball.name = "ball";
  ball.shape = Sphere{0.2f};
  ball.position = {0, 0.2f, 0};
  scene.add(ball);
  scene.add(Collider{});
  return scene;
}

Scene twisted_scene(int side) {
  constexpr float edge = 0.01f, seconds = 8, drawn_in = 0.1f;
  const int columns = 2 * side, rows = side / 2;  // on a wider sheet, half a turn would pull the ends together
  const float length = edge * static_cast<float>(columns - 1), width = edge * static_cast<float>(rows - 1);
  Scene scene = scene_of(20);
  scene.settings.sweep = Sweep::multigrid;  // other sweeps would stretch such a long sheet by half before it twists
  const Object sheet = sheet_of(grid_mesh(columns, rows, length, width), edge);
  const int object = scene.add(sheet);
  for (const int end : {-1, 1}) {
    Motion motion;
    for (int k = 0; k <= 16; ++k) {
      const float share = static_cast<float>(k) / 16, inward = -0.5f * drawn_in * share * share * length;
      motion.keyframes.push_back({seconds * share,
                                  {static_cast<float>(end) * inward, 0, 0},
                                  rotation({1, 0, 0}, 360 * static_cast<float>(end) * share)});
    }
    scene.pin(object, border(sheet, end, &Vec3f::x), motion);
  }
  return scene;
}

Scene ball_scene(int side) {
  constexpr float edge = 0.01f;
  Scene scene = scene_of(5);
  scene.settings.most_substeps = 2000;  // 10 m/s needs more than eight times the substeps
  scene.frame_time = 1.f / 240;         // so short that no frame starts on one side of the sheet and ends on the other
  TriangleMesh mesh = square(side, edge);
  const float width = edge * static_cast<float>(side - 1);
  for (Vec3f& p : mesh.positions) p = {0, p.x, p.z};
  const Object sheet = sheet_of(mesh, edge);
  const int object = scene.add(sheet);
  scene.pin(object, border(sheet, 1, &Vec3f::y));
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(3);
  for (Vec3f& p : ball.mesh.positions) p = p * (0.12f * width) + Vec3f{-0.8f * width, -0.2f * width, 0.05f * width};
  const Vec3f across{1.6f * width, 0, 0};
  const float time = 1.6f * width / 10;  // time for the distance at 10 m/s
  ball.motion.keyframes = {{0, {}, {}},        {0.1f, {}, {}},        {0.1f + time, across, {}},
                           {0.6f, across, {}}, {0.6f + time, {}, {}}, {1, {}, {}}};
  ball.motion.repeat = true;
  scene.add(ball);
  return scene;
}

namespace {

/// Places points along a polyline at distances of `apart`.
std::vector<Vec3f> resampled(const std::vector<Vec3d>& line, double apart) {
  std::vector<Vec3f> result{to_float(line.front())};
  double left = apart;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3d step = line[i] - line[i - 1];
    const double length = std::sqrt(dot(step, step));
    double gone = 0;
    for (; length - gone >= left; left = apart) {
      gone += left;
      result.push_back(to_float(line[i - 1] + step * (gone / length)));
    }
    left -= length - gone;
  }
  return result;
}

/// A trefoil knot that is cut at the tip of a lobe, with its ends led outward [m].
std::vector<Vec3f> open_trefoil(double size, double link) {
  constexpr double turn = 2 * double(std::numbers::pi_v<float>), gap = 0.12, leg = 8;
  constexpr int pieces = 2000;
  const auto at = [](double t) {
    return Vec3d{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
  };
  std::vector<Vec3d> line;
  const double begin = turn / 2 + gap, end = turn / 2 + turn - gap;
  line.push_back((at(begin) + Vec3d{leg / 2, -leg, 0}) * size);
  for (int i = 0; i <= pieces; ++i) line.push_back(at(begin + (end - begin) * i / pieces) * size);
  line.push_back((at(end) + Vec3d{-leg / 2, -leg, 0}) * size);
  return resampled(line, link);
}

}  // namespace

Scene knot_scene() {
  constexpr float link = 0.009f;
  RopeOptions options;
  options.linear_density = 0.03f;
  options.bends = true;
  options.bending = Stiffness::compliance(0.01f);
  options.thickness = 0.003f;
  Object rope = make_rope(open_trefoil(0.018, double(link)), options);
  rope.self_collision = true;
  rope.damping = 1;
  const int last = static_cast<int>(rope.positions.size()) - 1;
  const float reach = 0.5f * (link * static_cast<float>(last) - 0.09f);  // leaves less rope than the knot needs
  for (const int end : {0, last}) {
    Attachment attachment;
    attachment.particle = end;
    attachment.target = rope.positions[static_cast<std::size_t>(end)];
    attachment.stiffness = Stiffness::compliance(0.0005f);
    const Vec3f away{(end == 0 ? reach : -reach) - attachment.target.x, 0, -attachment.target.z};
    attachment.motion.keyframes = {{0, {}, {}}, {4, away, {}}};
    rope.attachments.push_back(attachment);
  }
  Scene scene = scene_of(20);
  scene.gravity = {};
  scene.add(rope);
  return scene;
}

namespace {

struct Long {
  const char* what;
  Scene scene;
  Audit (*look)(const Scene&, int);
};

std::string in_words(const Audit& audit, const char* how) {
  const auto brief3 = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return std::string(text);
  };
  std::string words = std::string(how) + ", " + std::to_string(audit.frames) + " frames of " +
                      std::to_string(audit.vertices) + " vertices, " + brief3(audit.ms) + " ms each, at most " +
                      brief3(audit.slowest_ms) + "; least distance " + brief3(audit.least_distance * 1e3) + " mm";
  if (audit.first >= 0) words += "; first in frame " + std::to_string(audit.first);
  return words;
}

}  // namespace

void long_contact_rows(Result& result) {
  constexpr int frames = 600;
  const std::string group = "collision: engine, ";
  for (const auto& [what, scene, look] :
       {Long{"100 x 100 cloth folded over itself and dropped", folded_scene(100), audit_surfaces},
        Long{"ten layers of 33 x 33 over a sphere", layered_scene(33), audit_surfaces},
        Long{"200 x 50 cloth twisted through two turns", twisted_scene(100), audit_surfaces},
        Long{"ball at 10 m/s back and forth through 64 x 64 cloth", ball_scene(64), audit_surfaces},
        Long{"knot pulled tight", knot_scene(), audit_rope}}) {
    const Audit audit = look(scene, frames);
    const bool rope = look == audit_rope;
    const double bad = audit.ok ? static_cast<double>(audit.most) : std::numeric_limits<double>::quiet_NaN();
    result.rows.push_back(at_most(group + what + (rope ? ", links that meet" : ", edges that meet triangles"), 0, bad,
                                  "", in_words(audit, rope ? "paths of every substep" : "exact signs")));
    result.rows.push_back(
        at_most(group + what + ", unresolvable pairs", 0, static_cast<double>(audit.unresolvable), "", ""));
  }
}

}  // namespace pliant::validate

// A user's program with rigid bodies: a pile of boxes falls, a lamp swings on a rope, and their poses are printed.
#include <pliant/pliant.h>

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace {

/// A lamp of 5 kg under a rope of 1 m, which starts level and swings down.
pliant::Object swinging_lamp() {
  pliant::Object object =
      pliant::make_body({{pliant::Sphere{0.1f}}}, {.name = "lamp", .position = {1.1f, 3, 3}, .mass = 5});
  std::vector<pliant::Vec3f> line;
  for (int i = 0; i <= 10; ++i) line.push_back({0.1f * static_cast<float>(i), 3, 3});
  const int first = pliant::append(object, pliant::make_rope(line));
  object.pins.push_back({first, {}});
  pliant::attach(object, {first + 10}, 0);
  return object;
}

pliant::Object pile_of_boxes() {
  pliant::Object pile;
  pile.name = "pile";
  for (int i = 0; i < 5; ++i) {
    pliant::BodyOptions options;
    options.name = "box " + std::to_string(i);
    options.position = {0, 0.5f + 1.05f * static_cast<float>(i), 0};
    pliant::add_body(pile, {{pliant::Box{{0.5f, 0.5f, 0.5f}}}}, options);
  }
  return pile;
}

}  // namespace

int main() {
  pliant::Scene scene;
  scene.colliders.emplace_back();  // a plane, y = 0
  const pliant::ObjectId lamp = scene.add(swinging_lamp()), pile = scene.add(pile_of_boxes());
  pliant::World world(scene);
  for (int frame = 0; frame < 120; ++frame) {
    const pliant::Report report = world.step(1.f / 60);
    if (!report.ok() || !report.warnings.empty()) return std::cerr << report.explain() << "\n", 1;
  }
  const pliant::RigidPose top = world.object(pile).pose("box 4"), hung = world.object(lamp).pose("lamp");
  std::cout << "the top box is at " << top.position.y << " m, the lamp at " << hung.position.x << ", "
            << hung.position.y << " m\n";
  const float x = hung.position.x, y = hung.position.y - 3, length = std::sqrt(x * x + y * y);
  return std::fabs(top.position.y - 4.5f) < 0.05f && std::fabs(length - 1.1f) < 0.02f ? 0 : 1;
}

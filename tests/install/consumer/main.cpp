// The example of README.md, word for word; a test compares the two.
#include <pliant/pliant.h>

#include <iostream>

int main() {
  pliant::Scene scene;
  pliant::ClothOptions options;
  options.material = pliant::fabric("cotton");  // typical figures, in SI units
  pliant::TriangleMesh square = pliant::grid_mesh(40, 40, 1.f, 1.f);
  int cloth = scene.add_cloth(square, options);
  scene.objects[cloth].thickness = 0.003f;  // metres that surfaces keep from each other: a tenth of an edge
  scene.objects[cloth].self_collision = true;

  pliant::Collider ball;
  ball.shape = pliant::Sphere{0.25f};
  ball.position = {0, -0.5f, 0};
  scene.add(ball);

  pliant::World world(scene);  // throws pliant::Error, which says what to change
  for (int frame = 0; frame < 90; ++frame) {
    pliant::Report report = world.step(1.f / 60);
    if (!report.ok()) return std::cerr << report.explain() << "\n", 1;
  }
  pliant::write_mesh("draped.ply", world.object(cloth).mesh());
  std::cout << "wrote draped.ply\n";
}

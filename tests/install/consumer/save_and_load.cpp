// A user's program that saves a run, loads it in a new World and continues with the same bits.
#include <pliant/pliant.h>

#include <iostream>

namespace {

constexpr float frame_time = 1.f / 60;

pliant::Scene hanging_sheet() {
  pliant::Scene scene;
  const int cloth = scene.add_cloth(pliant::grid_mesh(20, 20, 1.f, 1.f));
  scene.pin(cloth, {0, 19});
  return scene;
}

int complain(const char* what) {
  std::cerr << what << "\n";
  return 1;
}

}  // namespace

int main() {
  const pliant::Scene scene = hanging_sheet();
  pliant::World world(scene);
  for (int frame = 0; frame < 10; ++frame) world.step(frame_time);
  pliant::save("sheet.state", world.state(), scene);
  pliant::save("sheet.world", world, scene);
  world.step(frame_time);

  pliant::World again(scene);
  again.restore(pliant::load_state("sheet.state", scene));
  again.step(frame_time);
  if (again.state_hash() != world.state_hash()) return complain("the loaded State goes on otherwise");

  pliant::LoadedWorld loaded = pliant::load_world("sheet.world");
  loaded.world.step(frame_time);
  if (loaded.world.state_hash() != world.state_hash()) return complain("the loaded World goes on otherwise");

  pliant::Scene other = scene;
  other.gravity.y = -1.6f;
  try {
    pliant::load_state("sheet.state", other);
  } catch (const pliant::Error& error) {
    std::cout << error.what() << "\n";
    return 0;
  }
  return complain("the State of another scene was loaded");
}

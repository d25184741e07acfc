// A user-defined constraint type, registered with the installed library: a weight on a line that cannot grow longer
// than a tether.
#include <pliant/constraint.h>
#include <pliant/pliant.h>

#include <cmath>
#include <iostream>
#include <limits>

struct Leash {
  static constexpr const char* name = "leash";
  using slots = pliant::Points<2>;
  static constexpr int rows = 1;
  template <class R>
  struct Params {
    R longest;  // length [m]
  };
  static constexpr std::array<const char*, 1> fields{"longest"};

  template <class R>
  static void evaluate(const pliant::SlotValues<slots, R>& at, const Params<R>& p, pliant::Rows<slots, rows, R>& out) {
    using pliant::max, pliant::select, pliant::sqrt;
    const pliant::Vec3<R> d = at.point[1] - at.point[0];
    const R length = sqrt(dot(d, d));
    const auto slack = length < p.longest;
    const R scale = select(slack, R(0), R(1) / max(length, R(1e-20f)));
    out.c[0] = select(slack, R(0), length - p.longest);
    out.gradient[0][1] = d * scale;
    out.gradient[0][0] = -out.gradient[0][1];
  }
};

int main() {
  pliant::register_constraint<Leash>();
  pliant::Object weight;
  weight.name = "weight";
  weight.positions = {{0, 2, 0}, {0.5f, 2, 0}};
  weight.masses = {std::numeric_limits<float>::infinity(), 1};
  pliant::ConstraintGroup group;
  group.type = "leash";
  group.particles = {0, 1};
  group.rest = {1};
  weight.constraints = {group};
  weight.damping = 4;
  pliant::Scene scene;
  scene.add(weight);
  pliant::World world(scene);
  for (int frame = 0; frame < 600; ++frame) {
    pliant::Report report = world.step(1.f / 60);
    if (!report.ok()) return std::cerr << report.explain() << "\n", 1;
  }
  const pliant::Vec3f end = world.object(0).positions()[1];
  if (std::abs(end.y - 1) > 0.001f) return std::cerr << "the weight hangs at " << end.y << " m, not at 1 m\n", 1;
  if (world.object(0).info().constraints.front().first != "leash") return std::cerr << "the type is not counted\n", 1;
  std::cout << "the weight hangs at " << end.y << " m\n";
}

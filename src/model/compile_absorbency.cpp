#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "math/vector.h"
#include "model/compiled_object.h"

namespace pliant {

namespace {

Vec3d place(const CompiledObject& object, int particle) {
  const Record& x = object.positions[static_cast<std::size_t>(particle)];
  return {static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)};
}

/// Adds half the cotangent of the angle at `corner` to the edge across it.
void add_cotangent(const CompiledObject& object, int corner, int a, int b,
                   std::map<std::pair<int, int>, double>& weights) {
  const Vec3d to_a = place(object, a) - place(object, corner), to_b = place(object, b) - place(object, corner);
  const double across = length(cross(to_a, to_b));
  weights[std::minmax(a, b)] += across > 0 ? 0.5 * dot(to_a, to_b) / across : 0;
}

}  // namespace

void compile_absorbency(const Object& object, CompiledObject& out) {
  if (!object.absorbency) return;
  CompiledAbsorbency& made = out.absorbency;
  made.is_used = true;
  made.described = *object.absorbency;
  made.areas.assign(static_cast<std::size_t>(out.particles), 0.f);
  std::map<std::pair<int, int>, double> weights;
  for (const std::array<int, 3>& t : out.surface.triangles) {
    const double area = 0.5 * length(cross(place(out, t[1]) - place(out, t[0]), place(out, t[2]) - place(out, t[0])));
    for (std::size_t k = 0; k < 3; ++k) {
      made.areas[static_cast<std::size_t>(t[k])] += static_cast<float>(area / 3);
      add_cotangent(out, t[k], t[(k + 1) % 3], t[(k + 2) % 3], weights);
    }
  }
  for (const auto& [edge, weight] : weights) {
    const auto along = static_cast<float>(length(place(out, edge.second) - place(out, edge.first)));
    made.edges.push_back({edge.first, edge.second, static_cast<float>(std::max(weight, 0.0)), along});
  }
}

}  // namespace pliant

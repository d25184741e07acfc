// Twice double's precision for what double precision finds to touch.
#include "geometry/sharp_continuous.h"

#include "geometry/double_double.h"

namespace pliant {

namespace {

using Sharp = DoubleDouble;

void convert_all(const Vec3d (&from)[4], Vec3<Sharp> (&to)[4]) {
  for (int i = 0; i < 4; ++i) to[i] = convert<Sharp>(from[i]);
}

Impact<double> rounded(const Impact<Sharp>& impact) {
  return {impact.hit, static_cast<double>(impact.time), convert<double>(impact.normal), static_cast<double>(impact.gap),
          impact.front};
}

}  // namespace

Impact<double> sharp_vertex_triangle_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness) {
  const Impact<double> impact = vertex_triangle_impact(from, to, thickness);
  if (!impact.hit) return impact;
  Vec3<Sharp> sharp_from[4], sharp_to[4];
  convert_all(from, sharp_from);
  convert_all(to, sharp_to);
  return rounded(vertex_triangle_impact(sharp_from, sharp_to, Sharp(thickness)));
}

Impact<double> sharp_edge_edge_impact(const Vec3d (&from)[4], const Vec3d (&to)[4], double thickness) {
  const Impact<double> impact = edge_edge_impact(from, to, thickness);
  if (!impact.hit) return impact;
  Vec3<Sharp> sharp_from[4], sharp_to[4];
  convert_all(from, sharp_from);
  convert_all(to, sharp_to);
  return rounded(edge_edge_impact(sharp_from, sharp_to, Sharp(thickness)));
}

}  // namespace pliant

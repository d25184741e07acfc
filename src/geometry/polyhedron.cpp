#include "geometry/polyhedron.h"

#include <cstddef>
#include <map>
#include <utility>

namespace pliant {

Polyhedron polyhedron_of(const ConvexHull& hull) {
  Polyhedron out;
  out.corners = hull.corners;
  out.normals = hull.normals;
  std::map<std::pair<int, int>, std::size_t> started;  // edges of which one face is known
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const std::vector<int>& loop = hull.faces[f];
    out.first_of_face.push_back(static_cast<int>(out.face_corners.size()));
    out.face_corners.insert(out.face_corners.end(), loop.begin(), loop.end());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      if (const auto other = started.find({b, a}); other != started.end()) {
        out.edges[other->second].right = static_cast<int>(f);
        continue;
      }
      started[{a, b}] = out.edges.size();
      out.edges.push_back({a, b, static_cast<int>(f), -1});
    }
  }
  out.first_of_face.push_back(static_cast<int>(out.face_corners.size()));
  for (const Vec3f& corner : out.corners) out.centre += corner;
  out.centre = out.centre * (1 / static_cast<float>(out.corners.size()));
  return out;
}

Polyhedron polyhedron_of_box(const Vec3f& h) {
  ConvexHull box;
  for (int i = 0; i < 8; ++i)
    box.corners.push_back({(i & 1) != 0 ? h.x : -h.x, (i & 2) != 0 ? h.y : -h.y, (i & 4) != 0 ? h.z : -h.z});
  box.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  box.normals = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  return polyhedron_of(box);
}

void move(const Polyhedron& polyhedron, const Posef& pose, Polyhedron& out) {
  out = polyhedron;
  for (Vec3f& corner : out.corners) corner = to_world(pose, corner);
  for (Vec3f& normal : out.normals) normal = rotate(pose.rotation, normal);
  out.centre = to_world(pose, out.centre);
}

Polyhedron moved(const Polyhedron& polyhedron, const Posef& pose) {
  Polyhedron out;
  move(polyhedron, pose, out);
  return out;
}

}  // namespace pliant

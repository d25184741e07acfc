// Computes the table of marching cubes.
#include "surface/cube_cases.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pliant::surface {

namespace {

/// The corners of the six faces, counter-clockwise seen from outside.
constexpr std::array<std::array<int, 4>, 6> faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// The edge between two corners.
int edge_between(int a, int b) {
  for (int edge = 0; edge < 12; ++edge)
    if (edge_start(edge) == std::min(a, b) && (a ^ b) == 1 << (edge >> 2)) return edge;
  return -1;
}

bool is_on_face(int edge, const std::array<int, 4>& face) {
  const int start = edge_start(edge), end = start | 1 << (edge >> 2);
  const auto has = [&](int corner) { return std::find(face.begin(), face.end(), corner) != face.end(); };
  return has(start) && has(end);
}

bool share_a_face(int a, int b) {
  return std::any_of(faces.begin(), faces.end(),
                     [&](const auto& face) { return is_on_face(a, face) && is_on_face(b, face); });
}

/// The edge that follows each crossed edge along its loop: on each face, a run of inside corners is entered at one edge
/// and left at another.
std::array<std::uint8_t, 12> successors(int inside) {
  const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
  std::array<std::uint8_t, 12> next{};
  for (const auto& face : faces)
    for (std::size_t i = 0; i < 4; ++i) {
      if (is_inside(face[i]) || !is_inside(face[(i + 1) % 4])) continue;
      std::size_t last = i + 1;
      while (is_inside(face[(last + 1) % 4])) ++last;
      const int entered = edge_between(face[i], face[(i + 1) % 4]);
      next[static_cast<std::size_t>(entered)] =
          static_cast<std::uint8_t>(edge_between(face[last % 4], face[(last + 1) % 4]));
    }
  return next;
}

using Polygon = std::vector<int>;

/// Triangulates the part first..last of a loop, whose closing edge is given. False if each way has a diagonal in a
/// face.
bool triangulate(const Polygon& loop, std::size_t first, std::size_t last, CubeCase& result) {
  if (last - first < 2) return true;
  const auto is_allowed = [&](std::size_t a, std::size_t b) { return b - a < 2 || !share_a_face(loop[a], loop[b]); };
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    if (!is_allowed(first, apex) || !is_allowed(apex, last)) continue;
    const std::uint8_t before = result.count;
    if (triangulate(loop, first, apex, result) && triangulate(loop, apex, last, result)) {
      const auto edge = [&](std::size_t i) { return static_cast<std::uint8_t>(loop[i]); };
      result.triangles.at(static_cast<std::size_t>(result.count++)) = {edge(first), edge(apex), edge(last)};
      return true;
    }
    result.count = before;
  }
  return false;
}

CubeCase make_case(int inside) {
  CubeCase result;
  result.next = successors(inside);
  std::array<bool, 12> is_done{};
  for (int start = 0; start < 12; ++start) {
    const int from = edge_start(start), to = from | 1 << (start >> 2);
    const bool is_crossed = (inside >> from & 1) != (inside >> to & 1);
    if (is_crossed) result.crossed.at(result.crossed_count++) = static_cast<std::uint8_t>(start);
    if (!is_crossed || is_done[static_cast<std::size_t>(start)]) continue;
    Polygon loop;
    for (int edge = start; !is_done[static_cast<std::size_t>(edge)];
         edge = result.next[static_cast<std::size_t>(edge)]) {
      is_done[static_cast<std::size_t>(edge)] = true;
      loop.push_back(edge);
    }
    triangulate(loop, 0, loop.size() - 1, result);
  }
  return result;
}

std::array<CubeCase, 256> make_cases() {
  std::array<CubeCase, 256> cases;
  for (std::size_t inside = 0; inside < cases.size(); ++inside) cases[inside] = make_case(static_cast<int>(inside));
  return cases;
}

}  // namespace

const std::array<CubeCase, 256>& cube_cases() {
  static const std::array<CubeCase, 256> cases = make_cases();
  return cases;
}

}  // namespace pliant::surface

// Most of a large body's surface stays as it is when the body comes apart in some places. So if the triangles are the
// border of the tetrahedra, in the order of border_triangles, only those at reached particles are found again; else all
// are.
#include "matter/solid_border.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "matter/around.h"
#include "matter/cut_edges.h"
#include "matter/tetrahedron_faces.h"
#include "pliant/soft_body.h"
#include "topology/edges.h"

namespace pliant {

namespace {

using Corners = std::array<int, 4>;

/// A triangle, and the face that it is: four times the tetrahedron plus the face's number.
struct BorderFace {
  std::int64_t face = 0;
  Triangle triangle{};
};

bool is_reached(const Triangle& triangle, const std::vector<char>& reached) {
  return std::any_of(triangle.begin(), triangle.end(),
                     [&](int p) { return reached[static_cast<std::size_t>(p)] != 0; });
}

/// Numbers of faces whose sum without carry tells sets of them apart, as in chess programs (Zobrist 1970): what is in
/// it twice cancels.
class FaceNumbers {
 public:
  explicit FaceNumbers(std::size_t particles) {
    of_particle_.reserve(particles);
    for (std::uint64_t p = 0; p < particles; ++p) of_particle_.push_back(mix(mix(p + 1)));
  }

  std::uint64_t of(int particle) const { return of_particle_[static_cast<std::size_t>(particle)]; }
  std::uint64_t of(const Triangle& t) const { return mix(of(t[0]) + of(t[1]) + of(t[2])); }
  std::uint64_t of_faces(const Corners& t) const {
    const std::uint64_t a = of(t[0]), b = of(t[1]), c = of(t[2]), d = of(t[3]), all = a + b + c + d;
    return mix(all - a) ^ mix(all - b) ^ mix(all - c) ^ mix(all - d);
  }

 private:
  static std::uint64_t mix(std::uint64_t x) {
    x *= 0x9e3779b97f4a7c15U;
    return x ^ (x >> 32);
  }

  std::vector<std::uint64_t> of_particle_;
};

/// The faces that triangles are, if these are the border of tetrahedra in the order of border_triangles: each has the
/// corners of a face, the faces ascend, and all other faces are there twice.
std::optional<std::vector<BorderFace>> faces_of(const std::vector<Triangle>& triangles,
                                                const std::vector<Corners>& tetrahedra,
                                                const std::vector<Vec3f>& positions) {
  const FaceNumbers numbers(positions.size());
  std::uint64_t sum = 0;
  for (const Triangle& triangle : triangles) sum ^= numbers.of(triangle);
  std::vector<BorderFace> found;
  auto next = triangles.begin();
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    sum ^= numbers.of_faces(tetrahedra[t]);
    if (next == triangles.end() || !has_corner(tetrahedra[t], (*next)[0]) || !has_corner(tetrahedra[t], (*next)[1]))
      continue;
    const Corners corners = wound(tetrahedra[t], positions);
    for (std::size_t f = 0; f < tetrahedron_faces.size() && next != triangles.end(); ++f)
      if (*next == face_of(corners, f)) found.push_back({static_cast<std::int64_t>(4 * t + f), *next++});
  }
  if (next != triangles.end() || sum != 0) return {};
  return found;
}

/// The border faces with a reached corner after the edit, ascending; nothing if three tetrahedra share one.
std::optional<std::vector<BorderFace>> reached_border(const SolidParting& parting, const std::vector<Corners>& after,
                                                      const std::vector<Vec3f>& positions) {
  std::vector<std::pair<Triangle, BorderFace>> faces;  // key: sorted corners
  for (std::size_t t = 0; t < after.size(); ++t) {
    const Corners& old = parting.tetrahedra[t];
    char any = 0;
    for (const int corner : old) any |= parting.reached[static_cast<std::size_t>(corner)];
    if (any == 0 || (!parting.removed.empty() && parting.removed[t] != 0)) continue;
    const Corners before = wound(old, positions), now = wound(after[t], positions);
    for (std::size_t f = 0; f < tetrahedron_faces.size(); ++f) {
      if (!is_reached(face_of(before, f), parting.reached)) continue;
      Triangle sorted = face_of(now, f);
      std::sort(sorted.begin(), sorted.end());
      faces.push_back({sorted, {static_cast<std::int64_t>(4 * t + f), face_of(now, f)}});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<BorderFace> found;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].first == faces[i].first) ++end;
    if (end - i > 2) return {};
    if (end - i == 1) found.push_back(faces[i].second);
    i = end;
  }
  std::sort(found.begin(), found.end(), [](const BorderFace& a, const BorderFace& b) { return a.face < b.face; });
  return found;
}

/// The border after the edit, found from that before it; nothing if the triangles are not all of that.
std::optional<std::vector<Triangle>> changed_border(const std::vector<Triangle>& triangles, const SolidParting& parting,
                                                    const std::vector<Corners>& after,
                                                    const std::vector<Vec3f>& positions) {
  std::optional<std::vector<BorderFace>> known = faces_of(triangles, parting.tetrahedra, positions);
  if (!known) return {};
  const std::optional<std::vector<BorderFace>> fresh = reached_border(parting, after, positions);
  if (!fresh) return {};
  std::erase_if(*known, [&](const BorderFace& one) { return is_reached(one.triangle, parting.reached); });
  std::vector<BorderFace> merged;
  std::merge(known->begin(), known->end(), fresh->begin(), fresh->end(), std::back_inserter(merged),
             [](const BorderFace& a, const BorderFace& b) { return a.face < b.face; });
  std::vector<Triangle> border;
  border.reserve(merged.size());
  for (const BorderFace& one : merged) border.push_back(one.triangle);
  return border;
}

/// The border after the edit, of all tetrahedra that stay.
std::vector<Triangle> whole_border(const SolidParting& parting, const std::vector<Corners>& after,
                                   const std::vector<Vec3f>& positions) {
  std::vector<Corners> kept;
  for (std::size_t t = 0; t < after.size(); ++t)
    if (parting.removed.empty() || parting.removed[t] == 0) kept.push_back(after[t]);
  return border_triangles({positions, std::move(kept)});
}

/// Takes out the triangles whose corners are all of tetrahedra; returns them.
std::vector<Triangle> take_solid(std::vector<Triangle>& triangles, const std::vector<Corners>& tetrahedra,
                                 std::size_t particles) {
  std::vector<char> is_solid(particles);
  for (const Corners& t : tetrahedra)
    for (const int corner : t) is_solid[static_cast<std::size_t>(corner)] = 1;
  std::vector<Triangle> taken;
  std::erase_if(triangles, [&](const Triangle& triangle) {
    const bool take = std::all_of(triangle.begin(), triangle.end(),
                                  [&](int p) { return is_solid[static_cast<std::size_t>(p)] != 0; });
    if (take) taken.push_back(triangle);
    return take;
  });
  return taken;
}

/// The triangles that have the corners of no tetrahedron, be they all of tetrahedra.
std::vector<Triangle> triangles_of_cloth(const Object& object, const std::vector<Corners>& tetrahedra) {
  const Around around(tetrahedra, std::vector<char>(object.positions.size(), 1));
  std::vector<Triangle> found = object.triangles;
  std::erase_if(found, [&](const Triangle& triangle) {
    const std::span<const int> at = around[triangle[0]];
    return std::any_of(at.begin(), at.end(), [&](int t) {
      const Corners& corners = tetrahedra[static_cast<std::size_t>(t)];
      return has_corner(corners, triangle[1]) && has_corner(corners, triangle[2]);
    });
  });
  return found;
}

}  // namespace

std::vector<Triangle> surface_after(const Object& object, const SolidParting& parting,
                                    const std::vector<Corners>& after, const std::vector<Vec3f>& positions) {
  require_triangles(object);
  std::vector<Triangle> all = object.triangles;
  const std::vector<Triangle> solid = take_solid(all, parting.tetrahedra, object.positions.size());
  std::optional<std::vector<Triangle>> border = changed_border(solid, parting, after, positions);
  if (!border) {
    all = triangles_of_cloth(object, parting.tetrahedra);
    border = whole_border(parting, after, positions);
  }
  all.insert(all.end(), border->begin(), border->end());
  return all;
}

}  // namespace pliant

// Tears surfaces and soft bodies where they are stretched too far, and cuts them along planes.
//
// A tear splits one particle of what is too long: the triangles or tetrahedra around it part by the side of a plane through the
// particle, across the direction of the greatest stretch, on which they lie (Mueller et al. 2007, section 4.6). The mesh around it
// stays as it was, and ends of the tear are the next to split.
#include <algorithm>
#include <cmath>
#include <string>

#include "constraints/registry.h"
#include "math/jacobi_rotation.h"
#include "matter/cut_edges.h"
#include "matter/cut_faces.h"
#include "matter/edit_parts.h"
#include "matter/plane_sides.h"
#include "model/soft_body_substeps.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace pliant {

namespace {

using Tetrahedron = std::array<int, 4>;

Vec3d wide(const Vec3f& p) { return {p.x, p.y, p.z}; }

/// What comes apart in one Edit.
struct Breaks {
  std::set<Edge> edges;                 ///< of triangles
  std::set<Face> faces;                 ///< of tetrahedra
  std::set<std::pair<int, int>> links;  ///< constraints that are removed: group, and number in it

  bool any() const { return !edges.empty() || !faces.empty() || !links.empty(); }
};

Edit broken(const Object& object, const Breaks& at) {
  if (!at.faces.empty()) return cut_faces(object, at.faces);
  Object without = object;
  for (std::size_t g = 0; g < object.constraints.size() && !at.links.empty(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    const int slots = slots_of(group, object);
    ConstraintGroup kept = empty_like(group);
    for (int c = 0; c < static_cast<int>(group.particles.size()) / slots; ++c)
      if (at.links.count({static_cast<int>(g), c}) == 0) append(group, c, stencil_of(group, slots, c), 1, kept);
    without.constraints[g] = std::move(kept);
  }
  if (at.edges.empty()) return unchanged(without);
  without.volume.reset();  // through the tear the gas escapes
  return cut_edges(without, at.edges);
}

/// Particles that must not be split, because both copies would be held at the same place.
std::vector<char> held_particles(const Object& object) {
  std::vector<char> held(object.positions.size());
  for (std::size_t i = 0; i < object.masses.size(); ++i) held[i] = std::isinf(object.masses[i]) ? 1 : 0;
  for (const Pin& pin : object.pins) held.at(static_cast<std::size_t>(pin.particle)) = 1;
  for (const Attachment& attachment : object.attachments) held.at(static_cast<std::size_t>(attachment.particle)) = 1;
  return held;
}

// ---------------------------------------------------------------- surfaces and links

/// A distance constraint that is too long.
struct LongLink {
  double stretch = 1;
  int group = 0, number = 0;
  int a = 0, b = 0;
};

/// Calls body(group, number, a, b, rest length) for each distance constraint.
template <class Body>
void for_each_link(const Object& object, Body&& body) {
  for (std::size_t g = 0; g < object.constraints.size(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    if (!is_length(group.type)) continue;
    for (std::size_t c = 0; 2 * c + 1 < group.particles.size(); ++c) {
      const int a = group.particles[2 * c], b = group.particles[2 * c + 1];
      const Vec3d d =
          wide(object.positions[static_cast<std::size_t>(b)]) - wide(object.positions[static_cast<std::size_t>(a)]);
      const double rest = group.rest.empty() ? std::sqrt(dot(d, d)) : static_cast<double>(group.rest[c]);
      body(static_cast<int>(g), static_cast<int>(c), a, b, rest);
    }
  }
}

/// The links that are too long, the longest first.
std::vector<LongLink> long_links(const Object& object, std::span<const Vec3f> positions) {
  std::vector<LongLink> found;
  for_each_link(object, [&](int group, int number, int a, int b, double rest) {
    const Vec3d d = wide(positions[static_cast<std::size_t>(b)]) - wide(positions[static_cast<std::size_t>(a)]);
    const double stretch = rest > 0 ? std::sqrt(dot(d, d)) / rest : 0;
    if (stretch > static_cast<double>(object.tearing->stretch)) found.push_back({stretch, group, number, a, b});
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const LongLink& one, const LongLink& other) { return one.stretch > other.stretch; });
  return found;
}

/// Tears a surface.
class SurfaceTear {
 public:
  SurfaceTear(const Object& object, std::span<const Vec3f> positions)
      : object_(object),
        positions_(positions),
        around_(triangles_around(object)),
        held_(held_particles(object)),
        touched_(object.positions.size()) {}

  Breaks find() {
    for (const LongLink& link : long_links(object_, positions_)) {
      if (touched(link.a) || touched(link.b)) continue;
      if (is_edge(link.a, link.b))
        tear(link.a, link.b);
      else
        breaks_.links.insert({link.group, link.number});
    }
    return std::move(breaks_);
  }

 private:
  const std::vector<int>& around(int p) const { return around_[static_cast<std::size_t>(p)]; }
  const std::array<int, 3>& triangle(int t) const { return object_.triangles[static_cast<std::size_t>(t)]; }
  Vec3d at(int p) const { return wide(positions_[static_cast<std::size_t>(p)]); }
  bool touched(int p) const { return touched_[static_cast<std::size_t>(p)] != 0; }

  bool is_edge(int a, int b) const {
    return std::any_of(around(a).begin(), around(a).end(), [&](int t) { return has_corner(triangle(t), b); });
  }

  /// True if an edge at p belongs to one triangle alone.
  bool is_on_border(int p) const {
    for (const int t : around(p))
      for (const int other : triangle(t)) {
        if (other == p) continue;
        const auto count =
            std::count_if(around(p).begin(), around(p).end(), [&](int one) { return has_corner(triangle(one), other); });
        if (count == 1) return true;
      }
    return false;
  }

  /// The edges at p between triangles on both sides of the plane through p across the way to `toward`.
  std::set<Edge> edges_across(int p, int toward) const {
    const Vec3d way = at(toward) - at(p);
    const auto is_ahead = [&](int t) {
      const auto& [a, b, c] = triangle(t);
      return dot(at(a) + at(b) + at(c) - at(p) * 3., way) > 0;
    };
    std::set<Edge> found;
    for (const int one : around(p))
      for (const int two : around(p)) {
        if (!is_ahead(one) || is_ahead(two)) continue;
        for (const int corner : triangle(one))
          if (corner != p && has_corner(triangle(two), corner)) found.insert(edge_of(p, corner));
      }
    return found;
  }

  /// Splits one end of an edge: one that is not held, on the border before others, so that tears run on.
  void tear(int a, int b) {
    const bool b_first = held(a) || (!held(b) && is_on_border(b) && !is_on_border(a));
    if (!split(b_first ? b : a, b_first ? a : b)) split(b_first ? a : b, b_first ? b : a);
  }

  bool held(int p) const { return held_[static_cast<std::size_t>(p)] != 0; }

  bool split(int p, int toward) {
    if (held(p)) return false;
    const std::set<Edge> edges = edges_across(p, toward);
    if (edges.empty()) return false;
    breaks_.edges.insert(edges.begin(), edges.end());
    for (const int t : around(p))
      for (const int corner : triangle(t)) touched_[static_cast<std::size_t>(corner)] = 1;
    return true;
  }

  const Object& object_;
  std::span<const Vec3f> positions_;
  Around around_;
  std::vector<char> held_, touched_;  ///< by particle
  Breaks breaks_;
};

// ---------------------------------------------------------------- soft bodies

/// A tetrahedron that is too long along a direction of the rest shape.
struct LongTetrahedron {
  double stretch = 1;
  int number = 0;
  Vec3d direction;
};

/// The greatest stretch of a tetrahedron, and its direction in the rest shape: of F^T F, F the deformation gradient.
LongTetrahedron greatest_stretch(const Tetrahedron& t, const std::vector<Vec3f>& rest, std::span<const Vec3f> now) {
  const auto edges = [&](const auto& positions, Vec3d(&out)[3]) {
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = wide(positions[static_cast<std::size_t>(t[i + 1])]) - wide(positions[static_cast<std::size_t>(t[0])]);
  };
  Vec3d x[3], y[3];
  edges(rest, x);
  edges(now, y);
  const double six = dot(cross(x[0], x[1]), x[2]);
  if (std::fabs(six) < 1e-30) return {};
  const Vec3d rows[3] = {cross(x[1], x[2]) * (1 / six), cross(x[2], x[0]) * (1 / six), cross(x[0], x[1]) * (1 / six)};
  const auto column = [&](double Vec3d::*axis) {
    return y[0] * (rows[0].*axis) + y[1] * (rows[1].*axis) + y[2] * (rows[2].*axis);
  };
  const Vec3d f[3] = {column(&Vec3d::x), column(&Vec3d::y), column(&Vec3d::z)};
  Diagonal<3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.a[i][j] = dot(f[i], f[j]);
  make_diagonal(m);
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (m.a[i][i] > m.a[largest][largest]) largest = i;
  return {std::sqrt(std::max(m.a[largest][largest], 0.)), 0, {m.v[0][largest], m.v[1][largest], m.v[2][largest]}};
}

/// Tears a soft body.
class SolidTear {
 public:
  SolidTear(const Object& object, std::span<const Vec3f> positions)
      : object_(object),
        positions_(positions),
        tetrahedra_(required_tetrahedra(object)),
        around_(object.positions.size()),
        held_(held_particles(object)),
        touched_(object.positions.size()) {}

  Breaks find() {
    const std::vector<LongTetrahedron> longs = too_long();
    if (longs.empty()) return {};
    for (int t = 0; t < static_cast<int>(tetrahedra_.size()); ++t)
      for (const int corner : tetrahedron(t)) around_[static_cast<std::size_t>(corner)].push_back(t);
    on_surface_.resize(object_.positions.size());
    for (const auto& triangle : object_.triangles)
      for (const int corner : triangle) on_surface_[static_cast<std::size_t>(corner)] = 1;
    for (const LongTetrahedron& one : longs) tear(one);
    return std::move(breaks_);
  }

 private:
  const Tetrahedron& tetrahedron(int t) const { return tetrahedra_[static_cast<std::size_t>(t)]; }
  const std::vector<int>& around(int p) const { return around_[static_cast<std::size_t>(p)]; }
  static bool is_in(const std::vector<char>& set, int p) { return set[static_cast<std::size_t>(p)] != 0; }

  std::vector<LongTetrahedron> too_long() const {
    std::vector<LongTetrahedron> found;
    for (int t = 0; t < static_cast<int>(tetrahedra_.size()); ++t) {
      LongTetrahedron one = greatest_stretch(tetrahedron(t), object_.positions, positions_);
      one.number = t;
      if (one.stretch > static_cast<double>(object_.tearing->stretch)) found.push_back(one);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const LongTetrahedron& one, const LongTetrahedron& other) { return one.stretch > other.stretch; });
    return found;
  }

  /// Splits a corner: one that is not held, on the surface before others, so that tears begin there and run on.
  void tear(const LongTetrahedron& one) {
    Tetrahedron corners = tetrahedron(one.number);
    if (std::any_of(corners.begin(), corners.end(), [&](int p) { return is_in(touched_, p); })) return;
    std::stable_sort(corners.begin(), corners.end(),
                     [&](int a, int b) { return is_in(on_surface_, a) && !is_in(on_surface_, b); });
    for (const int corner : corners) {
      if (is_in(held_, corner)) continue;
      const std::set<Face> faces = faces_across(corner, one.direction);
      if (faces.empty()) continue;
      breaks_.faces.insert(faces.begin(), faces.end());
      for (const int t : around(corner))
        for (const int p : tetrahedron(t)) touched_[static_cast<std::size_t>(p)] = 1;
      return;
    }
  }

  /// The faces at p between tetrahedra on both sides of the plane through p, across a direction of the rest shape.
  std::set<Face> faces_across(int p, const Vec3d& direction) const {
    std::vector<Tetrahedron> near;
    std::vector<char> is_ahead;
    const Vec3d place = wide(object_.positions[static_cast<std::size_t>(p)]);
    for (const int t : around(p)) {
      near.push_back(tetrahedron(t));
      Vec3d sum = place * -4.;
      for (const int corner : near.back()) sum = sum + wide(object_.positions[static_cast<std::size_t>(corner)]);
      is_ahead.push_back(dot(sum, direction) > 0 ? 1 : 0);
    }
    std::set<Face> found;
    for (const InnerFace& inner : inner_faces(near))
      if (is_ahead[static_cast<std::size_t>(inner.a)] != is_ahead[static_cast<std::size_t>(inner.b)] &&
          std::find(inner.face.begin(), inner.face.end(), p) != inner.face.end())
        found.insert(inner.face);
    return found;
  }

  const Object& object_;
  std::span<const Vec3f> positions_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<std::vector<int>> around_;           ///< tetrahedra at each particle
  std::vector<char> held_, touched_, on_surface_;  ///< by particle
  Breaks breaks_;
};

// ---------------------------------------------------------------- cuts along planes

/// Adds what a cut has reached at a time.
void add_cut(const Object& object, const PlaneCut& cut, double time, Breaks& breaks) {
  const PlaneSides sides(object, cut, time);
  if (is_soft_body(object)) {
    const std::vector<Tetrahedron> tetrahedra = required_tetrahedra(object);
    for (const InnerFace& inner : inner_faces(tetrahedra))
      if (sides.are_parted(tetrahedra[static_cast<std::size_t>(inner.a)], tetrahedra[static_cast<std::size_t>(inner.b)]) &&
          sides.is_reached(inner.face))
        breaks.faces.insert(inner.face);
    return;
  }
  std::vector<int> side;
  for (const auto& triangle : object.triangles) side.push_back(sides.is_ahead(triangle) ? 1 : 0);
  for (const Edge& edge : edges_between(object, side))
    if (sides.is_reached(std::array<int, 2>{edge.first, edge.second})) breaks.edges.insert(edge);
  const Around around = triangles_around(object);
  for_each_link(object, [&](int group, int number, int a, int b, double) {
    if (triangles_of({a, b}, object, around).empty() && sides.are_parted(std::array<int, 1>{a}, std::array<int, 1>{b}) &&
        sides.is_reached(std::array<int, 2>{a, b}))
      breaks.links.insert({group, number});
  });
}

}  // namespace

std::optional<Edit> tear(const Object& object, std::span<const Vec3f> positions) {
  if (positions.size() != object.positions.size())
    throw Error({.object = object.name},
                "has " + std::to_string(object.positions.size()) + " particles and is given " +
                    std::to_string(positions.size()) + " positions",
                "give one for each particle of the description");
  if (!object.tearing) return {};
  const Breaks breaks = is_soft_body(object) ? SolidTear(object, positions).find() : SurfaceTear(object, positions).find();
  if (!breaks.any()) return {};
  return broken(object, breaks);
}

std::optional<Edit> make_cuts(const Object& object, double time) {
  Breaks breaks;
  for (const PlaneCut& cut : object.cuts)
    if (time >= static_cast<double>(cut.start)) add_cut(object, cut, time, breaks);
  if (!breaks.any()) return {};
  return broken(object, breaks);
}

}  // namespace pliant

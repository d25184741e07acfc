#include "collision/untangle/initial_intersections.h"

#include <algorithm>
#include <tuple>

#include "collision/broad/bounds.h"

namespace pliant {

namespace {

/// Returns the bounding box of a body's particles.
BoxBounds box_of(const Block& vertices, const Record* positions) {
  const auto at = [&](int v) { return Vec3f{positions[v].x, positions[v].y, positions[v].z}; };
  BoxBounds box{at(vertices.first), at(vertices.first)};
  for (int v = vertices.first; v < vertices.end(); ++v) box = {min(box.low, at(v)), max(box.high, at(v))};
  return box;
}

/// A selection of a model's triangles as a mesh of its own.
struct Extract {
  std::vector<int> numbers, vertices;  ///< indices in the model of the triangles and vertices, ascending
  std::vector<Triangle> triangles;     ///< triangles as indices into `vertices`

  void add(int number, const Triangle& t) {
    numbers.push_back(number);
    triangles.push_back(t);
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  void renumber() {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (Triangle& t : triangles)
      for (int& v : t) v = static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  }
};

/// Adds the triangles of a body that overlap a box.
void add_triangles_in(const BoxBounds& box, const PairModel& model, const Block& triangles, const Record* positions,
                      Extract& out) {
  for (int number = triangles.first; number < triangles.end(); ++number) {
    const Triangle& t = model.elements.triangles[number];
    const auto at = [&](int k) { return Vec3f{positions[t[k]].x, positions[t[k]].y, positions[t[k]].z}; };
    const Vec3f corners[3] = {at(0), at(1), at(2)};
    if (overlap(BoxBounds::of(corners, 3), box)) out.add(number, t);
  }
}

/// Selects all triangles of a body, and those of bodies that it may meet that overlap its bounding box.
Extract around_body(const PairModel& model, int body, const Record* positions) {
  const BodyElements& own = model.bodies.at(body);
  Extract out;
  if (own.triangles.size == 0) return out;
  const BoxBounds box = box_of(own.vertices, positions);
  for (const auto& [other, of] : model.bodies) {
    if (of.triangles.size == 0 || (other != body && !model.shared->rules.meet(body, other))) continue;
    if (other == body || overlap(box_of(of.vertices, positions), box))
      add_triangles_in(box, model, of.triangles, positions, out);
  }
  out.renumber();
  return out;
}

void sort(std::vector<Intersection>& found) {
  std::sort(found.begin(), found.end(), [](const Intersection& x, const Intersection& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  });
}

}  // namespace

void InitialIntersections::change(const std::vector<int>& removed, const std::vector<int>& added) {
  finder_ = nullptr;
  std::erase_if(new_bodies_, [&](int body) { return std::binary_search(removed.begin(), removed.end(), body); });
  new_bodies_.insert(new_bodies_.end(), added.begin(), added.end());
  std::sort(new_bodies_.begin(), new_bodies_.end());
}

void InitialIntersections::find(const Record* positions, bool forget) {
  if (finder_ == nullptr) make_finder();
  counts_before_.clear();
  if (!forget) counts_before_.swap(counts_);
  std::vector<Vec3f> places;
  places.reserve(vertices_.size());
  for (const int v : vertices_) places.push_back({positions[v].x, positions[v].y, positions[v].z});
  std::vector<Intersection> found = finder_->find(places);
  for (Intersection& one : found) one = {vertices_[one.a], vertices_[one.b], triangles_[one.triangle], one.kind};
  sort(found);
  keep(std::move(found));
}

/// Makes the search over all triangles. It numbers the vertices body by body, so that it costs what the PairModel's
/// bodies cost and not what the World does.
void InitialIntersections::make_finder() {
  std::vector<Triangle> in_use;
  triangles_.clear();
  vertices_.clear();
  for (const auto& [body, of] : model_.bodies) {
    if (of.triangles.size == 0) continue;
    const int shift = static_cast<int>(vertices_.size()) - of.vertices.first;
    for (int v = of.vertices.first; v < of.vertices.end(); ++v) vertices_.push_back(v);
    for (int number = of.triangles.first; number < of.triangles.end(); ++number) {
      const auto& [a, b, c] = model_.elements.triangles[number];
      triangles_.push_back(number);
      in_use.push_back({a + shift, b + shift, c + shift});
    }
  }
  finder_ = std::make_unique<IntersectionFinder>(in_use, static_cast<int>(vertices_.size()));
}

void InitialIntersections::find_of_new(const Record* positions) {
  if (new_bodies_.empty()) return;
  counts_before_.clear();
  std::vector<Intersection> found;
  for (const int body : new_bodies_) {
    const Extract near = around_body(model_, body, positions);
    std::vector<Vec3f> places;
    for (const int v : near.vertices) places.push_back({positions[v].x, positions[v].y, positions[v].z});
    IntersectionFinder finder(near.triangles, static_cast<int>(places.size()));
    for (const Intersection& one : finder.find(places)) {
      const Intersection in_model{near.vertices[one.a], near.vertices[one.b], near.numbers[one.triangle], one.kind};
      const int a = model_.shared->vertex_body[in_model.a],
                b = model_.shared->vertex_body[model_.elements.triangles[in_model.triangle][0]];
      const bool is_found_before =
          std::min(a, b) < body && std::binary_search(new_bodies_.begin(), new_bodies_.end(), std::min(a, b));
      if ((a == body || b == body) && !is_found_before) found.push_back(in_model);
    }
  }
  sort(found);
  keep(std::move(found));
}

/// Keeps the intersections between bodies that meet, counts them and exempts their pairs.
void InitialIntersections::keep(std::vector<Intersection> found) {
  new_bodies_.clear();
  const auto bodies_of = [&](const Intersection& one) {
    return std::pair(model_.shared->vertex_body[one.a],
                     model_.shared->vertex_body[model_.elements.triangles[one.triangle][0]]);
  };
  std::erase_if(found, [&](const Intersection& one) {
    const auto [a, b] = bodies_of(one);
    return !model_.shared->rules.meet(a, b);
  });
  found_ = std::move(found);
  counts_.clear();
  exempt_.clear();
  for (const Intersection& one : found_) {
    const auto [a, b] = bodies_of(one);
    ++counts_[std::minmax(a, b)];
    exempt(one);
  }
  std::sort(exempt_.begin(), exempt_.end());
}

bool InitialIntersections::are_no_fewer(std::pair<int, int> bodies) const {
  const auto before = counts_before_.find(bodies), now = counts_.find(bodies);
  return before != counts_before_.end() && now != counts_.end() && now->second >= before->second;
}

/// Exempts the pairs of primitives that an intersecting edge and triangle form with each other and their neighbours.
void InitialIntersections::exempt(const Intersection& found) {
  const TrianglesAround& triangles_at = model_.triangles_around;
  const auto exempt_corner = [&](int vertex, const Triangle& t) { exempt_.push_back({vertex, t[0], t[1], t[2], 1}); };
  const Triangle& t = model_.elements.triangles[found.triangle];
  exempt_corner(found.a, t);
  exempt_corner(found.b, t);
  const std::array<int, 2> crossing{found.a, found.b};
  for (int k = 0; k < 3; ++k) {
    const std::array<int, 2> side{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
    const auto &e = std::min(crossing, side), &f = std::max(crossing, side);
    exempt_.push_back({e[0], e[1], f[0], f[1], 2});
  }
  // Pairs of the triangle's corners with the triangles that contain the edge.
  for (const int* other = triangles_at.begin(found.a); other != triangles_at.end(found.a); ++other) {
    const Triangle& o = model_.elements.triangles[*other];
    if (o[0] != found.b && o[1] != found.b && o[2] != found.b) continue;
    for (const int corner : t) exempt_corner(corner, o);
  }
}

bool InitialIntersections::hold(const PairStencil& pair) const {
  if (exempt_.empty()) return false;
  const auto& v = pair.vertex;
  return std::binary_search(exempt_.begin(), exempt_.end(),
                            std::array<std::int32_t, 5>{v[0], v[1], v[2], v[3], pair.first_side});
}

}  // namespace pliant

#include "world/touching_starts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "collision/broad/tree.h"
#include "collision/near/neighbourhood.h"
#include "collision/proxies/pair_stencil.h"
#include "core/at.h"
#include "geometry/exact.h"
#include "geometry/triangle.h"
#include "math/disjoint_sets.h"
#include "math/record.h"
#include "topology/boundary.h"
#include "world/object_store.h"

namespace pliant {

namespace {

/// A vertex with less weight than this at the touching place does not touch.
constexpr double least_weight = 1e-3;
/// A vertex is clearly on one side of a triangle if it is above or below it by this share of its distance: beyond a
/// border it is on neither side.
constexpr double clear_side = 0.99;
/// Passes over the distances that a vertex has to keep from several triangles.
constexpr int passes = 3;
/// A vertex uses at most this share of the way to the next surface, which is searched to this multiple of its
/// displacement.
constexpr float share_of_room = 0.4f, looked_ahead = 1 / share_of_room;

/// The surface of an object: triangles, or lines as triangles whose last two corners are one. Vertices have their
/// numbers in the State.
struct Part {
  int number = 0;  ///< of the object in the model
  int first = 0, end = 0;
  std::vector<Triangle> elements;
  bool has_sides = false, moves = false, is_closed = false, is_near_others = false;
  float tolerance = 0;  ///< below which a distance is rounding [m]
  BoxBounds bounds{};
  /// Of the elements, grown by the tolerance; empty until they are needed, like the tree.
  std::vector<BoxBounds> boxes;
  Tree<BoxBounds> tree;

  bool has(int vertex) const { return vertex >= first && vertex < end; }
  /// 0 is fixed for 1 and 2, 1 for 2.
  int rank() const { return !moves ? 0 : is_closed ? 1 : 2; }
};

/// A vertex of the part that moves, on a triangle of the other.
struct TouchingVertex {
  int vertex = 0, triangle = 0;
  friend auto operator<=>(const TouchingVertex&, const TouchingVertex&) = default;  // NOLINT(modernize-use-nullptr)
};

/// A vertex has to move by `least` or more along `normal`.
struct Demand {
  int vertex = 0;
  Vec3d normal{};
  double least = 0;
};

class TouchingStarts {
 public:
  TouchingStarts(const Model& model, State& state);

  /// Moves the objects of all numbers, or of one.
  void run(int only);

 private:
  void add_part(int number);
  void build(Part& part);
  void sort_parts();
  bool meet(const Part& a, const Part& b) const;
  bool are_near(const Part& a, const Part& b) const;
  double distance_kept(const Part& a, const Part& b) const;
  Vec3d place(int vertex) const { return convert<double>(xyz(places_[at(vertex)])); }
  Vec3d normal_of(const Triangle& t) const { return triangle_normal(place(t[0]), place(t[1]), place(t[2])); }

  std::vector<TouchingVertex> find_touching(Part& moving, Part& fixed);
  void add_touching(const Part& moving, const Triangle& element, const Part& fixed, int triangle,
                    std::vector<TouchingVertex>& out) const;
  std::vector<char> far_sides(const Part& moving, const Part& fixed, const std::vector<TouchingVertex>& touching) const;
  int side_of(int vertex, const Part& fixed) const;
  void add_demands(Part& moving, Part& fixed, std::vector<Demand>& demands);
  void meet_demands(const std::vector<Demand>& demands);
  void keep_to_room(const Part& part);
  float room(int vertex, const Part& part, bool has_own_layers = true);
  float room(const Triangle& element, const Part& part);
  bool move_as_one(const Part& part, const std::vector<Demand>& demands);
  bool is_free_and_whole(const Part& part) const;
  void move(const Part& part);

  const Model& model_;
  State& state_;
  Records places_;             ///< of all particles at the start
  std::vector<Vec3d> shifts_;  ///< by which they move; empty: none does
  std::vector<Part> parts_;    ///< in the order in which one is fixed for the next
};

TouchingStarts::TouchingStarts(const Model& model, State& state)
    : model_(model), state_(state), places_(state.positions) {
  std::vector<char> is_field(model.objects.size(), 0);
  for (const FieldCollider& field : model.fields) is_field[at(field.object)] = 1;
  for (int number = 0; number < static_cast<int>(model.objects.size()); ++number) {
    const CompiledObject& object = model.objects[at(number)];
    if (object.particles == 0 || is_field[at(number)] != 0 || !(object.collides || object.is_collider)) continue;
    if (object.surface.triangles.empty() && object.lines.empty()) continue;
    if (state.time == 0) move_to_present(object, 0, &places_[at(model.first[at(number)])]);
    add_part(number);
  }
}

void TouchingStarts::add_part(int number) {
  const CompiledObject& object = model_.objects[at(number)];
  Part& part = parts_.emplace_back();
  part.number = number;
  part.first = model_.first[at(number)];
  part.end = part.first + object.particles;
  part.has_sides = !object.surface.triangles.empty();
  const int first = part.first;
  part.elements.reserve(object.surface.triangles.size() + object.lines.size());
  for (const auto& [a, b, c] : object.surface.triangles) part.elements.push_back({first + a, first + b, first + c});
  if (!part.has_sides)
    for (const auto& [a, b] : object.lines) part.elements.push_back({first + a, first + b, first + b});
  Vec3f low = xyz(places_[at(part.elements[0][0])]), high = low;
  for (const Triangle& element : part.elements)
    for (const int v : element) {
      low = min(low, xyz(places_[at(v)]));
      high = max(high, xyz(places_[at(v)]));
      part.moves = part.moves || places_[at(v)].w > 0;
    }
  const Vec3f extent = max(abs(low), abs(high));
  part.tolerance = least_margin_roundings * one_rounding * largest(extent);
  part.bounds = BoxBounds{low, high}.grown(part.tolerance);
}

/// Prepares the search in a part.
void TouchingStarts::build(Part& part) {
  if (!part.boxes.empty()) return;
  part.boxes.reserve(part.elements.size());
  for (const Triangle& t : part.elements) {
    const Vec3f corners[3] = {xyz(places_[at(t[0])]), xyz(places_[at(t[1])]), xyz(places_[at(t[2])])};
    part.boxes.push_back(BoxBounds::of(corners, 3).grown(part.tolerance));
  }
  part.tree.build(part.boxes);
}

bool TouchingStarts::meet(const Part& a, const Part& b) const {
  const CompiledObject &p = model_.objects[at(a.number)], &q = model_.objects[at(b.number)];
  if (a.number == b.number) return p.self_collision;
  const bool masks = (p.groups & q.mask) != 0 && (q.groups & p.mask) != 0;
  return masks && ((p.collides && q.collides) || p.is_collider || q.is_collider);
}

bool TouchingStarts::are_near(const Part& a, const Part& b) const { return meet(a, b) && overlap(a.bounds, b.bounds); }

/// The distance that contact keeps between two parts [m]; for a thickness of 0 twice what counts as touching.
double TouchingStarts::distance_kept(const Part& a, const Part& b) const {
  const CompiledObject &p = model_.objects[at(a.number)], &q = model_.objects[at(b.number)];
  float kept = p.thickness + q.thickness;
  for (const PairProperties& pair : model_.pairs) {
    const bool is_it =
        (pair.first == p.name && pair.second == q.name) || (pair.first == q.name && pair.second == p.name);
    if (is_it && pair.thickness) kept = *pair.thickness;
  }
  return static_cast<double>(std::max(kept, 2 * std::max(a.tolerance, b.tolerance)));
}

// ---------------------------------------------------------------- what touches

/// Adds the vertices of an element that are within the tolerance of a triangle, or at a place that is.
void TouchingStarts::add_touching(const Part& moving, const Triangle& element, const Part& fixed, int triangle,
                                  std::vector<TouchingVertex>& out) const {
  const Triangle& t = fixed.elements[at(triangle)];
  const auto tolerance = static_cast<double>(std::max(moving.tolerance, fixed.tolerance));
  const auto test = [&](const PairStencil& pair) {
    const PairDistance found = pair_distance(pair, places_.data());
    if (found.distance > tolerance) return;
    for (std::size_t i = 0; i < 4; ++i)
      if (moving.has(pair.vertex[i]) && std::abs(found.weight[i]) > least_weight)
        out.push_back({pair.vertex[i], triangle});
  };
  for (std::size_t k = 0; k < 3; ++k) {
    test({{element[k], t[0], t[1], t[2]}, 1});
    test({{t[k], element[0], element[1], element[2]}, 1});
    for (std::size_t j = 0; j < 3; ++j) test({{element[k], element[(k + 1) % 3], t[j], t[(j + 1) % 3]}, 2});
  }
}

std::vector<TouchingVertex> TouchingStarts::find_touching(Part& moving, Part& fixed) {
  build(moving);
  build(fixed);
  std::vector<TouchingVertex> touching;
  moving.tree.pairs(fixed.tree, [&](int element, int triangle) {
    add_touching(moving, moving.elements[at(element)], fixed, triangle, touching);
  });
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  return touching;
}

// ---------------------------------------------------------------- on which side

/// 1 or -1 for a vertex that is clearly on the side of the normal of the nearest triangle, or on the other; else 0.
int TouchingStarts::side_of(int vertex, const Part& fixed) const {
  const Vec3d p = place(vertex);
  const auto nearest = [&](int triangle) {
    const Triangle& t = fixed.elements[at(triangle)];
    return closest_on_triangle(p, place(t[0]), place(t[1]), place(t[2]));
  };
  const int triangle = fixed.tree
                           .closest(xyz(places_[at(vertex)]), std::numeric_limits<float>::max(),
                                    [&](int t) { return static_cast<float>(sqrt(nearest(t).distance_squared)); })
                           .first;
  if (triangle < 0) return 0;
  const auto found = nearest(triangle);
  const double distance = sqrt(found.distance_squared),
               height = dot(p - found.point, normal_of(fixed.elements[at(triangle)]));
  if (!(distance > static_cast<double>(fixed.tolerance)) || std::abs(height) < clear_side * distance) return 0;
  return height > 0 ? 1 : -1;
}

/// For each vertex of the moving part: 1 if it is in a touching patch of which all that is clearly on a side is on the
/// far one.
std::vector<char> TouchingStarts::far_sides(const Part& moving, const Part& fixed,
                                            const std::vector<TouchingVertex>& touching) const {
  const auto count = at(moving.end - moving.first);
  std::vector<char> touches(count, 0), is_far(count, 0);
  for (const TouchingVertex& one : touching) touches[at(one.vertex - moving.first)] = 1;
  DisjointSets patches(count);
  for (const Triangle& element : moving.elements)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(element[k] - moving.first), b = at(element[(k + 1) % 3] - moving.first);
      if (touches[a] != 0 && touches[b] != 0) patches.join(a, b);
    }
  std::vector<int> above(count, 0), below(count, 0);
  for (const Triangle& element : moving.elements) {
    const auto corner =
        std::find_if(element.begin(), element.end(), [&](int v) { return touches[at(v - moving.first)] != 0; });
    if (corner == element.end()) continue;
    const std::size_t patch = patches.root(at(*corner - moving.first));
    for (const int v : element) {
      const int side = touches[at(v - moving.first)] != 0 ? 0 : side_of(v, fixed);
      (side > 0 ? above : below)[patch] += std::abs(side);
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const std::size_t patch = touches[v] != 0 ? patches.root(v) : v;
    is_far[v] = touches[v] != 0 && below[patch] > 0 && above[patch] == 0 ? 1 : 0;
  }
  return is_far;
}

// ---------------------------------------------------------------- by how much

/// What the vertices of a part have to keep from one that is fixed for it, and which may have moved itself.
void TouchingStarts::add_demands(Part& moving, Part& fixed, std::vector<Demand>& demands) {
  const std::vector<TouchingVertex> touching = find_touching(moving, fixed);
  if (touching.empty()) return;
  if (shifts_.empty()) shifts_.resize(places_.size());
  const std::vector<char> is_far = far_sides(moving, fixed, touching);
  const double kept = distance_kept(moving, fixed);
  demands.reserve(demands.size() + touching.size());
  for (const TouchingVertex& one : touching) {
    const Triangle& t = fixed.elements[at(one.triangle)];
    Vec3d normal = normal_of(t);
    if (is_far[at(one.vertex - moving.first)] != 0) normal = -normal;
    double moved = dot(shifts_[at(t[0])], normal);
    for (const int corner : t) moved = std::max(moved, dot(shifts_[at(corner)], normal));
    if (length_squared(normal) > 0) demands.push_back({one.vertex, normal, moved + kept});
  }
}

void TouchingStarts::meet_demands(const std::vector<Demand>& demands) {
  for (int pass = 0; pass < passes; ++pass)
    for (const Demand& demand : demands) {
      if (!(places_[at(demand.vertex)].w > 0)) continue;
      Vec3d& shift = shifts_[at(demand.vertex)];
      const double missing = demand.least - dot(shift, demand.normal);
      if (missing > 0) shift += demand.normal * missing;
    }
  std::vector<int> between;  // opposed surfaces, of which neither side is right
  for (const Demand& demand : demands)
    if (dot(shifts_[at(demand.vertex)], demand.normal) < std::min(0., demand.least)) between.push_back(demand.vertex);
  for (const int vertex : between) shifts_[at(vertex)] = {};
}

/// The share of its displacement that a vertex can move by before it meets other surfaces and, with `has_own_layers`,
/// other layers of its own.
float TouchingStarts::room(int vertex, const Part& part, bool has_own_layers) {
  const Vec3f from = xyz(places_[at(vertex)]), along = convert<float>(shifts_[at(vertex)]) * looked_ahead;
  const Vec3f edge[2] = {from, from + along};
  const BoxBounds box = BoxBounds::of(edge, 2);
  float share = 1;
  for (Part& other : parts_) {
    if (!other.has_sides || !meet(part, other) || !overlap(other.bounds, box)) continue;
    if (&other == &part && !has_own_layers) continue;
    build(other);
    other.tree.query(box, [&](int number) {
      const Triangle& t = other.elements[at(number)];
      if (std::find(t.begin(), t.end(), vertex) != t.end()) return;
      const Vec3f corners[3] = {xyz(places_[at(t[0])]), xyz(places_[at(t[1])]), xyz(places_[at(t[2])])};
      if (how_edge_meets_triangle(edge, corners) == EdgeTriangle::apart) return;
      const Vec3d normal = normal_of(t);
      const double height = dot(normal, place(t[0]) - place(vertex)), rise = dot(normal, convert<double>(along));
      const bool touches = std::abs(height) < 2 * static_cast<double>(std::max(part.tolerance, other.tolerance));
      if (!touches && height / rise > 0) share = std::min(share, static_cast<float>(height / rise));
    });
  }
  return share;
}

/// The same for an element before it meets vertices of others. The paths of its corners do not see what lies over the
/// middle of a triangle.
float TouchingStarts::room(const Triangle& element, const Part& part) {
  const Vec3d mean = (shifts_[at(element[0])] + shifts_[at(element[1])] + shifts_[at(element[2])]) * (1. / 3);
  const Vec3f along = convert<float>(mean) * looked_ahead;
  const Vec3f corners[3] = {xyz(places_[at(element[0])]), xyz(places_[at(element[1])]), xyz(places_[at(element[2])])};
  const Vec3f swept[6] = {corners[0],         corners[1],         corners[2],
                          corners[0] + along, corners[1] + along, corners[2] + along};
  const BoxBounds box = BoxBounds::of(swept, 6);
  const Vec3d normal = normal_of(element);
  const double rise = dot(normal, convert<double>(along));
  float share = 1;
  if (!part.has_sides || rise == 0) return share;
  for (Part& other : parts_) {
    if (&other == &part || !meet(part, other) || !overlap(other.bounds, box)) continue;
    build(other);
    other.tree.query(box, [&](int number) {
      for (const int v : other.elements[at(number)]) {
        const double height = dot(normal, place(v) - place(element[0]));
        const bool touches = std::abs(height) < 2 * static_cast<double>(std::max(part.tolerance, other.tolerance));
        const Vec3f edge[2] = {xyz(places_[at(v)]), xyz(places_[at(v)]) - along};
        if (touches || !(height / rise > 0) || how_edge_meets_triangle(edge, corners) == EdgeTriangle::apart) continue;
        share = std::min(share, static_cast<float>(height / rise));
      }
    });
  }
  return share;
}

void TouchingStarts::keep_to_room(const Part& part) {
  std::vector<float> shares(at(part.end - part.first), 1.f);
  for (int v = part.first; v < part.end; ++v)
    if (length_squared(shifts_[at(v)]) > 0) shares[at(v - part.first)] = room(v, part);
  for (const Triangle& element : part.elements) {
    const float share = room(element, part);
    for (const int v : element) shares[at(v - part.first)] = std::min(shares[at(v - part.first)], share);
  }
  for (int v = part.first; v < part.end; ++v)
    shifts_[at(v)] = shifts_[at(v)] * static_cast<double>(shares[at(v - part.first)]);
}

/// True for an object that is one closed surface, of which nothing is held: a soft body, or a balloon.
bool TouchingStarts::is_free_and_whole(const Part& part) const {
  if (!part.is_closed) return false;
  for (int v = part.first; v < part.end; ++v)
    if (!(places_[at(v)].w > 0)) return false;
  DisjointSets pieces(at(part.end - part.first));
  for (const Triangle& t : part.elements)
    for (const int corner : {t[1], t[2]}) pieces.join(at(t[0] - part.first), at(corner - part.first));
  const std::size_t first = pieces.root(at(part.elements.front()[0] - part.first));
  return std::all_of(part.elements.begin(), part.elements.end(),
                     [&](const Triangle& t) { return pieces.root(at(t[0] - part.first)) == first; });
}

/// Moves a body as a whole, so that it is not squeezed. False if its particles have to move on their own.
bool TouchingStarts::move_as_one(const Part& part, const std::vector<Demand>& demands) {
  if (!is_free_and_whole(part)) return false;
  Vec3d shift{};
  for (int pass = 0; pass < passes; ++pass)
    for (const Demand& demand : demands)
      shift += demand.normal * std::max(0., demand.least - dot(shift, demand.normal));
  const bool is_between = std::any_of(demands.begin(), demands.end(), [&](const Demand& demand) {
    return dot(shift, demand.normal) < 0.5 * demand.least;
  });
  if (is_between) return false;
  std::fill(shifts_.begin() + part.first, shifts_.begin() + part.end, shift);
  float share = 1;
  for (const Triangle& element : part.elements) {
    share = std::min(share, room(element, part));
    for (const int v : element) share = std::min(share, room(v, part, false));
  }
  std::fill(shifts_.begin() + part.first, shifts_.begin() + part.end, shift * static_cast<double>(share));
  return true;
}

void TouchingStarts::move(const Part& part) {
  for (int v = part.first; v < part.end; ++v) {
    if (length_squared(shifts_[at(v)]) == 0) continue;
    const Vec3f to = convert<float>(place(v) + shifts_[at(v)]);
    Record& x = state_.positions[at(v)];
    x = {to.x, to.y, to.z, x.w};
  }
}

/// Finds which parts are near others, and puts them in order.
void TouchingStarts::sort_parts() {
  for (Part& part : parts_) {
    part.is_near_others = std::any_of(parts_.begin(), parts_.end(), [&](const Part& other) {
      return &other != &part && (part.moves || other.moves) && (part.has_sides || other.has_sides) &&
             are_near(part, other);
    });
    if (part.is_near_others && part.moves && part.has_sides)
      part.is_closed = is_closed(find_edges(model_.objects[at(part.number)].surface.triangles, part.end - part.first));
  }
  std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.rank() < b.rank(); });
}

void TouchingStarts::run(int only) {
  sort_parts();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].moves || !parts_[i].is_near_others || (only >= 0 && parts_[i].number != only)) continue;
    std::vector<Demand> demands;
    for (std::size_t k = 0; k < (only < 0 ? i : parts_.size()); ++k)
      if (k != i && parts_[k].has_sides && are_near(parts_[i], parts_[k])) add_demands(parts_[i], parts_[k], demands);
    if (demands.empty() || move_as_one(parts_[i], demands)) continue;
    meet_demands(demands);
    keep_to_room(parts_[i]);
  }
  if (shifts_.empty()) return;
  for (const Part& part : parts_)
    if (part.moves) move(part);
}

}  // namespace

void part_touching_starts(WorldData& world, int number) { TouchingStarts(world.model, world.state).run(number); }

}  // namespace pliant

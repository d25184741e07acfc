#include "solver/bodies/surface_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "math/wide.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Lists hold for about so many substeps at the present speed.
constexpr float substeps_of_lists = 8;

bool encloses(const BoxBounds& outer, const BoxBounds& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
         outer.high.x >= inner.high.x && outer.high.y >= inner.high.y && outer.high.z >= inner.high.z;
}

BoxBounds box_of(const MovingCollider& solid) { return {solid.swept.low, solid.swept.high}; }

std::vector<std::array<int, 3>> elements_of(const CompiledObject& object) {
  std::vector<std::array<int, 3>> out(object.surface.triangles.begin(), object.surface.triangles.end());
  if (!out.empty()) return out;
  for (const auto& [a, b] : object.lines) out.push_back({std::min(a, b), std::max(a, b), std::max(a, b)});
  return out;
}

/// The largest thickness that the scene's `pairs` give an object [m]; 0 without any.
float largest_named(const Model& model, const std::string& object) {
  float most = 0;
  for (const PairProperties& pair : model.pairs)
    if (pair.first == object || pair.second == object) most = max(most, pair.thickness.value_or(0));
  return most;
}

int lowest(const std::array<int, 3>& element) { return std::min(element[0], std::min(element[1], element[2])); }

/// Gives each element to the tile of its lowest vertex. `tiles` are those of one object, by their particles.
void add_elements(const CompiledObject& object, int first_particle, SurfaceTile* tiles, int count) {
  std::vector<std::array<int, 3>> elements = elements_of(object);
  std::stable_sort(elements.begin(), elements.end(),
                   [](const auto& a, const auto& b) { return lowest(a) < lowest(b); });
  for (std::array<int, 3>& e : elements)
    for (int& i : e) i += first_particle;
  auto next = elements.begin();
  for (int t = 0; t < count; ++t) {
    SurfaceTile& tile = tiles[t];
    tile.has_triangles = !object.surface.triangles.empty();
    tile.first_element.assign(at(tile.last - tile.first) + 1, 0);
    for (; next != elements.end() && lowest(*next) < tile.last; ++next) {
      if (lowest(*next) < tile.first) continue;
      ++tile.first_element[at(lowest(*next) - tile.first) + 1];
      tile.elements.push_back(*next);
      for (const int i : *next)
        if (i < tile.first || i >= tile.last) tile.border.push_back(i);
    }
    for (std::size_t i = 1; i < tile.first_element.size(); ++i) tile.first_element[i] += tile.first_element[i - 1];
    std::sort(tile.border.begin(), tile.border.end());
    tile.border.erase(std::unique(tile.border.begin(), tile.border.end()), tile.border.end());
  }
}

Quad least(const Quad& a, const Quad& b) { return a < b ? a : b; }
Quad most(const Quad& a, const Quad& b) { return a > b ? a : b; }
float squared_of(const Quad& a) {
  const Quad squares = a * a;
  return squares[0] + squares[1] + squares[2];
}

/// Calls visit(place, particle) for the particles of a tile and its border.
template <class Visit>
void for_vertices(const SurfaceTile& tile, const Visit& visit) {
  std::size_t place = 0;
  for (int i = tile.first; i < tile.last; ++i) visit(place++, at(i));
  for (const int i : tile.border) visit(place++, at(i));
}

/// The box of a tile's elements on their way, and its fastest vertex.
void measure(const Substep& s, SurfaceTile& tile) {
  Quad low = Quad{} + 3e38f, high = -low;
  float squared = 0;
  for_vertices(tile, [&](std::size_t, std::size_t i) {
    const Quad x = load_quad(&s.state.positions[i]), d = load_quad(&s.work.displacements[i]), to = x + d;
    low = least(low, least(x, to));
    high = most(high, most(x, to));
    squared = max(squared, squared_of(d));
  });
  tile.fastest = std::sqrt(squared);
  const float thickness = max(s.model.objects[at(tile.object)].thickness, tile.named_thickness);
  const BoxBounds box{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  tile.box = box.grown(2 * (thickness + 2 * tile.fastest));  // twice the reach of contacts
}

/// How far the fastest vertex has moved since the last call [m]; infinity if there was none.
float moved_since(const Substep& s, SurfaceTile& tile) {
  const std::size_t count = at(tile.last - tile.first) + tile.border.size();
  const bool is_first = tile.before.size() != count;
  tile.before.resize(count);
  float squared = 0;
  for_vertices(tile, [&](std::size_t place, std::size_t i) {
    const Record& x = s.state.positions[i];
    squared = max(squared, squared_of(load_quad(&x) - load_quad(&tile.before[place])));
    tile.before[place] = x;
  });
  return is_first ? std::numeric_limits<float>::infinity() : std::sqrt(squared);
}

/// Measures edges again where motion could have doubled them.
void measure_edges(const Substep& s, SurfaceTile& tile) {
  if (tile.longest > 0 && tile.grown < 0.5f * tile.longest) return;
  float squared = 0;
  for (const std::array<int, 3>& e : tile.elements) {
    const Vec3f a = xyz(s.state.positions[at(e[0])]), b = xyz(s.state.positions[at(e[1])]),
                c = xyz(s.state.positions[at(e[2])]);
    squared = max(squared, max(length_squared(b - a), max(length_squared(c - b), length_squared(a - c))));
  }
  tile.longest = std::sqrt(squared) * (1 + 1e-5f);
  tile.grown = 0;
}

}  // namespace

SurfaceTiles::SurfaceTiles(const Model& model, const std::vector<int>& tasks) {
  for (const int task : tasks) {
    SurfaceTile& tile = tiles_.emplace_back();
    const Task& of = model.tiles()[at(task)];
    const Tile& range = model.objects[at(of.object)].tiles[at(of.item)];
    const int first = model.first[at(of.object)];
    tile.task = task;
    tile.object = of.object;
    tile.named_thickness = largest_named(model, model.objects[at(of.object)].name);
    tile.first = first + range.first_particle;
    tile.last = first + range.last_particle;
  }
  for (std::size_t first = 0, last = 0; first < tiles_.size(); first = last) {
    const int object = tiles_[first].object;
    while (last < tiles_.size() && tiles_[last].object == object) ++last;
    add_elements(model.objects[at(object)], model.first[at(object)], &tiles_[first], static_cast<int>(last - first));
  }
}

bool SurfaceTiles::are_lists_valid(const std::vector<MovingCollider>& solids) const {
  if (kept_solids_.size() != solids.size()) return false;
  for (std::size_t i = 0; i < solids.size(); ++i)
    if (!encloses(kept_solids_[i], box_of(solids[i]))) return false;
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    if (!encloses(kept_tiles_[t], tiles_[t].box)) return false;
  return true;
}

void SurfaceTiles::make_lists(const std::vector<MovingCollider>& solids) {
  kept_solids_.clear();
  for (const MovingCollider& solid : solids) {
    const float path = length(solid.after.position - solid.before.position);
    kept_solids_.push_back(box_of(solid).grown(substeps_of_lists * path));
  }
  kept_tiles_.clear();
  for (const SurfaceTile& tile : tiles_) kept_tiles_.push_back(tile.box.grown(substeps_of_lists * tile.fastest));
  tree_.build(kept_solids_);
  tiles_near_.resize(solids.size());
  for (std::vector<int>& tiles : tiles_near_) tiles.clear();
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    std::vector<int>& near = tiles_[t].solids;
    near.clear();
    tree_.query(kept_tiles_[t], [&](int solid) { near.push_back(solid); });
    std::sort(near.begin(), near.end());
    for (const int solid : near) tiles_near_[at(solid)].push_back(static_cast<int>(t));
    tiles_[t].near_points.keep_only(near);
  }
}

void SurfaceTiles::sort_points(const Substep& s, int tile) {
  tiles_[at(tile)].near_points.sort();
  measure_edges(s, tiles_[at(tile)]);
}

void SurfaceTiles::begin_frame() {
  for (SurfaceTile& tile : tiles_) tile.longest = 0;
}

void SurfaceTiles::update(const Substep& s, const std::vector<MovingCollider>& solids, bool begins) {
  s.context.executor.parallel_for(nullptr, static_cast<int>(tiles_.size()), [&](int t) {
    SurfaceTile& tile = tiles_[at(t)];
    if (begins) {
      const float moved = moved_since(s, tile);
      tile.near_points.begin_substep(s.state.positions.data(), tile.first, tile.last, moved);
      tile.grown += 2 * moved;
      if (tile.longest > 0) tile.longest += 2 * moved;
    }
    measure(s, tile);
  });
  if (!are_lists_valid(solids)) make_lists(solids);
}

}  // namespace pliant

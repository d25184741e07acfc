#include "model/chains.h"

#include <algorithm>
#include <array>

#include "constraints/registry.h"
#include "model/fill_pool.h"
#include "topology/geodesics.h"
#include "topology/paths.h"

namespace pliant {

namespace {

constexpr int most_tethers = 4;

bool has_direction(const ConstraintList& list, int i) {
  return list.rest[i] > 0 &&
         list.stencils[2 * static_cast<std::size_t>(i)] != list.stencils[2 * static_cast<std::size_t>(i) + 1];
}

void move_constraint(const ConstraintList& from, int i, ConstraintList& to) {
  for (std::size_t slot = 0; slot < 2; ++slot)
    to.stencils.push_back(from.stencils[2 * static_cast<std::size_t>(i) + slot]);
  to.rest.push_back(from.rest[i]);
  to.response.push_back(from.response[i]);
  to.damping.push_back(from.damping[i]);
  to.origin.push_back(from.origin[i]);
}

/// Replaces particles by the targets that hold them.
void hold(ConstraintList& list, const std::vector<int>& held) {
  if (held.empty()) return;
  for (int& particle : list.stencils.own()) particle = held[particle];
}

std::vector<std::array<int, 2>> edges_of(const ConstraintList& list) {
  std::vector<std::array<int, 2>> edges(list.count());
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = {list.stencils[2 * i], list.stencils[2 * i + 1]};
  return edges;
}

std::vector<Vec3f> positions_of(const CompiledObject& object) {
  std::vector<Vec3f> places;
  places.reserve(object.positions.size());
  for (const Record& p : object.positions) places.push_back({p.x, p.y, p.z});
  return places;
}

/// Appends link number `step` of up to sixteen paths as one batch and one segment.
void append_step(const ConstraintList& list, const std::vector<Row>& rows, const Path* paths, int count, int step,
                 int pool_number, CompiledObject& out) {
  Pool& pool = out.pools[pool_number];
  const std::size_t block = pool.blocks.size();
  pool.blocks.resize(block + pool.block_floats);
  Segment segment{pool_number, 0, pool.batches, 1, 0, static_cast<std::int64_t>(pool.indices.size())};
  pool.indices.resize(pool.indices.size() + 2 * batch_width);
  for (int lane = 0; lane < batch_width; ++lane) {
    const Path& path = paths[std::min(lane, count - 1)];
    const bool valid = lane < count && step < static_cast<int>(path.edges.size());
    const int link = std::min(step, static_cast<int>(path.edges.size()) - 1);
    segment.last_count += valid ? 1 : 0;
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (pool.row_offset[row] >= 0) pool.blocks[block + pool.row_offset[row] + lane] = rows[row].at(path.edges[link]);
    std::int32_t* index = pool.indices.data() + segment.index_offset + lane;
    index[0] = path.vertices[valid ? link : link + 1];
    index[batch_width] = path.vertices[link + 1];
    pool.origin.push_back(valid ? list.origin[path.edges[link]] : -1);
  }
  out.segments.push_back(segment);
  ++pool.batches;
}

/// The inverse of a path's total mass. With a regularisation in proportion to it, each link stretches by the
/// same small share of g h^2 under the path's own weight, whatever the number of links and the load at the
/// path's end.
float mobility_of(const Path& path, const CompiledObject& object) {
  double mass = 0;
  for (int v : path.vertices) mass += object.positions[v].w > 0 ? 1 / double(object.positions[v].w) : 0.0;
  return mass > 0 ? static_cast<float>(1 / mass) : 0.f;
}

void append_colour(const ConstraintList& list, const PathColour& colour, float softness, int pool_number,
                   CompiledObject& out) {
  const std::vector<Row> rows = rows_of(list);
  const int paths = static_cast<int>(colour.paths.size());
  ObjectPhase batches{Driver::chain, static_cast<int>(out.chains.size()), 0};
  for (int first = 0; first < paths; first += batch_width) {
    ChainBatch batch{pool_number, static_cast<int>(out.segments.size()),
                     static_cast<int>(colour.paths[first].edges.size())};
    for (int step = 0; step < batch.steps; ++step)
      append_step(list, rows, &colour.paths[first], std::min(batch_width, paths - first), step, pool_number, out);
    out.chains.push_back(batch);
    for (int lane = 0; lane < batch_width; ++lane)
      out.chain_softness.push_back(first + lane < paths ? softness * mobility_of(colour.paths[first + lane], out)
                                                        : 0.f);
  }
  batches.last = static_cast<int>(out.chains.size());
  out.phases.push_back(batches);
}

struct Tether {
  int anchor = -1;  ///< index in Tethers::anchors; -1: no tether
  float length = no_tether;
};

/// Finds the tethers of each particle: `slots` entries per particle, sorted by anchor, so that neighbouring particles
/// have equal anchors in equal slots.
std::vector<Tether> tethers_of(const CompiledObject& object, const std::vector<std::vector<NearSource>>& near,
                               const std::vector<int>& anchors, float slack, int slots) {
  std::vector<Tether> tethers(object.positions.size() * slots);
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (object.positions[i].w == 0) continue;
    std::vector<NearSource> sorted = near[i];
    std::sort(sorted.begin(), sorted.end(),
              [](const NearSource& a, const NearSource& b) { return a.source < b.source; });
    for (std::size_t s = 0; s < sorted.size(); ++s) {
      const auto anchor = std::lower_bound(anchors.begin(), anchors.end(), sorted[s].source) - anchors.begin();
      const double length = sorted[s].distance * (1 + double(slack));
      tethers[i * slots + s] = {static_cast<int>(anchor), static_cast<float>(std::min(length, double(no_tether)))};
    }
  }
  return tethers;
}

void append_row(const Tether (&lanes)[batch_width], Tethers& out) {
  Tethers::Row row;
  int first = -1;
  bool alike = true;
  for (const Tether& tether : lanes) {
    if (tether.anchor < 0) continue;
    if (first < 0) first = tether.anchor;
    alike = alike && tether.anchor == first;
  }
  row.anchor = alike ? std::max(first, 0) : -1;
  row.lanes = static_cast<std::int32_t>(out.lane_anchors.size());
  for (const Tether& tether : lanes) {
    out.lengths.push_back(tether.length);
    if (!alike) out.lane_anchors.push_back(std::max(tether.anchor, 0));
  }
  out.rows.push_back(row);
}

}  // namespace

void split_off_chains(std::vector<ConstraintList>& lists, const std::vector<int>& held) {
  std::vector<ConstraintList> split;
  for (ConstraintList& list : lists) {
    if (!is_length(list.type) || list.law != Law::compliant) {
      split.push_back(std::move(list));
      continue;
    }
    ConstraintList chained = list.empty(), rest = list.empty();
    chained.chained = true;
    for (int i = 0; i < list.count(); ++i) move_constraint(list, i, has_direction(list, i) ? chained : rest);
    hold(chained, held);
    if (chained.count() > 0) split.push_back(std::move(chained));
    if (rest.count() > 0) split.push_back(std::move(rest));
  }
  lists = std::move(split);
}

void append_chains(const std::vector<ConstraintList>& lists, float softness, CompiledObject& out) {
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!lists[i].chained) continue;
    for (const PathColour& colour : lay_paths(positions_of(out), edges_of(lists[i])))
      append_colour(lists[i], colour, softness, static_cast<int>(i), out);
  }
}

Tethers find_tethers(const std::vector<ConstraintList>& lists, float slack, const std::vector<int>& anchors,
                     const CompiledObject& object) {
  Tethers out;
  out.anchors = anchors;
  Distances mesh{object.particles, {}, {}, object.surface.triangles};
  for (const ConstraintList& list : lists) {
    if (!is_length(list.type)) continue;
    const std::vector<std::array<int, 2>> more = edges_of(list);
    mesh.edges.insert(mesh.edges.end(), more.begin(), more.end());
    for (std::size_t i = 0; i < list.rest.size(); ++i) mesh.lengths.push_back(list.rest[i]);
  }
  const auto near = nearest_sources(mesh, out.anchors, most_tethers);
  for (std::size_t i = 0; i < near.size(); ++i)
    if (object.positions[i].w > 0) out.slots = std::max(out.slots, static_cast<int>(near[i].size()));
  if (out.slots == 0) return {};
  const std::vector<Tether> tethers = tethers_of(object, near, out.anchors, slack, out.slots);
  for (int first = 0; first < object.particles; first += batch_width) {
    for (int slot = 0; slot < out.slots; ++slot) {
      Tether lanes[batch_width];
      for (int lane = 0; lane < batch_width; ++lane) {
        const int particle = first + 4 * (lane % 4) + lane / 4;
        if (particle < object.particles) lanes[lane] = tethers[static_cast<std::size_t>(particle) * out.slots + slot];
      }
      append_row(lanes, out);
    }
  }
  return out;
}

}  // namespace pliant

// The clearance of PairSystem: of two clusters whose pairs would have to be listed anew, most can be seen to have none that are
// near, from how far apart boxes are or, within one surface, from the distances of vertices alone.
//
// Between a point p of one primitive and q of another, with weights a over corners x and b over corners y,
//
//   |p - q|^2  =  sum a_i b_j |x_i - y_j|^2  -  sum_{i<k} a_i a_k |x_i - x_k|^2  -  sum_{j<k} b_j b_k |y_j - y_k|^2.
//
// The first sum is no less than the least squared distance of two corners, and the others are at most a quarter of an edge's square
// for an edge and a third of its longest side's for a triangle. What lists hold shares no vertex and has no edge between two corners,
// so those pairs of vertices count for nothing; the next nearest, in cloth that lies flat, are the two that an edge has on its
// sides. Only where cloth bends sharply, or lies on itself, is there anything to be listed. There are some thirteen times as many primitives'
// boxes to be compared as vertices, and a distance asks for no paths: those of one substep are within its moves.
#include <algorithm>
#include <limits>

#include "collision/morton.h"
#include "collision/pair_bounds.h"

namespace pliant {

namespace {

/// Clearance is looked for up to so many skins beyond what is of interest, and is of use from so many on.
constexpr float most_skins = 1.25f, fewest_skins = 0.2f;
/// A squared distance of floats is rounded by less than this.
constexpr float squared_slack = 1e-5f;

/// How far two boxes are apart along the axis where they are farthest.
float distance_between(const BoxBounds& a, const BoxBounds& b) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z);
}

PlaceRows rows_of(std::vector<float> (&place)[3]) { return {{place[0].data(), place[1].data(), place[2].data()}}; }

}  // namespace

// ---------------------------------------------------------------- once for all

void PairSystem::lay_out_corners(const std::vector<std::array<std::int32_t, 2>>& joined) {
  std::vector<Vec3f> places;
  for (const Record& x : model_.rest) places.push_back({x.x, x.y, x.z});
  std::vector<int> order, rank(places.size());
  MortonSorter().sort(places, order);
  for (std::size_t i = 0; i < order.size(); ++i) rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  corners_.start.assign(1, 0);
  for (int c = 0; c < model_.clusters; ++c) {
    std::vector<std::int32_t> all(cluster_vertices_.begin() + cluster_start_[c],
                                  cluster_vertices_.begin() + cluster_start_[c + 1]);
    std::sort(all.begin(), all.end(), [&](int a, int b) { return rank[a] < rank[b]; });
    corners_.vertex.insert(corners_.vertex.end(), all.begin(), all.end());
    corners_.start.push_back(static_cast<int>(corners_.vertex.size()));
  }
  for (std::vector<float>& row : corners_.place) row.resize(corners_.vertex.size());
  corners_.batch_box.resize(corners_.vertex.size() / 16);
  corners_.wanted.resize(static_cast<std::size_t>(model_.clusters));
  lay_out_lines();
  leave_out_joined(joined);
}

void PairSystem::lay_out_lines() {
  corners_.line_start.assign(1, 0);
  corners_.longest.resize(static_cast<std::size_t>(model_.clusters));
  for (int c = 0; c < model_.clusters; ++c) {
    std::vector<std::array<std::int32_t, 2>> lines;
    for (const Kind kind : {edge_kind, triangle_kind}) {
      const Elements& of = elements_[kind];
      for (int i = of.start[c]; i < of.start[c + 1]; ++i)
        for (int k = 0; k < (kind == edge_kind ? 1 : 3); ++k) {
          const std::int32_t a = of.corner[k][i], b = of.corner[(k + 1) % of.corners][i];
          lines.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    while (lines.size() % 16 != 0) lines.push_back(lines.back());
    for (const auto& line : lines)
      for (int k = 0; k < 2; ++k) corners_.line[k].push_back(line[k]);
    corners_.line_start.push_back(static_cast<int>(corners_.line[0].size()));
  }
}

/// `joined`: vertices with an edge between them whose pairs are surroundings, each with its others.
void PairSystem::leave_out_joined(const std::vector<std::array<std::int32_t, 2>>& joined) {
  std::vector<std::vector<std::int32_t>> places(model_.rest.size()), others(model_.rest.size());
  for (std::size_t i = 0; i < corners_.vertex.size(); ++i)
    places[corners_.vertex[i]].push_back(static_cast<std::int32_t>(i));
  for (std::size_t v = 0; v < others.size(); ++v) others[v] = places[v];
  for (const auto& [v, u] : joined) others[v].insert(others[v].end(), places[u].begin(), places[u].end());
  for (std::vector<std::int32_t>& list : others) std::sort(list.begin(), list.end());
  for (const std::int32_t v : corners_.vertex) {
    const std::size_t start = corners_.left_out.size();
    corners_.left_out_start.push_back(static_cast<std::int32_t>(start));
    for (const std::int32_t place : others[v]) {
      const bool begins = corners_.left_out.size() == start;
      if (begins || corners_.left_out.back().batch != place / 16) corners_.left_out.push_back({place / 16, 0});
      corners_.left_out.back().bits |= 1U << (place % 16);
    }
    corners_.left_out.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
}

// ---------------------------------------------------------------- in a substep

/// Takes from what is stale the buckets in which nothing can be near for a while: they are empty until then.
void PairSystem::clear_stale(Executor& executor, const PairParticles& particles) {
  ask_for_clearance(executor, particles);
  for (Task& task : tasks_) {
    const auto is_clear_now = [&](std::int32_t number) { return is_clear(buckets_[number]); };
    task.stale.erase(std::remove_if(task.stale.begin(), task.stale.end(), is_clear_now), task.stale.end());
  }
}

bool PairSystem::is_clear(Bucket& bucket) const {
  const Neighbours& pair = neighbours_[bucket.neighbours];
  const float care = care_of(bucket);
  const float apart = pair.is_asked
                          ? pair.clearance
                          : distance_between(path_box(bucket.first), path_box(bucket.second)) * (1 - squared_slack);
  const float room = apart - care,
              least = pair.is_asked ? max(fewest_skins * skin(), 1.1f * pair.moves) : skin() * bound_slack;
  if (!(room > least)) return false;
  bucket.listed_at = pair.moved;
  bucket.pairs.clear();
  bucket.least_reach = out_of_reach;
  bucket.margin = room;
  return true;
}

/// The clearance of the clusters of all buckets that are stale.
void PairSystem::ask_for_clearance(Executor& executor, const PairParticles& particles) {
  for (const std::int32_t bucket : asked_) neighbours_[buckets_[bucket].neighbours].is_asked = false;
  asked_.clear();
  std::fill(corners_.wanted.begin(), corners_.wanted.end(), 0);
  for (const Task& task : tasks_)
    for (const std::int32_t number : task.stale) {
      const Bucket& bucket = buckets_[number];
      Neighbours& pair = neighbours_[bucket.neighbours];
      if (!pair.is_joined || pair.is_asked) continue;
      pair.is_asked = true;
      asked_.push_back(number);
      corners_.wanted[pair.a] = corners_.wanted[pair.b] = 1;
    }
  executor.parallel_for("place corners", model_.clusters, [&](int c) {
    if (corners_.wanted[c] != 0) place_corners(c, particles);
  });
  const int tasks = static_cast<int>(tasks_.size());
  const auto share = [&](int task) {
    return asked_.size() * static_cast<std::size_t>(task) / static_cast<std::size_t>(tasks);
  };
  executor.parallel_for("look for clearance", tasks, [&](int task) {
    for (std::size_t i = share(task); i < share(task + 1); ++i) {
      const Bucket& bucket = buckets_[asked_[i]];
      neighbours_[bucket.neighbours].clearance = clearance_of(bucket, tasks_[task].batches);
    }
  });
}

void PairSystem::place_corners(int cluster, const PairParticles& particles) {
  const int first = corners_.start[cluster], last = corners_.start[cluster + 1];
  kernels_.gather_places(corners_.vertex.data(), first, last, particles.positions, rows_of(corners_.place));
  const auto at = [&](int i) { return Vec3f{corners_.place[0][i], corners_.place[1][i], corners_.place[2][i]}; };
  for (int i = first; i < last; i += 16) {
    BoxBounds box{at(i), at(i)};
    for (int k = i + 1; k < i + 16; ++k) box = {min(box.low, at(k)), max(box.high, at(k))};
    corners_.batch_box[i / 16] = box;
  }
  corners_.longest[cluster] =
      kernels_.longest_squared({{corners_.line[0].data(), corners_.line[1].data(), nullptr}, 2},
                               corners_.line_start[cluster], corners_.line_start[cluster + 1], particles.positions);
}

/// No pair of two clusters that lists could hold is nearer at the substep's start, as far as is of interest.
float PairSystem::clearance_of(const Between& clusters, std::vector<std::int32_t>& batches) {
  const float wanted = care_of(clusters) + most_skins * skin(), a = corners_.longest[clusters.first],
              b = corners_.longest[clusters.second],
              sizes = max(0.25f * (a + b), max(a, b) * (1 / 3.f)) * (1 + squared_slack), beyond = wanted * wanted + sizes,
              reach = sqrt(beyond) * (1 + squared_slack);
  const int first = corners_.start[clusters.second] / 16, last = corners_.start[clusters.second + 1] / 16;
  BoxBounds far = corners_.batch_box[first];
  for (int k = first + 1; k < last; ++k)
    far = {min(far.low, corners_.batch_box[k].low), max(far.high, corners_.batch_box[k].high)};
  far = far.grown(reach);
  const float far_box[6] = {far.low.x, far.low.y, far.low.z, far.high.x, far.high.y, far.high.z};
  float least = beyond;
  for (int rows = corners_.start[clusters.first] / 16; rows < corners_.start[clusters.first + 1] / 16; ++rows) {
    if (!overlap(corners_.batch_box[rows], far)) continue;
    const BoxBounds own = corners_.batch_box[rows].grown(reach);
    batches.clear();
    for (int k = clusters.first == clusters.second ? rows : first; k < last; ++k)
      if (overlap(own, corners_.batch_box[k])) batches.push_back(k);
    const VertexComparison of{rows_of(corners_.place),
                              16 * rows,
                              far_box,
                              rows_of(corners_.place),
                              batches.data(),
                              static_cast<int>(batches.size()),
                              corners_.left_out.data(),
                              corners_.left_out_start.data()};
    least = min(least, kernels_.least_squared(of, beyond));
  }
  return sqrt(max(0.f, least * (1 - squared_slack) - sizes)) * (1 - squared_slack);
}

}  // namespace pliant

// Everything that moves against everything else that moves, and against meshes: from candidates to contacts to the filter.
//
//   lists       candidates whose boxes, around the motion ahead, come within a radius: kept while all stay within their boxes
//   detect      of those, pairs that may come within their thickness in this substep become contacts
//   project     the contacts' constraints, after each sweep
//   filter      no clean pair crosses: moves are shortened (plane_filter.h)
//
// What a substep does depends on positions and displacements alone: lists and bounds of distances only save work, so a
// State put back gives the same bits. To that end whatever is done about a pair is decided by its own distance, moves and
// paths as they are now, never by an old bound alone. A pair's distance falls by no more than both its primitives move, measured against the
// mean motion of their clusters: as long as that leaves it out of reach it is not looked at.
#pragma once

#include <memory>
#include <vector>

#include "collision/candidates.h"
#include "collision/intersections.h"
#include "collision/pair_contact.h"
#include "collision/plane_filter.h"
#include "model/model.h"
#include "parallel/executor.h"

namespace pliant {

/// What of a model can touch, in numbers of its State.
struct PairModel {
  ContactElements elements;
  std::vector<Record> rest;  ///< positions at the beginning
  int bodies = 0;
  std::vector<int> vertex_body;         ///< object of each particle
  std::vector<char> meets;              ///< bodies x bodies
  std::vector<PairMaterial> materials;  ///< bodies x bodies
  /// Vertices of one body that lie together, some sixty-four, and the edges and triangles that begin at them. Moves are
  /// measured against the mean of a cluster's: what falls, swings or turns as a whole hardly changes its own distances.
  int clusters = 0;
  std::vector<int> vertex_cluster, edge_cluster, triangle_cluster, cluster_body;
  float radius = 0;             ///< within which candidates are looked for [m]
  float largest_thickness = 0;  ///< [m]
  bool filter = true;
};

/// Nothing where no two things meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model, const Records& positions);

/// Particles of a model in a substep.
struct PairParticles {
  const Record* positions = nullptr;
  const Record* remainders = nullptr;
  Record* displacements = nullptr;
  float h = 0;
  float ahead = 1;  ///< substeps until lists had better be made anew: the frame's end
};

/// What was done, for the Report.
struct PairCounts {
  std::int64_t candidates = 0, contacts = 0, shortened = 0, hopeless = 0, tangled = 0, rebuilds = 0;
};

class PairSystem {
 public:
  explicit PairSystem(const PairModel& model);

  /// At a frame's start: forgets counts, and finds out which tangled pairs are apart by now. `anew` looks at all pairs: due at
  /// the first frame and after a State was put back.
  void begin_frame(const Record* positions, bool anew);

  /// Contacts of the substep from predicted displacements.
  void detect(Executor& executor, const PairParticles& particles);
  void project(const PairParticles& particles);
  /// Shortens displacements so that nothing crosses.
  void filter(Executor& executor, const PairParticles& particles);
  /// After a substep. `gravity` is what velocities of a body's free particles lack: within a frame, that of the frame [m/s].
  void respond(const Record* positions, Record* velocities, FunctionRef<Vec3f(int body)> gravity) const;

  const PairCounts& counts() const { return counts_; }
  const std::vector<PairContact>& contacts() const { return contacts_; }
  /// Edges and triangles that pass through one another though they are not meant to: left out until they are apart.
  const std::vector<Intersection>& tangles() const { return tangles_; }
  const Triangle& triangle(int number) const { return model_.elements.triangles[number]; }

 private:
  struct Pair {
    std::int32_t a, b;  ///< vertex and triangle, or two edges
    float reach;        ///< distance when it was last measured, plus what both sides had moved until then [m]
    float rest;         ///< what its distance at rest allows it to keep [m]; below 0: not measured
  };
  /// Pairs of one kind between two clusters. Those that can matter soon are active; the others wait until the clusters' moves
  /// add up to the margin.
  struct Bucket {
    int first_cluster, second_cluster;
    bool vertices;                  ///< a vertex and a triangle, or two edges
    std::int32_t first, last;       ///< of pairs_
    std::int32_t active_last = 0;   ///< its active pairs are active_[first] to active_[active_last - 1]
    float between_sum = 0;          ///< moves of the two means against each other since lists were made [m]
    float growth = 0, margin = -1;  ///< moves since pairs were made active, and how far they may go [m]
  };
  struct Task {
    int first = 0, last = 0;  ///< of buckets_
    std::vector<std::int32_t> near;
    std::vector<PairStencil> stencils;
    std::vector<PairContact> contacts;
    std::vector<SeparatingSlab> slabs;
    std::vector<std::pair<std::int32_t, float>> shares;
    int hopeless = 0;
  };

  PairStencil stencil(const Bucket& bucket, std::int32_t pair) const;
  const PairMaterial& material(const Bucket& bucket) const;
  float least_of(float thickness) const;
  float margin_beyond(float distance) const;
  bool paths_within(const PairStencil& pair, const PairParticles& particles, float distance) const;
  bool is_finite(const PairParticles& particles);
  Vec3f mean_move(const PairParticles& particles) const;
  bool all_within(const PairParticles& particles, float margin);
  void rebuild(Executor& executor, const PairParticles& particles);
  void fill_buckets();
  void cut_into_tasks();
  void measure_moves(Executor& executor, const PairParticles& particles);
  void settle_moves();
  float between(const Bucket& bucket) const;
  float sums(const Bucket& bucket, std::int32_t pair) const;
  float moves(const Bucket& bucket, std::int32_t pair) const;
  void activate(Bucket& bucket, Task& task, const PairParticles& particles);
  void collect_near(Bucket& bucket, Task& task, float within);
  template <class Visit>
  void measure(const Bucket& bucket, Task& task, const PairParticles& particles, Visit visit);
  void detect_bucket(Bucket& bucket, Task& task, const PairParticles& particles);
  void filter_bucket(Bucket& bucket, Task& task, const PairParticles& particles);
  void filter_pair(const Bucket& bucket, std::int32_t pair, const PairParticles& particles, Task& task);
  bool shorten(const PairParticles& particles, bool stops);
  template <class Allow>
  void hold_rounded(const PairParticles& particles, Allow allow);
  void keep_apart(Executor& executor, const PairParticles& particles);
  void find_tangles(const Record* positions);

  const PairModel& model_;
  CandidateFinder finder_;
  IntersectionFinder intersections_;
  std::vector<Vec3f> from_, to_;
  std::vector<Pair> pairs_;
  std::vector<std::int32_t> active_;  ///< room for all of pairs_
  std::vector<Bucket> buckets_;
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys_;  ///< of buckets while they are made
  std::vector<std::int32_t> bucket_of_;                       ///< of each candidate while they are made
  Vec3f drift_{};  ///< of the mean since lists were made, this substep left out [m]
  Vec3f mean_{};   ///< displacement in this substep [m]
  bool listed_ = false;

  // By particle, triangle, edge: the move of this substep, relative to its cluster's mean, and the sum of those made.
  std::vector<float> vertex_move_, triangle_move_, edge_move_, vertex_sum_, triangle_sum_, edge_sum_;
  std::vector<Vec3f> cluster_move_;     ///< mean
  std::vector<float> cluster_largest_;  ///< of what begins at it, relative to the mean
  std::vector<std::vector<int>> cluster_vertices_, cluster_triangles_, cluster_edges_;

  std::vector<Task> tasks_;
  std::vector<PairContact> contacts_;
  std::vector<float> share_;
  std::vector<std::int32_t> touched_, shortened_;  ///< vertices, in a round of the filter and in all of a substep
  std::vector<Intersection> tangles_;
  std::vector<std::uint64_t> tangled_pairs_, tangled_edges_;  ///< a << 32 | b, ascending
  float extent_ = 0;                                          ///< the largest coordinate [m]
  PairCounts counts_;
};

}  // namespace pliant

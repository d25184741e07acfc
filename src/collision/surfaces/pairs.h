// Everything that moves against everything else that moves, and against meshes: from candidates to contacts to the filter.
//
//   clusters    vertices that lie together and what begins at them: how they move, which are near one another
//   clearance   of two that belong to one surface, how far apart all is that is not near in the mesh (pair_clearance.h)
//   lists       of two clusters that are near, the pairs that are: kept until the two have moved too far against each other
//   detect      of those, pairs that may come within their thickness in this substep become contacts
//   project     the contacts' constraints, after each sweep
//   filter      no clean pair crosses: moves are shortened (plane_filter.h)
//
// What a substep does depends on positions and displacements alone: lists and bounds of distances only save work, so a
// State put back gives the same bits. To that end whatever is done about a pair is decided by its own distance, moves and
// paths as they are now, never by an old bound alone.
//
// A pair's distance falls by no more than both its primitives depart from a common motion that goes along and turns, and for
// straight paths that holds without any error of second order: the points p and q go to p + m + w x p and q + m + w x q, and
// p - q + w x (p - q) is no shorter than p - q. So cloth that falls, swings or turns as a whole is hardly looked at. As long as
// the sum of departures leaves a pair out of reach nothing is done about it, nor about all pairs of two clusters at once.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "collision/broad/tree.h"
#include "collision/filter/plane_filter.h"
#include "collision/narrow/pair_contact.h"
#include "collision/near/clearance.h"
#include "collision/proxies/pair_kernels.h"
#include "collision/proxies/pair_model.h"
#include "collision/untangle/intersections.h"
#include "collision/untangle/untangle.h"
#include "parallel/executor.h"

namespace pliant {

/// Pairs between two bodies that no shortening keeps apart.
struct HopelessPairs {
  PairStencil first;
  std::int64_t count = 0;
};

/// What was done, for the Report.
struct PairCounts {
  std::int64_t candidates = 0, contacts = 0, shortened = 0, hopeless = 0, tangled = 0, rebuilds = 0, inside = 0;
  double deepest = 0;  ///< overlap that contacts of the last substep left [m]
};

class PairSystem {
 public:
  /// `kernels` are those of an instruction set that this machine has; all give the same bits.
  explicit PairSystem(const PairModel& model, const PairKernels& kernels = pair_kernels_generic());

  /// At a frame's start: forgets counts, and finds out which tangled pairs are apart by now. `anew` looks at all pairs: due at
  /// the first frame and after a State was put back.
  void begin_frame(const Record* positions, bool anew);

  /// Contacts of the substep from predicted displacements.
  void detect(Executor& executor, const PairParticles& particles);
  void project(const PairParticles& particles);
  /// Whether something that can't be pushed moves on into what contacts have not yet moved out of its way, so that the filter might
  /// not keep them apart: then they should be projected again, which passes a push on to what lies behind.
  bool is_overrun(const PairParticles& particles) const;
  /// Shortens displacements so that nothing crosses.
  void filter(Executor& executor, const PairParticles& particles);
  /// After a frame's last substep: how much of their thickness contacts lack.
  void measure_overlaps(const PairParticles& particles);
  /// After a substep. `gravity` is what velocities of a body's free particles lack: within a frame, that of the frame [m/s].
  /// Approaches no faster than `slow` are rest [m/s].
  void respond(const Record* positions, Record* velocities, float slow, FunctionRef<Vec3f(int body)> gravity) const;

  /// Whether something is drawn apart in this frame, so that contacts are to be found before constraints are projected.
  bool untangles() const { return untangler_ && untangler_->calms(); }

  const PairCounts& counts() const { return counts_; }
  const std::vector<PairContact>& contacts() const { return contacts_; }
  std::vector<PairContact>& contacts() { return contacts_; }
  /// Edges and triangles that pass through one another though they are not meant to: left out until they are apart.
  const std::vector<Intersection>& tangles() const { return tangles_; }
  const Triangle& triangle(int number) const { return model_.elements.triangles[number]; }
  /// Of this frame, by their bodies, the lower one first.
  const std::map<std::pair<int, int>, HopelessPairs>& hopeless() const { return hopeless_; }

 private:
  enum Kind { vertex_kind, edge_kind, triangle_kind };
  struct Pair {
    std::array<std::int32_t, 4> vertex;  ///< of a vertex and a triangle, or of two edges, that of the lower number first
    float rest;                          ///< what its distance at rest allows it to keep [m]; below 0: not measured
  };
  /// Two clusters that are near one another, or one and itself.
  struct Neighbours {
    int a, b;  ///< a <= b
    float apart =
        0;  ///< by how much the distance of a point of one and one of the other falls as both go along and turn [m]
    float moves = 0;         ///< the same with what vertices depart from that: by how much any distance falls at most [m]
    float moved = 0;         ///< the same, in all substeps since clusters were last listed [m]
    bool is_joined = false;  ///< of one surface: a cluster and itself, or two with surroundings between them
    bool is_asked = false;   ///< whether `clearance` is of this substep
    float clearance = 0;     ///< no pair of theirs that lists could hold is nearer, as far as was looked [m]
  };
  /// Two clusters and the kind of pairs between them: a vertex of the first and a triangle of the second, or two edges.
  struct Between {
    int first, second;
    bool of_vertices;
    int neighbours = -1;    ///< number of the two clusters'
    float listed_at = 0;    ///< of `moved`
    float least_reach = 0;  ///< of all pairs, or less [m]
  };
  /// Pairs that were found to be near. They are all until the moves since they were listed add up to the margin.
  struct Bucket : Between {
    float margin = -1;  ///< [m]
    std::vector<Pair> pairs{};
    std::vector<float>
        reach{};  ///< of each, distance when it was last measured, plus what the bucket had moved until then [m]
  };
  /// Pairs that are near one another in the mesh, always the same, in sixteens.
  struct Surroundings : Between {
    int first_block = 0, last_block = 0, pairs = 0;
  };
  struct Task {
    int first = 0, last = 0;  ///< of buckets_
    int first_surroundings = 0, last_surroundings = 0;
    std::vector<std::int32_t> stale, near, batches;
    std::vector<BoxHit> hits;
    std::vector<Pair> found;
    std::vector<PairContact> contacts;
    std::size_t contacts_of_surroundings = 0;
    std::vector<SeparatingSlab> slabs;
    std::vector<std::pair<std::int32_t, float>> shares;
    std::vector<PairStencil> hopeless;
  };
  /// Elements of one kind, cluster by cluster, each cluster's along a curve and filled up to sixteens with what overlaps nothing.
  struct Elements {
    int corners = 0;
    std::vector<int> start, count;  ///< of each cluster
    std::vector<std::int32_t> item, corner[3];
    std::vector<float> box[6];
    std::vector<BoxBounds> batch_box;  ///< of sixteen
    // What rows, if these are, leave out of the columns: what shares a vertex and what is among the surroundings.
    std::vector<std::int32_t> left_out_start;
    std::vector<LeftOut> left_out;
  };

  // pair_surroundings.cpp: what lies together on the surface.
  void lay_out_elements(Kind kind, int corners);
  void lay_out_vertices();
  void find_surroundings();
  std::vector<Clearance::Piece> pieces() const;
  void leave_out(Kind rows, Kind columns, std::vector<std::array<std::int32_t, 2>>& pairs);
  void fill_surroundings(bool of_vertices, const std::vector<std::array<std::int32_t, 2>>& pairs);
  void fill_blocks(Surroundings& of, std::vector<PairStencil>& pairs);

  // pair_clusters.cpp: how clusters move, and which are near one another.
  void measure_moves(Executor& executor, const PairParticles& particles);
  float travel_of(std::size_t cluster) const;
  bool clusters_hold() const;
  bool has_gone_far() const;
  void list_clusters();
  BoxBounds path_box(std::size_t cluster) const;
  void measure_between(Neighbours& pair) const;
  void number_surroundings(const std::vector<Neighbours>& old);
  void make_buckets(const std::vector<Neighbours>& old);
  void cut_into_tasks();
  void settle_moves();

  // pair_lists.cpp: which pairs are near.
  void bring_up_to_date(Executor& executor, const PairParticles& particles);
  void find_stale(Task& task);
  void clear_stale(Executor& executor, const PairParticles& particles);
  void ask_for_clearance(Executor& executor, const PairParticles& particles);
  bool is_clear(Bucket& bucket) const;
  void fit_boxes(Executor& executor, const PairParticles& particles);
  void fit_boxes_of(Elements& of, int cluster, const PairParticles& particles);
  void refresh(Bucket& bucket, Task& task, const PairParticles& particles);
  void find_pairs(const Bucket& bucket, float reach, Task& task);
  void add_pair(const Bucket& bucket, std::int32_t a, std::int32_t b, Task& task) const;
  void keep_near(Bucket& bucket, float within, Task& task, const PairParticles& particles);

  PairStencil stencil(bool of_vertices, std::int32_t a, std::int32_t b) const;
  const PairMaterial& material(const Between& clusters) const;
  bool is_tangled(const PairStencil& pair) const;
  float least_of(const Between& clusters) const;
  float care_of(const Between& clusters) const;
  float skin() const;
  float moves(const Between& clusters) const { return neighbours_[clusters.neighbours].moves; }
  float moved(const Between& clusters) const { return neighbours_[clusters.neighbours].moved - clusters.listed_at; }
  void find_paths(const Between& clusters, const PairStencils& pairs, const PairParticles& particles, PairPaths& out) const;
  void collect_near(Bucket& bucket, Task& task, float within) const;
  bool begin_anew(Surroundings& of, float within);
  /// Sixteen pairs that may become contacts.
  struct Batch {
    PairStencils stencils;
    PairBatch at;
    PairPaths paths;
  };
  void measure(const Between& clusters, Batch& batch, const PairParticles& particles) const;
  void detect_pair(const Between& clusters, const Batch& batch, int lane, float* rest, Task& task,
                   const PairParticles& particles);
  static void add_contact(const PairStencil& four, const PairBatch& at, int lane, const PairMaterial& material,
                          const PairParticles& particles, Task& task);
  void detect_bucket(Bucket& bucket, Task& task, const PairParticles& particles);
  void detect_surroundings(Surroundings& of, Task& task, const PairParticles& particles);
  void detect_block(const Surroundings& of, int block, Task& task, const PairParticles& particles);
  void filter_bucket(Bucket& bucket, Task& task, const PairParticles& particles);
  void filter_surroundings(Surroundings& of, Task& task, const PairParticles& particles);
  void filter_pair(const Between& clusters, const PairStencils& pairs, const PairPaths& paths, int lane,
                   const PairParticles& particles, Task& task);
  bool shorten(const PairParticles& particles, bool stops);
  void count_hopeless();
  template <class Allow>
  void hold_rounded(const PairParticles& particles, Allow allow);
  void keep_apart(Executor& executor, const PairParticles& particles);
  void find_tangles(const Record* positions);
  void exempt_tangled();
  bool is_lost(const PairStencil& pair) const;

  const PairModel& model_;
  std::unique_ptr<Untangler> untangler_;  ///< where the model says so
  const PairKernels& kernels_;
  IntersectionFinder intersections_;

  // Clusters.
  Elements elements_[3];
  Clearance clearance_;
  std::vector<char> placed_;                    ///< clusters that clearance_ knows the places of, in this substep
  std::vector<std::int32_t> asked_;             ///< buckets for whose clusters a clearance is looked for
  std::vector<std::int32_t> cluster_vertices_;  ///< and the corners of what begins at them
  std::vector<int> cluster_start_;
  std::vector<ClusterMotion> motions_;
  std::vector<float> travel_;  ///< since clusters were listed, against the mean of all [m]
  std::vector<float> extent_;  ///< of each cluster when all was last looked at anew: the largest coordinate [m]
  std::vector<BoxBounds> cluster_boxes_;
  Tree<BoxBounds> cluster_tree_;
  std::vector<Neighbours> neighbours_;
  std::vector<std::vector<std::pair<int, int>>> partners_;  ///< of each cluster: others, and the neighbours' number
  std::vector<Bucket> buckets_;
  std::vector<Surroundings> surroundings_;
  std::vector<PairStencils, CacheLineAllocator<PairStencils>> blocks_;  ///< of surroundings
  std::vector<float> block_reach_;
  std::int64_t pairs_of_surroundings_ = 0;
  bool listed_ = false;
  std::vector<char> wanted_[3];  ///< clusters whose boxes are

  Vec3f mean_{};  ///< displacement of all that can be pushed in this substep [m]
  bool is_bounded_ = true;

  std::vector<Task> tasks_;
  std::vector<PairContact> contacts_;
  std::vector<float> share_;
  std::vector<std::int32_t> touched_, shortened_;  ///< vertices, in a round of the filter and in all of a substep
  std::vector<Intersection> tangles_;
  std::vector<std::array<std::int32_t, 5>>
      tangled_;  ///< stencils of pairs that are exempt, and their first side; ascending
  std::map<std::pair<int, int>, HopelessPairs> hopeless_;
  PairCounts counts_;
};

}  // namespace pliant

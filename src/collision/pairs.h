// Everything that moves against everything else that moves, and against meshes: from candidates to contacts to the filter.
//
//   lists       candidates whose boxes, around the motion ahead, come within a radius: kept while all stay within their boxes
//   detect      of those, pairs that may come within their thickness in this substep become contacts
//   project     the contacts' constraints, after each sweep
//   filter      no clean pair crosses: moves are shortened (plane_filter.h)
//
// What a substep does depends on positions and displacements alone: lists and bounds of distances only save work, so a
// State put back gives the same bits. A pair's distance falls by no more than both its primitives move, measured against the
// mean motion of their bodies: as long as that leaves it out of reach it is not looked at.
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
  std::vector<Record> rest;      ///< positions at the beginning
  std::vector<int> vertex_body;  ///< object of each particle
  std::vector<int> triangle_body, edge_body;
  int bodies = 0;
  std::vector<char> meets;              ///< bodies x bodies
  std::vector<PairMaterial> materials;  ///< bodies x bodies
  float radius = 0;                     ///< within which candidates are looked for [m]
  float largest_thickness = 0;          ///< [m]
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
  void respond(const Record* positions, Record* velocities) const;

  const PairCounts& counts() const { return counts_; }
  const std::vector<PairContact>& contacts() const { return contacts_; }

 private:
  struct Pair {
    std::int32_t a, b;  ///< vertex and triangle, or two edges
    float reach;        ///< distance when it was last measured, plus what both sides had moved until then [m]
    float rest;  ///< what its distance at rest allows it to keep [m]; below 0: not measured; tangled pairs are left out
  };
  /// A vertex or an edge with its pairs: as long as none can be near none is looked at.
  struct Owner {
    std::int32_t element;
    std::int32_t first, last;  ///< of pairs_
    float reach;               ///< the least of its pairs'
  };
  struct Task {
    int first = 0, last = 0;           ///< of owners_
    std::vector<std::int32_t> active;  ///< of pairs_, ascending: what to look at for now
    std::vector<std::int32_t> near;    ///< of these, what to measure
    std::vector<PairStencil> stencils;
    std::vector<PairContact> contacts;
    std::vector<SeparatingSlab> slabs;
    std::vector<std::pair<std::int32_t, float>> shares;
    int hopeless = 0;
  };

  PairStencil stencil(std::int32_t pair) const;
  int body_of_first(std::int32_t pair) const {
    return pair < vertex_pairs_ ? model_.vertex_body[pairs_[pair].a] : model_.edge_body[pairs_[pair].a];
  }
  int body_of_second(std::int32_t pair) const {
    return pair < vertex_pairs_ ? model_.triangle_body[pairs_[pair].b] : model_.edge_body[pairs_[pair].b];
  }
  const PairMaterial& material(int a, int b) const {
    return model_.materials[static_cast<std::size_t>(a) * model_.bodies + b];
  }
  bool is_finite(const PairParticles& particles) const;
  bool all_within(const PairParticles& particles, float margin) const;
  void rebuild(Executor& executor, const PairParticles& particles);
  void measure_moves(Executor& executor, const PairParticles& particles);
  void settle_moves(Executor& executor, const PairParticles& particles);
  void append(const IntLists& lists, const std::vector<std::uint64_t>& tangled);
  void cut_into_tasks();
  float sums(std::int32_t pair) const;
  float moves(std::int32_t pair) const;
  float largest_growth() const;
  template <class Within>
  void collect_near(Task& task, Within within);
  void bound_owners();
  void activate(Executor& executor, const PairParticles& particles);
  void activate_task(Task& task, const PairParticles& particles, float margin);
  template <class Visit>
  void measure(Task& task, const PairParticles& particles, Visit visit);
  float least_distance(int a, int b) const;
  void detect_task(Task& task, const PairParticles& particles);
  void filter_task(Task& task, const PairParticles& particles);
  void filter_pair(std::int32_t pair, const PairParticles& particles, Task& task);
  void shorten(const PairParticles& particles);
  void find_tangles(const Record* positions);

  const PairModel& model_;
  CandidateFinder finder_;
  IntersectionFinder intersections_;
  std::vector<Vec3f> from_, to_;
  std::vector<Pair> pairs_;
  std::int32_t vertex_pairs_ = 0;  ///< of pairs_; the rest are of edges
  std::vector<Owner> owners_;
  bool listed_ = false, active_ = false;
  float margin_ = 0;  ///< how far things may move before pairs are made active anew [m]

  // By particle, triangle, edge: the move of this substep, relative to its body's mean, and the sum of those made.
  std::vector<float> vertex_move_, triangle_move_, edge_move_, vertex_sum_, triangle_sum_, edge_sum_;
  std::vector<Vec3d> body_move_;
  std::vector<int> body_size_;
  std::vector<float> between_move_, between_sum_;  ///< bodies x bodies: of their means
  std::vector<float> body_triangle_, body_edge_;   ///< the largest of sum and move of a body's triangles and edges
  std::vector<float> body_largest_, growth_,
      between_growth_;              ///< largest move of a body; its sum since pairs were made active
  std::vector<float> owner_other_;  ///< by body: what the other side of its pairs can have moved at most, twice

  std::vector<Task> tasks_;
  std::vector<PairContact> contacts_;
  std::vector<float> share_;
  std::vector<Intersection> tangles_;
  std::vector<std::uint64_t> tangled_pairs_, tangled_edges_;  ///< a << 32 | b, ascending
  float extent_ = 0;                                          ///< the largest coordinate [m]
  PairCounts counts_;
};

}  // namespace pliant

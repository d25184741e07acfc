// Which surfaces can meet, and their contact parameters: all that contact needs to know apart from motion.
//
// Each body has a block in every array; a removed body leaves unused entries that a later one takes. So adding a body
// costs what that body costs, and indices of other bodies stay. Indices of primitives and clusters therefore say
// nothing about the order of bodies; whatever decides bits is ordered by body first (is_before, cluster_order).
#pragma once

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "collision/proxies/body_blocks.h"
#include "collision/proxies/contact_elements.h"
#include "collision/proxies/contact_rules.h"
#include "collision/proxies/triangles_around.h"
#include "model/model.h"

namespace pliant {

/// The blocks of a body in the arrays of a PairModel; all but `vertices` are empty if it meets no body, nor itself.
struct BodyElements {
  Block vertices;  ///< the body's particles, also if it meets no body
  Block edges, triangles, clusters;
  float median_edge = 0;  ///< median edge length at rest [m]; 0: no edges
};

/// The part of a model that takes part in contact, in the particle indices of the State. Over fifteen members: each
/// kind of primitive has arrays of its own.
struct PairModel {
  /// Corners of unused entries are -1. `vertices` stays empty: a vertex takes part in contact if it has a cluster.
  ContactElements elements;
  std::vector<Record> rest;      ///< initial positions of all particles
  ContactRules rules;            ///< who meets whom; bodies are the objects and mesh colliders of the Model
  std::vector<int> vertex_body;  ///< body of each particle; -1: none, where an object was removed
  std::vector<int>
      free_points;  ///< particles of bodies without triangles and lines, ordered by body; they meet one another as spheres
  /// Clusters: about 64 neighbouring vertices of one body, with the edges and triangles whose first vertex is one of them.
  int clusters = 0;                                                               ///< one past the last cluster in use
  std::vector<int> vertex_cluster, edge_cluster, triangle_cluster, cluster_body;  ///< -1: none
  std::vector<int> cluster_order;                                                 ///< clusters in use, ordered by body
  /// For each cluster: its pairs have no contact where positions round by more than this [m]. Empty: no limit.
  std::vector<float> coarsest;
  std::vector<BodyElements> bodies;
  /// For each body that may meet others, the number of its set (ContactRules::sets), below `sets`; -1: meets none. Sets are
  /// numbered densely, so that what is kept for each of them costs nothing for bodies of other PairModels.
  std::vector<int> body_set;
  int sets = 0;
  std::vector<char> has;  ///< for each body: 1 if it may meet any body; empty: all may
  BodyBlocks edge_blocks, triangle_blocks, cluster_blocks;
  TrianglesAround triangles_around;
  float radius = 0;             ///< distance within which clusters are searched for candidates [m]
  float largest_thickness = 0;  ///< largest thickness of two bodies that meet [m]
  bool filter = true;
  float untangling_speed = 0;  ///< depenetration speed of initial intersections [m/s]; 0: not moved apart

  /// The order of clusters that decides bits: by body, then by number.
  bool is_before(int cluster, int other) const { return key_of(cluster) < key_of(other); }
  int set_of_cluster(int cluster) const {
    return body_set[static_cast<std::size_t>(cluster_body[static_cast<std::size_t>(cluster)])];
  }
  std::pair<int, int> key_of(int cluster) const { return {cluster_body[static_cast<std::size_t>(cluster)], cluster}; }
};

/// Returns null if no two bodies can meet. Bodies b with has[b] == 0 meet none; if `has` is empty, all bodies may meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model, const std::vector<char>& has = {});

/// The changes that update_pair_model made.
struct PairChanges {
  std::vector<int> removed, added;  ///< bodies, ascending; a body that was edited is in both
  std::vector<Block> clusters;      ///< clusters that the removed bodies had
  bool radius = false;              ///< true if the search radius changed
};

/// Updates bodies that were added, removed or edited, and bodies that begin or cease to meet others because of them.
/// Returns nullopt if no two bodies can meet any more; the PairModel is then invalid.
std::optional<PairChanges> update_pair_model(const Model& model, const std::vector<int>& changed, PairModel& out);

/// Computes `bodies`, `body_set`, `sets`, `cluster_order` and `triangles_around` of a model whose other arrays are in the order
/// of bodies.
void index_bodies(PairModel& model);

}  // namespace pliant

// Which surfaces can meet, and their contact parameters: everything known before motion.
//
// Bodies come and go. Each has a block in every array, and a removed one leaves a hole that a later one takes, so that adding
// one costs what that one costs and no number of another body changes. Numbers of elements and clusters therefore say nothing
// about the order of bodies; what decides bits goes by body first (is_before, cluster_order).
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

/// What a body has in the arrays of a PairModel; all empty if it meets no other and not itself.
struct BodyElements {
  Block vertices;  ///< its particles, also of a body that meets none
  Block edges, triangles, clusters;
  float median_edge = 0;  ///< at rest; 0 without edges [m]
};

/// The part of a model that takes part in contact, in the indices of its State. Over fifteen members: arrays of different
/// elements.
struct PairModel {
  /// In holes the corners are -1. `vertices` stays empty: a vertex takes part if it has a cluster.
  ContactElements elements;
  std::vector<Record> rest;      ///< initial positions
  ContactRules rules;            ///< between bodies, which are the objects and mesh colliders of the Model
  std::vector<int> vertex_body;  ///< body of each particle; -1: of none, where an object was removed
  std::vector<int>
      free_points;  ///< particles of bodies without triangles and lines; they meet one another as spheres; by body
  /// Clusters: about sixty-four neighbouring vertices of one body, with the edges and triangles that begin at them.
  int clusters = 0;                                                               ///< one past the last in use
  std::vector<int> vertex_cluster, edge_cluster, triangle_cluster, cluster_body;  ///< -1: none
  std::vector<int> cluster_order;                                                 ///< those in use, by body
  /// For each cluster: pairs are excluded from contact where positions round by more. Empty: no limit. [m]
  std::vector<float> coarsest;
  std::vector<BodyElements> bodies;
  std::vector<char> has;  ///< by body: true if it may meet any; empty: all may
  BodyBlocks edge_blocks, triangle_blocks, cluster_blocks;
  TrianglesAround triangles_around;
  float radius = 0;             ///< search radius of candidates [m]
  float largest_thickness = 0;  ///< [m]
  bool filter = true;
  float untangling_speed = 0;  ///< depenetration speed of initial intersections; 0: they stay [m/s]

  /// The order of clusters that decides bits: by body, then by number.
  bool is_before(int cluster, int other) const { return key_of(cluster) < key_of(other); }
  std::pair<int, int> key_of(int cluster) const { return {cluster_body[static_cast<std::size_t>(cluster)], cluster}; }
};

/// Returns null if no two bodies can meet. Bodies that `has` leaves out meet none.
std::unique_ptr<PairModel> make_pair_model(const Model& model, const std::vector<char>& has = {});

/// What update_pair_model changed.
struct PairChanges {
  std::vector<int> removed, added;  ///< bodies, ascending; a body that was edited is in both
  std::vector<Block> clusters;      ///< those that the removed ones had
  bool radius = false;              ///< true if the search radius changed
};

/// Brings the bodies that were added, removed or edited up to date, and those that meet others only with or without them.
/// Returns nothing if no two bodies can meet any more; the PairModel is then invalid.
std::optional<PairChanges> update_pair_model(const Model& model, const std::vector<int>& changed, PairModel& out);

/// Derives `bodies`, `cluster_order` and `triangles_around` of a model whose other arrays are given body after body.
void index_bodies(PairModel& model);

}  // namespace pliant

// Which surfaces can meet, and their contact parameters: everything known before motion.
#pragma once

#include <memory>
#include <vector>

#include "collision/proxies/contact_elements.h"
#include "collision/proxies/contact_rules.h"
#include "model/model.h"

namespace pliant {

/// The part of a model that takes part in contact, in the indices of its State.
struct PairModel {
  ContactElements elements;
  std::vector<Record> rest;      ///< initial positions
  ContactRules rules;            ///< between bodies, which are the objects and mesh colliders of the Model
  std::vector<int> vertex_body;  ///< body of each particle; -1: of none, where an object was removed
  std::vector<int>
      free_points;  ///< particles of bodies without triangles and lines; they meet one another as spheres; ascending
  /// Clusters: about sixty-four neighbouring vertices of one body, with the edges and triangles that begin at them.
  int clusters = 0;
  std::vector<int> vertex_cluster, edge_cluster, triangle_cluster, cluster_body;
  /// For each cluster: pairs are excluded from contact where positions round by more. Empty: no limit. [m]
  std::vector<float> coarsest;
  float radius = 0;             ///< search radius of candidates [m]
  float largest_thickness = 0;  ///< [m]
  bool filter = true;
  float untangling_speed = 0;  ///< depenetration speed of initial intersections; 0: they stay [m/s]
};

/// Returns null if no two bodies can meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model, const Records& positions);

}  // namespace pliant

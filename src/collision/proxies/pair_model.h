// Which surfaces meet, and how: what is known before anything moves.
#pragma once

#include <memory>
#include <vector>

#include "collision/proxies/contact_elements.h"
#include "collision/proxies/contact_rules.h"
#include "model/model.h"

namespace pliant {

/// What of a model can touch, in numbers of its State.
struct PairModel {
  ContactElements elements;
  std::vector<Record> rest;      ///< positions at the beginning
  ContactRules rules;            ///< of bodies: the objects and mesh colliders of the Model
  std::vector<int> vertex_body;  ///< of each particle
  std::vector<int>
      free_points;  ///< particles of bodies without triangles and lines, which meet one another as spheres; ascending
  /// Vertices of one body that lie together, some sixty-four, and the edges and triangles that begin at them.
  int clusters = 0;
  std::vector<int> vertex_cluster, edge_cluster, triangle_cluster, cluster_body;
  /// Of each cluster: where positions are rounded by more, pairs are left out of contact. Empty: no limit. [m]
  std::vector<float> coarsest;
  float radius = 0;             ///< within which candidates are looked for [m]
  float largest_thickness = 0;  ///< [m]
  bool filter = true;
  float untangling_speed = 0;  ///< at which what passes through at the beginning is drawn apart; 0: it is left [m/s]
};

/// Nothing where no two things meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model, const Records& positions);

}  // namespace pliant

// What contact between surfaces needs to know about all bodies and particles of a World.
//
// Each substep group has a PairModel of its own, and all of them share one of these tables. A body belongs to one
// group, so a PairModel writes and reads only the entries of its own bodies. Memory therefore grows with the World and
// not with the number of groups, and indices of particles and bodies are the same everywhere.
#pragma once

#include <memory>
#include <vector>

#include "collision/proxies/contact_rules.h"
#include "collision/proxies/triangles_around.h"
#include "model/model.h"

namespace pliant {

/// Entries of particles and bodies without contact are not meaningful.
struct ContactTables {
  ContactRules rules;                   ///< who meets whom; bodies are the objects and mesh colliders of the Model
  std::vector<int> body_set;            ///< for each body, the number of its set in its PairModel; -1: it meets none
  std::vector<Record> rest;             ///< initial position of each particle
  std::vector<int> vertex_body;         ///< body of each particle
  std::vector<int> vertex_cluster;      ///< cluster of each particle in the PairModel of its body; -1: none
  std::vector<float> permitted_shares;  ///< scratch memory of the filter: 1 for each particle, except while it runs
  std::shared_ptr<VertexRanges> triangle_ranges = std::make_shared<VertexRanges>();
};

/// Applies the scene's override of a pair's material. If only the static friction is given, the kinetic one is at most
/// that.
void apply(const PairProperties& said, PairMaterial& material);

/// The rules of all objects and mesh colliders of a model.
ContactRules contact_rules(const Model& model);

/// Updates the rules of the bodies that were added, removed or edited, and the sizes of the arrays.
void update_tables(const Model& model, const std::vector<int>& changed, ContactTables& out);

}  // namespace pliant

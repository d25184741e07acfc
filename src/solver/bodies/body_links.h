// The constraints that connect rigid bodies with one another and with particles: the edges of islands that do not
// change with contact.
#pragma once

#include <utility>
#include <vector>

#include "model/model.h"

namespace pliant {

/// A constraint between two nodes of BodyIslands.
struct BodyLink {
  int a = 0, b = 0;        ///< nodes
  int object = 0;          ///< index in Model::objects
  int joint = -1;          ///< index in CompiledObject::joints; -1: a constraint of no joint
  bool does_work = false;  ///< true: has a motor, or gives way, so that it may store energy
};

/// The links of an object with bodies. Its bodies are the nodes from `first_body` on, its other particles the node
/// `points`.
void add_links(const Model& model, int object, int first_body, int points, std::vector<BodyLink>& links);

/// The pairs of bodies between which nothing is left but broken joints, so that they collide from then on; sorted.
/// `broken` are indices in CompiledObject::joints, in ascending order.
std::vector<std::pair<int, int>> pairs_without_joint(const CompiledObject& object, const std::vector<int>& broken);

}  // namespace pliant

// Islands of rigid bodies: sets of bodies, and of particles that they touch, which act on one another.
//
// A node is a body, or all particles of an object that are no centres of bodies. Nodes are joined by contacts that
// press and by constraints. Bodies of infinite mass and colliders join nothing.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/narrow/contact.h"
#include "core/islands.h"
#include "model/model.h"
#include "solver/bodies/body_links.h"
#include "solver/bodies/contact_bodies.h"

namespace pliant {

struct Substep;
class BodyPoints;

class BodyIslands {
 public:
  BodyIslands() = default;
  BodyIslands(const Model& model, const ContactBodies& bodies);

  /// What touches in a substep. Places are those of ContactBodies.
  struct Contacts {
    std::span<const std::pair<int, int>> pressing;  ///< places whose contact presses
    std::span<const BodyState> states;              ///< [place] at the frame's start
    const BodyPoints& points;
  };

  /// Finds the islands of a substep after its solve.
  void find(const Substep& s, const ContactBodies& bodies, const Contacts& contacts);

  /// The constraints that join nodes.
  const std::vector<BodyLink>& links() const { return links_; }
  int nodes() const { return bodies_ + objects_; }
  /// The node of an object's particles.
  int node_of_points(int object) const { return bodies_ + object; }
  /// The smallest node of a node's island.
  int island_of(int node) const { return island_[static_cast<std::size_t>(node)]; }
  /// True if work may be done on the island from outside, or by energy that is not counted: a collider or body of
  /// infinite mass that moves touches it, a joint has a motor or gives way, or an object has a volume.
  bool is_driven(int island) const { return is_driven_[static_cast<std::size_t>(island)] != 0; }

 private:
  void find_movers(const Substep& s, const ContactBodies& bodies, std::span<const BodyState> states);
  void join_bodies(std::span<const std::pair<int, int>> pressing);
  void join_points(const Substep& s, const BodyPoints& points);
  void join_links(const Substep& s);
  void mark_driven_points(const Substep& s);
  void drive(int node) { is_driven_[static_cast<std::size_t>(node)] = 1; }
  void join(int a, int b);

  int bodies_ = 0, objects_ = 0;
  std::vector<BodyLink> links_;
  Islands islands_;
  std::vector<char> is_fixed_;   ///< [node] a body of infinite mass
  std::vector<char> moves_;      ///< [place] a collider, or body of infinite mass, that moves in the substep
  std::vector<int> island_;      ///< [node]
  std::vector<char> is_driven_;  ///< [node] of islands, by their smallest node
};

}  // namespace pliant

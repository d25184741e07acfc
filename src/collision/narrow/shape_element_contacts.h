// Finds the contacts of one edge or triangle with one sphere, capsule or box (shape_contacts.h has the rules).
#pragma once

#include <array>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_elements.h"

namespace pliant {

/// The path of a vertex in a collider's frame, from the substep's start to the prediction, as two groups of four
/// floats.
struct VertexWay {
  Vec3f from;
  float unused = 0;
  Vec3f to;
  float unused_too = 0;
  Vec3f at(float s) const { return from + (to - from) * s; }
};

/// A cluster of an object, and the collider that its elements are tested against.
struct Meeting {
  const CompiledObject& object;
  const AdvanceArguments& particles;
  int first = 0;  ///< the object's first particle in the State
  const ElementCluster& cluster;
  const std::vector<VertexWay>& ways;  ///< paths of the cluster's vertices
  const MovingCollider& collider;
  int number = 0;  ///< index of the collider
  const PairMaterial& material;
  float thickness = 0;  ///< of the material [m]
  /// Squared length; the interior of shorter edges is nearer than their ends by at most least_dip [m^2]
  float shortest_squared = 0;
};

/// Squared length up to which an edge dips by at most least_dip into a circle around solid and thickness [m^2]; 0: box.
float shortest_dipping(const LocalShape& shape, float thickness);

void find_edge_contacts(const Meeting& meeting, const std::array<int, 2>& edge, std::vector<Contact>& contacts);

/// Features of a solid that can enter a triangle's interior: points with a radius.
struct Features {
  std::array<Vec3f, 8> point;
  int count = 0;
  float radius = 0;

  /// Returns the features within `reach` of a box along each axis.
  Features near(const BoundingBox<float>& box, float reach) const;
};

Features features_of(const LocalShape& shape);

/// The distance from a feature point within which a triangle whose vertices move by `path` can meet the solid [m].
float reach_of(const Meeting& meeting, float path);

/// Appends the contacts of a triangle with those of the `features` that are near it.
void find_triangle_contacts(const Meeting& meeting, const Features& features, const std::array<int, 3>& triangle,
                            std::vector<Contact>& contacts);

}  // namespace pliant

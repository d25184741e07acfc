// The contacts of one edge or triangle with one sphere, capsule or box (shape_contacts.h says which there are).
#pragma once

#include <array>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_elements.h"

namespace pliant {

/// A vertex in a collider's frame, at the substep's start and as predicted: two quads of floats.
struct VertexWay {
  Vec3f from;
  float unused = 0;
  Vec3f to;
  float unused_too = 0;
  Vec3f at(float s) const { return from + (to - from) * s; }
};

/// A cluster of an object and a collider.
struct Meeting {
  const CompiledObject& object;
  const AdvanceArguments& particles;
  int first = 0;  ///< the object's first particle in the State
  const ElementCluster& cluster;
  const std::vector<VertexWay>& ways;  ///< of its vertices
  const MovingCollider& collider;
  int number = 0;  ///< index of the collider
  float thickness = 0;
  float shortest_squared =
      0;  ///< sides of elements shorter than this cannot come nearer than their ends by least_dip [m^2]
};

/// For a circle of radius r around a round solid with its thickness: a chord above 2 sqrt(dip (2 r - dip)) dips by more.
float shortest_dipping(const LocalShape& shape, float thickness);

void find_edge_contacts(const Meeting& meeting, const std::array<int, 2>& edge, std::vector<Contact>& contacts);

/// Features of a solid that can enter a triangle's interior: points with a radius.
struct Features {
  std::array<Vec3f, 8> point;
  int count = 0;
  float radius = 0;

  /// Those within `reach` of a box, along each axis.
  Features near(const BoundingBox<float>& box, float reach) const;
};

Features features_of(const LocalShape& shape);

/// How near a triangle whose vertices move by `path` must be to a feature point to meet the solid [m].
float reach_of(const Meeting& meeting, float path);

/// Contacts of a triangle with those of the `features` that are near it.
void find_triangle_contacts(const Meeting& meeting, const Features& features, const std::array<int, 3>& triangle,
                            std::vector<Contact>& contacts);

}  // namespace pliant

// Which surfaces can meet, and their contact parameters: all that contact needs to know apart from motion.
//
// Arrays of primitives and clusters hold those of the PairModel's own bodies. Each body has a block in every such
// array; a removed body leaves unused entries that a later one takes. So adding a body costs what that body costs, and
// indices of other bodies stay. Indices of primitives and clusters therefore say nothing about the order of bodies;
// whatever decides bits is ordered by body first (is_before, cluster_order). Arrays of particles and bodies are in
// ContactTables, which the PairModels of a World share.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "collision/proxies/body_blocks.h"
#include "collision/proxies/contact_elements.h"
#include "collision/proxies/contact_tables.h"
#include "collision/proxies/triangles_around.h"
#include "model/model.h"

namespace pliant {

/// The blocks of a body in the arrays of a PairModel, and its particles in the State.
struct BodyElements {
  Block vertices, edges, triangles, clusters;
  float median_edge = 0;  ///< median edge length at rest [m]; 0: no edges
};

/// The elements of bodies, ordered by body. A sorted array, because it is read for all bodies each time that one of
/// thousands comes or goes.
class ElementsOfBodies {
 public:
  using Entry = std::pair<int, BodyElements>;

  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  bool has(int body) const { return lower_bound(body) != end() && lower_bound(body)->first == body; }
  /// The elements of a body that has some.
  const BodyElements& at(int body) const { return lower_bound(body)->second; }
  /// The elements of a body, to be changed; empty if it has none.
  BodyElements& operator[](int body) {
    const auto found = entries_.begin() + (lower_bound(body) - begin());
    return found != entries_.end() && found->first == body ? found->second : entries_.insert(found, {body, {}})->second;
  }
  void erase(int body) { entries_.erase(lower_bound(body)); }

 private:
  std::vector<Entry>::const_iterator lower_bound(int body) const {
    return std::lower_bound(begin(), end(), body, [](const Entry& entry, int of) { return entry.first < of; });
  }

  std::vector<Entry> entries_;
};

/// The part of a model that takes part in contact, in the particle indices of the State. Over fifteen members: each
/// kind of primitive has arrays of its own.
struct PairModel {
  explicit PairModel(std::shared_ptr<ContactTables> tables = std::make_shared<ContactTables>())
      : shared(std::move(tables)), triangles_around(shared->triangle_ranges) {}

  std::shared_ptr<ContactTables> shared;
  std::vector<int> members;  ///< bodies among which contact is found, ascending
  bool has_all = true;       ///< true if the members are all bodies of the World
  /// Corners of unused entries are -1. `vertices` stays empty: a vertex takes part in contact if it has a cluster.
  ContactElements elements;
  /// Particles of bodies without triangles and lines, ordered by body; they meet one another as spheres.
  std::vector<int> free_points;
  std::vector<int> points_at_lines;       ///< free particles that meet bodies of lines, ordered by body
  std::vector<std::array<int, 2>> lines;  ///< edges of bodies of lines that meet free particles, ordered by body
  /// Clusters: about 64 neighbouring vertices of one body, with the edges and triangles whose first vertex is one of
  /// them.
  int clusters = 0;                                               ///< one past the last cluster in use
  std::vector<int> edge_cluster, triangle_cluster, cluster_body;  ///< -1: none
  std::vector<int> cluster_order;                                 ///< clusters in use, ordered by body
  /// For each cluster: its pairs have no contact where positions round by more than this [m]. Empty: no limit.
  std::vector<float> coarsest;
  ElementsOfBodies bodies;  ///< of the members that meet others or themselves
  int sets = 0;  ///< the number of sets that these form (ContactRules::sets); ContactTables::body_set is below
  BodyBlocks edge_blocks, triangle_blocks, cluster_blocks;
  TrianglesAround triangles_around;
  float radius = 0;             ///< distance within which clusters are searched for candidates [m]
  float largest_thickness = 0;  ///< largest thickness of two bodies that meet [m]
  bool filter = true;
  float untangling_speed = 0;  ///< depenetration speed of initial intersections [m/s]; 0: not moved apart

  /// The order of clusters that decides bits: by body, then by number.
  bool is_before(int cluster, int other) const { return key_of(cluster) < key_of(other); }
  int set_of_cluster(int cluster) const {
    return shared->body_set[static_cast<std::size_t>(cluster_body[static_cast<std::size_t>(cluster)])];
  }
  std::pair<int, int> key_of(int cluster) const { return {cluster_body[static_cast<std::size_t>(cluster)], cluster}; }
};

/// Makes the PairModel of all bodies, with tables of its own. Returns null if no two of them can meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model);
/// Makes the PairModel of the given bodies (ascending), or of all if `members` is null. The tables must be up to date.
/// Members may meet no other bodies: these would have no contact with them. Returns null if no two can meet.
std::unique_ptr<PairModel> make_pair_model(const Model& model, std::shared_ptr<ContactTables> tables,
                                           const std::vector<int>* members);

/// The changes that update_pair_model made.
struct PairChanges {
  std::vector<int> removed, added;  ///< bodies, ascending; a body that was edited is in both
  std::vector<Block> clusters;      ///< clusters that the removed bodies had
  bool radius = false;              ///< true if the search radius changed
};

/// Updates bodies that were added, removed or edited, became members or ceased to be (ascending), and bodies that begin
/// or cease to meet others because of them. The tables must be up to date. Returns nullopt if no two bodies can meet
/// any more; the PairModel is then invalid.
std::optional<PairChanges> update_pair_model(const Model& model, const std::vector<int>& changed, PairModel& out);

/// Computes `members`, `bodies`, `sets`, their numbers, `cluster_order` and `triangles_around` of a model whose other
/// arrays are in the order of bodies.
void index_bodies(PairModel& model);

}  // namespace pliant

// Contacts with edges and vertices of mesh colliders that do not rise above the triangles which their particles are on.
//
// Where two meshes are flush, or a mesh has a seam of split vertices, no triangle around a border has those beyond it.
// The direction of a contact with the border, of what is still beside it, would be a ramp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/narrow/pair_contact.h"
#include "collision/proxies/pair_model.h"

namespace pliant {

class FlushContacts {
 public:
  explicit FlushContacts(const PairModel& model) : model_(model) {}

  /// Removes contacts whose direction is oblique to those that the same particles have with faces of mesh colliders,
  /// and whose closest point on the mesh is not above these faces. The contacts with the faces keep the particles above
  /// it. Of the first `leading` ones as many are left as it returns.
  std::size_t remove(const Record* positions, std::size_t leading, std::vector<Contact>& contacts);

 private:
  /// The side of a contact that a mesh collider has.
  struct OnMesh {
    int held = 0;           ///< number of its corners that hold the closest point; 0: no side
    bool is_first = false;  ///< true if it is the contact's first side
  };
  OnMesh on_mesh(const Contact& contact) const;
  bool is_collider(std::int32_t vertex) const {
    return model_.shared->rules.is_immovable(model_.shared->vertex_body[static_cast<std::size_t>(vertex)]);
  }
  bool is_flush(const Contact& contact, const OnMesh& side, const Record* positions,
                const std::vector<Contact>& contacts) const;
  const Contact* face_under(std::int32_t particle, const Contact& contact, bool mesh_is_first, const Contact* other,
                            const Record* positions, const std::vector<Contact>& contacts) const;

  const PairModel& model_;
  struct FaceContact {
    std::int32_t particle = 0, contact = 0;
  };
  std::vector<FaceContact> faces_;  ///< by particle, later contacts first
  std::vector<std::int32_t> features_;
};

}  // namespace pliant

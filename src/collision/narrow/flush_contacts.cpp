#include "collision/narrow/flush_contacts.h"

#include <algorithm>

#include "math/record.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A corner with a smaller weight does not hold the closest point.
constexpr float least_weight = 1e-5f;
/// The squared sine of the least angle between directions that differ.
constexpr float least_tilt_squared = 1e-6f;
/// What rises above a face by less than this share of the thickness is flush with it.
constexpr float flush_share = 1e-3f;

bool differ(const Vec3f& a, const Vec3f& b) { return length_squared(cross(a, b)) > least_tilt_squared; }

float distance_of(const Contact& contact) { return contact.gap + contact.thickness; }

/// Corner number i is of the contact's first side: weights are positive there.
bool holds_on(bool first_side, const Contact& contact, std::size_t i) {
  return first_side ? contact.weight[i] >= least_weight : contact.weight[i] <= -least_weight;
}

/// The closest point on the side of the mesh, relative to a place [m].
Vec3f point_on_mesh(const Contact& contact, bool mesh_is_first, const Vec3f& from, const Record* positions) {
  Vec3f point{};
  for (std::size_t i = 0; i < 4; ++i)
    if (holds_on(mesh_is_first, contact, i))
      point += (xyz(positions[contact.point[i]]) - from) * abs(contact.weight[i]);
  return point;
}

/// True if a contact with a face keeps its particle as far from a point as `contact` keeps it; `point` relative to the
/// particle [m].
bool keeps_above(const Contact& face, const Vec3f& point, const Contact& contact) {
  const float slack = flush_share * contact.thickness;
  const float height = dot(face.normal, point) + distance_of(face);
  return height <= slack &&
         contact.thickness - face.thickness <= max(distance_of(contact) - distance_of(face), 0.f) + slack;
}

}  // namespace

FlushContacts::OnMesh FlushContacts::on_mesh(const Contact& contact) const {
  OnMesh side;
  const auto body_of = [&](std::int32_t vertex) {
    return model_.shared->vertex_body[static_cast<std::size_t>(vertex)];
  };
  const bool is_second = is_collider(contact.point[3]);
  if (body_of(contact.point[0]) == body_of(contact.point[3])) return side;
  if (!is_second && !is_collider(contact.point[0])) return side;
  side.is_first = !is_second;
  for (std::size_t i = 0; i < 4; ++i) side.held += holds_on(side.is_first, contact, i) ? 1 : 0;
  return side;
}

/// The contact with a face that keeps a particle above the closest point of an oblique one, and is alike `other`; null:
/// none.
const Contact* FlushContacts::face_under(std::int32_t particle, const Contact& contact, bool mesh_is_first,
                                         const Contact* other, const Record* positions,
                                         const std::vector<Contact>& contacts) const {
  auto at = std::lower_bound(faces_.begin(), faces_.end(), particle,
                             [](const FaceContact& face, std::int32_t p) { return face.particle < p; });
  for (; at != faces_.end() && at->particle == particle; ++at) {
    const Contact& face = contacts[static_cast<std::size_t>(at->contact)];
    if (!differ(face.normal, contact.normal) || (other != nullptr && differ(face.normal, other->normal))) continue;
    if (keeps_above(face, point_on_mesh(contact, mesh_is_first, xyz(positions[particle]), positions), contact))
      return &face;
  }
  return nullptr;
}

bool FlushContacts::is_flush(const Contact& contact, const OnMesh& side, const Record* positions,
                             const std::vector<Contact>& contacts) const {
  const Contact* under = nullptr;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!holds_on(!side.is_first, contact, i)) continue;
    under = face_under(contact.point[i], contact, side.is_first, under, positions, contacts);
    if (under == nullptr) return false;
  }
  return under != nullptr;
}

std::size_t FlushContacts::remove(const Record* positions, std::size_t leading, std::vector<Contact>& contacts) {
  features_.clear();
  faces_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const OnMesh side = on_mesh(contacts[k]);
    if (side.held == 0) continue;
    if (side.held < 3) features_.push_back(static_cast<std::int32_t>(k));
    if (side.held == 3) faces_.push_back({contacts[k].point[0], static_cast<std::int32_t>(k)});
  }
  const auto is_kept = [&](std::int32_t k) {
    const Contact& contact = contacts[static_cast<std::size_t>(k)];
    return !is_flush(contact, on_mesh(contact), positions, contacts);
  };
  if (faces_.empty() || features_.empty()) return leading;
  std::sort(faces_.begin(), faces_.end(), [](const FaceContact& a, const FaceContact& b) {
    return a.particle != b.particle ? a.particle < b.particle : a.contact > b.contact;
  });
  std::erase_if(features_, is_kept);
  if (features_.empty()) return leading;
  std::size_t kept = 0, left = leading;
  auto gone = features_.begin();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (gone != features_.end() && static_cast<std::size_t>(*gone) == k) {
      ++gone;
      left -= k < leading ? 1 : 0;
      continue;
    }
    contacts[kept++] = contacts[k];
  }
  contacts.resize(kept);
  return left;
}

}  // namespace pliant

// Contact of a bending sheet with colliders and bodies.
//
// P does not know contacts: what presses a sheet onto a support is spread by P^-1 over all vertices near it, and the
// projection of contacts pushes back those alone that touch. So stiff sheets on supports sagged up to 7 times too far.
// Here the bending finds the forces f of contacts itself:
//
//   x = P^-1 (r + J^T f),   f >= 0,   room + J x + y f >= 0,   one of the two 0
//   d = u + x
//
// `room` is the gap at u and y the inverse mass of a body that yields. At rest r = -J^T f, hence x = 0 whatever P is:
// the sag depends on neither cycles nor substeps. Contacts with colliders continue from these forces, so that friction
// knows the whole load. Those with bodies take d = u + x - M^-1 J^T f instead: their projection pushes against what is
// given back, and so gives the body its impulse. Between few edges and triangles of colliders that made sheets hum.
#pragma once

#include <array>
#include <vector>

#include "constraints/contact.h"
#include "parallel/executor.h"
#include "solver/sheets/sheet_solver.h"

namespace pliant::sheets {

/// A contact of a sheet with what does not bend.
struct SheetContact {
  std::array<std::int32_t, 4> row{};  ///< of its points in the sheet; `points` of them are in use
  std::array<float, 4> weight{};
  int points = 0;
  Vec3f normal{};
  float room = 0;                  ///< by how much the sides may approach [m]
  float inverse_mass = 0;          ///< of the sheet's side: sum of w weight^2 [1/kg]
  float yields = 0;                ///< y: of a body, times the number of its contacts [1/kg]
  float force = 0;                 ///< f h^2 [kg m]
  Contact* of_collider = nullptr;  ///< null: with a body
  float turn = 0;                  ///< the search direction of `force` [kg m]
};

/// The contacts of an object's sheet in this substep. `gravity`: what it moves in a substep [m].
std::vector<SheetContact> contacts_of_sheet(Substep& s, int object, const Vec3f& gravity);

/// Adds `by` J^T f, of the forces or of the search direction.
void add_contact_forces(const std::vector<SheetContact>& contacts, float SheetContact::*of, float by, Records& to);

/// Gives the forces of contacts with colliders to these, and takes them from `contacts`.
void hand_over_forces(std::vector<SheetContact>& contacts);

/// x = P^-1 (right + J^T `of`), or without the right-hand side if that is null.
using SheetResponse = FunctionRef<void(const Records* right, float SheetContact::*of, Records& x)>;

/// Finds the forces of contacts, and x. `mass`: of rows; 0 where they are fixed [kg]; `gravity`: what it moves in a
/// substep [m].
void solve_contacts(const std::vector<float>& mass, const Records& right, float gravity, SheetResponse respond,
                    std::vector<SheetContact>& contacts, Records& x);

}  // namespace pliant::sheets

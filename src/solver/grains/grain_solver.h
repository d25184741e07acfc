// The grains of a substep group, as stages of a frame: contacts of spheres with Coulomb friction, projected by a Jacobi
// iteration.
//
// A contact yields: an iteration removes a fixed share of its overlap, and a fixed share of the slip since the two
// grains stuck, up to the Coulomb bound (the tangential spring of Cundall and Strack 1979). Force is thus a function of
// overlap and slip, which last over substeps, and not of how far an iteration has converged. Slip is kept in
// State::grain_contacts.
//
// With cohesion the spring of the overlap goes on beyond contact and pulls, up to the pull that a contact bears
// (model/cohesion.h). Friction is then that of the push plus this pull, which presses the grains together (Derjaguin,
// Muller and Toporov 1975).
#pragma once

#include <cstdint>
#include <vector>

#include "collision/neighbours/neighbour_lists.h"
#include "model/model.h"
#include "solver/systems/system.h"

namespace pliant {

struct Substep;

/// A neighbour of a grain, as seen from that grain.
struct GrainNeighbour {
  std::int32_t slot = 0;  ///< of the neighbour
  float push = 0;         ///< sum of normal corrections in the substep; negative: cohesion pulls [m]
  float pull = 0;         ///< the most that cohesion may pull in the substep; 0: none, or they do not touch [m]
  Vec3f slip{};           ///< of the grain over the neighbour since they stuck, up to the substep's start [m]
  Vec3f friction{};       ///< sum of tangential corrections in the substep [m]
};

/// What a contact needs to know of a grain.
struct GrainTraits {
  float radius = 0;        ///< [m]
  float friction = 0;      ///< coefficient of a contact [-]
  float cohesion = 0;      ///< [Pa]
  float inverse_mass = 0;  ///< 0: fixed [1/kg]
  float mass_scaling = 0;  ///< Grains::mass_scaling [1/m]
  int object = 0;
  std::uint32_t groups = 0, mask = 0;
};

/// Contacts are kept in this order.
inline bool in_order_of_particles(const GrainContact& a, const GrainContact& b) {
  return a.a != b.a ? a.a < b.a : a.b < b.b;
}

/// Coefficient of friction of contacts with which a heap of spheres that do not turn has the given one: the tangent of
/// its angle.
float contact_friction(float of_bulk);

/// Grains are numbered by slots, in the order of cells.
class GrainSolver : public System {
 public:
  /// For the grains of the given objects, or of all if it is null.
  GrainSolver(const Model& model, const std::vector<int>* objects);
  ~GrainSolver() override;

  bool has_any() const { return !objects_.empty(); }

  /// Starts a frame: neighbours are found in its first substep, so that they follow from the State.
  void begin_frame(Substep& s) override;
  /// After the prediction: finds neighbours, if grains have moved too far since.
  void collide(Substep& s) override;
  /// Projects all contacts once.
  void project_neighbours(Substep& s, bool is_first) override;
  /// Gives the State the contacts that press.
  void end_frame(Substep& s) override;
  void order(State& state) const override;

 private:
  void list_points(const Model& model, const State& state);
  void find_neighbours(Substep& s, const std::vector<GrainContact>& known);
  void count_neighbours();
  void list_contacts(std::vector<GrainContact>& to) const;
  void list_neighbours(int slot, const std::vector<GrainContact>& known);
  bool are_neighbours_known(Substep& s);
  void slide(const State& state, int slot);
  void project_grain(Substep& s, int slot, bool is_first);

  std::vector<int> objects_;          ///< ascending
  std::vector<std::int32_t> points_;  ///< all particles that are there, as in the State
  std::vector<GrainTraits> traits_;   ///< of each of `points_`
  float largest_radius_ = 0;          ///< [m]
  bool has_cohesion_ = false, scales_masses_ = false;

  NeighbourLists lists_;
  std::vector<std::int32_t> of_slot_;       ///< the particle of each slot
  std::vector<GrainTraits> of_grain_;       ///< by slot
  std::vector<std::int32_t> first_;         ///< of each slot: its first neighbour; one more than slots
  std::vector<GrainNeighbour> neighbours_;  ///< of all slots, each ascending by particle
  Records found_at_;                        ///< predicted places when neighbours were found, by slot [m]
  Records places_, moves_;                  ///< predicted, and the way there from the substep's start, by slot [m]
  Records starts_, residues_;               ///< State::positions and remainders at the substep's start, by slot [m]
  std::vector<float> task_moves_;           ///< by task: square of the largest move since neighbours were found [m^2]
  bool is_new_frame_ = true;
};

}  // namespace pliant

// Particles that carry rigid bodies: those tied to a body, and those on which a body presses.
//
// In the solve of chains such a particle has a share of its body's inertia (sweeps/chain_loaded.h). The motion that a
// phase of chains gives it, times that share, is an impulse on the body. Shares of one body add up to its mass at most
// (mass splitting: Tonge et al. 2012), so the body moves by no more than the mean of its particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "collision/narrow/contact.h"
#include "model/model.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/sweeps/chain_loaded.h"

namespace pliant {

struct Substep;

/// A body as points touch it.
struct TouchedBody {
  int object = 0, body = 0;     ///< index in Model::objects, and among the object's bodies
  int particle = 0, frame = 0;  ///< indices in the State
};

class PointLoads {
 public:
  PointLoads() = default;
  PointLoads(const Model& model, const std::vector<TouchedBody>& bodies);

  /// The contacts of a substep, with their impulses so far [N s].
  struct Contacts {
    const std::vector<Contact>& all;
    std::vector<float>& impulses;
    const std::vector<int>& body_of_solid;
  };

  /// Notes the particles on which bodies press at a substep's end.
  void note_pressed(const Substep& s, const Contacts& contacts);
  /// Finds the particles that carry bodies: those tied, and those of contacts that push, or that pushed in the last
  /// substep where `begins`. `motions` have the bodies' inertias.
  void find(const Substep& s, const Contacts& contacts, const std::vector<BodyMotion>& motions, bool begins);

  /// False if no particle of the object carries a body.
  bool has_any(int object) const { return !loads_.empty() && is_loaded_[static_cast<std::size_t>(object)] != 0; }
  ChainLoads of(int first_particle) {
    return {of_particle_.data() + first_particle, inertias_.data(), is_released_.data()};
  }
  /// The paths of a chain batch of an object with a particle that carries a body: bit i for lane i.
  std::uint32_t loaded_lanes(int object, int batch) const {
    return lanes_[first_batch_[static_cast<std::size_t>(object)] + static_cast<std::size_t>(batch)];
  }

  /// Before and after a phase of chains: gives the bodies the impulses of their particles.
  void begin_chains(const Substep& s);
  void end_chains(Substep& s, const std::vector<BodyMotion>& motions, std::vector<float>& impulses);

 private:
  struct Load {
    int particle = 0;             ///< index in the State
    int body = 0;                 ///< index among the bodies
    int contact = -1;             ///< -1: tied to the body; else index of a contact, which only pushes
    Vec3f axis{};                 ///< of a contact its normal, away from the body
    float along = 0, across = 0;  ///< share of the body's inertia along the axis and across it [kg]
    float given = 0;              ///< impulse along the axis in this substep, times its length [kg m]
    Vec3f before{};               ///< displacement before a phase [m]
  };

  /// One of the sixteen paths of a chain batch.
  struct Lane {
    std::int32_t batch = 0;  ///< index in lanes_
    std::uint32_t bit = 0;
  };

  void find_paths(const Model& model);
  void mark_lanes(bool are_loaded);
  void add_ties(const Substep& s);
  void add_contacts(const Substep& s, const Contacts& contacts, bool begins);
  void add(int particle, int body, int contact, const Vec3f& axis);
  void share_inertia(const Substep& s, const std::vector<BodyMotion>& motions);
  Vec3f impulse_of(Load& load, const Vec3f& moved) const;

  std::vector<TouchedBody> bodies_;
  std::vector<std::pair<int, int>> ties_;  ///< particles in the State, and bodies
  /// [particle in the State] 1 + body that pressed at the last substep's end, or 0.
  std::vector<std::int32_t> pressed_by_;
  std::vector<int> pressed_;               ///< particles with such an entry
  std::vector<std::int32_t> of_particle_;  ///< [particle in the State] index in loads_, or -1
  std::vector<char> is_loaded_;            ///< [object]
  std::vector<Load> loads_, kept_;
  std::vector<LoadedInertia> inertias_;  ///< of loads_
  std::vector<char> is_released_;        ///< [load] moved without its body in this phase
  std::vector<int> carriers_;            ///< [body] number of its loads
  std::vector<int> first_path_;  ///< [particle in the State] of its paths in paths_; the last entry is their number
  std::vector<Lane> paths_;
  std::vector<std::size_t> first_batch_;  ///< [object] of its chain batches in lanes_
  std::vector<std::uint32_t> lanes_;      ///< [chain batch]
};

}  // namespace pliant

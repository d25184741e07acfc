// The scratch data of a step, kept between steps only to avoid allocations.
#pragma once

#include <vector>

#include <memory>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_contacts.h"
#include "collision/surfaces/surface_contact.h"
#include "model/control.h"
#include "model/model.h"
#include "pliant/state.h"
#include "solver/contact_log.h"
#include "solver/contact_solver.h"
#include "solver/residual.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The results of one tile.
struct alignas(64) TileScratch {
  std::vector<Contact> contacts, more_contacts, all_contacts;  ///< current ones; the others are scratch for finding more
  std::vector<std::int32_t> near;                              ///< particles that a collider could touch
  PointBounds bounds;
  bool finite = true;
  double gradient_squared = 0, position_along = 0, motion_along = 0;  ///< sums for the volume constraint
};

/// The time for which gravity of the current frame has acted on an object's particles, reduced by damping [s].
struct FrameGravity {
  double finished = 0, begun = 0, settled = 0;  ///< of the ending substep, the starting one, and already in velocities
  float kept = 1;                               ///< factor of the velocity after damping in a substep

  void next(float h) {
    finished = begun;
    settled = finished * kept;
    begun = settled + h;
  }
};

/// The frame data within a substep (stencil.h).
struct FrameScratch {
  Records predicted, corrections;  ///< rotation vectors in world axes [rad]
};

/// Memory that a World reuses from step to step. Over fifteen members: one buffer for each stage of a substep.
struct Workspace {
  Records displacements;                                       ///< displacements since the substep's start [m]
  std::vector<std::vector<AlignedVector<float>>> multipliers;  ///< [object][pool], one float per lane; empty if not stored
  std::vector<std::vector<float*>> multiplier_pointers;
  FrameScratch frames;
  std::vector<double> volume_multipliers;           ///< one per object
  Records volume_gradients;                         ///< one per particle if any object has a volume constraint
  std::vector<std::vector<Vec3f>> triangle_forces;  ///< [object], if there is air
  std::vector<TileScratch> tiles;                   ///< one per tile task
  std::vector<MovingCollider> colliders;
  std::unique_ptr<ContactLog> contact_log;  ///< contact sums of the current frame; null if not requested
  Control control;                          ///< user control of the current frame
  std::vector<FrameGravity> gravity;        ///< one per object
  std::vector<Records> anchors;             ///< [object], position and displacement of each tether anchor
  SweepGroups sweeps;                       ///< the sweeps in use
  Records predicted;                        ///< predicted displacements, if residuals are recorded
  std::unique_ptr<SurfaceContact> pairs;    ///< null if no dynamic surface can touch another
  ContactSolver contact_solver;             ///< solver of the contacts of `pairs`
  ShapeContacts shape_contacts;             ///< contacts of edges and triangles with primitive colliders
  ContactSolver shape_contact_solver;
  bool look_for_tangles = true;  ///< search for initial intersections in the next frame: the first, or after a restore
  ResidualScratch residual;      ///< data of the residual for stopping at a tolerance
};

/// Which multipliers are stored: none, those that a second iteration needs, or all.
enum class Multipliers { none, needed, all };

/// Resizes everything for a model except its sweeps.
void prepare(const Model& model, Multipliers kept, Workspace& workspace);

/// Resizes the data of one object after it was added, edited or removed.
void prepare(const Model& model, int object, Multipliers kept, Workspace& workspace);

/// Call after prepare: makes the groups of the sweeps in use, and their
/// scratch. Of the settings, only sweep options and recording matter.
void prepare_sweeps(const Model& model, const Settings& settings, int threads, Workspace& workspace);
void prepare_sweep(const Model& model, int object, const Settings& settings, int threads, Workspace& workspace);
/// Drops groups without objects after an edit or a removal.
void drop_unused_sweeps(const Model& model, Workspace& workspace);

}  // namespace pliant

// What a step needs besides model and state, kept between steps only so that nothing is allocated in one.
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

/// Results of one tile.
struct alignas(64) TileScratch {
  std::vector<Contact> contacts, more_contacts, all_contacts;  ///< those that count; and for finding more, scratch
  std::vector<std::int32_t> near;                              ///< particles that a collider could touch
  PointBounds bounds;
  bool finite = true;
  double gradient_squared = 0, position_along = 0, motion_along = 0;  ///< sums of the volume constraint
};

/// For how long an object's particles have felt the gravity of the frame under way, less what damping took of it [s].
struct FrameGravity {
  double finished = 0, begun = 0, settled = 0;  ///< in the substep that ends, in the one that begins, and between the two
  float kept = 1;                               ///< share of velocity that damping leaves after a substep

  void next(float h) {
    finished = begun;
    settled = finished * kept;
    begun = settled + h;
  }
};

/// Of frames, within a substep (stencil.h).
struct FrameScratch {
  Records predicted, corrections;  ///< rotation vectors, world axes [rad]
  bool finite = true;
};

struct Workspace {
  Records displacements;                                       ///< since the substep's start [m]
  std::vector<std::vector<AlignedVector<float>>> multipliers;  ///< [object][pool], a float a lane; empty where not kept
  std::vector<std::vector<float*>> multiplier_pointers;
  FrameScratch frames;
  std::vector<double> volume_multipliers;           ///< one an object
  Records volume_gradients;                         ///< one a particle where some object has a volume constraint
  std::vector<std::vector<Vec3f>> triangle_forces;  ///< [object], where there is air
  std::vector<TileScratch> tiles;                   ///< one a tile task
  std::vector<MovingCollider> colliders;
  std::unique_ptr<ContactLog> contact_log;  ///< of the frame under way; null where nobody asks
  Control control;                          ///< of the frame under way
  std::vector<FrameGravity> gravity;        ///< one an object
  std::vector<Records> anchors;             ///< [object], position and displacement of each anchor of tethers
  SweepGroups sweeps;                       ///< of the sweeps that objects are solved by
  Records predicted;                        ///< displacements as predicted, where residuals are recorded
  std::unique_ptr<SurfaceContact> pairs;    ///< null where no surface that moves can touch another
  ContactSolver contact_solver;             ///< of the contacts of `pairs`
  ShapeContacts shape_contacts;             ///< of edges and triangles with primitive colliders
  ContactSolver shape_contact_solver;
  bool look_for_tangles = true;  ///< at the next frame: the first, or after a State was put back
  ResidualScratch residual;      ///< where iterations stop at a tolerance
};

/// Which multipliers are kept: those that a second iteration needs, or all.
enum class Multipliers { none, needed, all };

/// Makes everything the right size for a model but for its sweeps.
void prepare(const Model& model, Multipliers kept, Workspace& workspace);

/// Makes what belongs to one object the right size, after it was added, edited or removed.
void prepare(const Model& model, int object, Multipliers kept, Workspace& workspace);

/// After prepare: the groups of the sweeps that objects are compiled for, and what their methods keep. Of the settings, the
/// options of sweeps and what is recorded count.
void prepare_sweeps(const Model& model, const Settings& settings, int threads, Workspace& workspace);
void prepare_sweep(const Model& model, int object, const Settings& settings, int threads, Workspace& workspace);
/// Drops the groups that no object is of any more, after one was edited or removed.
void drop_unused_sweeps(const Model& model, Workspace& workspace);

}  // namespace pliant

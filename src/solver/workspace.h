// Scratch data of a step. It is kept between steps only to avoid allocations.
#pragma once

#include <vector>

#include <memory>

#include "collision/narrow/contact.h"
#include "collision/narrow/shape_contacts.h"
#include "collision/surfaces/surface_contact.h"
#include "math/functions.h"
#include "model/control.h"
#include "model/model.h"
#include "pliant/state.h"
#include "solver/bodies/object_joints.h"
#include "solver/contact_log.h"
#include "solver/contact_solver.h"
#include "solver/joint_load_sums.h"
#include "solver/limit.h"
#include "solver/momentum.h"
#include "solver/residual.h"
#include "solver/sheets/sheet_solver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// Sums over the particles of a tile for the guard of energy (stages/guard_energy.cpp) [J].
struct CorrectionEnergy {
  double kinetic = 0;             ///< kinetic energy at the substep's start
  double predicted = 0;           ///< change of energy in a substep without its corrections
  double linear = 0;              ///< energy that corrections add, the part that is linear in their velocities
  double quadratic = 0;           ///< the quadratic part
  bool has_outside_work = false;  ///< true if a kinematic particle moves
};

/// The scratch data and results of one tile.
struct alignas(64) TileScratch {
  std::vector<Contact> contacts, more_contacts, all_contacts;  ///< contacts with colliders; the other two are scratch
  std::vector<std::int32_t> near;                              ///< particles that a collider could touch
  PointBounds bounds;
  bool finite = true;
  std::vector<std::pair<int, int>> inside;  ///< colliders and particles inside of them (collider_depenetration.h)
  int impacts = 0;                          ///< on colliders, within the next quarter of a frame (impacts.h)
  CorrectionEnergy energy;
  double gradient_squared = 0, position_along = 0, motion_along = 0;  ///< sums of the volume constraint
  RigidSums rigid;                                                    ///< of inflated objects
  DisplacementMomentum noted;                                         ///< before an iteration, less impulses on bodies
};

/// The share of its velocity that an object with a rate of decay [1/s] keeps in h, exp(-h rate).
inline float velocity_kept(float h, float rate) {
  return rate > 0 ? static_cast<float>(exp(-(static_cast<double>(h) * static_cast<double>(rate)))) : 1.f;
}

/// For how long gravity of this frame has acted on an object's particles, reduced by damping [s].
struct FrameGravity {
  double finished = 0, begun = 0,
         settled = 0;  ///< time in the ending substep; in the starting one; already in velocities
  float kept = 1;      ///< factor by which damping reduces a velocity in a substep

  void next(float h) {
    finished = begun;
    settled = finished * kept;
    begun = settled + h;
  }
};

/// Frame data within a substep (stencil.h).
struct FrameScratch {
  Records starts;                  ///< orientations at the substep's start
  Records predicted, corrections;  ///< rotation vectors of each frame in world axes [rad]
  Records round;                   ///< see FrameArrays
};

/// Of each set of objects that can meet: whether its impacts go on in this round (respond.cpp), and in the next one.
struct ImpactScratch {
  std::vector<char> goes_on, again;
};

/// What the speeds of an object's particles are limited to in a substep (collider_depenetration.h).
struct SpeedLimit {
  int object = 0;
  float most = 0;             ///< [m/s]
  std::vector<float> speeds;  ///< at the substep's start, which may be higher [m/s]
};

/// Scratch data of a substep of a group. Nothing lasts for the next one, so groups that take turns share it; groups
/// that run side by side have one for each thread.
struct SubstepScratch {
  std::vector<MovingCollider> colliders;
  ContactSolver contact_solver;         ///< projects contacts between surfaces
  std::vector<Contact> shape_contacts;  ///< contacts of edges and triangles with primitive colliders
  ContactSolver shape_contact_solver;
  std::vector<AlignedVector<float>> chains;  ///< for each thread that solves chains, room for the longest
  std::vector<float> demands;                ///< substeps that constraints demand (substep_law.h)
  bool free_is_known = false;
  FreeBodies free;  ///< objects on which nothing fixed acts in the substep (free_objects.h)
  std::vector<VertexDisplacement> without_velocity;  ///< of displacements, what is not to become velocity
  ImpactScratch impacts;
  std::vector<SpeedLimit> speed_limits;
  LimitScratch limit;                  ///< the limit of overstretch
  std::vector<RigidStep> rigid_steps;  ///< [object] if it is inflated (momentum.h)
};

/// Memory that a World reuses from step to step. Over fifteen members: each stage of a substep has buffers of its own.
struct Workspace {
  Records displacements;  ///< displacements since the substep's start [m]
  /// [object][pool], one float per lane; empty if not stored.
  std::vector<std::vector<AlignedVector<float>>> multipliers;
  std::vector<std::vector<float*>> multiplier_pointers;
  std::vector<char> stores_in_last;  ///< [object] 1: multipliers are stored in the last substep of a frame only
  std::vector<ObjectJoints> joints;  ///< [object]
  FrameScratch frames;
  std::vector<std::vector<Vec3f>> cluster_multipliers;  ///< [object][member of a cluster]; empty if not stored [m]
  std::vector<double> volume_multipliers;               ///< multiplier of each object's volume constraint
  Records volume_gradients;                 ///< gradient at each particle, if any object has a volume constraint
  std::vector<Records> triangle_forces;     ///< [object][triangle], if there is air
  std::vector<TileScratch> tiles;           ///< scratch data of each tile of the model
  std::vector<SubstepScratch> of_thread;    ///< [0] also for groups that take turns
  std::unique_ptr<ContactLog> contact_log;  ///< null if contact events are not requested
  bool sums_joint_loads = false;
  std::vector<JointLoadSums> joint_loads;  ///< [object]; empty unless sums_joint_loads
  Control control;                         ///< what the user set for the current frame
  std::vector<FrameGravity> gravity;       ///< gravity in each object's velocities
  std::vector<SheetScratch> sheets;        ///< [object] that bends as a sheet
  std::vector<Records> anchors;            ///< [object], a position and a displacement for each tether anchor
  SweepGroups sweeps;                      ///< the sweep groups in use
  Records predicted;                       ///< predicted displacements, kept if residuals are recorded
  std::unique_ptr<SurfaceContact> pairs;   ///< contact between surfaces; null if no dynamic surface can touch another
  ShapeContacts shape_contacts;            ///< finds contacts of edges and triangles with primitive colliders
  /// True: the next frame searches all initial intersections (first frame, restored State)
  bool look_for_tangles = true;
  Records velocities_before;  ///< of the substep's start, before forces change them; only where there are forces [m/s]
  Records expected_velocities;  ///< velocities after the impacts of the next quarter (impacts.h) [m/s]
  std::vector<float> last_h;    ///< length of each object's last substep [s]; 0: none yet
  ResidualScratch residual;     ///< the residual for Settings::tolerance
  /// As multiplier_pointers, of substeps before the last of a frame: null where only that one stores them.
  std::vector<std::vector<float*>> pointers_before_last;
};

/// Which multipliers are stored: none; those of elastic constraints in the last substep of a frame, after which
/// overstretch is measured and convergence estimated, those of distances in each substep if `lengths`; those that a
/// second iteration needs; or all. Only `all` includes rigid constraints, whose multipliers no projection needs.
enum class Multipliers { none, lengths_in_last, lengths, needed, all };

/// Resizes everything for a model but its sweeps.
void prepare(const Model& model, Multipliers kept, Workspace& workspace);

/// Resizes the data of one object after it was added, edited or removed.
void prepare(const Model& model, int object, Multipliers kept, Workspace& workspace);

/// Makes the groups of the sweeps in use, and their scratch data; call it after prepare. Of the settings it reads sweep
/// options and recording.
void prepare_sweeps(const Model& model, const Settings& settings, int threads, Workspace& workspace);
void prepare_sweep(const Model& model, int object, const Settings& settings, int threads, Workspace& workspace);
/// Removes sweep groups that have no objects after an edit or a removal.
void drop_unused_sweeps(const Model& model, Workspace& workspace);

}  // namespace pliant

// The joints of an object's rigid bodies that form trees, solved directly in each pass over the stencils (JointTree).
//
// C is that of the present positions, its gradients are those of the substep's start, which keeps energy (SHAKE;
// Ryckaert, Ciccotti, Berendsen 1977). Where joints pull so hard that a body would oscillate faster than substeps can
// follow, gradients are those of the present, and the geometric stiffness of the joint forces is added to the body's
// inertia (Tournier, Nesme, Gilles, Faure 2015). What that takes from the angular momentum of a tree that holds on to
// nothing is given back (free_tree.h).
//
// Limits, motors and friction of a joint in a tree are further rows of that joint. Which of them act at a bound is
// found by repeated solves (an active set). Joints that close loops remain with the stencil driver.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/bodies/joint_tree.h"
#include "solver/bodies/object_joints.h"

namespace pliant {

struct CompiledObject;
struct Substep;

/// Joints of one object that are solved directly, and scratch data for them. Bodies that no joints connect are in
/// different forests.
struct JointForest {
  /// A constraint: of a joint, or a limit, motor or friction of it.
  struct Part {
    int pool = 0;
    std::int64_t batch = 0;
    int lane = 0;
  };
  /// The slots: point and frame of a, then of b. Indices of frames count from the object's first one. The first part is
  /// bilateral, the others have bounds.
  struct Joint {
    std::array<std::int32_t, 4> slots{};
    std::vector<Part> parts;
    int rows = 0;         ///< of all parts
    bool in_tree = true;  ///< false: closes a loop
  };
  struct Body {
    std::int32_t point = 0, frame = 0;
    bool is_held = false;  ///< its centre is pinned when trees are made, and it rotates
  };
  /// A row whose change of the multiplier has bounds.
  struct BoundedRow {
    enum class State : char { free, low, high };
    std::size_t joint = 0, row = 0;
    float low = 0, high = 0;          ///< bounds of the change
    float value = 0, compliance = 0;  ///< of the row while it is free
    float inverse_mass = 0;           ///< J M^-1 J^T of its two bodies
    State state = State::free;        ///< at which bound the change is held
  };

  std::vector<Joint> joints;  ///< in the order of the schedule
  std::vector<JointEnds> ends;
  std::vector<Body> bodies;
  std::optional<JointTree> tree;
  bool in_bundle = false;  ///< solved side by side with others (rod_bundle.h)

  std::vector<BodyMass> masses;
  std::vector<JointRows> rows;
  std::vector<BoundedRow> bounded;
  std::vector<BodyCorrection> corrections;
  std::vector<std::array<float, most_joint_rows>> multipliers;
  std::vector<Symmetric> stiffness;  ///< [body] geometric stiffness times h^2 [kg m^2]
  std::vector<float> sizes;          ///< [body] sum of |f| h^2 |r| of its joints [kg m^2]

  using Pull = std::array<Vec3f, 2>;  ///< the force on bodies a and b, times h^2 [kg m]
  std::vector<Pull> pulls;            ///< [joint] of the last substep, or of this one's passes so far
  std::vector<Pull> pulls_of_pass;    ///< [joint] scratch
  bool is_fast = false;  ///< a body turns so fast on a bearing that stands still that joints hold velocities, too
  float inverse_h2_of_pulls = 0;  ///< of the substep in which the pulls were found [1/s^2]
};

/// Finds the trees of an object, of its joints that are not broken.
void prepare_joints(const CompiledObject& object, ObjectJoints& joints);

/// Solves the trees of all objects that take part.
void solve_joint_trees(Substep& s, bool first_pass);
/// Solves them again where contact has opened joints since.
void close_joint_trees(Substep& s);

/// Finds the trees of which a body turns fast, by the velocities at the substep's end. True if there are any.
bool has_fast_joints(Substep& s);
/// Joints of those trees hold velocities, too.
void hold_joint_velocities(Substep& s);

}  // namespace pliant

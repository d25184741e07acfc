// Records of the table that several other records use.
#pragma once

#include "scene_grammar.h"

namespace pliant::scene_file {

Type stiffness();
const Record& rotation_record();
const Record& motion_record();
const Record& volume_record();
const Record& plasticity_record();
const Record& strain_limit_record();
const Record& rest_keyframe_record();
const Record& mesh_record();
/// A list of places, or the name of points in memory.
Type places();
const Record& fabric_record();
std::vector<std::string> fabric_names();

// Defined in scene_grammar_matter.cpp.
const Record& cloth_record();
const Record& line_record();
const Record& rope_record();
const Record& particles_record();
const Record& fill_record();
const Record& emitter_record();
const Record& drain_record();
const Record& liquid_record();
const Record& grains_record();

// Defined in scene_grammar_gases.cpp.
const Record& gas_record();
const Record& tracers_record();

// Defined in scene_grammar_rods.cpp.
const Record& rod_record();

// Defined in scene_grammar_soft_bodies.cpp.
const Record& soft_body_record();

// Defined in scene_grammar_colliders.cpp.
const Record& plane_record();
const Record& sphere_record();
const Record& capsule_record();
const Record& box_record();
const Record& collider_record();
const Record& pair_record();

// Defined in scene_grammar_bodies.cpp.
const Record& body_record();

// Defined in scene_grammar_joints.cpp.
const Record& joint_record();
const Record& urdf_record();

// Defined in scene_grammar_gauges.cpp.
const Record& gauge_record();

// Defined in scene_camera.cpp.
const Record& camera_record();

}  // namespace pliant::scene_file

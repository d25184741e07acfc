// From checked JSON values to the small structures of a scene: vectors, stiffnesses, motions, fabrics.
//
// Everything here relies on scene_check: types and ranges are right already. What remains to be refused are relations
// between values, which a table of fields cannot say.
#pragma once

#include <string>

#include "pliant/material.h"
#include "pliant/motion.h"
#include "pliant/scene.h"
#include "scene_json.h"

namespace pliant::scene_file {

Vec3f vector_of(const JsonValue& value);

/// Puts the member `name` of an object into `target`, which keeps its value, the default, where there is none.
bool set(const JsonValue& at, const char* name, bool& target);
bool set(const JsonValue& at, const char* name, int& target);
bool set(const JsonValue& at, const char* name, float& target);
bool set(const JsonValue& at, const char* name, std::string& target);
bool set(const JsonValue& at, const char* name, Vec3f& target);
/// A list of the numbers of the bits that are set.
bool set(const JsonValue& at, const char* name, std::uint32_t& target);

/// The elements of the member `name`, or nothing where there is none.
const std::vector<JsonValue>& elements(const JsonValue& at, const char* name);

/// Of the member `name`; Throws Error where the axis of a rotation is zero.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Quatf& target);
/// Throws Error where both a damping and a PBD stiffness are given.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Stiffness& target);
/// Throws Error where times do not increase.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Motion& target);
bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::optional<Volume>& target);
/// A fabric by name or spelled out.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Fabric& target);

/// Both coefficients of friction; a static one given alone lowers the default of the kinetic one where it must. Throws
/// Error where the kinetic one is larger than the static one.
void set_friction(const JsonDocument& document, const JsonValue& at, float& static_friction, float& kinetic_friction);

/// v turned by a unit quaternion, in the same bits everywhere.
Vec3f rotated(const Quatf& q, const Vec3f& v);

}  // namespace pliant::scene_file

// Converts checked JSON values to small structs of a scene: vectors, stiffnesses, motions, fabrics.
//
// scene_check has validated types and ranges already. These functions only reject values that contradict each other,
// which a table of fields cannot express.
#pragma once

#include <string>

#include "pliant/material.h"
#include "pliant/motion.h"
#include "pliant/scene.h"
#include "scene_json.h"

namespace pliant::scene_file {

inline constexpr float radian = 0.017453292519943295f;  ///< per degree

Vec3f vector_of(const JsonValue& value);

/// Reads the member `name` into `target`, which keeps its default if the member is absent. Returns true if it is
/// present.
bool set(const JsonValue& at, const char* name, bool& target);
bool set(const JsonValue& at, const char* name, int& target);
bool set(const JsonValue& at, const char* name, float& target);
bool set(const JsonValue& at, const char* name, std::string& target);
bool set(const JsonValue& at, const char* name, Vec3f& target);
/// `unit` converts the value.
bool set(const JsonValue& at, const char* name, std::optional<float>& target, float unit = 1);
/// Reads a list of bit indices, and sets these bits.
bool set(const JsonValue& at, const char* name, std::uint32_t& target);

/// The elements of the list `name`; empty if it is absent.
const std::vector<JsonValue>& elements(const JsonValue& at, const char* name);

/// Reads a rotation. Throws an Error if the axis is zero.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Quatf& target);
/// Reads a stiffness. Throws an Error if damping is given together with PBD stiffness.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Stiffness& target);
/// Reads a motion. Throws an Error if the times of keyframes do not increase.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Motion& target);
bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::optional<Volume>& target);
bool set(const JsonValue& at, const char* name, std::optional<Plasticity>& target);
bool set(const JsonValue& at, const char* name, std::optional<StrainLimit>& target);
/// Reads factors of rest data. Throws an Error if their times do not increase.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::vector<RestKeyframe>& target);
/// Reads a fabric: by name, or as a record.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Fabric& target);

/// Reads both coefficients of friction. If only the static one is given, the kinetic one is at most that. Throws an
/// Error if the kinetic coefficient exceeds the static one.
void set_friction(const JsonDocument& document, const JsonValue& at, float& static_friction, float& kinetic_friction);

/// Rotates v by a unit quaternion, with the same bits on every machine.
Vec3f rotated(const Quatf& q, const Vec3f& v);

}  // namespace pliant::scene_file

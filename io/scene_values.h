// Converts checked JSON values to the small structures of a scene: vectors, stiffnesses, motions, fabrics.
//
// scene_check has already validated types and ranges. These functions only
// reject inconsistent values, which a table of fields cannot express.
#pragma once

#include <string>

#include "pliant/material.h"
#include "pliant/motion.h"
#include "pliant/scene.h"
#include "scene_json.h"

namespace pliant::scene_file {

Vec3f vector_of(const JsonValue& value);

/// Reads the member `name` of an object into `target`, which keeps its default if the member is absent.
bool set(const JsonValue& at, const char* name, bool& target);
bool set(const JsonValue& at, const char* name, int& target);
bool set(const JsonValue& at, const char* name, float& target);
bool set(const JsonValue& at, const char* name, std::string& target);
bool set(const JsonValue& at, const char* name, Vec3f& target);
/// Reads a list of the indices of set bits.
bool set(const JsonValue& at, const char* name, std::uint32_t& target);

/// The elements of the member `name`; empty if absent.
const std::vector<JsonValue>& elements(const JsonValue& at, const char* name);

/// Reads a rotation. Throws an Error if its axis is zero.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Quatf& target);
/// Throws an Error if both a damping and a PBD stiffness are given.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Stiffness& target);
/// Throws an Error if times do not increase.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Motion& target);
bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::optional<Volume>& target);
/// A fabric by name, or as a record.
bool set(const JsonDocument& document, const JsonValue& at, const char* name, Fabric& target);

/// Reads both friction coefficients. A static one alone also limits the default of the kinetic one. Throws an Error if the
/// kinetic coefficient exceeds the static one.
void set_friction(const JsonDocument& document, const JsonValue& at, float& static_friction, float& kinetic_friction);

/// v rotated by a unit quaternion, with the same bits everywhere.
Vec3f rotated(const Quatf& q, const Vec3f& v);

}  // namespace pliant::scene_file

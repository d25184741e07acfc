// The caller's memory: texts, lists and structures that go to it, and arrays that come from it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "errors.h"
#include "pliant/motion.h"
#include "pliant/vec3.h"

namespace pliant::c {

/// The caller's memory for a list: room for `capacity` elements, and where to tell how many there are.
template <class T>
struct Room {
  T* into;
  size_t capacity;
  size_t* count;
};

/// Tells the number of elements. Returns true if they are to be copied. Throws a StatusError if there is too little
/// room.
template <class T>
bool tell(const Room<T>& room, size_t needed, const char* elements) {
  if (room.into == nullptr && room.capacity > 0)
    throw StatusError(PLIANT_NULL, "'into' is a null pointer, and its capacity is not 0",
                      "pass 0 to ask for the length");
  if (room.count != nullptr) *room.count = needed;
  if (room.into == nullptr) return false;
  if (room.capacity >= needed) return true;
  throw StatusError(
      PLIANT_TOO_SMALL,
      "there are " + std::to_string(needed) + " " + elements + ", and memory for " + std::to_string(room.capacity),
      "give more memory");
}

/// Copies a list to the caller's memory.
template <class T>
void give_list(std::span<const T> list, const Room<T>& room, const char* elements) {
  if (tell(room, list.size(), elements)) std::copy(list.begin(), list.end(), room.into);
}

/// Copies a text and a 0 after it. The length does not count the 0, the capacity does.
inline void give_text(std::string_view text, const Room<char>& room) {
  if (room.count != nullptr) *room.count = text.size();
  if (!tell<char>({room.into, room.capacity, nullptr}, text.size() + 1, "bytes with the 0 at the end")) return;
  std::copy(text.begin(), text.end(), room.into);
  room.into[text.size()] = 0;
}

/// Throws a StatusError if a structure's size is smaller than its first version's.
inline void require_size(size_t given, size_t least, const char* what) {
  if (given < least)
    throw StatusError(
        PLIANT_REFUSED,
        std::string("'") + what + "' has the size " + std::to_string(given) + " and needs " + std::to_string(least),
        "set its member `size` to sizeof the structure");
}

/// Copies facts to a structure of the caller's, which may be of a later version of the header.
template <class T>
void give(const T& facts, T* into, const char* what) {
  require(into, what);
  const size_t size = into->size;
  require_size(size, sizeof(T), what);
  T copy = facts;
  copy.size = size;
  std::memcpy(into, &copy, sizeof(T));
  std::memset(reinterpret_cast<char*>(into) + sizeof(T), 0, size - sizeof(T));
}

static_assert(sizeof(Vec3f) == 3 * sizeof(float), "points are three floats");

/// Points of the caller's memory, three floats each.
inline std::span<const Vec3f> points(const float* from, size_t count, const char* what) {
  if (count > 0) require(from, what);
  return {reinterpret_cast<const Vec3f*>(from), count};
}

inline std::span<Vec3f> points(float* into, size_t count, const char* what) {
  if (count > 0) require(into, what);
  return {reinterpret_cast<Vec3f*>(into), count};
}

inline std::span<const int> integers(const std::int32_t* from, size_t count, const char* what) {
  if (count > 0) require(from, what);
  return {from, count};
}

inline RigidPose pose_of(const pliant_pose* pose, const char* what) {
  require(pose, what);
  return {{pose->position[0], pose->position[1], pose->position[2]},
          {pose->rotation[0], pose->rotation[1], pose->rotation[2], pose->rotation[3]}};
}

inline void give_pose(const RigidPose& pose, pliant_pose* into) {
  require(into, "pose");
  *into = {{pose.position.x, pose.position.y, pose.position.z},
           {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}};
}

/// Copies a vector to three floats or doubles.
template <class Vector, class T>
void put3(const Vector& from, T* to) {
  to[0] = from.x, to[1] = from.y, to[2] = from.z;
}

inline Vec3f vector_of(const float* from, const char* what) {
  require(from, what);
  return {from[0], from[1], from[2]};
}

}  // namespace pliant::c

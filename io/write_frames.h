// What every writer of moving geometry is given, and the writers there are.
//
// A format sees objects that do not change (names, triangles, colours) and frames that do (places, velocities). It sees no
// World, so it can be tested with a mesh made by hand, and a run read back from a checkpoint could be written as well.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pliant/io.h"
#include "pliant/scene.h"
#include "pliant/vec3.h"

namespace pliant {
class AtomicFile;
}

namespace pliant::output {

/// What does not change about an object. It is a surface where it has triangles, else lines, else points.
struct FrameObject {
  std::string name;
  Vec3f colour{};       ///< linear RGB
  float width = 0.01f;  ///< of lines and points [m]
  int particles = 0;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> lines;  ///< each the particles along a line; a closed one ends where it began
};

/// One moment.
struct Frame {
  double time = 0;                             ///< [s]
  std::vector<std::vector<Vec3f>> positions;   ///< an object's particles [m]
  std::vector<std::vector<Vec3f>> velocities;  ///< the same, or empty [m/s]
  std::int64_t number = 0;                     ///< in the run: names the file where a format has a file a frame
};

/// Writes one format. Frames come in the order of time; finish() completes the files.
class FormatWriter {
 public:
  virtual ~FormatWriter() = default;
  virtual void add(const Frame& frame) = 0;
  virtual void finish() = 0;

  /// Every file that is in its place, in the order in which they got there.
  const std::vector<WrittenFile>& written() const { return written_; }

 protected:
  /// Puts a file in its place and notes it. Throws Error as AtomicFile::commit does.
  void commit(AtomicFile& file);

 private:
  std::vector<WrittenFile> written_;
};

/// The objects of a scene as writers see them. The lines of an object without triangles are its first group of distance
/// constraints: in a rope those are its links, later groups (bending) are no part of its shape.
std::vector<FrameObject> describe(const Scene& scene);
FrameObject describe(const Object& object);

/// Joins edges to as few lines as a walk in the order of the particles finds.
std::vector<std::vector<int>> join_lines(const std::vector<std::array<int, 2>>& edges);

/// Throws Error naming `path` and the object where a frame does not fit the objects, has a non-finite place, or does not
/// come after `last_time` (the first: give -infinity).
void check_frame(const std::string& path, const std::vector<FrameObject>& objects, const Frame& frame, double last_time);

/// A name for each object made of letters, digits and _, beginning with no digit, all different.
std::vector<std::string> identifiers(const std::vector<FrameObject>& objects);

/// Vertex normals, weighted by area; (0, 1, 0) where there is none.
std::vector<Vec3f> vertex_normals(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles);

/// The path without its last suffix, and the suffix with its point ("" where there is none), in lower case.
struct SplitPath {
  std::string stem, suffix;
};
SplitPath split_path(const std::string& path);

/// `path`'s last part.
std::string file_name(const std::string& path);

/// A frame's number in four digits or more.
std::string frame_number(std::int64_t frame);

// One maker a format. `path` is the path with suffix as the user gave it; `frame_time` the nominal time between frames [s].
using Objects = std::vector<FrameObject>;
std::unique_ptr<FormatWriter> make_obj_sequence(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_ply_sequence(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_glb_writer(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_usda_writer(const std::string& path, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pc2_writer(const std::string& path, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pvd_writer(const std::string& path, const Objects& objects);

/// The writer for the suffix. Throws Error listing the suffixes there are for another one.
std::unique_ptr<FormatWriter> make_format_writer(const std::string& path, const Objects& objects, double frame_time);

}  // namespace pliant::output

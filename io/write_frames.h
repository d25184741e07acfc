// The input of all writers of moving geometry, and the list of writers.
//
// A format sees constant objects (names, triangles, colours) and frames (positions, velocities), but no World. So it can be
// tested with a handmade mesh, and could also write a run from saved States.
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

/// The constant part of an object. It is a surface if it has triangles, else lines, else points.
struct FrameObject {
  std::string name;
  Vec3f colour{};       ///< linear RGB
  float width = 0.01f;  ///< width of lines and points [m]
  int particles = 0;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> lines;  ///< each the particles along a line; a closed one ends at its start
};

/// The data of one time.
struct Frame {
  double time = 0;                             ///< [s]
  std::vector<std::vector<Vec3f>> positions;   ///< positions of each object's particles [m]
  std::vector<std::vector<Vec3f>> velocities;  ///< velocities of each object's particles, or empty [m/s]
  std::int64_t number = 0;                     ///< number of the frame in the run, used in names of single-frame files
};

/// Writes one format. Frames must come in time order; finish() completes the files.
class FormatWriter {
 public:
  virtual ~FormatWriter() = default;
  virtual void add(const Frame& frame) = 0;
  virtual void finish() = 0;

  /// Every committed file, in order of commit.
  const std::vector<WrittenFile>& written() const { return written_; }

 protected:
  /// Commits a file and records it. Throws as AtomicFile::commit does.
  void commit(AtomicFile& file);

 private:
  std::vector<WrittenFile> written_;
};

/// The objects of a scene as writers see them. An object without triangles has its first group of distance constraints as
/// lines: a rope's links. Later groups (bending) are not part of its shape.
std::vector<FrameObject> describe(const Scene& scene);
FrameObject describe(const Object& object);

/// Joins edges to polylines by a walk in the order of particles, as few as it finds.
std::vector<std::vector<int>> join_lines(const std::vector<std::array<int, 2>>& edges);

/// Throws an Error that names `path` and the object if a frame does not fit the objects, has a non-finite position, or is
/// not after `last_time` (-infinity for the first).
void check_frame(const std::string& path, const std::vector<FrameObject>& objects, const Frame& frame, double last_time);

/// A unique identifier for each object: letters, digits and _, with no leading digit.
std::vector<std::string> identifiers(const std::vector<FrameObject>& objects);

/// Area-weighted vertex normals; (0, 1, 0) if undefined.
std::vector<Vec3f> vertex_normals(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles);

/// The path without its last suffix, and the suffix with its point ("" if there is none), in lower case.
struct SplitPath {
  std::string stem, suffix;
};
SplitPath split_path(const std::string& path);

/// The last component of `path`.
std::string file_name(const std::string& path);

/// A frame's number with four digits or more.
std::string frame_number(std::int64_t frame);

// One factory per format. `path` is the user's path with suffix; `frame_time` is the nominal time between frames [s].
using Objects = std::vector<FrameObject>;
std::unique_ptr<FormatWriter> make_obj_sequence(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_ply_sequence(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_glb_writer(const std::string& path, const Objects& objects);
std::unique_ptr<FormatWriter> make_usda_writer(const std::string& path, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pc2_writer(const std::string& path, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pvd_writer(const std::string& path, const Objects& objects);

/// The writer for the suffix. Throws an Error that lists the known suffixes if it is unknown.
std::unique_ptr<FormatWriter> make_format_writer(const std::string& path, const Objects& objects, double frame_time);

}  // namespace pliant::output

// What all writers of animations get as input, and the list of these writers.
//
// A writer sees constant objects (names, triangles, colours) and frames (positions, velocities), but no World. So it
// can be tested with a mesh made by hand, and could also write a run from saved States.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "output_file.h"
#include "pliant/io.h"
#include "pliant/scene.h"
#include "pliant/vec3.h"

namespace pliant::output {

/// A rigid body of an object: its surface is one of FrameObject::solids, which bodies of equal solids share.
struct FrameBody {
  std::string name;
  int solid = 0;  ///< index in FrameObject::solids
};

/// What does not change in an object. It is a surface if it has triangles, else lines if it has these, else points; its
/// rigid bodies are surfaces of their own.
struct FrameObject {
  std::string name;
  Vec3f colour{};       ///< colour as linear RGB
  float width = 0.01f;  ///< width of lines and points [m]
  int particles = 0;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> lines;  ///< particles along each line; a closed line ends with its first particle
  /// Surfaces of bodies, each in the body's principal axes about its centre of mass.
  std::vector<TriangleMesh> solids{};
  std::vector<FrameBody> bodies{};
  bool is_remeshed = false;  ///< true: a surface that is another mesh in each frame (Frame::triangles)
  /// True: lines of which links can break: each frame has those that are left (Frame::lines)
  bool is_relinked = false;
  bool varies = false;  ///< true: points, of which each frame has as many as are there

  /// True if the object has particles to show that are no centres of bodies.
  bool has_matter() const { return bodies.empty() || !triangles.empty() || !lines.empty(); }
  bool is_surface() const { return is_remeshed || !triangles.empty(); }
};

/// The motion of a rigid body at one time.
struct BodyMotion {
  RigidPose pose{};          ///< of the principal axes about the centre of mass
  Vec3f velocity{};          ///< of the centre of mass [m/s]
  Vec3f angular_velocity{};  ///< in world axes [rad/s]
};

/// The data of one frame.
struct Frame {
  double time = 0;                                ///< time of the frame [s]
  std::vector<std::vector<Vec3f>> positions;      ///< positions of each object's particles [m]
  std::vector<std::vector<Vec3f>> velocities;     ///< velocities of each object's particles, or empty [m/s]
  std::int64_t number = 0;                        ///< number of the frame in the run, for file names
  std::vector<std::vector<BodyMotion>> bodies{};  ///< motions of each object's bodies; empty if no object has any
  /// The triangles of each object that is remeshed, whose positions are then its vertices, without velocities; those of
  /// others are empty. Empty if no object is remeshed.
  std::vector<std::vector<std::array<int, 3>>> triangles{};
  /// The lines of each object that is relinked, by its particles; those of others are empty. Empty if no object is
  /// relinked.
  std::vector<std::vector<std::vector<int>>> lines{};
};

/// Writes frames in one format. Frames must be added in the order of time; finish() completes the files.
class FormatWriter {
 public:
  virtual ~FormatWriter() = default;
  virtual void add(const Frame& frame) = 0;
  virtual void finish() = 0;

  /// Every file that is complete, in the order of completion.
  virtual const std::vector<WrittenFile>& written() const { return written_; }

 protected:
  /// Completes a file and lists it in written(). Throws as OutputFile::commit does.
  void commit(OutputFile& file);

 private:
  std::vector<WrittenFile> written_;
};

/// Converts the objects of a scene for writers. An object without triangles gets lines, from its first group of
/// distance constraints: the links of a rope. Later groups (bending) are no part of its shape.
std::vector<FrameObject> describe(const Scene& scene);
FrameObject describe(const Object& object);

/// The group of constraints whose links are the lines of an object: its first one of distance constraints; -1 if it has
/// none.
int line_group_of(const Object& object);
/// The lines that the links of a group form.
std::vector<std::vector<int>> lines_of(const Object& object, int group);

/// True if a mesh differs from frame to frame.
bool is_any_remeshed(const std::vector<FrameObject>& objects);
/// True if the number of particles, the mesh or the lines of an object differ from frame to frame.
bool is_any_varying(const std::vector<FrameObject>& objects);
/// The objects with the meshes, lines and numbers of particles of a frame.
std::vector<FrameObject> present_objects(const std::vector<FrameObject>& objects, const Frame& frame);

/// The motions of all bodies of an object of a World.
std::vector<BodyMotion> body_motions(const Object& object, const ObjectView& view);

/// Joins edges to polylines, by following them in the order of particles.
std::vector<std::vector<int>> join_lines(const std::vector<std::array<int, 2>>& edges);

/// Throws an Error that names `path` and the object if a frame does not fit the objects, has a position that is not
/// finite, or is not later than `last_time` (-infinity for the first frame).
void check_frame(const std::string& path, const std::vector<FrameObject>& objects, const Frame& frame,
                 double last_time);

/// A different identifier for each object or name, of letters, digits and _; the first character is no digit.
std::vector<std::string> identifiers(const std::vector<FrameObject>& objects);
std::vector<std::string> identifiers(const std::vector<std::string>& names);

/// Normals of vertices, weighted by triangle area; (0, 1, 0) where undefined.
std::vector<Vec3f> vertex_normals(const std::vector<Vec3f>& positions,
                                  const std::vector<std::array<int, 3>>& triangles);

/// A path without its suffix, and the suffix in lower case with its point; empty if it has none.
struct SplitPath {
  std::string stem, suffix;
};
SplitPath split_path(const std::string& path);

/// The last component of a path.
std::string file_name(const std::string& path);

/// The number of a frame as text, with at least four digits.
std::string frame_number(std::int64_t frame);

// A function for each format. `frame_time` is the usual time between frames [s].
using Objects = std::vector<FrameObject>;
std::unique_ptr<FormatWriter> make_obj_sequence(const Destination& to, const Objects& objects);
std::unique_ptr<FormatWriter> make_ply_sequence(const Destination& to, const Objects& objects);
std::unique_ptr<FormatWriter> make_glb_writer(const Destination& to, const Objects& objects);
std::unique_ptr<FormatWriter> make_usda_writer(const Destination& to, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pc2_writer(const Destination& to, const Objects& objects, double frame_time);
std::unique_ptr<FormatWriter> make_pvd_writer(const Destination& to, const Objects& objects);

/// A writer of a format without bodies, which gets their surfaces as vertices that move. `make` makes it for given
/// objects.
std::unique_ptr<FormatWriter> make_surface_writer(
    const Objects& objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make);

/// A writer of a format whose lines cannot change. Each link of an object that is relinked gets two vertices of its
/// own, which are in one place from when it breaks. `make` makes it for given objects.
std::unique_ptr<FormatWriter> make_segment_writer(
    const Objects& objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make);

/// Makes the writer for the suffix of `path`, whose files go to `sink` if there is one. Throws an Error that lists the
/// known suffixes if it is unknown, or cannot have an object that is remeshed.
std::unique_ptr<FormatWriter> make_format_writer(const std::string& path, const Objects& objects, double frame_time,
                                                 const FileSink& sink = {});

}  // namespace pliant::output

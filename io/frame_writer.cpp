// The public FrameWriter: reads a World's objects in each frame and passes them to the writer of the suffix's format.
#include <algorithm>

#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/surface.h"
#include "write_frames.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& object, const std::string& element,
                         const std::string& problem) {
  throw Error({.file = path, .line = 0, .object = object, .element = element}, problem,
              "pass the scene from which the World was made");
}

/// Throws an Error unless an object of the scene has as many particles as that of the World: writers use the scene's
/// indices.
void require_fitting(const std::string& path, const Object& object, int particles, int frames) {
  if (object.positions.size() != static_cast<std::size_t>(particles))
    refuse(path, object.name, "",
           "the World has " + std::to_string(particles) + " particles, but the scene has " +
               std::to_string(object.positions.size()));
  const auto exists = [&](int particle) { return particle >= 0 && particle < particles; };
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (const int corner : object.triangles[t])
      if (!exists(corner))
        refuse(path, object.name, "triangle " + std::to_string(t), "uses a particle that does not exist");
  for (const ConstraintGroup& group : object.constraints)
    for (const int particle : group.particles)
      if (!exists(particle))
        refuse(path, object.name, group.type + " constraints", "use a particle that does not exist");
  for (const ObjectBody& body : object.bodies)
    if (!exists(body.particle) || body.frame < 0 || body.frame >= frames)
      refuse(path, object.name, "body '" + body.name + "'", "uses a particle or frame that does not exist");
}

/// Keeps the particles that are there; or if a format cannot, hides the others in the first that is there.
void leave_out_absent(const std::vector<int>& present, bool keeps_number, std::vector<Vec3f>& positions,
                      std::vector<Vec3f>& velocities) {
  std::vector<Vec3f> places(keeps_number ? positions.size() : 0,
                            positions.at(present.empty() ? 0 : static_cast<std::size_t>(present.front()))),
      speeds(places.size());
  for (const int i : present) {
    const auto particle = static_cast<std::size_t>(i);
    if (keeps_number) {
      places[particle] = positions[particle];
      speeds[particle] = velocities[particle];
    } else {
      places.push_back(positions[particle]);
      speeds.push_back(velocities[particle]);
    }
  }
  positions = std::move(places);
  velocities = std::move(speeds);
}

/// The group of an object's links, if they are drawn as lines and some can break, tear or be cut; -1: its lines stay.
int group_that_breaks(const Object& object) {
  const int group = object.triangles.empty() && !object.skin ? output::line_group_of(object) : -1;
  if (group < 0 || output::lines_of(object, group).empty()) return -1;
  const bool can_break = object.constraints[static_cast<std::size_t>(group)].break_force > 0;
  return can_break || object.tearing || !object.cuts.empty() ? group : -1;
}

/// True if the World tears or cuts an object in a way that changes its mesh. Of rods joints break, and their segments
/// stay.
bool changes_mesh(const Object& object) {
  const auto is_of_rod = [](const ObjectJoint& joint) { return joint.kind == "rod"; };
  const auto is_link = [](const ConstraintGroup& group) { return group.type == "distance"; };
  const bool has_rods_alone = object.triangles.empty() &&
                              std::any_of(object.joints.begin(), object.joints.end(), is_of_rod) &&
                              std::none_of(object.constraints.begin(), object.constraints.end(), is_link);
  return (object.tearing || !object.cuts.empty()) && !has_rods_alone && group_that_breaks(object) < 0;
}

class WorldWriter final : public FrameWriter {
 public:
  WorldWriter(std::unique_ptr<output::FormatWriter> format, const Scene& scene, std::vector<ObjectId> objects,
              const FrameWriterOptions& options, bool has_all_points)
      : format_(std::move(format)), objects_(std::move(objects)), has_all_points_(has_all_points) {
    for (const Object& object : scene.objects) {
      spacings_.push_back(object.fluid && options.liquid_surfaces ? object.fluid->spacing : 0);
      is_remeshed_.push_back(changes_mesh(object));
      line_groups_.push_back(group_that_breaks(object));
      has_lines_that_break_ = has_lines_that_break_ || line_groups_.back() >= 0;
      Object part;
      part.skin = object.skin;
      part.bodies = object.bodies;
      for (ObjectBody& body : part.bodies) body.solids.clear();
      particles_.push_back(object.positions.size());
      parts_.push_back(std::move(part));
      has_bodies_ = has_bodies_ || !object.bodies.empty();
    }
  }

  void add(const World& world) override {
    output::Frame frame{.time = world.state().time, .positions = {}, .velocities = {}, .number = world.state().frame};
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      const ObjectView object = world.object(objects_[o]);
      if (is_remeshed_[o])
        add_mesh(object, frame);
      else
        add_matter(object, spacings_[o], {world.threads(), has_all_points_}, frame);
      if (has_lines_that_break_)
        frame.lines.push_back(line_groups_[o] < 0 ? std::vector<std::vector<int>>{}
                                                  : output::lines_of(object.description(), line_groups_[o]));
      if (parts_[o].skin) {
        if (frame.positions.back().size() != particles_[o])
          throw Error({.object = object.info().name}, "has another number of particles than its skin was made for",
                      "make another writer after an edit");
        frame.positions.back() = skinned(*parts_[o].skin, frame.positions.back());
        frame.velocities.back() = skinned(*parts_[o].skin, frame.velocities.back());
      }
      if (has_bodies_) frame.bodies.push_back(output::body_motions(parts_[o], object));
    }
    format_->add(frame);
  }

  void finish() override { format_->finish(); }
  std::vector<WrittenFile> written() const override { return format_->written(); }

 private:
  /// Adds the particles of an object, or if it has a spacing the surface of its liquid.
  struct How {
    int threads = 1;
    bool has_all_points = false;
  };
  static void add_mesh(const ObjectView& object, output::Frame& frame) {
    TriangleMesh mesh = object.mesh();
    frame.positions.push_back(std::move(mesh.positions));
    frame.velocities.emplace_back();
    frame.triangles.push_back(std::move(mesh.triangles));
  }

  static void add_matter(const ObjectView& object, float spacing, const How& how, output::Frame& frame) {
    if (spacing == 0) {
      frame.positions.push_back(object.positions());
      frame.velocities.push_back(object.velocities());
      if (object.flows())
        leave_out_absent(object.present(), how.has_all_points, frame.positions.back(), frame.velocities.back());
      frame.triangles.emplace_back();
      return;
    }
    SurfaceOptions options;
    options.spacing = spacing;
    options.threads = how.threads;
    TriangleMesh mesh = liquid_surface(object.present_positions(), options);
    frame.positions.push_back(std::move(mesh.positions));
    frame.velocities.emplace_back();
    frame.triangles.push_back(std::move(mesh.triangles));
  }

  std::unique_ptr<output::FormatWriter> format_;
  std::vector<ObjectId> objects_;       ///< objects at the start of the run
  std::vector<Object> parts_;           ///< for each object, which particles and frames are bodies, and its skin
  std::vector<bool> is_remeshed_;       ///< for each object, whether it tears
  std::vector<int> line_groups_;        ///< for each object, the group of its links if they can break, else -1
  std::vector<std::size_t> particles_;  ///< of each object at the start
  std::vector<float> spacings_;         ///< for each object, that of its liquid if its surface is written, else 0 [m]
  bool has_bodies_ = false, has_lines_that_break_ = false;
  bool has_all_points_ = false;  ///< the format has the same number of points in each frame
};

}  // namespace

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world) {
  return make_frame_writer(path, scene, world, FrameWriterOptions{});
}

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world,
                                               const FrameWriterOptions& options) {
  if (world.object_count() != static_cast<int>(scene.objects.size()))
    refuse(path, "", "", "the scene has another number of objects than the World");
  const std::vector<ObjectId> ids = world.objects();
  for (std::size_t o = 0; o < ids.size(); ++o)
    require_fitting(path, scene.objects[o], world.object(ids[o]).particle_count(),
                    static_cast<int>(world.object(ids[o]).orientations().size()));
  output::Objects objects = output::describe(scene);
  for (std::size_t o = 0; o < objects.size(); ++o) {
    objects[o].is_remeshed =
        (options.liquid_surfaces && scene.objects[o].fluid.has_value()) || changes_mesh(scene.objects[o]);
    objects[o].is_relinked = group_that_breaks(scene.objects[o]) >= 0;
  }
  for (const Object& object : scene.objects)
    if (changes_mesh(object) && object.triangles.empty())
      throw Error({.file = path, .line = 0, .object = object.name}, "tears and has neither triangles nor links",
                  "leave its `tearing` and `cuts` out, or write no file");
  const auto parts = output::split_path(path);
  const bool has_all_points = parts.suffix == ".glb" || parts.suffix == ".pc2";
  for (std::size_t o = 0; o < objects.size() && !has_all_points; ++o)
    objects[o].varies = !objects[o].is_remeshed && world.object(ids[o]).flows();
  return std::make_unique<WorldWriter>(output::make_format_writer(path, objects, scene.frame_time, options.sink), scene,
                                       world.objects(), options, has_all_points);
}

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const World& world,
                                               const FrameWriterOptions& options) {
  return make_frame_writer(path, world.description(), world, options);
}

}  // namespace pliant

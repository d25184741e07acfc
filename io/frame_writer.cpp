// The public FrameWriter: reads a World's objects in each frame and passes them to the writer of the suffix's format.
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
      if (!exists(particle)) refuse(path, object.name, group.type + " constraints", "use a particle that does not exist");
  for (const ObjectBody& body : object.bodies)
    if (!exists(body.particle) || body.frame < 0 || body.frame >= frames)
      refuse(path, object.name, "body '" + body.name + "'", "uses a particle or frame that does not exist");
}

class WorldWriter final : public FrameWriter {
 public:
  WorldWriter(std::unique_ptr<output::FormatWriter> format, const Scene& scene, std::vector<ObjectId> objects,
              const FrameWriterOptions& options)
      : format_(std::move(format)), objects_(std::move(objects)) {
    for (const Object& object : scene.objects) {
      spacings_.push_back(object.fluid && options.liquid_surfaces ? object.fluid->spacing : 0);
      Object part;
      part.bodies = object.bodies;
      for (ObjectBody& body : part.bodies) body.solids.clear();
      bodies_.push_back(std::move(part));
      has_bodies_ = has_bodies_ || !object.bodies.empty();
    }
  }

  void add(const World& world) override {
    output::Frame frame{.time = world.state().time, .positions = {}, .velocities = {}, .number = world.state().frame};
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      const ObjectView object = world.object(objects_[o]);
      add_matter(object, spacings_[o], world.threads(), frame);
      if (has_bodies_) frame.bodies.push_back(output::body_motions(bodies_[o], object));
    }
    format_->add(frame);
  }

  void finish() override { format_->finish(); }
  std::vector<WrittenFile> written() const override { return format_->written(); }

 private:
  /// Adds the particles of an object, or if it has a spacing the surface of its liquid.
  static void add_matter(const ObjectView& object, float spacing, int threads, output::Frame& frame) {
    if (spacing == 0) {
      frame.positions.push_back(object.positions());
      frame.velocities.push_back(object.velocities());
      frame.triangles.emplace_back();
      return;
    }
    SurfaceOptions options;
    options.spacing = spacing;
    options.threads = threads;
    TriangleMesh mesh = liquid_surface(object.positions(), options);
    frame.positions.push_back(std::move(mesh.positions));
    frame.velocities.emplace_back();
    frame.triangles.push_back(std::move(mesh.triangles));
  }

  std::unique_ptr<output::FormatWriter> format_;
  std::vector<ObjectId> objects_;  ///< objects at the start of the run
  std::vector<Object> bodies_;     ///< for each object, which particles and frames are bodies
  std::vector<float> spacings_;    ///< for each object, that of its liquid if its surface is written, else 0 [m]
  bool has_bodies_ = false;
};

}  // namespace

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world) {
  return make_frame_writer(path, scene, world, FrameWriterOptions{});
}

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world,
                                               const FrameWriterOptions& options) {
  if (world.object_count() != static_cast<int>(scene.objects.size()))
    refuse(path, "", "", "the scene has another number of objects than the World");
  for (int o = 0; o < world.object_count(); ++o)
    require_fitting(path, scene.objects[static_cast<std::size_t>(o)], world.object(o).info().particles,
                    static_cast<int>(world.object(o).orientations().size()));
  output::Objects objects = output::describe(scene);
  for (std::size_t o = 0; o < objects.size(); ++o)
    objects[o].is_remeshed = options.liquid_surfaces && scene.objects[o].fluid.has_value();
  return std::make_unique<WorldWriter>(output::make_format_writer(path, objects, scene.frame_time), scene, world.objects(),
                                       options);
}

}  // namespace pliant

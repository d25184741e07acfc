// The public writer: reads a World's objects, frame by frame, and hands them to the format that the suffix names.
#include "pliant/error.h"
#include "pliant/io.h"
#include "write_frames.h"

namespace pliant {

namespace {

class WorldWriter final : public FrameWriter {
 public:
  explicit WorldWriter(std::unique_ptr<output::FormatWriter> format) : format_(std::move(format)) {}

  void add(const World& world) override {
    output::Frame frame{.time = world.state().time, .positions = {}, .velocities = {}};
    for (int object = 0; object < world.object_count(); ++object) {
      frame.positions.push_back(world.positions(object));
      frame.velocities.push_back(world.velocities(object));
    }
    format_->add(frame);
  }

  void finish() override { format_->finish(); }

 private:
  std::unique_ptr<output::FormatWriter> format_;
};

}  // namespace

std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world) {
  output::Objects objects = output::describe(scene);
  if (world.object_count() != static_cast<int>(objects.size()))
    throw Error({.file = path, .line = 0, .object = {}, .element = {}}, "the world was made from another scene");
  return std::make_unique<WorldWriter>(output::make_format_writer(path, objects, scene.frame_time));
}

}  // namespace pliant

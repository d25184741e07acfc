// Files of the frames of a run.
#include "memory.h"
#include "pliant/io.h"
#include "world_handle.h"

namespace pliant::c {

struct WriterHandle {
  std::unique_ptr<FrameWriter> writer;  ///< null once it is finished
  std::weak_ptr<WorldHandle> world;     ///< whose frames it writes
};

namespace {

FrameWriter& unfinished(WriterHandle& handle) {
  if (!handle.writer) throw StatusError(PLIANT_REFUSED, "the writer is finished", "open another one for another file");
  return *handle.writer;
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_writer_open(const pliant_world* world, const char* path, pliant_writer** writer) {
  return guarded([&] {
    const auto of = at(world);
    require(path, "path");
    require(writer, "writer");
    auto made = std::make_shared<WriterHandle>();
    made->world = of;
    made->writer = make_frame_writer(path, of->world);
    give_handle(std::move(made), writer);
  });
}

pliant_status pliant_writer_add(pliant_writer* writer, const pliant_world* world) {
  return guarded([&] {
    const auto to = at(writer);
    const auto of = at(world);
    FrameWriter& frames = unfinished(*to);
    if (to->world.lock() != of)
      throw StatusError(PLIANT_REFUSED, "the writer was opened for another World", "open a writer for each World");
    frames.add(of->world);
  });
}

pliant_status pliant_writer_finish(pliant_writer* writer) {
  return guarded([&] {
    const auto of = at(writer);
    unfinished(*of).finish();
    of->writer.reset();
  });
}

pliant_status pliant_writer_free(pliant_writer* writer) { return free_handle(writer); }

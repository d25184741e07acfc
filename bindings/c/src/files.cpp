// Files of the frames of a run, on disk and in memory.
#include "memory.h"
#include "pliant/io.h"
#include "world_handle.h"

namespace pliant::c {

struct WriterHandle {
  std::unique_ptr<FrameWriter> writer;  ///< null once it is finished
  std::weak_ptr<WorldHandle> world;     ///< whose frames it writes
  bool is_in_use = false;               ///< true while its sink may be called
};

namespace {

FrameWriter& unfinished(WriterHandle& handle) {
  if (!handle.writer) throw StatusError(PLIANT_REFUSED, "the writer is finished", "open another one for another file");
  return *handle.writer;
}

/// Marks a writer as in use. Throws a StatusError if it is: its own sink called it.
class Use {
 public:
  explicit Use(WriterHandle& handle) : handle_(handle) {
    if (handle_.is_in_use)
      throw StatusError(PLIANT_BUSY, "the writer passes a file to its sink", "call again after the sink has returned");
    handle_.is_in_use = true;
  }
  ~Use() { handle_.is_in_use = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  WriterHandle& handle_;
};

FileSink sink_of(pliant_file_sink sink, void* user) {
  return [sink, user](const std::string& path, const std::vector<std::byte>& bytes) {
    const pliant_status status = sink(user, path.c_str(), bytes.data(), bytes.size());
    if (status != PLIANT_OK)
      throw StatusError(status, "the sink did not take the file '" + path + "'; it returned " + std::to_string(status) +
                                    ", " + pliant_status_name(status));
  };
}

void open_writer(const pliant_world* world, const char* path, const FrameWriterOptions& options,
                 pliant_writer** writer) {
  const auto of = at(world);
  require(path, "path");
  require(writer, "writer");
  auto made = std::make_shared<WriterHandle>();
  made->world = of;
  made->writer = make_frame_writer(path, of->world, options);
  give_handle(std::move(made), writer);
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_writer_open(const pliant_world* world, const char* path, pliant_writer** writer) {
  return guarded([&] { open_writer(world, path, {}, writer); });
}

pliant_status pliant_writer_open_sink(const pliant_world* world, const char* path, pliant_file_sink sink, void* user,
                                      pliant_writer** writer) {
  return guarded([&] {
    if (sink == nullptr) require(nullptr, "sink");
    FrameWriterOptions options;
    options.sink = sink_of(sink, user);
    open_writer(world, path, options, writer);
  });
}

pliant_status pliant_writer_add(pliant_writer* writer, const pliant_world* world) {
  return guarded([&] {
    const auto to = at(writer);
    const auto of = at(world);
    const Use use(*to);
    FrameWriter& frames = unfinished(*to);
    if (to->world.lock() != of)
      throw StatusError(PLIANT_REFUSED, "the writer was opened for another World", "open a writer for each World");
    frames.add(of->world);
  });
}

pliant_status pliant_writer_finish(pliant_writer* writer) {
  return guarded([&] {
    const auto of = at(writer);
    const Use use(*of);
    unfinished(*of);
    const auto last = std::move(of->writer);  // also if it fails: what the sink refused is not given again
    last->finish();
  });
}

pliant_status pliant_writer_free(pliant_writer* writer) { return free_handle(writer); }

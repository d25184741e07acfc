// Saving, loading and writers of frames.
#include "files.h"

#include <cstddef>
#include <span>

#include "pliant/error.h"
#include "pliant/save.h"
#include "world.h"

namespace pliant::python {

namespace {

/// Writes frames of a World, as a context manager.
struct Writer {
  SharedWorld world;
  std::unique_ptr<FrameWriter> writer;
  bool is_finished = false;

  FrameWriter& open() {
    if (is_finished) throw Error({}, "this Writer has finished", "make another by World.writer()");
    return *writer;
  }
};

Writer make_writer(const WorldRef& self, const std::string& path, bool liquid_surfaces) {
  const World& world = self.world->idle();
  FrameWriterOptions options;
  options.liquid_surfaces = liquid_surfaces;
  Writer writer{self.world, make_frame_writer(path, self.world->present(), world, options)};
  writer.writer->add(world);
  return writer;
}

void finish(Writer& self) {
  if (self.is_finished) return;
  self.writer->finish();
  self.is_finished = true;
}

nb::list written(const Writer& self) {
  nb::list list;
  for (const WrittenFile& file : self.writer->written()) list.append(file.path);
  return list;
}

/// The path of a str or os.PathLike.
std::string path_of(nb::handle path) {
  const nb::object text = nb::steal(PyOS_FSPath(path.ptr()));
  if (!text.is_valid()) {
    PyErr_Clear();
    throw wrong_type("path", path, "a str or os.PathLike");
  }
  if (!nb::isinstance<nb::str>(text)) throw wrong_type("path", path, "a str or os.PathLike");
  return nb::cast<std::string>(text);
}

void save_world(const WorldRef& self, nb::handle path) {
  const World& world = self.world->idle();
  save(path_of(path), world, self.world->present());
}

WorldRef ref_of(LoadedWorld loaded) {
  auto file = std::make_shared<SceneFile>();
  file->scene = std::move(loaded.scene);
  return {SharedWorld(std::make_unique<OwnedWorld>(std::move(file), std::move(loaded.world)))};
}

nb::bytes bytes_from(const std::vector<std::byte>& bytes) { return nb::bytes(bytes.data(), bytes.size()); }

std::span<const std::byte> span_of(const nb::bytes& bytes) {
  return {reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()};
}

}  // namespace

nb::bytes bytes_of(const State& state) { return bytes_from(save_bytes(state)); }

State state_of(const nb::bytes& bytes) { return load_state_bytes(span_of(bytes), "the pickled State"); }

void bind_saving(nb::class_<WorldRef>& c) {
  c.def("save", &save_world, nb::arg("path"), nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
        "Saves the World as one file: description, settings and State. Forces and targets that wait for the next step, and "
        "what is recorded, are not saved. Raises Error if writing fails; an existing file then stays unchanged.")
      .def_static(
          "load", [](nb::handle path) { return ref_of(load_world(path_of(path))); }, nb::arg("path"),
          nb::sig("def load(path: str | os.PathLike[str]) -> World"),
          "Loads a World that save() wrote; its next step gives the same bits as without saving, if nothing was set for "
          "it.")
      .def(
          "__getstate__",
          [](const WorldRef& self) {
            const World& world = self.world->idle();
            return bytes_from(save_bytes(world, self.world->present()));
          },
          "The bytes of the save format: a World can be pickled, unless it has forces. What save() leaves out is left out.")
      .def(
          "__setstate__",
          [](WorldRef& self, const nb::bytes& bytes) {
            new (&self) WorldRef(ref_of(load_world_bytes(span_of(bytes), "the pickled World")));
          },
          nb::arg("bytes"), "Reads the bytes of the save format.")
      .def(
          "writer",
          [](const WorldRef& self, nb::handle path, bool liquid_surfaces) {
            return make_writer(self, path_of(path), liquid_surfaces);
          },
          nb::arg("path"), nb::arg("liquid_surfaces") = false,
          nb::sig("def writer(self, path: str | os.PathLike[str], liquid_surfaces: bool = False) -> Writer"),
          "A Writer of frames by suffix: .obj, .ply, .glb, .usda, .pc2 or .pvd. The present state is its first frame. "
          "`liquid_surfaces`: surfaces of liquids instead of points.");
}

void bind_files(nb::module_& m) {
  nb::class_<Writer>(m, "Writer", nb::type_slots(collected_slots<Writer>()),
                     "Writes frames of a World to files: a context manager that World.writer() returns.")
      .def(
          "add", [](Writer& self) { self.open().add(self.world->idle()); }, "Adds the present state as the next frame.")
      .def("finish", &finish, "Completes the files; the end of a `with` block calls it.")
      .def_prop_ro("written", &written, nb::sig("def written(self) -> list[str]"),
                   "Paths of the files that are written; after finish() all.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> Writer"),
          "Itself.")
      .def(
          "__exit__",
          [](Writer& self, nb::handle type, nb::handle /*value*/, nb::handle /*trace*/) {
            if (type.is_none()) finish(self);
          },
          nb::arg("type").none(), nb::arg("value").none(), nb::arg("trace").none(),
          nb::sig("def __exit__(self, type: type[BaseException] | None, value: BaseException | None, trace: "
                  "types.TracebackType | "
                  "None) -> None"),
          "Completes the files, unless an exception ended the block.");
}

}  // namespace pliant::python

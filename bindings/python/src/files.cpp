// Saving, loading and writers of frames.
#include "files.h"

#include <algorithm>
#include <cctype>
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
  /// A dict of files in memory or a file object, which the sink only borrows; null: files go to disk.
  nb::object target;
  std::unique_ptr<FrameWriter> writer;
  bool is_finished = false, has_failed = false;

  FrameWriter& open() {
    if (is_finished) throw Error({}, "this Writer has finished", "make another by World.writer()");
    return *writer;
  }
};

/// tp_traverse: a file object may refer to its Writer.
int traverse_writer(PyObject* self, visitproc visit, void* arg) {
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<Writer>(self)->target.ptr());
  return traverse_world<Writer>(self, visit, arg);
}

PyType_Slot* writer_slots() {
  static PyType_Slot slots[] = {{Py_tp_setattro, reinterpret_cast<void*>(refuse_attribute)},
                                {Py_tp_init, reinterpret_cast<void*>(refuse_construction)},
                                {Py_tp_traverse, reinterpret_cast<void*>(traverse_writer)},
                                {0, nullptr}};
  return slots;
}

nb::bytes bytes_from(const std::vector<std::byte>& bytes) { return nb::bytes(bytes.data(), bytes.size()); }

/// The name of the files of a format that was given as "glb", ".glb" or "GLB". Throws an Error if there is none such.
std::string name_of_format(const std::string& given) {
  std::string format = given.substr(!given.empty() && given.front() == '.' ? 1 : 0);
  std::transform(format.begin(), format.end(), format.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {"obj", "ply", "glb", "usda", "pc2", "pvd"})
    if (format == known) return "frames." + format;
  throw Error({}, "'" + given + "' is not a format of frames", "choose 'obj', 'ply', 'glb', 'usda', 'pc2' or 'pvd'");
}

/// A sink into a dict of files by name.
FileSink sink_into_dict(nb::handle files) {
  return [files](const std::string& path, const std::vector<std::byte>& bytes) {
    nb::borrow<nb::dict>(files)[path.c_str()] = bytes_from(bytes);
  };
}

/// A sink into a file object. Throws an Error if the object cannot take the format.
FileSink sink_into_file(nb::handle file, const std::string& name) {
  if (!name.ends_with(".glb") && !name.ends_with(".usda"))
    throw Error({}, "a run as '" + name.substr(name.rfind('.')) + "' is several files, and a file object holds one",
                "give format='glb' or 'usda', or leave the path out and read Writer.files");
  if (nb::isinstance(file, nb::module_::import_("io").attr("TextIOBase")))
    throw Error({}, "the file object takes text, and frames are bytes", "open it with mode 'wb', or use io.BytesIO");
  return [file](const std::string&, const std::vector<std::byte>& bytes) {
    nb::object rest = bytes_from(bytes);
    for (std::size_t left = bytes.size(); left > 0;) {
      const nb::object taken = file.attr("write")(rest);
      if (!nb::isinstance<nb::int_>(taken)) {
        if (taken.is_none() && !nb::hasattr(file, "fileno")) return;  // a writer of one's own that returns nothing
        throw Error({}, "the file object does not say how much it has written", "open it with mode 'wb', and blocking");
      }
      const auto count = nb::cast<std::size_t>(taken);
      if (count == 0 || count > left)
        throw Error({}, "the file object takes no more bytes", "look whether its disk is full");
      left -= count;
      rest = rest[nb::slice(nb::int_(count), nb::none(), nb::none())];
    }
  };
}

Writer make_writer(const WorldRef& self, const std::string& path, FrameWriterOptions options, nb::object target = {}) {
  const World& world = self.world->idle();
  Writer writer{self.world, std::move(target), make_frame_writer(path, self.world->present(), world, options)};
  writer.writer->add(world);
  return writer;
}

void finish(Writer& self) {
  if (self.is_finished) return;
  if (self.has_failed)
    throw Error({}, "an earlier finish() of this Writer failed, so files are missing", "write the run again");
  self.has_failed = true;
  self.writer->finish();
  self.has_failed = false;
  self.is_finished = true;
}

nb::object files(const Writer& self) {
  if (!PyDict_Check(self.target.is_valid() ? self.target.ptr() : Py_None))
    throw Error({}, "the files of this Writer are not in memory",
                "their paths are in `written`; make a Writer by World.writer(format=...) to have their bytes");
  return self.target;
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

bool is_path(nb::handle path) { return nb::isinstance<nb::str>(path) || nb::hasattr(path, "__fspath__"); }

/// World.writer(): to a path, to a file object, or into memory.
Writer writer_of(const WorldRef& self, nb::object path, bool liquid_surfaces,
                 const std::optional<std::string>& format) {
  FrameWriterOptions options;
  options.liquid_surfaces = liquid_surfaces;
  if (is_path(path)) {
    if (format)
      throw Error({}, "`format` is given beside a path", "leave it out: the suffix of the path is the format");
    return make_writer(self, path_of(path), options);
  }
  if (path.is_none() && !format)
    throw Error({}, "a Writer needs a path or a format",
                "give a path such as 'run.glb', or format='glb' to write into memory");
  if (!path.is_none() && !nb::hasattr(path, "write"))
    throw wrong_type("path", path, "a str, an os.PathLike, or a file object that takes bytes");
  if (!format) throw Error({}, "a file object has no suffix that is the format", "give format='glb' or format='usda'");
  const std::string name = name_of_format(*format);
  const nb::object target = path.is_none() ? nb::object(nb::dict()) : std::move(path);
  options.sink = PyDict_Check(target.ptr()) ? sink_into_dict(target) : sink_into_file(target, name);
  return make_writer(self, name, std::move(options), target);
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

std::span<const std::byte> span_of(const nb::bytes& bytes) {
  return {reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()};
}

}  // namespace

nb::bytes bytes_of(const State& state) { return bytes_from(save_bytes(state)); }

State state_of(const nb::bytes& bytes) { return load_state_bytes(span_of(bytes), "the pickled State"); }

void bind_saving(nb::class_<WorldRef>& c) {
  c.def("save", &save_world, nb::arg("path"), nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
        "Saves the World as one file: description, settings and State. Forces and targets that wait for the next step, "
        "and "
        "what is recorded, are not saved. Raises Error if writing fails; an existing file then stays unchanged.")
      .def_static(
          "load", [](nb::handle path) { return ref_of(load_world(path_of(path))); }, nb::arg("path"),
          nb::sig("def load(path: str | os.PathLike[str]) -> World"),
          "Loads a World that save() wrote; its next step gives the same bits as without saving, if nothing was set "
          "for "
          "it.")
      .def(
          "__getstate__",
          [](const WorldRef& self) {
            const World& world = self.world->idle();
            return bytes_from(save_bytes(world, self.world->present()));
          },
          "The bytes of the save format: a World can be pickled, unless it has forces. What save() leaves out is left "
          "out.")
      .def(
          "__setstate__",
          [](WorldRef& self, const nb::bytes& bytes) {
            new (&self) WorldRef(ref_of(load_world_bytes(span_of(bytes), "the pickled World")));
          },
          nb::arg("bytes"), "Reads the bytes of the save format.")
      .def(
          "writer", &writer_of, nb::arg("path") = nb::none(), nb::arg("liquid_surfaces") = false, nb::kw_only(),
          nb::arg("format") = nb::none(),
          nb::sig(
              "def writer(self, path: str | os.PathLike[str] | typing.IO[bytes] | None = None, liquid_surfaces: bool = "
              "False, *, format: str | None = None) -> Writer"),
          "A Writer of frames. The suffix of `path` is the format: .obj, .ply, .glb, .usda, .pc2 or .pvd. The present "
          "state "
          "is the first frame. `liquid_surfaces`: surfaces of liquids instead of points. In memory: without a path, "
          "`format` "
          "such as 'glb' says what Writer.files will hold; a `path` that is a file object gets the bytes of format "
          "'glb' "
          "or "
          "'usda' at finish(). Raises Error if the format is unknown or cannot show the World.");
}

void bind_files(nb::module_& m) {
  nb::class_<Writer>(m, "Writer", nb::type_slots(writer_slots()),
                     "Writes frames of a World to files or into memory: a context manager that World.writer() returns.")
      .def(
          "add", [](Writer& self) { self.open().add(self.world->idle()); }, "Adds the present state as the next frame.")
      .def("finish", &finish, "Completes the files; the end of a `with` block calls it.")
      .def_prop_ro("written", &written, nb::sig("def written(self) -> list[str]"),
                   "Paths of the files that are written, or their names in memory; after finish() all.")
      .def_prop_ro(
          "files", &files, nb::sig("def files(self) -> dict[str, bytes]"),
          "The files of a Writer that World.writer(format=...) made, by name: 'frames.glb' and 'frames.usda' after "
          "finish(); 'frames_0000.obj' and .ply, and 'frames/OBJECT_0000.vtp' of 'frames.pvd', after each add(); "
          "'frames.pc2' with 'frames.obj'. It is always the same dict: remove what you no longer need. Raises Error "
          "if the files are on disk or in a file object.")
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

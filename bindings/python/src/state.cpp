// pliant.State: all of a World that changes with time, as a value that pickles.

#include "arrays.h"
#include "bindings.h"
#include "files.h"
#include "pliant/save.h"

namespace pliant::python {

void bind_state(nb::module_& m) {
  nb::class_<State>(
      m, "State", nb::type_slots(plain_slots()),
      "All of a World that changes with time, as a value. Restore it, and the next step gives the same bits. It can be "
      "pickled.\n\nWorld.state() returns one; World.restore() takes it.")
      .def_ro("time", &State::time, "Simulated time [s].")
      .def_ro("frame", &State::frame, "Number of complete frames.")
      .def_prop_ro(
          "particles", [](const State& state) { return state.positions.size(); }, "Number of particles of all objects.")
      .def(
          "hash", [](const State& state) { return hash(state); }, "The SHA-256 hash as 64 hexadecimal digits.")
      .def(
          "__eq__",
          [](const State& state, nb::handle other) -> nb::object {
            const State* second = nullptr;
            if (!nb::try_cast(other, second) || second == nullptr) return nb::borrow(Py_NotImplemented);
            return nb::bool_(hash(state) == hash(*second));
          },
          nb::arg("other"), nb::sig("def __eq__(self, other: object, /) -> bool"), "True if both have the same bits.")
      .def(
          "__hash__", [](const State& state) { return nb::hash(nb::str(hash(state).c_str())); }, "The hash of hash().")
      .def(
          "__copy__", [](const State& state) { return state; }, "A copy.")
      .def(
          "__deepcopy__", [](const State& state, nb::handle /*memo*/) { return state; }, nb::arg("memo"), "A copy.")
      .def(
          "__getstate__", [](const State& state) { return bytes_of(state); }, "The bytes of the save format.")
      .def(
          "__setstate__", [](State& state, const nb::bytes& bytes) { new (&state) State(state_of(bytes)); },
          nb::arg("bytes"), "Reads the bytes of the save format.")
      .def("__repr__", [](const State& state) {
        return "<pliant.State: frame " + std::to_string(state.frame) + ", " + std::to_string(state.positions.size()) +
               " particles>";
      });
}

}  // namespace pliant::python

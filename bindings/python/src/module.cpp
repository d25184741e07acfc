// The extension module pliant._pliant. The package in ../pliant re-exports what users need of it.
#include "bindings.h"
#include "pliant/version.h"

NB_MODULE(_pliant, m) {
  using namespace pliant::python;
  m.doc() = "The compiled part of pliant. Use the names of the package pliant.";
  m.def("version", &pliant::version, "The version of the library.");
  nanobind::set_leak_warnings(false);  // what globals hold at exit is no fault
  bind_errors(m);
  bind_scene(m);
  bind_state(m);
  bind_report(m);
  bind_object(m);
  bind_colliders(m);
  bind_core(m);
  bind_edit(m);
  bind_gauges(m);
  bind_world(m);
  bind_files(m);
  bind_batch(m);
  explain_calls(m);
}

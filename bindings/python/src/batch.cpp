// pliant.Batch: many worlds stepped on all threads, one thread each.
#include "bindings.h"
namespace pliant::python {
void bind_batch(nb::module_& /*m*/) {}
}  // namespace pliant::python

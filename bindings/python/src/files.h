// States to and from bytes, by the save format.
#pragma once

#include <nanobind/nanobind.h>

#include "pliant/state.h"

namespace pliant::python {

nanobind::bytes bytes_of(const State& state);
/// Throws an Error if the bytes are damaged or no State.
State state_of(const nanobind::bytes& bytes);

}  // namespace pliant::python

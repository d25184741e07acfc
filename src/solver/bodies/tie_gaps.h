// How far ties of particles to rigid bodies are open at the end of a frame.
//
// A tie is solved one at a time, after chains and before contact, so a tie between a light particle and a heavy body
// may be left open where the rope pulls hard. The gap counts as a share of the edges at the particle, as if the tie
// were one of them.
#pragma once

#include "model/model.h"
#include "pliant/report.h"
#include "pliant/state.h"

namespace pliant {

/// The rigid tie with the largest share of gap and length, the first of equal ones. TieGap::object is the number in the
/// model.
TieGap widest_tie(const Model& model, const State& state);

}  // namespace pliant

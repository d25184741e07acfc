#include "world/convergence_record.h"

namespace pliant {

namespace {

/// Lengths are measured by overstretch, of all objects together.
void add_lengths(const Report& report, const IdTable<Object>& ids, FunctionRef<int(int)> substeps_of,
                 ConvergenceEstimate& stretching) {
  if (!report.overstretch || report.overstretch->constraints == 0) return;
  const Overstretch& found = *report.overstretch;
  if (stretching.constraints > 0 && stretching.excess > found.p99) return;
  const ObjectId object = found.object < 0 ? ObjectId() : ObjectId(found.object, found.generation);
  stretching = {found.p99, found.p99, object, ids.has(object) ? substeps_of(ids.number(object)) : report.substeps,
                found.constraints};
}

/// Follows a value down at once and up by a share of the way, so that an impact of a few frames hardly raises it.
double followed_slowly(double lasting, double now) {
  constexpr double share = 0.05;
  return now < lasting ? now : lasting + share * (now - lasting);
}

}  // namespace

ConvergenceEstimates ConvergenceRecord::add(const Report& report, const IdTable<Object>& ids,
                                            FunctionRef<int(int)> substeps_of) {
  ConvergenceEstimates now = meter_.estimates();
  for (ConvergenceEstimate& one : now)
    if (one.constraints > 0) one.object = ids.id_of(one.object.slot);
  add_lengths(report, ids, substeps_of, now[static_cast<std::size_t>(Resistance::stretching)]);
  if (report.compression.mean > 0)
    now[static_cast<std::size_t>(Resistance::density)] = {report.compression.mean, 0, {}, report.substeps, 1};
  for (std::size_t k = 0; k < resistance_count; ++k) {
    if (now[k].constraints == 0) continue;
    const ConvergenceEstimate before = lasting_[k].object == now[k].object ? lasting_[k] : ConvergenceEstimate{};
    lasting_[k] = now[k];
    lasting_[k].excess = followed_slowly(before.excess, now[k].excess);
    lasting_[k].strain = followed_slowly(before.strain, now[k].strain);
    if (worst_.frames[k] > 0 && !is_farther(static_cast<Resistance>(k), lasting_[k], worst_.estimates[k])) continue;
    worst_.estimates[k] = lasting_[k];
    worst_.frames[k] = report.frame;
  }
  return now;
}

void ConvergenceRecord::forget_object(ObjectId object) {
  meter_.restart();
  for (std::size_t k = 0; k < resistance_count; ++k)
    if (worst_.estimates[k].object == object) {
      worst_.estimates[k] = {};
      worst_.frames[k] = 0;
    }
}

void ConvergenceRecord::restart() {
  meter_.restart();
  lasting_ = {};
  worst_ = {};
}

}  // namespace pliant

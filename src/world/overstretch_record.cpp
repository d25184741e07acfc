#include "world/overstretch_record.h"

namespace pliant {

void OverstretchRecord::add(const Overstretch& measured, std::int64_t frame) {
  Overstretch& worst = worst_.overstretch;
  if (measured.p99 > worst.p99) {
    worst.p99 = measured.p99;
    worst_.frame_of_p99 = frame;
  }
  worst.constraints = measured.constraints;
  if (!(measured.largest > worst.largest)) return;
  worst.largest = measured.largest;
  worst.object = measured.object;
  worst.particles = measured.particles;
  worst.generation = measured.generation;
  worst_.frame_of_largest = frame;
}

void OverstretchRecord::forget_object(int slot) {
  Overstretch& worst = worst_.overstretch;
  if (worst.object != slot) return;
  worst.object = -1;
  worst.particles = {-1, -1};
}

}  // namespace pliant

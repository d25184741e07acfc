// Which object a particle belongs to, for many particles in a row: neighbours mostly belong to the object of the last
// one.
#pragma once

#include "model/model.h"

namespace pliant {

class ObjectLookup {
 public:
  explicit ObjectLookup(const Model& model) : model_(model) {}

  /// The object of a particle, which must be in no hole of the State.
  int of(int particle) {
    if (particle < first_ || particle >= end_) {
      object_ = model_.object_of(particle);
      first_ = model_.first[static_cast<std::size_t>(object_)];
      end_ = model_.end_of(object_);
    }
    return object_;
  }

 private:
  const Model& model_;
  int object_ = -1, first_ = 0, end_ = 0;
};

}  // namespace pliant

// The list of constraint types, as the outside sees it.
#include "constraints/all.h"
#include "pliant/scene.h"

namespace pliant {

const std::vector<ConstraintType>& constraint_types() {
  static const std::vector<ConstraintType> types = [] {
    std::vector<ConstraintType> list;
    for_each_type(AllConstraints{}, [&](auto tag, int) {
      using T = typename decltype(tag)::type;
      list.push_back({T::name, T::size, {T::fields.begin(), T::fields.end()}});
    });
    return list;
  }();
  return types;
}

}  // namespace pliant

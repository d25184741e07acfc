#include "far_mesh.h"

#include <fmt/format.h>

#include <limits>

namespace pliant {

std::string Rounding::in_words() const {
  const auto far = static_cast<float>(distance);
  const auto spacing = static_cast<double>(std::nextafter(far, std::numeric_limits<float>::infinity()) - far);
  return fmt::format("lies {:.7g} from the origin, where floats are {:.2g} apart, {:.0f} % of its mean edge", distance,
                     spacing, 100 * spacing / mean_edge);
}

}  // namespace pliant

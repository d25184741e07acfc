// Makes the text of a Report.
#include "pliant/world.h"

namespace pliant {

std::string Report::explain() const {
  std::string text;
  if (nonfinite && nonfinite->object.empty()) {
    text = "frame " + std::to_string(nonfinite->frame) + ": " + nonfinite->element + "; restore a state to go on";
  } else if (nonfinite) {
    text =
        "frame " + std::to_string(nonfinite->frame) + ", substep " + std::to_string(nonfinite->substep) + ": object '" +
        nonfinite->object + "', " + nonfinite->element +
        " is the first with a value that is not finite; more substeps, less stiffness or a smaller velocity may help";
  }
  for (const std::string& warning : warnings) text += (text.empty() ? "" : "\n") + warning;
  return text;
}

}  // namespace pliant

// Makes the text of a Report.
#include <algorithm>

#include "pliant/world.h"

namespace pliant {

namespace {

std::string without_numbers(std::string text) {
  const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  text.erase(std::remove_if(text.begin(), text.end(), is_of_number), text.end());
  return text;
}

}  // namespace

std::string Report::explain() const {
  std::string text;
  if (nonfinite && nonfinite->object.empty()) {
    text = "frame " + std::to_string(nonfinite->frame) + ": " + nonfinite->element + "; restore a state to go on";
  } else if (nonfinite) {
    text = "frame " + std::to_string(nonfinite->frame) + ", substep " + std::to_string(nonfinite->substep) + ": object '" +
           nonfinite->object + "', " + nonfinite->element +
           " is the first with a value that is not finite; more substeps, less stiffness or a smaller velocity may help";
  }
  for (const std::string& warning : warnings) text += (text.empty() ? "" : "\n") + warning;
  return text;
}

void WarningLog::add(const Report& report) {
  for (const std::string& warning : report.warnings)
    if (kinds_.insert(without_numbers(warning)).second)
      lines_.push_back("frame " + std::to_string(report.frame) + ": " + warning);
}

}  // namespace pliant

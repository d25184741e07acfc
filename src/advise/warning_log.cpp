// Keeps one warning of each kind.
#include <algorithm>

#include "pliant/advise.h"

namespace pliant {

namespace {

std::string without_numbers(std::string text) {
  const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  text.erase(std::remove_if(text.begin(), text.end(), is_of_number), text.end());
  return text;
}

}  // namespace

void WarningLog::add(const Report& report) {
  for (const std::string& warning : report.warnings)
    if (kinds_.insert(without_numbers(warning)).second)
      lines_.push_back("frame " + std::to_string(report.frame) + ": " + warning);
}

}  // namespace pliant

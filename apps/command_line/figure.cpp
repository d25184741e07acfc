#include "apps/command_line/figure.h"

#include <cmath>
#include <cstdio>

namespace pliant::command {

std::string figure(double value, int digits) {
  char text[32];
  const double size = std::fabs(value);
  const bool is_long = size >= std::pow(10., digits) - 0.5 && size < 1e15;
  std::snprintf(text, sizeof text, is_long ? "%.*f" : "%.*g", is_long ? 0 : digits, value);
  return text;
}

}  // namespace pliant::command

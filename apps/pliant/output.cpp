#include "output.h"

#include <cstdio>

#include "pliant/error.h"

namespace pliant::command {

void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written) {
    Location where;
    where.file = "standard output";
    throw Error(where, "could not be written", "see whether the disk is full or the pipe's other end has closed");
  }
}

std::string one_line(const std::string& text) {
  std::string line;
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (character == '\n') {
      line += "\\n";
    } else if (character == '\t') {
      line += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned>(byte));
      line += escaped;
    } else {
      line += character;
    }
  }
  return line;
}

}  // namespace pliant::command

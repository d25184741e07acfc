#include "apps/command_line/guard.h"

#include <cstdio>
#include <exception>
#include <new>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"

namespace pliant::command {

void complain(const std::string& message) { std::fprintf(stderr, "pliant: %s\n", one_line(message).c_str()); }

int run_guarded(const std::function<int()>& subcommand) {
  try {
    return subcommand();
  } catch (const Interrupted& interrupted) {
    complain(interrupted.what());
    return interrupted.exit_status();
  } catch (const std::bad_alloc&) {
    complain("out of memory; simulate fewer particles, or close other programs");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return 1;
}

}  // namespace pliant::command

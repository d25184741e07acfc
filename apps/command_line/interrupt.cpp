#include "apps/command_line/interrupt.h"

#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "atomic_file.h"

namespace pliant::command {

namespace {

/// Time between a signal and the forced end of the program [us].
constexpr suseconds_t patience = 700000;

std::atomic<int> received{0};
std::atomic<bool> flag{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void remember_signal(int signal) {
  received = signal;
  flag = true;
  const itimerval once{{0, 0}, {0, patience}};
  ::setitimer(ITIMER_REAL, &once, nullptr);
}

const char* name_of(int signal) {
  if (signal == SIGINT) return "Ctrl-C";
  return signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

constexpr const char* consequence = "; no unfinished file is left behind";

void say(const char* text) { (void)!::write(STDERR_FILENO, text, std::strlen(text)); }

/// The signal handler that ends the program. It is async-signal-safe: it allocates nothing, takes no lock and does not
/// block.
extern "C" void end_program(int /*signal*/) {
  const int signal = received;
  remove_unfinished_files();
  say("pliant: ended by ");
  say(name_of(signal));
  say(consequence);
  say("\n");
  ::_exit(128 + signal);
}

}  // namespace

Interrupted::Interrupted(int signal)
    : signal_(signal), message_(std::string("ended by ") + name_of(signal) + consequence) {}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = remember_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal has its default effect, which ends the program
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr);  // signals that nohup or `&` ignore stay ignored
  }
  action.sa_handler = end_program;
  sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

const std::atomic<bool>& interrupted() { return flag; }

void throw_if_interrupted() {
  const int signal = received;
  if (signal != 0) throw Interrupted(signal);
}

}  // namespace pliant::command

// pliant::Error as the Python exception pliant.Error, with its parts; and Ctrl-C.
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>

#include "bindings.h"
#include "pliant/error.h"

namespace pliant::python {

namespace {

void raise(const Error& error) {
  const Location& where = error.where();
  const nb::object type = python_part("pliant._errors", "Error");
  nb::dict parts;
  parts["file"] = where.file;
  parts["line"] = where.line;
  parts["column"] = where.column;
  parts["object"] = where.object;
  parts["element"] = where.element;
  const nb::object exception = type(nb::str(error.problem().c_str()), nb::str(error.advice().c_str()), **parts);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

void translate(const std::exception_ptr& pointer, void* /*unused*/) {
  try {
    std::rethrow_exception(pointer);
  } catch (const Error& error) {
    try {
      raise(error);
    } catch (nb::python_error& other) {  // names that are no UTF-8, say
      other.restore();
    } catch (const std::exception&) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  } catch (const std::bad_alloc&) {
    PyErr_SetString(PyExc_MemoryError, "there is not enough memory; use smaller objects, or free what is not needed");
  } catch (const std::bad_cast&) {
    PyErr_SetString(PyExc_TypeError,
                    "an argument holds values of a wrong type, or text that is not valid Unicode; see the docstring of "
                    "what was called");
  }
}

/// The flag of the World that steps in the main thread; null: none.
std::atomic<std::atomic<bool>*> stepping{nullptr};
struct sigaction before {};
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

extern "C" void interrupt_step(int signal, siginfo_t* info, void* context) {
  if (std::atomic<bool>* flag = stepping.load()) flag->store(true);
  if ((before.sa_flags & SA_SIGINFO) != 0)
    before.sa_sigaction(signal, info, context);
  else
    before.sa_handler(signal);  // Python's: it only remembers the signal
}

/// Python runs handlers of signals in the main thread alone.
bool is_main_thread() { return ::syscall(SYS_gettid) == ::getpid(); }

}  // namespace

StopOnInterrupt::StopOnInterrupt(std::atomic<bool>& flag, bool wanted) {
  if (!wanted || !is_main_thread() || stepping.load() != nullptr) return;
  if (sigaction(SIGINT, nullptr, &before) != 0) return;
  if ((before.sa_flags & SA_SIGINFO) == 0 && (before.sa_handler == SIG_DFL || before.sa_handler == SIG_IGN)) return;
  stepping.store(&flag);
  struct sigaction ours {};
  ours.sa_sigaction = interrupt_step;
  ours.sa_flags = static_cast<int>(SA_SIGINFO | (before.sa_flags & SA_ONSTACK));
  sigemptyset(&ours.sa_mask);
  installed_ = sigaction(SIGINT, &ours, nullptr) == 0;
  if (!installed_) stepping.store(nullptr);
}

StopOnInterrupt::~StopOnInterrupt() {
  if (!installed_) return;
  struct sigaction now {};  // a force may have set another one
  const bool is_ours =
      sigaction(SIGINT, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == interrupt_step;
  if (is_ours) sigaction(SIGINT, &before, nullptr);
  stepping.store(nullptr);
}

nb::object python_part(const char* module, const char* name) { return nb::module_::import_(module).attr(name); }

void bind_errors(nb::module_& /*m*/) { nb::register_exception_translator(translate); }

}  // namespace pliant::python

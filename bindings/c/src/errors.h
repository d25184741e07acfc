// Statuses and the words of the last error: where every exception ends before it reaches C.
#pragma once

#include <string>

#include "pliant/error.h"
#include "pliant_c.h"

namespace pliant::c {

/// An Error that says which status it becomes.
class StatusError : public Error {
 public:
  StatusError(pliant_status status, std::string problem, std::string advice = {})
      : Error({}, std::move(problem), std::move(advice)), status_(status) {}
  pliant_status status() const noexcept { return status_; }

 private:
  pliant_status status_;
};

/// Turns the exception under way into a status, and keeps its words for pliant_last_error().
pliant_status failure() noexcept;

/// Calls `body` and ends every exception. A body that returns nothing has succeeded.
template <class Body>
pliant_status guarded(const Body& body) noexcept {
  try {
    body();
    return PLIANT_OK;
  } catch (...) {
    return failure();
  }
}

/// Throws a StatusError unless the pointer is there. `what` is the name of the parameter.
inline void require(const void* pointer, const char* what) {
  if (pointer == nullptr)
    throw StatusError(PLIANT_NULL, std::string("'") + what + "' is a null pointer",
                      "pass the address of what is meant");
}

}  // namespace pliant::c

// Keeps the last error of each thread.
#include "errors.h"

#include <cstring>
#include <new>

#include "memory.h"

namespace pliant::c {

namespace {

/// The last error of a thread. Its texts are what pliant_last_error() and pliant_last_error_parts() point to.
struct LastError {
  pliant_status status = PLIANT_OK;
  Location where;
  std::string problem, advice, whole;
  bool has_no_words = false;  ///< true if there was no memory for them
};

constexpr const char* no_memory_words = "there is not enough memory; use smaller objects, or free what is not needed";

LastError& last_error() noexcept {
  thread_local LastError last;
  return last;
}

pliant_status remember(pliant_status status, const Error& error) noexcept {
  LastError& last = last_error();
  last.status = status;
  try {
    last.where = error.where();
    last.problem = error.problem();
    last.advice = error.advice();
    last.whole = error.what();
    last.has_no_words = false;
  } catch (...) {
    last.has_no_words = true;
  }
  return status;
}

pliant_status remember(pliant_status status, const char* words) noexcept {
  try {
    return remember(status, Error({}, words));
  } catch (...) {
    last_error().status = status;
    last_error().has_no_words = true;
    return status;
  }
}

}  // namespace

pliant_status failure() noexcept {
  try {
    throw;
  } catch (const StatusError& error) {
    return remember(error.status(), error);
  } catch (const Error& error) {
    return remember(PLIANT_REFUSED, error);
  } catch (const std::bad_alloc&) {
    return remember(PLIANT_NO_MEMORY, no_memory_words);
  } catch (const std::exception& error) {
    return remember(PLIANT_INTERNAL, error.what());
  } catch (...) {
    return remember(PLIANT_INTERNAL, "a fault of an unknown kind");
  }
}

}  // namespace pliant::c

using namespace pliant::c;

const char* pliant_last_error(void) {
  const LastError& last = last_error();
  return last.has_no_words ? no_memory_words : last.whole.c_str();
}

pliant_status pliant_last_error_parts(pliant_error_parts* parts) {
  const LastError& last = last_error();
  pliant_error_parts found{};
  found.status = last.status;
  found.line = last.where.line;
  found.column = last.where.column;
  found.file = last.where.file.c_str();
  found.object = last.where.object.c_str();
  found.element = last.where.element.c_str();
  found.problem = last.has_no_words ? no_memory_words : last.problem.c_str();
  found.advice = last.advice.c_str();
  // A refusal of this very call replaces what `found` points to; it is not copied then.
  return guarded([&] { give(found, parts, "parts"); });
}

const char* pliant_status_name(pliant_status status) {
  switch (status) {
    case PLIANT_OK:
      return "PLIANT_OK";
    case PLIANT_NULL:
      return "PLIANT_NULL";
    case PLIANT_STALE:
      return "PLIANT_STALE";
    case PLIANT_REFUSED:
      return "PLIANT_REFUSED";
    case PLIANT_TOO_SMALL:
      return "PLIANT_TOO_SMALL";
    case PLIANT_NOT_FOUND:
      return "PLIANT_NOT_FOUND";
    case PLIANT_STOPPED:
      return "PLIANT_STOPPED";
    case PLIANT_NOT_FINITE:
      return "PLIANT_NOT_FINITE";
    case PLIANT_NO_MEMORY:
      return "PLIANT_NO_MEMORY";
    case PLIANT_BUSY:
      return "PLIANT_BUSY";
    case PLIANT_INTERNAL:
      return "PLIANT_INTERNAL";
    default:
      return "unknown status";
  }
}

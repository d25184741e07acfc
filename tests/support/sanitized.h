// Detects sanitizers, which make code ten or more times slower. Tests that would take more than a minute use it to run
// fewer scenes or frames; other tests are unchanged.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PLIANT_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PLIANT_SANITIZED 1
#endif

namespace pliant::testing_support {

#ifdef PLIANT_SANITIZED
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Returns `all`, or `sanitized` if a sanitizer is active.
constexpr int fewer_if_sanitized(int all, int sanitized) { return is_sanitized ? sanitized : all; }

}  // namespace pliant::testing_support

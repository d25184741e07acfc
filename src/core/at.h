// Signed indices as the containers of the standard library take them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pliant {

/// Converts an index, which must not be negative, to std::size_t.
constexpr std::size_t at(std::int64_t index) { return static_cast<std::size_t>(index); }

}  // namespace pliant

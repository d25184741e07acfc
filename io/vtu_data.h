// The data of VTK XML files as bytes: plain or as base64, whole or compressed in blocks (Kitware, "VTK file formats").
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace pliant {

struct VtuEncoding {
  bool is_base64 = true;
  bool has_big_end_first = false;
  bool has_long_headers = false;  ///< UInt64 instead of UInt32
  bool is_compressed = false;     ///< by zlib
};

/// Throws an Error with a problem and advice, at the place that is read.
using VtuFail = std::function<void(const std::string& problem, const std::string& advice)>;

/// The bytes of one array that begins at the start of `from`. What follows it is not read.
std::string vtu_array(std::string_view from, const VtuEncoding& encoding, const VtuFail& fail);

}  // namespace pliant

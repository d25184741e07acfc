// numpy's arrays in and out. What is written to must fit exactly; what is read is converted to float32 or int32.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pliant/state.h"
#include "pliant/vec3.h"

namespace pliant::python {

namespace nb = nanobind;

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && alignof(Vec3f) == alignof(float),
              "spans of Vec3f are arrays of floats");
static_assert(sizeof(Record) == 4 * sizeof(float));

/// An array that was given, as C-contiguous numbers, for as long as it lives.
class Numbers {
 public:
  /// Takes an array of `columns` numbers a row; 0 columns: one dimension. Others are converted by numpy. Throws an
  /// Error that begins with `what` if shape or kind is wrong. `type` is 'f' or 'i'.
  Numbers(nb::handle given, char type, int columns, const char* what);
  ~Numbers();
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  std::size_t rows() const { return rows_; }
  std::span<const Vec3f> vectors() const { return {static_cast<const Vec3f*>(view_.buf), rows_}; }
  std::span<const int> integers() const { return {static_cast<const int*>(view_.buf), rows_}; }
  const float* floats() const { return static_cast<const float*>(view_.buf); }
  const int* ints() const { return static_cast<const int*>(view_.buf); }

 private:
  bool take(nb::handle given, char type, int columns, const char* what);
  nb::object converted_;
  Py_buffer view_{};
  std::size_t rows_ = 0;
};

/// The caller's array that a function fills: float32, C-contiguous, writable, of exactly this shape. Throws an Error
/// otherwise.
class Output {
 public:
  Output(nb::handle given, std::span<const std::size_t> shape);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  float* floats() const { return static_cast<float*>(view_.buf); }
  std::span<Vec3f> vectors() const { return {static_cast<Vec3f*>(view_.buf), count_}; }

 private:
  Py_buffer view_{};
  std::size_t count_ = 0;  ///< of vectors
};

/// A new array of float32 of this shape that nothing has filled yet.
nb::object new_floats(std::span<const std::size_t> shape);

/// Calls fill(span of n vectors) with the memory of `out`, or of a new array where that is None, and returns it.
template <class Fill>
nb::object filled_vectors(nb::handle out, std::size_t n, const Fill& fill) {
  const std::size_t shape[2] = {n, 3};
  nb::object array = out.is_none() ? new_floats(shape) : nb::borrow(out);
  const Output output(array, shape);
  fill(output.vectors());
  return array;
}

/// A new array of int32 with these values.
nb::object integers(std::span<const int> values);
/// A new array (n, 3) or (n, columns) of int32 or float32 from memory.
nb::object int_rows(const int* values, std::size_t rows, std::size_t columns);
nb::object float_rows(const float* values, std::size_t rows, std::size_t columns);
nb::object vectors(const std::vector<Vec3f>& values);

/// A vector of three numbers from a sequence or array. Throws an Error that begins with `what`.
Vec3f vector_from(nb::handle given, const char* what);
/// A quaternion (x, y, z, w).
Quatf quaternion_from(nb::handle given, const char* what);

}  // namespace pliant::python

#include "arrays.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "pliant/error.h"

namespace pliant::python {

namespace {

std::string shape_of(const Py_buffer& view) {
  std::string text = "(";
  for (int i = 0; i < view.ndim; ++i)
    text += (i > 0 ? ", " : "") + std::to_string(view.shape[i]) + (view.ndim == 1 ? "," : "");
  return text + ")";
}

std::string wanted_shape(int columns) { return columns == 0 ? "(n,)" : "(n, " + std::to_string(columns) + ")"; }

const nb::module_& numpy() {
  static const nb::module_* module = new nb::module_(nb::module_::import_("numpy"));  // outlives the interpreter's exit
  return *module;
}

nb::object numpy_part(const char* name) { return numpy().attr(name); }

nb::handle float32() {
  static const nb::object* type = new nb::object(numpy().attr("float32"));
  return *type;
}

bool is_aligned(const Py_buffer& view) { return reinterpret_cast<std::uintptr_t>(view.buf) % alignof(float) == 0; }

bool has_format(const Py_buffer& view, char type) {
  if (view.itemsize != 4 || view.format == nullptr) return false;
  return std::strcmp(view.format, type == 'f' ? "f" : "i") == 0;
}

std::string name_of_type(nb::handle given) { return nb::cast<std::string>(nb::object(given.type().attr("__name__"))); }

/// The array as numpy sees it, of a numeric kind that fits.
nb::object converted(nb::handle given, char type, const std::string& what) {
  nb::object array;
  try {
    array = numpy_part("asarray")(given);
  } catch (nb::python_error&) {
    throw Error({}, what + " are no array of numbers", "pass a numpy array, or a list of lists of numbers");
  }
  const std::string kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (nb::cast<int>(array.attr("ndim")) == 0) throw Error({}, what + " are one value", "pass an array, or a list");
  const bool is_empty = nb::cast<std::size_t>(array.attr("size")) == 0;
  const bool fits = kind == "i" || kind == "u" || (kind == "f" && (type == 'f' || is_empty));
  if (!fits)
    throw Error({}, what + " have the type " + nb::cast<std::string>(nb::str(nb::object(array.attr("dtype")))),
                type == 'f' ? "pass numbers, such as float32" : "pass whole numbers, such as int32");
  if (type == 'i' && !is_empty) {
    const nb::object low = array.attr("min")(), high = array.attr("max")();
    if (nb::cast<long long>(nb::int_(low)) < -2147483647LL || nb::cast<double>(nb::float_(high)) > 2147483647.)
      throw Error({}, what + " do not fit into 32 bits", "pass indices");
  }
  try {
    // "CA": contiguous and aligned, as arrays that came over a network need not be.
    return numpy_part("require")(array, type == 'f' ? nb::borrow(float32()) : numpy_part("int32"), "CA");
  } catch (nb::python_error&) {  // where a program makes errors of numpy's warnings
    throw Error({}, what + " do not fit into 32 bits", "pass smaller numbers");
  }
}

}  // namespace

namespace {

/// Refuses an array of numpy.ma with masked values, whose buffer holds what lies under the mask. Others of this kind,
/// and all others, are as they look.
void refuse_masked(nb::handle given, const char* what) {
  static const nb::object* plain = new nb::object(numpy().attr("ndarray"));
  if (given.type().is(*plain) || !nb::isinstance(given, *plain) || !nb::hasattr(given, "mask")) return;
  if (nb::bool_(given.attr("mask").attr("any")()))
    throw Error({}, std::string(what) + " have masked values", "fill or remove them");
}

}  // namespace

bool Numbers::take(nb::handle given, char type, int columns, const char* what) {
  if (PyObject_CheckBuffer(given.ptr()) == 0) return false;
  if (PyObject_GetBuffer(given.ptr(), &view_, PyBUF_FORMAT | PyBUF_STRIDES) != 0) {
    PyErr_Clear();
    return false;
  }
  if (!has_format(view_, type) || PyBuffer_IsContiguous(&view_, 'C') == 0 || !is_aligned(view_)) {
    PyBuffer_Release(&view_);
    return false;
  }
  const bool fits = columns == 0 ? view_.ndim == 1 : view_.ndim == 2 && view_.shape[1] == columns;
  if (!fits) {
    const std::string shape = shape_of(view_);
    PyBuffer_Release(&view_);
    throw Error({}, std::string(what) + " have the shape " + shape, "pass " + wanted_shape(columns));
  }
  rows_ = static_cast<std::size_t>(view_.shape[0]);
  return true;
}

Numbers::Numbers(nb::handle given, char type, int columns, const char* what) {
  refuse_masked(given, what);
  if (take(given, type, columns, what)) return;
  converted_ = converted(given, type, what);
  if (columns > 0 && nb::cast<std::size_t>(converted_.attr("size")) == 0 && nb::cast<int>(converted_.attr("ndim")) == 1)
    converted_ = converted_.attr("reshape")(0, columns);
  if (!take(converted_, type, columns, what))
    throw Error({}, std::string(what) + " are no array of numbers", "pass a numpy array");
}

Numbers::~Numbers() { PyBuffer_Release(&view_); }

Output::Output(nb::handle given, std::span<const std::size_t> shape) {
  std::string wanted = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) wanted += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  const auto remedy = [&] { return "pass a C-contiguous, writable numpy array of float32 of shape " + wanted + ")"; };
  if (PyObject_GetBuffer(given.ptr(), &view_, PyBUF_FORMAT | PyBUF_STRIDES) != 0) {
    PyErr_Clear();
    throw Error({}, "out is a " + name_of_type(given) + ", which has no array that can be filled", remedy());
  }
  std::string problem;
  bool same = static_cast<std::size_t>(view_.ndim) == shape.size();
  for (std::size_t i = 0; same && i < shape.size(); ++i) same = static_cast<std::size_t>(view_.shape[i]) == shape[i];
  if (!has_format(view_, 'f'))
    problem = "out holds no float32, but '" + std::string(view_.format != nullptr ? view_.format : "bytes") + "'";
  else if (!same)
    problem = "out has the shape " + shape_of(view_);
  else if (view_.readonly != 0)
    problem = "out is read-only";
  else if (PyBuffer_IsContiguous(&view_, 'C') == 0 || !is_aligned(view_))
    problem = "out is not C-contiguous";
  if (!problem.empty()) {
    PyBuffer_Release(&view_);
    throw Error({}, problem, remedy());
  }
  count_ = static_cast<std::size_t>(view_.len) / sizeof(Vec3f);
}

Output::~Output() { PyBuffer_Release(&view_); }

nb::object new_floats(std::span<const std::size_t> shape) {
  static const nb::object* empty = new nb::object(numpy().attr("empty"));
  if (shape.size() == 1) return (*empty)(nb::make_tuple(shape[0]), float32());
  if (shape.size() == 2) return (*empty)(nb::make_tuple(shape[0], shape[1]), float32());
  return (*empty)(nb::make_tuple(shape[0], shape[1], shape[2]), float32());
}

nb::object int_rows(const int* values, std::size_t rows, std::size_t columns) {
  const nb::object array =
      numpy_part("empty")(columns == 0 ? nb::make_tuple(rows) : nb::make_tuple(rows, columns), numpy_part("int32"));
  const Numbers to(array, 'i', static_cast<int>(columns), "indices");
  if (rows > 0)
    std::memcpy(const_cast<int*>(to.ints()), values, rows * std::max<std::size_t>(columns, 1) * sizeof(int));
  return array;
}

nb::object float_rows(const float* values, std::size_t rows, std::size_t columns) {
  const std::size_t one[1] = {rows}, two[2] = {rows, columns};
  const nb::object array = columns == 0 ? new_floats(one) : new_floats(two);
  const Numbers to(array, 'f', static_cast<int>(columns), "values");
  if (rows > 0)
    std::memcpy(const_cast<float*>(to.floats()), values, rows * std::max<std::size_t>(columns, 1) * sizeof(float));
  return array;
}

nb::object integers(std::span<const int> values) { return int_rows(values.data(), values.size(), 0); }

nb::object vectors(const std::vector<Vec3f>& values) {
  return float_rows(reinterpret_cast<const float*>(values.data()), values.size(), 3);
}

namespace {

const float* require_count(const Numbers& numbers, std::size_t count, const char* what) {
  if (numbers.rows() == count) return numbers.floats();
  throw Error({}, std::string(what) + " has " + std::to_string(numbers.rows()) + " numbers",
              "pass " + std::to_string(count));
}

}  // namespace

Vec3f vector_from(nb::handle given, const char* what) {
  const Numbers numbers(given, 'f', 0, what);
  const float* v = require_count(numbers, 3, what);
  return {v[0], v[1], v[2]};
}

Quatf quaternion_from(nb::handle given, const char* what) {
  const Numbers numbers(given, 'f', 0, what);
  const float* q = require_count(numbers, 4, what);
  return {q[0], q[1], q[2], q[3]};
}

}  // namespace pliant::python

// What Python says of calls with wrong arguments, and of attributes that cannot be set.
//
// nanobind's own TypeError lists C++ signatures. Python knows better which argument is wrong (../pliant/_calls.py). So
// each function of the module gets another vectorcall, which calls the first one and then explains such an error. A
// call that is right costs one comparison more.
#include <array>
#include <cstring>
#include <limits>

#include "bindings.h"

namespace pliant::python {

namespace {

/// nanobind has a few kinds of vectorcall, by how much of a signature must be looked at.
constexpr std::size_t most_kinds = 8;
std::array<vectorcallfunc, most_kinds> originals{};

/// The error that nanobind has set, if it says that no signature fits; else null.
nb::object unexplained_error() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  const nb::object text = nb::steal(PyObject_Str(value));
  if (text.is_valid() && std::strstr(nb::str(text).c_str(), "incompatible function arguments") != nullptr) {
    Py_XDECREF(type);
    Py_XDECREF(trace);
    return nb::steal(value);
  }
  PyErr_Restore(type, value, trace);
  return {};
}

/// Replaces the error by one that names the argument.
void explain(PyObject* function, PyObject* const* args, std::size_t flagged, PyObject* names) {
  const nb::object error = unexplained_error();
  if (!error.is_valid()) return;
  try {
    const std::size_t count =
        flagged & (~std::size_t{0} >> 8);  // the highest bits are flags, of Python and of nanobind
    nb::list given;
    for (std::size_t i = 0; i < count; ++i) given.append(nb::handle(args[i]));
    nb::dict named;
    for (std::size_t i = 0; names != nullptr && i < static_cast<std::size_t>(PyTuple_GET_SIZE(names)); ++i)
      named[nb::handle(PyTuple_GET_ITEM(names, i))] = nb::handle(args[count + i]);
    const nb::object text = python_part("pliant._calls", "explain")(nb::handle(function), given, named);
    PyErr_SetObject(PyExc_TypeError, text.ptr());
  } catch (nb::python_error& other) {
    other.restore();
  }
}

template <std::size_t Kind>
PyObject* call(PyObject* function, PyObject* const* args, std::size_t flagged, PyObject* names) {
  PyObject* const result = originals[Kind](function, args, flagged, names);
  if (result == nullptr && PyErr_ExceptionMatches(PyExc_TypeError) != 0) explain(function, args, flagged, names);
  return result;
}

template <std::size_t... Kinds>
constexpr std::array<vectorcallfunc, most_kinds> explaining(std::index_sequence<Kinds...> /*all*/) {
  return {call<Kinds>...};
}
constexpr std::array<vectorcallfunc, most_kinds> explaining_calls = explaining(std::make_index_sequence<most_kinds>());

void explain_calls_of(nb::handle function) {
  PyTypeObject* const type = Py_TYPE(function.ptr());
  if (std::strcmp(type->tp_name, "nanobind.nb_func") != 0 && std::strcmp(type->tp_name, "nanobind.nb_method") != 0)
    return;
  auto* const place =
      reinterpret_cast<vectorcallfunc*>(reinterpret_cast<char*>(function.ptr()) + type->tp_vectorcall_offset);
  for (std::size_t kind = 0; kind < most_kinds; ++kind) {
    if (*place == explaining_calls[kind]) return;
    if (originals[kind] == nullptr) originals[kind] = *place;
    if (originals[kind] != *place) continue;
    *place = explaining_calls[kind];
    return;
  }
}

}  // namespace

void explain_calls(nb::module_& m) {
  for (const auto& [name, value] : nb::borrow<nb::dict>(m.attr("__dict__"))) {
    explain_calls_of(value);
    if (!nb::isinstance<nb::type_object>(value)) continue;
    for (const nb::handle member : nb::list(nb::object(value.attr("__dict__").attr("values")())))
      explain_calls_of(member);
  }
}

int refuse_attribute(PyObject* self, PyObject* name, PyObject* value) {
  if (PyObject_GenericSetAttr(self, name, value) == 0) return 0;  // of a class that Python derived
  if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) return -1;
  PyErr_Clear();
  try {
    const nb::object text = python_part("pliant._calls", "no_attribute")(nb::handle(self).type(), nb::handle(name));
    PyErr_SetObject(PyExc_AttributeError, text.ptr());
  } catch (nb::python_error& other) {
    other.restore();
  }
  return -1;
}

int refuse_construction(PyObject* self, PyObject* /*args*/, PyObject* /*keywords*/) {
  try {
    const nb::object text = python_part("pliant._calls", "no_construction")(nb::handle(self).type());
    PyErr_SetObject(PyExc_TypeError, text.ptr());
  } catch (nb::python_error& other) {
    other.restore();
  }
  return -1;
}

nb::builtin_exception wrong_type(const std::string& what, nb::handle given, const char* expected) {
  const nb::object text = python_part("pliant._calls", "wrong_type")(what, given, expected);
  return nb::type_error(nb::cast<std::string>(text).c_str());
}

double number_from(nb::handle given, const char* what) {
  double value = 0;
  if (PyBool_Check(given.ptr()) != 0 || !nb::try_cast(given, value)) throw wrong_type(what, given, "a number");
  return value;
}

std::string repr_of(nb::handle given) { return nb::cast<std::string>(nb::repr(given)); }

}  // namespace pliant::python

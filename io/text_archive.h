// Archives for save_fields.h: one writes a struct as JSON, one reads it back from a tree.
//
// A struct is an object with its members by name, a list an array, Vec3f and Quatf arrays of their parts, an
// enumeration its word, a variant an object with one member, what is absent null. Numbers have the fewest digits that
// read back exactly; JSON has no infinity, so that it is the string "infinity".
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/save_archive.h"
#include "io/scene_json.h"
#include "io/shortest_number.h"
#include "pliant/error.h"

namespace pliant::save_file {

/// The next of the names in "kind, value, damping", which is taken off.
inline std::string_view next_name(std::string_view& names) {
  const std::size_t end = std::min(names.find(','), names.size());
  const std::string_view name = names.substr(0, end);
  names.remove_prefix(end);
  while (!names.empty() && (names.front() == ',' || names.front() == ' ' || names.front() == '\n'))
    names.remove_prefix(1);
  return name;
}

inline std::array<float, 3> parts_of(const Vec3f& of) { return {of.x, of.y, of.z}; }
inline std::array<float, 4> parts_of(const Quatf& of) { return {of.x, of.y, of.z, of.w}; }
template <class T>
inline constexpr bool has_parts = std::is_same_v<T, Vec3f> || std::is_same_v<T, Quatf>;

/// Appends JSON to a text: each member on a line, and each element of a list, except for lists of numbers.
class TextOutput {
 public:
  explicit TextOutput(std::string& text) : text_(text) {}

  template <class... T>
  void operator()(const char* names, const T&... values) {
    std::string_view left = names;
    (member(next_name(left), values), ...);
  }
  template <class... T>
  void aside(const char* names, const T&... values) {
    (*this)(names, values...);
  }

  template <class T>
  requires std::is_class_v<T> &&(!is_plain<T>)void put(const T& of) {
    open('{');
    fields(*this, of);
    close('}');
  }
  /// Opens an object for members of the caller, who calls close().
  void open(char bracket) {
    text_ += bracket;
    ++depth_;
    is_first_ = true;
  }
  void close(char bracket) {
    --depth_;
    if (!is_first_) new_line();
    is_first_ = false;
    text_ += bracket;
  }

 private:
  template <class T>
  void member(std::string_view name, const T& value) {
    next();
    text_ += '"';
    text_ += name;
    text_ += "\": ";
    put(value);
  }
  void next() {
    if (!is_first_) text_ += ',';
    is_first_ = false;
    new_line();
  }
  void new_line() {
    text_ += '\n';
    text_.append(2 * static_cast<std::size_t>(depth_), ' ');
  }

  template <class T>
  requires is_number<T>
  void put(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) {
        text_ += std::isnan(value) ? "\"nan\"" : value > 0 ? "\"infinity\"" : "\"-infinity\"";
        return;
      }
      if (value == 0 && std::signbit(value)) {  // "-0" would be read as the integer 0
        text_ += "-0.0";
        return;
      }
    }
    char digits[64];
    text_.append(digits, write_shortest(digits, digits + sizeof digits, value));
  }
  void put(bool value) { text_ += value ? "true" : "false"; }
  template <class E>
  requires std::is_enum_v<E>
  void put(E value) {
    const auto all = words(value);
    const auto index = static_cast<std::size_t>(value);
    if (index >= all.size())
      throw Error({}, "the scene has a value of an enumeration that it does not have", "mend it");
    put_word(all[index]);
  }
  void put(const std::string& text) {
    try {
      text_ += nlohmann::json(text).dump();
    } catch (const nlohmann::json::exception&) {
      throw Error({}, "the name '" + scene_file::printable(text) + "' is not UTF-8", "give it another name");
    }
  }
  void put_word(const char* word) { text_.append("\"").append(word).append("\""); }
  template <class T>
  requires has_parts<T>
  void put(const T& value) { put(parts_of(value)); }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    put_row(values);
  }
  template <class T>
  void put(const std::vector<T>& list) {
    if constexpr (is_number<T>) {
      put_row(list);
    } else {
      open('[');
      for (const T& element : list) {
        next();
        put(element);
      }
      close(']');
    }
  }
  /// Elements on one line.
  template <class List>
  void put_row(const List& list) {
    text_ += '[';
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i > 0) text_ += ", ";
      put(list[i]);
    }
    text_ += ']';
  }
  template <class T>
  void put(const std::optional<T>& value) {
    value ? put(*value) : void(text_ += "null");
  }
  template <class T>
  void put(const std::shared_ptr<const T>& value) {
    value ? put(*value) : void(text_ += "null");
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    open('{');
    std::visit([&](const auto& held) { member(words(value)[value.index()], held); }, value);
    close('}');
  }

  std::string& text_;
  int depth_ = 0;
  bool is_first_ = true;
};

/// Reads members from a tree. Members that are not there keep their values; others than those of the struct, and values
/// of another type, are Errors at their place in the text.
class TextInput {
 public:
  TextInput(const scene_file::JsonDocument& document, const scene_file::JsonValue& at)
      : document_(document), at_(&at) {}

  template <class... T>
  void operator()(const char* names, T&... values) {
    std::string_view left = names;
    (member(next_name(left), values), ...);
  }
  template <class... T>
  void aside(const char* names, T&... values) {
    (*this)(names, values...);
  }

  template <class T>
  requires std::is_class_v<T> &&(!is_plain<T>)void get(T& of) {
    require(Kind::object, "an object");
    fields(*this, of);
  }

 private:
  using Kind = scene_file::JsonValue::Kind;

  template <class T>
  void member(std::string_view name, T& value) {
    if (const scene_file::JsonValue* found = at_->find(std::string(name).c_str())) get_at(*found, value);
  }
  template <class T>
  void get_at(const scene_file::JsonValue& at, T& value) {
    const scene_file::JsonValue* const outer = std::exchange(at_, &at);
    get(value);
    at_ = outer;
  }
  [[noreturn]] void refuse(const std::string& expected) const {
    document_.fail(*at_, "is not " + expected, "change it to " + expected);
  }
  void require(Kind kind, const char* expected) const {
    if (at_->kind != kind) refuse(expected);
  }

  template <class T>
  requires is_number<T>
  void get(T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (at_->kind == Kind::string) {
        value = not_finite<T>();
        return;
      }
      require(Kind::number, "a number");
      value = static_cast<T>(at_->number);
      if (!std::isfinite(value)) refuse("a number in the range of a float");
    } else {
      require(Kind::number, "a number");
      const auto least = static_cast<double>(std::numeric_limits<T>::min());
      const auto most = static_cast<double>(std::numeric_limits<T>::max());
      if (!(at_->number >= least && at_->number <= most) || at_->number != std::floor(at_->number))
        refuse("an integer from " + std::to_string(std::numeric_limits<T>::min()) + " to " +
               std::to_string(std::numeric_limits<T>::max()));
      value = static_cast<T>(at_->number);
    }
  }
  template <class T>
  T not_finite() const {
    if (at_->text == "infinity") return std::numeric_limits<T>::infinity();
    if (at_->text == "-infinity") return -std::numeric_limits<T>::infinity();
    if (at_->text == "nan") return std::numeric_limits<T>::quiet_NaN();
    refuse("a number, \"infinity\", \"-infinity\" or \"nan\"");
  }
  void get(bool& value) {
    require(Kind::boolean, "true or false");
    value = at_->truth;
  }
  template <class E>
  requires std::is_enum_v<E>
  void get(E& value) {
    require(Kind::string, "a word");
    const auto all = words(value);
    std::string list;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (at_->text == all[i]) {
        value = static_cast<E>(i);
        return;
      }
      list += (i == 0 ? "'" : ", '") + std::string(all[i]) + "'";
    }
    refuse("one of " + list);
  }
  void get(std::string& text) {
    require(Kind::string, "a string");
    text = at_->text;
  }
  void get(Vec3f& value) {
    std::array<float, 3> parts{};
    get(parts);
    value = {parts[0], parts[1], parts[2]};
  }
  void get(Quatf& value) {
    std::array<float, 4> parts{};
    get(parts);
    value = {parts[0], parts[1], parts[2], parts[3]};
  }
  template <class T, std::size_t n>
  void get(std::array<T, n>& values) {
    if (at_->kind != Kind::array || at_->items.size() != n) refuse("an array of " + std::to_string(n) + " values");
    for (std::size_t i = 0; i < n; ++i) get_at(at_->items[i], values[i]);
  }
  template <class T>
  void get(std::vector<T>& list) {
    require(Kind::array, "an array");
    list.resize(at_->items.size());
    for (std::size_t i = 0; i < list.size(); ++i) get_at(at_->items[i], list[i]);
  }
  template <class T>
  void get(std::optional<T>& value) {
    value.reset();
    if (at_->kind != Kind::null) get(value.emplace());
  }
  template <class T>
  void get(std::shared_ptr<const T>& value) {
    value.reset();
    if (at_->kind == Kind::null) return;
    auto made = std::make_shared<T>();
    get(*made);
    value = std::move(made);
  }
  template <class... T>
  void get(std::variant<T...>& value) {
    require(Kind::object, "an object");
    const auto all = words(value);
    if (at_->items.size() != 1) refuse("an object with one member");
    const std::string& word = at_->items[0].key;
    std::size_t tried = 0;
    const auto read = [&]<class One>(One made) {
      if (word != all[tried++]) return false;
      (void)at_->find(word.c_str());  // which marks it as used
      get_at(at_->items[0], made);
      value = std::move(made);
      return true;
    };
    if (!(read(T{}) || ...)) document_.fail_key(at_->items[0], "is not the name of a shape", "use a sphere or a box");
  }

  const scene_file::JsonDocument& document_;
  const scene_file::JsonValue* at_;
};

}  // namespace pliant::save_file

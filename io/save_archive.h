// Archives for save_fields.h: one writes bytes to a sink, one reads them back.
// Numbers are little-endian, as in memory; lists and strings are length-prefixed.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "io/save_fields.h"

namespace pliant::save_file {

template <class T>
inline constexpr bool is_number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

/// True for types without padding in which all bits are valid: lists of them are copied as bytes.
template <class T>
inline constexpr bool is_plain = is_number<T> || std::is_same_v<T, Vec3f> || std::is_same_v<T, Quatf>;
template <class T, std::size_t n>
inline constexpr bool is_plain<std::array<T, n>> = is_plain<T>;
static_assert(sizeof(Vec3f) == 12 && sizeof(Quatf) == 16);

/// Which members an archive takes: all, or only those that determine a run's bits.
enum class Take { all, deciding };

/// An archive that passes the bytes of members to `sink(const void*, size)`.
template <class Sink>
class Output {
 public:
  Output(Sink sink, Take take) : sink_(std::move(sink)), take_(take) {}

  template <class... T>
  void operator()(const char* /*names*/, const T&... values) {
    (put(values), ...);
  }
  template <class... T>
  void aside(const char* /*names*/, const T&... values) {
    if (take_ == Take::all) (put(values), ...);
  }

 private:
  template <class T>
  requires is_plain<T>
  void put(const T& value) { sink_(&value, sizeof value); }
  void put(bool value) { put(static_cast<std::uint8_t>(value)); }
  template <class E>
  requires std::is_enum_v<E>
  void put(E value) { put(static_cast<std::uint8_t>(value)); }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    sink_(text.data(), text.size());
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(static_cast<std::uint64_t>(list.size()));
    if constexpr (is_plain<T>)
      sink_(list.data(), list.size() * sizeof(T));
    else
      for (const T& element : list) put(element);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::shared_ptr<const T>& value) {
    put(value != nullptr);
    if (value) put(*value);
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    put(static_cast<std::uint8_t>(value.index()));
    std::visit([&](const auto& held) { put(held); }, value);
  }
  template <class T>
  requires std::is_class_v<T> &&(!is_plain<T>)void put(const T& of) { fields(*this, of); }

  Sink sink_;
  Take take_;
};

/// An archive that reads members from bytes. It allocates no more than the bytes that remain can fill.
class Input {
 public:
  explicit Input(std::string_view bytes) : left_(bytes) {}

  template <class... T>
  void operator()(const char* /*names*/, T&... values) {
    (get(values), ...);
  }
  template <class... T>
  void aside(const char* /*names*/, T&... values) {
    (get(values), ...);
  }
  /// True if all bytes were valid and all have been read.
  bool complete() const { return good_ && left_.empty(); }

 private:
  template <class T>
  requires is_plain<T>
  void get(T& value) { copy(&value, sizeof value); }
  void get(bool& value) { value = small(1) != 0; }
  template <class E>
  requires std::is_enum_v<E>
  void get(E& value) { value = static_cast<E>(small(static_cast<int>(words(E{}).size()) - 1)); }
  void get(std::string& text) {
    text.resize(count(1));
    copy(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& list) {
    list.clear();
    if constexpr (is_plain<T>) {
      list.resize(count(sizeof(T)));
      copy(list.data(), list.size() * sizeof(T));
    } else {
      // Appended one by one, because an element in memory is larger than its smallest form in the file.
      for (std::uint64_t left = count(1); left > 0 && good_; --left) get(list.emplace_back());
    }
  }
  template <class T>
  void get(std::optional<T>& value) {
    value.reset();
    if (small(1) != 0) get(value.emplace());
  }
  template <class T>
  void get(std::shared_ptr<const T>& value) {
    value.reset();
    if (small(1) == 0) return;
    auto made = std::make_shared<T>();
    get(*made);
    value = std::move(made);
  }
  template <class... T>
  void get(std::variant<T...>& value) {
    const int index = small(static_cast<int>(sizeof...(T)) - 1);
    int tried = 0;
    ((tried++ == index ? get(value.template emplace<T>()) : void()), ...);
  }
  template <class T>
  requires std::is_class_v<T> &&(!is_plain<T>)void get(T& of) { fields(*this, of); }

  void copy(void* to, std::size_t size) {
    good_ = good_ && size <= left_.size();
    if (!good_ || size == 0) return;
    std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }
  /// Reads a byte from 0 to `largest`.
  int small(int largest) {
    std::uint8_t value = 0;
    copy(&value, 1);
    good_ = good_ && value <= largest;
    return good_ ? value : 0;
  }
  /// Reads a number of elements; 0 if the bytes that remain cannot contain so many.
  std::uint64_t count(std::size_t element_size) {
    std::uint64_t value = 0;
    copy(&value, sizeof value);
    good_ = good_ && value <= left_.size() / element_size;
    return good_ ? value : 0;
  }

  std::string_view left_;
  bool good_ = true;
};

}  // namespace pliant::save_file

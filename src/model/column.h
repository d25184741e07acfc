// A column with one number per constraint. It stores the number once if all are equal, refers to the user's array while
// it equals that, and else has an array of its own.
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <utility>
#include <vector>

namespace pliant {

/// A view of one number per constraint (a rest field, responses or dampings), valid until its Column changes.
struct Row {
  const float* first;
  int stride;
  float at(int constraint) const { return first[static_cast<std::size_t>(constraint) * stride]; }
};

/// A column that compares values bit for bit: +0 and -0 are different numbers.
template <class T>
class Column {
 public:
  Column() = default;
  Column(std::initializer_list<T> values) : size_(values.size()), own_(values) {}

  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return !own_.empty() ? own_[i] : given_ != nullptr ? given_[i] : same_; }

  void push_back(T value) {
    if (size_ == 0) same_ = value;
    if (own_.empty() && given_ == nullptr && is_same(value)) {
      ++size_;
      return;
    }
    own().push_back(value);
    ++size_;
  }

  /// Appends a number `count` times.
  void append(T value, std::size_t count) {
    if (count == 0) return;
    if (size_ == 0) same_ = value;
    if (own_.empty() && given_ == nullptr && is_same(value)) {
      size_ += count;
      return;
    }
    own().insert(own_.end(), count, value);
    size_ += count;
  }

  /// Appends an array, which must outlive the column and stay unchanged. The first one appended is not copied.
  void append(const std::vector<T>& values) {
    if (values.empty()) return;
    if (size_ == 0)
      given_ = values.data();
    else
      own().insert(own_.end(), values.begin(), values.end());
    size_ += values.size();
  }

  /// Appends an array that the caller gives away. The first one appended is moved, not copied.
  void append(std::vector<T>&& values) {
    if (size_ > 0 || values.empty()) return append(static_cast<const std::vector<T>&>(values));
    size_ = values.size();
    own_ = std::move(values);
  }

  void set(std::size_t i, T value) {
    if (std::memcmp(&(*this)[i], &value, sizeof value) != 0) own()[i] = value;
  }

  /// Converts the column to an array of its own, and returns that.
  std::vector<T>& own() {
    if (!own_.empty() || size_ == 0) return own_;
    own_.reserve(size_ + 1);
    for (std::size_t i = 0; i < size_; ++i) own_.push_back(given_ != nullptr ? given_[i] : same_);
    given_ = nullptr;
    return own_;
  }

  /// A view of every `width`-th number from `offset` on.
  Row row(int offset, int width) const {
    if (own_.empty() && given_ == nullptr) return {&same_, 0};
    return {(own_.empty() ? given_ : own_.data()) + offset, width};
  }

  friend bool operator==(const Column& a, const Column& b) {
    if (a.size_ != b.size_) return false;
    for (std::size_t i = 0; i < a.size_; ++i)
      if (a[i] != b[i]) return false;
    return true;
  }

 private:
  bool is_same(const T& value) const { return std::memcmp(&same_, &value, sizeof value) == 0; }

  std::size_t size_ = 0;
  const T* given_ = nullptr;
  T same_{};
  std::vector<T> own_;
};

/// A list of numbers that are mostly consecutive, stored as ranges.
class Ordinals {
 public:
  void push_back(int value) {
    if (runs_.empty() || runs_.back().second + static_cast<int>(size_ - runs_.back().first) != value)
      runs_.emplace_back(size_, value);
    ++size_;
  }
  /// Appends `count` consecutive numbers.
  void append(int first, std::size_t count) {
    if (count == 0) return;
    push_back(first);
    size_ += count - 1;
  }

  std::size_t size() const { return size_; }
  int operator[](std::size_t i) const {
    std::size_t low = 0, high = runs_.size();  // search for the last range that begins at or before i
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (runs_[middle].first <= i ? low : high) = middle;
    }
    return runs_[low].second + static_cast<int>(i - runs_[low].first);
  }

 private:
  std::size_t size_ = 0;
  std::vector<std::pair<std::size_t, int>> runs_;  // each range: index of its first number, and that number
};

}  // namespace pliant

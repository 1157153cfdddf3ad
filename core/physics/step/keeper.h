// What the next frame of a run depends on, kept as bytes and put back. One walk over a part does both, so that what
// is kept and what is put back cannot differ.
//
// Bytes are for the same scene in the same program: they are not checked, nor meant for a file.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace weft::physics {

class Keeper {
 public:
  Keeper() = default;  // keeps
  explicit Keeper(std::span<const std::byte> kept) : from_(kept), puts_back_(true) {}

  bool puts_back() const { return puts_back_; }
  std::vector<std::byte> take() { return std::move(kept_); }

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& value) { move(&value, sizeof value); }
  void operator()(std::string& text) { list(text); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values) { list(values); }
  template <class T>
  requires(!std::is_trivially_copyable_v<T>) void operator()(std::vector<T>& parts) {
    auto count = std::uint64_t(parts.size());
    (*this)(count);
    parts.resize(std::size_t(count));
    for (T& part : parts) (*this)(part);
  }
  // So many of what is there, wherever it lies.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void of(T* values, int count) { move(values, std::size_t(count) * sizeof(T)); }
  // Values of which most are zero.
  void sparse(float* values, int count) {
    std::vector<Other> others;
    for (int n = 0; n < count && !puts_back_; ++n)
      if (std::bit_cast<std::uint32_t>(values[n]) != 0) others.push_back({n, values[n]});
    list(others);
    if (!puts_back_) return;
    std::fill_n(values, count, 0.0f);
    for (const auto& [n, value] : others) values[n] = value;
  }

 private:
  struct Other {
    std::int32_t at;
    float value;
  };
  template <class List>
  void list(List& values) {
    auto count = std::uint64_t(values.size());
    (*this)(count);
    values.resize(std::size_t(count));
    move(values.data(), values.size() * sizeof values[0]);
  }
  void move(void* value, std::size_t bytes) {
    if (bytes == 0) return;
    if (puts_back_) {
      assert(bytes <= from_.size());
      std::memcpy(value, from_.data(), bytes);
      from_ = from_.subspan(bytes);
    } else {
      const auto* const first = static_cast<const std::byte*>(value);
      kept_.insert(kept_.end(), first, first + bytes);
    }
  }

  std::vector<std::byte> kept_;
  std::span<const std::byte> from_;
  bool puts_back_ = false;
};

}  // namespace weft::physics

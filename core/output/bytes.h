// Values as little-endian or big-endian bytes, whatever the machine's own order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace weft {

template <class T>
void append_little_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

template <class T>
void append_big_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

}  // namespace weft

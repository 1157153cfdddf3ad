// Hashes as 16 hexadecimal digits.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

namespace weft {

inline std::string hex16(std::uint64_t value) {
  char digits[16];
  const auto end = std::to_chars(digits, digits + 16, value, 16).ptr;
  const std::string text(digits, end);
  return std::string(16 - text.size(), '0') + text;
}

inline std::optional<std::uint64_t> from_hex16(const std::string& text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, 16);
  if (text.size() != 16 || error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace weft

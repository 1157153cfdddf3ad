// Cloths of made-up positions, as a simulation shows them, and values in the files made of them.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "weft/output.h"

namespace weft {

// A cloth of made-up positions with padded rows, as the simulation shows them.
class Sheet {
 public:
  Sheet(int columns, int rows) : columns_(columns), rows_(rows) {
    const auto size = static_cast<std::size_t>(rows) * kStride;
    x_.assign(size, kPadding);
    y_ = z_ = x_;
    move(0);
  }
  void move(float offset) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const auto n = static_cast<std::size_t>(j) * kStride + static_cast<std::size_t>(i);
        x_[n] = 0.1F * static_cast<float>(i) + offset;
        y_[n] = 1.0F / 3.0F;
        z_[n] = 0.1F * static_cast<float>(j);
      }
    }
  }
  ClothView view() const {
    ClothView view;
    view.columns = columns_;
    view.rows = rows_;
    view.stride = kStride;
    view.x = x_;
    view.y = y_;
    view.z = z_;
    return view;
  }

 private:
  static constexpr int kStride = 16;
  static constexpr float kPadding = 1e30F;  // must never be written
  int columns_, rows_;
  std::vector<float> x_, y_, z_;
};

inline View view_of(const std::vector<const Sheet*>& sheets) {
  View view;
  for (const Sheet* sheet : sheets) view.cloths.push_back(sheet->view());
  return view;
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace weft

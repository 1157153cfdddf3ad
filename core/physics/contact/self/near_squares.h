// Which squares of sheets are near each other: the pairs that self-collision among surfaces measures.
//
// Pairs are listed whose distance is less than what they are kept apart by, and somewhat beyond. As long
// as nothing has moved half as far as that, no others can touch. Then pairs are found again, by the same
// search as particles (pair_search.h), for those squares alone that have moved far; for all where these
// are many.
//
// A square is a pair with itself: folded along its diagonal, its A comes near its own BDC.
#pragma once

#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"
#include "physics/kernels/surface.h"

namespace weft::physics {

// Numbers of squares, two by two, with what kernels may read and write beyond the last.
struct SquarePairs {
  static constexpr std::size_t kPadding = 32;
  std::vector<std::int32_t> owner, neighbour;
  std::vector<float> near_squared;  // distance when they were measured last [m²]
  std::size_t count = 0;
  void reserve(std::size_t pairs);
  void pad();
  std::size_t bytes() const;
};

// Whether one of a square's four vertices is marked.
inline bool has_corner_in(const Square& square, const std::vector<std::uint8_t>& marked) {
  const auto at = [&](int c) { return marked[std::size_t(square.corner[c])]; };
  return (at(0) | at(1) | at(2) | at(3)) != 0;
}

class NearSquares {
 public:
  NearSquares(const std::vector<Sheet>& sheets, const KernelTable& kernels);

  // Particles of all sheets have numbers, row by row, and so have the squares that begin with them.
  std::size_t count() const { return squares_.size(); }
  std::size_t number(std::size_t sheet, int row, int column) const {
    return first_[sheet] + std::size_t(row) * std::size_t(sheets_[sheet].lattice->columns) +
           std::size_t(column);
  }
  const std::vector<Square>& squares() const { return squares_; }
  const std::vector<Vertex>& vertices() const { return vertices_; }

  // Squares with a particle that is marked are left out from the next update of all on.
  void leave_out(const std::vector<std::uint8_t>& marked) { passing_ = marked; }
  // Reads where all is now, and lists what is to be listed anew, or all. `frame`: a way that all have
  // gone together since the start [m], which is left out of account.
  void update(bool all, const float (&frame)[3], Threads& threads);
  SquarePairs& pairs() { return listed_; }
  // Squares that were torn at the last update and are whole at this.
  const std::vector<std::int32_t>& joined() const { return joined_; }
  // What pairs that are not listed are apart, at least [m].
  float unlisted() const { return least_ + (1 - 2 * kFar) * beyond_ - 2 * gone_; }

  // What neighbours on a sheet are kept apart [m], the most that any are, and how much farther apart
  // than that pairs are listed.
  float close() const { return close_; }
  float most() const { return most_; }
  float beyond() const { return beyond_; }
  // Squares whose pairs were listed so far, in times all of them.
  double listed() const;
  std::size_t bytes() const;

 private:
  // Of beyond(): vertices that have gone that far when others must be listed are listed anew, too.
  static constexpr float kFar = 1.0f / 6;

  struct Origin {
    float x[3], gone_squared;  // m, m²: where it was when its pairs were listed, how far off it is
  };
  struct LeftOut {
    std::int32_t number;
    float most_squared;  // m², of a corner's distance from the middle: nearer, it is whole
  };

  void make_squares();
  void read_vertices(Threads& threads);
  void look_how_far(const float (&frame)[3]);
  void look_who_joined();
  void list(bool all, const float (&frame)[3], Threads& threads);
  std::size_t choose(bool all, const float (&frame)[3]);
  float middle_of(std::size_t square, float (&middle)[3]) const;
  float list_whole(Spread& box, std::size_t& count);
  void fill_box(std::size_t sorted);
  void find_in(std::size_t chunk);
  void take_found();

  const std::vector<Sheet>& sheets_;
  const KernelTable& kernels_;
  std::vector<std::size_t> first_;  // number of every sheet's first particle
  std::vector<Square> squares_;
  std::vector<Vertex> vertices_;
  std::vector<Origin> origins_;
  float gone_ = 0;  // m, the farthest

  PairSearch search_;                  // among the middles of squares that are whole
  std::vector<std::uint8_t> chosen_;   // vertices, and
  std::vector<std::uint8_t> asked_;    // squares whose pairs are listed anew
  std::vector<std::int32_t> sorted_;   // numbers of squares as sorted by the search
  std::vector<SquareBox> boxes_;       // as sorted
  std::vector<SquarePairs> found_;     // of every chunk of the search
  std::vector<LeftOut> left_out_;      // squares that are torn
  std::vector<std::uint8_t> passing_;  // vertices of squares that are left out
  std::vector<std::int32_t> joined_;
  SquarePairs listed_;
  // m: the least and the most that any pair is kept apart
  float least_ = 0, most_ = 0, close_ = 0, beyond_ = 0;
  double squares_listed_ = 0;
};

}  // namespace weft::physics

// Self-collision, mode `surface`: vertices never pass through triangles, nor edges through edges.
//
// From time to time the least distance d of anything that a vertex belongs to from anything else that
// shares no corner with it is measured. What is nearer than the thickness is pushed apart then
// (kernels/surface.cpp), by a quarter of d at most, and the vertex has its place there, and a bound:
// what is left of 0.45 d. While no vertex is farther from its place than its bound, whatever two things
// were d apart are at least (1 - 2 · 0.45) d apart, on the whole way from there: nothing can have
// passed. So what has moved too far is put back to its bound. Below a floor bounds are nothing: however
// a collider or a pull presses, only pushing apart goes on, so that no distance dwindles to what
// rounding could cross. The common part of all motion is left out of account. (Conservative bounds on
// motion, as in Chen et al. 2025, Offset Geometric Contact; distances as in Bridson et al. 2002.)
//
// Vertices that come near their bounds are hot. Few of them are measured by themselves: they get a new
// bound, and all others keep what is left of theirs, about where they are, or less where a hot one has
// come near. Where many are hot, and every few substeps, all is measured.
//
// Pairs of squares of the sheets that are within reach, somewhat more than the thickness, are listed,
// and only these are measured as long as no others can touch. They are found by the same search as
// particles (pair_search.h), anew for those squares alone that have moved far; and each is measured
// once.
#pragma once

#include <memory>
#include <vector>

#include "physics/kernels/surface.h"
#include "physics/self_collision/blocks.h"
#include "physics/self_collision/pair_search.h"
#include "weft/scene.h"

namespace weft::physics {

class SurfaceContact {
 public:
  // Null unless a cloth asks for it; then over all cloths that take part in self-collision.
  static std::unique_ptr<SurfaceContact> make(const Scene& scene, const std::vector<Sheet>& sheets,
                                              const KernelTable& kernels);

  // Measures where all is now; nothing has crossed.
  void begin(Threads& threads);
  // Puts back what has moved too far in `since` substeps of dt, and measures what it is time for.
  // Returns after how many substeps to come again. Nothing has crossed afterwards.
  int run(double dt, int since, Threads& threads);

  void restart() { valid_ = false; }
  bool valid() const { return valid_; }
  // So far: times that all was measured, and a part, squares whose pairs were listed (in times all of them), and
  // vertices put back.
  std::int64_t measured() const { return measured_; }
  std::int64_t measured_in_part() const { return measured_in_part_; }
  double listed() const {
    return squares_listed_ / double(std::max<std::size_t>(squares_.size(), 1));
  }
  std::int64_t held_back() const { return held_back_; }
  std::size_t bytes() const;

 private:
  struct Place {
    float x[3], bound;  // m
    // m: where it was when its pairs were listed; m²: how far off it is now
    float listed[3], gone_squared;
  };
  struct Motion {     // of all vertices
    float share;      // greatest |displacement|/bound
    float rate;       // greatest speed/bound [1/s]
    float gone;       // m, greatest since pairs were listed
    std::size_t hot;  // vertices that are near their bounds
  };
  struct Pairs {
    std::vector<std::int32_t> owner, neighbour;
    std::vector<float> near_squared;  // m²
    std::size_t count = 0;
    void reserve(std::size_t pairs);
    void pad();
  };

  SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels);
  void read_vertices(Threads& threads);
  void list(Threads& threads);
  std::size_t choose(bool all);
  float middle_of(std::size_t square, float (&middle)[3]) const;
  float list_squares(Spread& box, std::size_t& count);
  bool come_together();
  void fill_box(std::size_t sorted);
  void find_in(std::size_t chunk);
  void take_found();
  void measure(bool all, Threads& threads);
  const Pairs& pairs_of_hot();
  void measure_piece(std::size_t piece);
  void sum_up(std::size_t begin, std::size_t end);
  void set_places_and_push(std::size_t sheet, int row, bool all);
  void hold(double seconds, double dt);
  // Of what listed pairs may be farther apart than is held: vertices that have gone that far when
  // others must be listed are listed anew, too.
  static constexpr float kFar = 1.0f / 6;
  // What pairs that are not listed are apart, at least [m].
  float unlisted() const { return least_ + (1 - 2 * kFar) * beyond_ - 2 * motion_.gone; }
  std::size_t number(std::size_t sheet, int row, int column) const {
    return first_[sheet] + std::size_t(row) * std::size_t(sheets_[sheet].lattice->columns) +
           std::size_t(column);
  }

  const std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  std::vector<std::size_t> first_;  // number of every sheet's first particle
  std::vector<Square> squares_;     // of every particle
  std::vector<Vertex> vertices_;
  std::vector<Place> places_;
  Motion motion_{};
  float frame_[3] = {};            // m: what has been common so far; places are apart from it
  std::vector<std::uint8_t> hot_;  // vertices that are near their bounds

  PairSearch search_;                 // among the middles of squares that are not torn
  std::vector<std::uint8_t> chosen_;  // vertices, and
  std::vector<std::uint8_t> asked_;   // squares whose pairs are listed anew
  std::vector<std::int32_t> sorted_;  // numbers of squares as sorted by the search
  std::vector<SquareBox> boxes_;      // as sorted
  std::vector<Pairs> found_;          // of every chunk of the search
  struct LeftOut {
    std::size_t number;
    float most_squared;  // m², of a corner's distance from the middle: nearer, it is whole
  };
  std::vector<LeftOut> left_out_;  // squares that are torn
  Pairs listed_;                   // numbers of squares
  Pairs of_hot_;                   // of these, what hot vertices belong to
  const Pairs* pairs_ = &listed_;  // those that are measured this time
  struct Piece {                   // of the listed pairs: those that touch
    std::vector<SquaresTouching> touching;
    std::size_t touches = 0;
    std::vector<float> near_squared;  // m²
  };
  std::vector<Piece> pieces_;
  std::vector<SquareChange> sums_;   // of every square
  std::vector<float> near_squared_;  // and its distance from others, squared [m²]
  // m: the least that any pair is kept apart, how much farther apart pairs are listed, how far apart
  // any are then at most; what neighbours are kept apart; a distance that motion does not go below
  float least_ = 0, beyond_ = 0, reach_ = 0, close_ = 0, floor_ = 0;
  bool valid_ = false;
  int since_ = 0;  // substeps since all was measured
  std::int64_t measured_ = 0, measured_in_part_ = 0, held_back_ = 0;
  double squares_listed_ = 0;
};

}  // namespace weft::physics

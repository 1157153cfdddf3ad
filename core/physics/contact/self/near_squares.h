// Which squares of sheets are near each other: the pairs that contact among surfaces measures.
//
// Pairs are listed whose distance is less than what they are kept apart by, and somewhat beyond. As long
// as nothing has moved half as far as that, no others can touch. Then pairs are found again, by the same
// search as particles (pair_search.h), for those squares alone that have moved far; for all where these
// are many. Motion that is common to all is left out of account.
//
// Those that share a corner are looked at apart (beside_squares.h; of meshes beside_triangles.h). Triangles
// that seams bring beside each other are no pairs (over_seams.h).
#pragma once

#include <memory>
#include <vector>

#include "physics/contact/self/beside_squares.h"
#include "physics/contact/self/beside_triangles.h"
#include "physics/contact/self/mesh_squares.h"
#include "physics/contact/self/over_seams.h"
#include "physics/contact/self/pair_search.h"

namespace weft::physics {

class NearSquares {
 public:
  // Particles of sheets are bodies, named as in pair_search.h, and so are the squares of grids that begin
  // with them; those of meshes (mesh_squares.h) have the numbers beyond. `rest`: of every body.
  NearSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
              const std::vector<RestPlace>& rest, const KernelTable& kernels);

  const std::vector<Square>& squares() const { return squares_; }
  // What each of them owns; empty: all own all.
  const std::vector<std::uint8_t>& owned() const { return owned_; }

  // Squares with a particle that is marked, by its number, sheet after sheet, are left out from the next
  // update of all on.
  void leave_out(const std::vector<std::uint8_t>& marked);
  // Lists pairs anew where need be, or all, with the bodies where they are now.
  void update(bool all, const Place* now, Threads& threads);
  // Of the listed pairs those that come within `range` of each other in an interval [m], and of those
  // that share a corner what does not lie flat.
  const SquarePairs& within(float range, const Place* place, const Displacement* moved,
                            Threads& threads);
  // Of those found last what comes within a shorter range in the same interval, when nothing moves
  // otherwise by more than half of the difference.
  const SquarePairs& still_within(float range, const Place* place, const Displacement* moved,
                                  Threads& threads);

  // Squares whose pairs were listed so far, in times all of them.
  double listed() const;
  std::size_t bytes() const;

 private:
  // Of beyond_: vertices that have gone that far when others must be listed are listed anew, too.
  static constexpr float kFar = 1.0f / 6;

  struct Origin {
    float x[3], gone_squared;  // m, m²: where it was when its pairs were listed, how far off it is
  };
  struct LeftOut {
    std::int32_t number;
    float most_squared;  // m², of a corner's distance from the middle: nearer, it is whole
  };

  // The squares of a mesh.
  struct Part {
    std::size_t first, end;
    BesideTriangles beside;
  };

  void make_squares();
  void make_parts(const std::vector<RestPlace>& rest);
  bool beside(std::int32_t p, std::int32_t q) const;
  void bound(const Place* place, const Displacement* moved, Threads& threads);
  void bound_square(std::size_t n, const Place* place, const Displacement* moved);
  template <class Visit>
  void for_each_body(const Visit& visit) const;
  template <class Visit>
  void for_each_square(const Visit& visit) const;
  void look_how_far();
  void look_who_joined();
  // What pairs that are not listed are apart, at least, less what they are kept apart [m].
  float left() const { return (1 - 2 * kFar) * beyond_ - 2 * gone_; }
  void list(bool all, Threads& threads);
  std::size_t choose(bool all);
  float middle_of(std::size_t square, float (&middle)[3]) const;
  float list_whole(Spread& box, std::size_t& count);
  void fill_box(std::size_t sorted);
  void find_in(std::size_t chunk);
  void take_found();
  void sort_listed();

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const KernelTable& kernels_;
  std::vector<Square> squares_;
  std::vector<std::int32_t> stride_;  // of every body's sheet
  std::vector<std::uint8_t> owned_;
  std::vector<float> most_squared_;  // m², of every square, as LeftOut::most_squared
  std::vector<std::unique_ptr<Part>> parts_;
  const OverSeams seams_;
  BesideSquares beside_;
  const Place* now_ = nullptr;
  std::vector<Origin> origins_;
  float frame_[3] = {};  // m: what has been common so far
  float gone_ = 0;       // m, the farthest

  PairSearch search_;                  // among the middles of squares that are whole
  std::vector<std::uint8_t> chosen_;   // vertices, and
  std::vector<std::uint8_t> asked_;    // squares whose pairs are listed anew
  std::vector<std::int32_t> sorted_;   // numbers of squares as sorted by the search
  std::vector<SquareBox> boxes_;       // as sorted, or of all in an interval
  std::vector<SquarePairs> found_;     // of every chunk of the search, or of the list
  std::vector<LeftOut> left_out_;      // squares that are torn
  std::vector<std::uint8_t> passing_;  // vertices of squares that are left out
  std::vector<std::int32_t>
      joined_;  // squares that were torn at the last update and are whole at this
  SquarePairs listed_, within_, still_;
  std::vector<std::int32_t> begin_;  // of every owner's pairs, to sort them
  float within_range_ = 0;           // m: of within_
  float most_ = 0, beyond_ = 0;      // m: the most that any pair is kept apart
  double squares_listed_ = 0;
  std::size_t all_squares_ = 0;
};

}  // namespace weft::physics

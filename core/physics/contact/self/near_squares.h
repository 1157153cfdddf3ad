// Which squares of sheets are near each other: the pairs that contact among surfaces measures.
//
// Pairs are listed whose distance is less than what they are kept apart by, and somewhat beyond. As long
// as nothing has moved half as far as that, no others can touch. Then pairs are found again, by the same
// search as particles (pair_search.h), for those squares alone that have moved far; for all where these
// are many. Motion that is common to all is left out of account.
//
// Of the listed pairs, and of those that share a corner, most sleep: how far apart they are is measured when they
// are looked at, and they are not looked at again before they may have come within range (square_ways.h). So what is
// measured in an interval are those that may touch in it.
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
#include "physics/contact/self/square_ways.h"

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
  // No pair sleeps: bodies are elsewhere than where they were left.
  void wake();
  // A body that was where it is now has been put elsewhere, so far [m].
  void shift(std::int32_t body, float way) { ways_.shift(body, way); }
  // Of the listed pairs those that come within `range` of each other in an interval [m], and of those
  // that share a corner what does not lie flat. Once an interval, always with the same range: pairs sleep.
  const SquarePairs& within(float range, const Place* place, const Displacement* moved,
                            Threads& threads);
  // The same for other displacements in an interval, with all pairs, whether they sleep or not.
  const SquarePairs& all_within(float range, const Place* place, const Displacement* moved,
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

  struct Room {  // of one piece of a list
    std::vector<std::int32_t> owner, neighbour, awake;
    std::vector<std::size_t> asked;
    std::vector<float> gap;
  };

  // The squares of a mesh.
  struct Part {
    std::size_t first, end;
    BesideTriangles beside;
  };

  void make_squares();
  void make_parts(const std::vector<RestPlace>& rest);
  bool beside(std::int32_t p, std::int32_t q) const;
  template <class Visit>
  void share_squares(Threads& threads, const Visit& visit) const;
  void bound(const Place* place, const Displacement* moved, Threads& threads);
  void bound_square(std::size_t n, const Place* place, const Displacement* moved);
  void add_ways(const Displacement* moved, Threads& threads);
  void list_beside(bool all, const Place* place, Threads& threads);
  void drop_alike(const Place* place);
  float& until(std::size_t pair);
  bool stays_away(std::size_t pair, float gap, float range, const Place* place);
  void take_awake(std::size_t first, std::size_t count, float range, Room& room,
                  SquarePairs& found);
  float box_gap(std::int32_t a, std::int32_t b) const;
  void put_to_sleep(std::size_t first, std::size_t count, float range, const Place* place,
                    Room& room, SquarePairs& kept);
  void keep_not_apart(float range, const Place* place, const Displacement* moved,
                      SquarePairs& found) const;
  void make_room(std::size_t pieces);
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
  void sort_by(std::vector<std::int32_t> SquarePairs::*number);
  void sleep_as_before();

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const KernelTable& kernels_;
  std::vector<Square> squares_;
  std::vector<std::int32_t> stride_;  // of every body's sheet
  std::vector<std::uint8_t> owned_;
  std::vector<float> most_squared_;  // m², of every square, as LeftOut::most_squared
  std::vector<std::unique_ptr<Part>> parts_;
  const OverSeams seams_;
  SquareWays ways_;
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
  std::vector<std::uint8_t> passing_;  // vertices of squares that are left out; empty: none
  std::vector<std::int32_t>
      joined_;  // squares that were torn at the last update and are whole at this
  SquarePairs listed_, within_, still_, before_;
  // m, of every listed pair, until when it sleeps; and of those that were listed before.
  std::vector<float> until_, sorted_until_, before_until_;
  std::vector<Room> rooms_;       // of every piece of a list
  std::size_t beside_count_ = 0;  // of within_, the first are those of beside_
  std::size_t turn_ = 0;
  std::vector<std::int32_t> begin_;  // of every owner's pairs, to sort them
  float within_range_ = 0;           // m: of within_
  float most_ = 0, beyond_ = 0;      // m: the most that any pair is kept apart
  double squares_listed_ = 0;
  std::size_t all_squares_ = 0;
};

}  // namespace weft::physics

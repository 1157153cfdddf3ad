// The wavefront: runs the stages of many substeps over the rows of a lattice, on any number of
// threads, with the result of running them one after the other.
//
// Stage q may work on row j as soon as stage q-1 is past row j + reach(q): all that stage q touches
// is then final. So stage q follows `offset(q)` rows behind stage 0, offset(q) = offset(q-1) +
// reach(q), through one substep after another. Rows are cut into tiles that lean with the offsets:
// tile k of a chunk of substeps runs stage q on rows [k h - offset(q), (k+1) h - offset(q)). A tile
// needs the tile before it in its chunk, and in the chunk before the tile that lies past its reach;
// nothing else. Tiles of several chunks are under way at once, without a barrier, and a tile's rows
// stay in the cache for all its substeps (time skewing: Wonnacott 2000; Strzodka et al. 2011). How tall tiles and how
// long chunks are is foreseen to take least. On several threads, a substep by itself runs stage after stage.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "physics/step/stage.h"

namespace weft::physics {

class Threads;

class Wavefront {
 public:
  // Stages of one substep, in order. `row_bytes` sizes the tiles to the cache.
  Wavefront(std::vector<RowStage*> stages, int rows, std::size_t row_bytes, double row_nanoseconds);

  // What stages work out of the length of substeps [s]; run() does so, too, where that has not been done.
  void prepare(double dt);

  // Only the rows of `awake` are worked on, spans in order and apart; empty: all rows. The `observer`
  // keeps all rows as they are before, and looks at them after.
  void run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake = {},
           RowObserver* observer = nullptr);

  // Adds to nanoseconds[q] the time that stage q took; off when null.
  void profile(std::span<std::atomic<std::int64_t>> nanoseconds) { profile_ = nanoseconds; }

 private:
  struct Run;
  // A few substeps in a row, and the tiles that they are cut into.
  struct Chunk {
    int first, count;  // substeps
    int slot;          // of the first
    int tiles;
    int span;  // tile k of the next chunk waits for tile k + span of this one,
    int last;  // tile `last` of the next chunk for the last of this one, those after it for none
  };
  // How several threads share a run out.
  struct Shape {
    int substeps = 1;     // of a chunk, at most
    int height = 1;       // rows of a tile
    bool rising = false;  // the first and last chunks are shorter
  };
  struct Shared {
    int count = 0, threads = 0;  // of substeps, that share them
    Shape shape;
  };
  void choose_tiles(int count);
  void choose_shared_tiles(int count, int threads);
  Shape best_shape(int count, int threads);
  void choose_chunks(int count, int threads, const Shape& shape);
  double estimate(int threads);
  double row_nanoseconds(int substeps, int threads) const;
  int lean(int substeps) const;
  Chunk chunk(int number, int first, int count) const;
  void run_tile(const Run& run, int tile, const Chunk& chunk) const;
  RowSpan tile_rows(int tile, int offset) const;
  RowSpan rows_of(int tile, const Chunk& chunk) const;
  void run_one_by_one(const Run& run, Threads& threads);
  void run_stage(const Run& run, std::size_t stage, RowSpan rows, const Substep& substep) const;
  static void run_rows(const Run& run, RowStage& stage, RowSpan rows, const Substep& substep);
  void run_parallel(const Run& run, Threads& threads);
  void work(const Run& run);
  void work_recorded(const Run& run);
  int run_and_release(const Run& run, int tile);

  std::vector<RowStage*> stages_;
  int rows_;
  std::size_t row_bytes_;
  double row_nanoseconds_;
  int reach_ = 0;  // of all stages together
  std::span<std::atomic<std::int64_t>> profile_;

  double prepared_dt_ = 0;
  int chunk_substeps_ = 1;  // at most
  int height_ = 1, ring_ = 1;
  std::vector<int> offset_;  // of every stage of every substep of the longest chunk
  std::vector<Chunk> chunks_;
  Shared shared_;  // what the chunks are for
  std::array<Shared, 8>
      chosen_;  // the last: where sheets meet, few numbers of substeps come again and again
  std::size_t next_chosen_ = 0;
  std::vector<double> ends_;  // ns, of every chunk as it is foreseen
  int most_tiles_ = 1;        // of a chunk; tile k of chunk c has number c * most_tiles_ + k
  std::unique_ptr<std::atomic<int>[]> waits_;  // of every number: for how many other tiles
  std::unique_ptr<std::atomic<int>[]> queue_;  // numbers in the order in which they became ready
  int room_ = 0;                               // of both
  int all_ = 0;                                // tiles
  std::atomic<int> left_ = 0, queued_ = 0, taken_ = 0;
};

}  // namespace weft::physics

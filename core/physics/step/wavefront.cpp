// The wavefront over rows and substeps (wavefront.h).
#include "physics/step/wavefront.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

#include "physics/step/share_rows.h"

namespace weft::physics {
namespace {

// A core's share of the second-level cache that a tile may fill.
constexpr std::size_t kTileBytes = 384 * 1024;
constexpr std::size_t kSecondLevelBytes = 1024 * 1024;
constexpr int kLeastHeight = 8;   // rows
constexpr int kMostSubsteps = 8;  // of a chunk
// So many stages that their rows are better kept in the first-level cache: measured with sweeps.
constexpr std::size_t kManyStages = 5;
constexpr std::size_t kFirstLevelBytes = 40 * 1024;
constexpr int kManyStagesLeast = 4, kManyStagesMost = 16;  // rows
// Of a stage: threads meet for what takes them longer than to meet. Bending of 300 triangles takes 7 µs.
constexpr std::int64_t kFewItems = 256;

// What sharing rows costs [ns]: a tile, to be taken and told of; a byte of rows that come from the third level or from
// another core's caches, or from memory. Fitted to two threads over chunks of 2 to 8 substeps and tiles of 8 to 16
// rows: with less for a tile they foretell Gauss-Seidel and Jacobi on 100 points a side to 15 %; the rest is room for
// threads that wait for a busy core.
constexpr double kTileNanoseconds = 800, kCachedByte = 0.03, kMemoryByte = 0.1;
constexpr std::size_t kThirdLevelBytes = std::size_t(32) << 20;
// Rows of a tile where several threads share the sheet.
constexpr int kSharedHeights[] = {2, 3, 4, 6, 8, 12, 16};
constexpr std::size_t kMostTiles = std::size_t{1} << 21;  // of a run: each has a place in memory

constexpr int kNone = -1;  // no tile

}  // namespace

struct Wavefront::Run {
  const Substeps& substeps;
  std::span<const RowSpan> awake;
  RowObserver* observer;
  TaskRecord* record;
};

Wavefront::Wavefront(std::vector<RowStage*> stages, int rows, std::size_t row_bytes,
                     double row_nanoseconds)
    : stages_(std::move(stages)),
      rows_(rows),
      row_bytes_(row_bytes),
      row_nanoseconds_(row_nanoseconds) {
  for (const RowStage* s : stages_) reach_ += s->reach;
  int offset = 0;
  for (int s = 0; s < kMostSubsteps; ++s)
    for (std::size_t q = 0; q < stages_.size(); ++q) {
      if (s + q > 0) offset += stages_[q]->reach;
      offset_.push_back(offset);
    }
}

// How far the last stage of so many substeps lies behind the first.
int Wavefront::lean(int substeps) const {
  return offset_[std::size_t(substeps) * stages_.size() - 1];
}

// One thread and a lattice that fits the cache: one tile a substep. Else tiles as tall as the cache allows, and many
// substeps a chunk: that its lean leaves the cache costs less than to come by more often.
void Wavefront::choose_tiles(int count) {
  const int reach = std::max(reach_, 1);
  const std::size_t bytes = row_bytes_ * std::size_t(rows_);
  chunk_substeps_ = 1;
  height_ = rows_ + reach;
  if (bytes <= kSecondLevelBytes && stages_.size() >= kManyStages) {
    const int rows = int(kFirstLevelBytes / std::max<std::size_t>(row_bytes_, 1));
    height_ = std::min(height_, std::clamp(rows, kManyStagesLeast, kManyStagesMost));
  } else if (bytes > kTileBytes) {
    const int cache_rows = int(kTileBytes / std::max<std::size_t>(row_bytes_, 1));
    // A tile and its lean share the cache.
    height_ = std::clamp(std::max({2 * reach, cache_rows / 2, kLeastHeight}), 1, rows_);
    chunk_substeps_ =
        bytes > kSecondLevelBytes ? kMostSubsteps : std::clamp(height_ / reach, 1, kMostSubsteps);
    chunk_substeps_ = std::clamp(count, 1, chunk_substeps_);
  }
  ring_ = 1;
  shared_ = {};
}

// Tiles and chunks for several threads: those that are done soonest. Long chunks fetch rows seldom, but threads
// wait for each other at both ends of a frame, and at every chunk where the sheet is not tall enough for all of
// them at once; low tiles cost more, and follow each other closely.
void Wavefront::choose_shared_tiles(int count, int threads) {
  if (count == shared_.count && threads == shared_.threads) return;
  ring_ = threads + 1;
  const auto known = std::find_if(chosen_.begin(), chosen_.end(), [&](const Shared& s) {
    return s.count == count && s.threads == threads;
  });
  shared_ = known != chosen_.end() ? *known : Shared{count, threads, best_shape(count, threads)};
  if (known == chosen_.end()) chosen_[next_chosen_++ % chosen_.size()] = shared_;
  choose_chunks(count, threads, shared_.shape);
}

Wavefront::Shape Wavefront::best_shape(int count, int threads) {
  double least = std::numeric_limits<double>::infinity();
  const int most = std::clamp(count / threads, 1, kMostSubsteps);
  Shape best{most, rows_, false};
  for (int substeps = 1; substeps <= most; ++substeps)
    for (const int height : kSharedHeights)
      for (const bool rising : {false, true}) {
        if (rising && substeps == 1) continue;
        const Shape shape{substeps, std::min(height, rows_), rising};
        choose_chunks(count, threads, shape);
        if (chunks_.size() * std::size_t(most_tiles_) > kMostTiles) continue;
        const double ns = estimate(threads);
        if (ns < least) least = ns, best = shape;
      }
  return best;
}

// What a run in these chunks takes [ns]: each goes to the thread that is free first, begins when the one before it
// is far enough ahead, and does not overtake it. Tiles at both ends of the sheet have fewer rows.
double Wavefront::estimate(int threads) {
  ends_.clear();
  double start = 0;
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    const double row = row_nanoseconds(chunk.count, threads);
    const double tile = height_ * row + kTileNanoseconds;
    if (c >= std::size_t(threads)) start = std::max(start, ends_[c - std::size_t(threads)]);
    double end = start + rows_ * row + chunk.tiles * kTileNanoseconds;
    if (c > 0) end = std::max(end, ends_.back() + tile);
    ends_.push_back(end);
    start += (chunk.span + 1) * tile;
  }
  return ends_.back();
}

// Of a row of a chunk.
double Wavefront::row_nanoseconds(int substeps, int threads) const {
  const int touched = height_ + lean(substeps) + stages_.front()->reach;
  const bool stay = row_bytes_ * std::size_t(touched) <= kSecondLevelBytes;
  // Chunks follow each other closely: the first of them brings rows from memory.
  const bool far = row_bytes_ * std::size_t(rows_) > kThirdLevelBytes;
  const double byte = far ? kCachedByte + (kMemoryByte - kCachedByte) / threads : kCachedByte;
  return row_nanoseconds_ * substeps + double(row_bytes_) * byte * (stay ? 1 : substeps);
}

Wavefront::Chunk Wavefront::chunk(int number, int first, int count) const {
  const int offset = lean(count);
  const int tiles = (rows_ + offset + height_ - 1) / height_;
  const int span = (offset + stages_.front()->reach + height_ - 1) / height_;
  const int slot = number % ring_ * chunk_substeps_;
  return {first, count, slot, tiles, span, std::max(0, tiles - 1 - span)};
}

// `rising`: the first chunks grow evenly up to the longest, and the last shrink. A thread begins when the one
// before it is span + 1 tiles ahead, the last of T threads so when (span + 1) T tiles of the mean
// length (first + longest)/2 are done; the first chunk, of t tiles, is to last just as long:
//
//   first/longest = (span + 1) T / (2 t - (span + 1) T).
//
// The chunks between are as long as each other, as many for every thread.
void Wavefront::choose_chunks(int count, int threads, const Shape& shape) {
  chunk_substeps_ = shape.substeps;
  height_ = shape.height;
  chunks_.clear();
  most_tiles_ = 0;
  auto add = [&, first = 0](int length) mutable {
    chunks_.push_back(chunk(int(chunks_.size()), first, length));
    most_tiles_ = std::max(most_tiles_, chunks_.back().tiles);
    first += length;
  };
  const Chunk whole = chunk(0, 0, chunk_substeps_);
  const double ramp = double(whole.span + 1) * threads;
  const double first_share = std::clamp(ramp / std::max(2 * whole.tiles - ramp, 1.0), 0.0, 1.0);
  const auto length = [&](int n) {
    const double share = first_share + (1 - first_share) * (n - 1) / (threads - 1);
    return std::max(1, int(std::lround(chunk_substeps_ * share)));
  };
  int rising = 1;
  for (; shape.rising && rising < threads && count >= 2 * length(rising) + chunk_substeps_;
       ++rising) {
    add(length(rising));
    count -= 2 * length(rising);
  }
  int between = (count + chunk_substeps_ - 1) / chunk_substeps_;
  between = std::min(count, (between + threads - 1) / threads * threads);
  for (int n = 0; n < between; ++n) add(count / between + (n < count % between));
  while (--rising > 0) add(length(rising));
}

void Wavefront::prepare(double dt) {
  if (dt == prepared_dt_) return;
  for (RowStage* s : stages_) s->prepare(dt);
  prepared_dt_ = dt;
}

void Wavefront::run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake,
                    RowObserver* observer) {
  // Spans are in order, apart, and within the rows.
  assert(std::adjacent_find(awake.begin(), awake.end(), [](const RowSpan& a, const RowSpan& b) {
           return a.end > b.begin;
         }) == awake.end());
  assert(awake.empty() || (awake.front().begin >= 0 && awake.back().end <= rows_));
  const Run r{substeps, awake, observer, threads.record()};
  const bool several = threads.count() > 1;
  if (!several)
    choose_tiles(substeps.count);
  else if (substeps.count > 1)
    choose_shared_tiles(substeps.count, threads.count());
  prepare(substeps.dt);
  for (RowStage* s : stages_) s->reserve(chunk_substeps_ * ring_);
  if (several && substeps.count == 1) return run_one_by_one(r, threads);
  if (several && rows_ > height_) return run_parallel(r, threads);
  for (int first = 0; first < substeps.count; first += chunk_substeps_) {
    const Chunk next = chunk(0, first, std::min(chunk_substeps_, substeps.count - first));
    for (int k = 0; k < next.tiles; ++k) run_tile(r, k, next);
  }
}

void Wavefront::run_rows(const Run& r, RowStage& stage, RowSpan rows, const Substep& substep) {
  if (r.awake.empty()) return stage.run(rows.begin, rows.end, substep);
  for (const RowSpan& span : r.awake) {
    const int begin = std::max(rows.begin, span.begin), end = std::min(rows.end, span.end);
    if (begin >= end) continue;
    if (begin == span.begin) stage.start(substep);
    stage.run(begin, end, substep);
  }
}

RowSpan Wavefront::tile_rows(int tile, int offset) const {
  return {std::clamp(tile * height_ - offset, 0, rows_),
          std::clamp((tile + 1) * height_ - offset, 0, rows_)};
}

// All that a tile touches.
RowSpan Wavefront::rows_of(int tile, const Chunk& chunk) const {
  return {tile_rows(tile, lean(chunk.count)).begin, tile_rows(tile, -stages_.front()->reach).end};
}

// Tiles of a single substep follow one on the other: stages whose rows are apart are shared out by themselves.
void Wavefront::run_one_by_one(const Run& r, Threads& threads) {
  const Substep substep = r.substeps.at(0);
  if (r.observer)
    share_rows(threads, rows_, false, [&](RowSpan rows) { r.observer->before(rows); });
  for (std::size_t q = 0; q < stages_.size(); ++q) {
    if (r.record) r.record->enter(stages_[q]->name);
    share_rows(threads, rows_, !stages_[q]->rows_apart() || stages_[q]->items < kFewItems,
               [&](RowSpan rows) { run_stage(r, q, rows, substep); });
  }
  if (r.observer) share_rows(threads, rows_, false, [&](RowSpan rows) { r.observer->after(rows); });
}

void Wavefront::run_stage(const Run& r, std::size_t q, RowSpan rows, const Substep& substep) const {
  if (profile_.empty()) return run_rows(r, *stages_[q], rows, substep);
  const auto before = std::chrono::steady_clock::now();
  run_rows(r, *stages_[q], rows, substep);
  const auto spent = std::chrono::steady_clock::now() - before;
  profile_[q] += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
}

void Wavefront::run_tile(const Run& r, int tile, const Chunk& chunk) const {
  // The first stage reaches ahead of the tile.
  const int ahead = stages_.front()->reach;
  const RowSpan reached{tile == 0 ? 0 : tile_rows(tile, -ahead).begin, tile_rows(tile, -ahead).end};
  if (r.observer && chunk.first == 0 && reached.begin < reached.end) r.observer->before(reached);
  std::size_t level = 0;
  for (int s = 0; s < chunk.count; ++s) {
    const Substep substep = r.substeps.at(chunk.first + s, chunk.slot + s);
    for (std::size_t q = 0; q < stages_.size(); ++q, ++level) {
      const RowSpan rows = tile_rows(tile, offset_[level]);
      if (rows.begin < rows.end) run_stage(r, q, rows, substep);
    }
  }
  // What the last stage leaves behind is final.
  if (r.observer && chunk.first + chunk.count == r.substeps.count)
    r.observer->after(tile_rows(tile, offset_[level - 1]));
}

// Every tile counts the tiles it still waits for. Whoever finishes the last of them goes on with it,
// and puts others that have become ready into a queue, for whoever comes next.
void Wavefront::run_parallel(const Run& r, Threads& threads) {
  const int chunks = int(chunks_.size());
  if (const int room = chunks * most_tiles_; room > room_) {
    waits_ = std::make_unique<std::atomic<int>[]>(room);
    queue_ = std::make_unique<std::atomic<int>[]>(room);
    room_ = room;
  }
  all_ = 0;
  for (int c = 0; c < chunks; ++c)
    for (int k = 0; k < chunks_[c].tiles; ++k, ++all_) {
      const bool left = k > 0;
      const bool before = c > 0 && k <= chunks_[c - 1].last;
      const bool slot = c >= ring_ && k == 0;
      waits_[c * most_tiles_ + k].store(left + before + slot, std::memory_order_relaxed);
      queue_[all_].store(kNone, std::memory_order_relaxed);
    }
  left_.store(all_, std::memory_order_relaxed);
  taken_.store(0, std::memory_order_relaxed);
  queue_[0].store(0, std::memory_order_relaxed);
  queued_.store(1, std::memory_order_relaxed);
  if (r.record) return work_recorded(r);
  threads.share(std::size_t(threads.count()), false, [&](std::size_t) { work(r); });
}

void Wavefront::work_recorded(const Run& r) {
  r.record->enter(stages_.front()->name + (stages_.size() > 1 ? " … " + stages_.back()->name : ""));
  r.record->open(row_bytes_);
  work(r);
  r.record->close();
}

// One thread's part: tiles from the queue, in the order in which they became ready.
void Wavefront::work(const Run& r) {
  for (int place; (place = taken_.fetch_add(1, std::memory_order_relaxed)) < all_;) {
    int tile;
    for (Patience patience; (tile = queue_[place].load(std::memory_order_acquire)) == kNone;) {
      if (left_.load(std::memory_order_acquire) == 0) return;
      patience.wait();
    }
    while (tile != kNone) tile = run_and_release(r, tile);
  }
}

// Runs a tile, and returns one that has become ready by that, or kNone.
int Wavefront::run_and_release(const Run& r, int tile) {
  const int k = tile % most_tiles_, c = tile / most_tiles_;
  const Chunk& chunk = chunks_[c];
  if (r.record) r.record->begin(tile, rows_of(k, chunk), chunk.first, chunk.count);
  run_tile(r, k, chunk);
  if (r.record) r.record->end();
  int next = kNone;
  const auto release = [&](int kk, int cc) {
    const int waiting = cc * most_tiles_ + kk;
    if (r.record) r.record->depends(waiting, tile);
    if (waits_[waiting].fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    if (next == kNone)
      next = waiting;
    else
      queue_[queued_.fetch_add(1, std::memory_order_relaxed)].store(waiting,
                                                                    std::memory_order_release);
  };
  const int chunks = int(chunks_.size());
  const bool last = k == chunk.tiles - 1;
  if (!last) release(k + 1, c);
  if (c + 1 < chunks) {
    if (last)
      release(chunk.last, c + 1);
    else if (k >= chunk.span && k - chunk.span < chunk.last)
      release(k - chunk.span, c + 1);
  }
  if (last && c + ring_ < chunks) release(0, c + ring_);
  left_.fetch_sub(1, std::memory_order_acq_rel);
  return next;
}

}  // namespace weft::physics

// The wavefront over rows and substeps (wavefront.h).
#include "physics/wavefront.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "physics/threads.h"

namespace weft::physics {
namespace {

// A core's share of the second-level cache that a tile may fill.
constexpr std::size_t kTileBytes = 384 * 1024;
// So many stages that their rows are better kept in the first-level cache: measured with sweeps.
constexpr std::size_t kManyStages = 5;
constexpr int kManyStagesHeight = 16;
constexpr int kSharedHeight = 16;  // so that all threads are busy to the end of a frame
// The least work worth a task [ns].
constexpr double kTaskNanoseconds = 12000;
constexpr double kSharedNanoseconds = 4000;  // and sharing out where nobody has to be woken

constexpr int kNone = -1;  // no tile

}  // namespace

struct Wavefront::Run {
  const Substeps& substeps;
  int chunks;
  std::span<const RowSpan> awake;
};

Wavefront::Wavefront(std::vector<RowStage*> stages, int rows, std::size_t row_bytes,
                     double row_nanoseconds)
    : stages_(std::move(stages)),
      rows_(rows),
      row_bytes_(row_bytes),
      row_nanoseconds_(row_nanoseconds) {
  for (const RowStage* s : stages_) reach_ += s->reach;
}

// One thread and a lattice that fits the cache: one tile a substep. Else tiles as tall as the cache
// allows, or as a task is worth, and as many substeps a chunk as its lean permits.
void Wavefront::choose_tiles(int count, int threads) {
  const int reach = std::max(reach_, 1);
  const bool fits = row_bytes_ * rows_ <= kTileBytes;
  chunk_substeps_ = 1;
  height_ = rows_ + reach;
  if (threads == 1 && stages_.size() >= kManyStages) {
    height_ = std::min(height_, kManyStagesHeight);
  } else if (threads > 1 || !fits) {
    const int cache_rows = std::max<int>(4, int(kTileBytes / std::max<std::size_t>(row_bytes_, 1)));
    // A tile and its lean share the cache; several tiles per thread keep all threads busy.
    height_ = std::max(2 * reach, cache_rows / 2);
    if (threads > 1)
      height_ = std::min(height_, std::max(std::min(rows_ / (4 * threads), kSharedHeight), reach));
    height_ = std::clamp(height_, 1, rows_);
    chunk_substeps_ = std::clamp(height_ / reach, 1, 8);
    const double tile = row_nanoseconds_ * height_;
    if (threads > 1)
      chunk_substeps_ =
          std::max(chunk_substeps_, std::min(8, int(std::ceil(kTaskNanoseconds / tile))));
    chunk_substeps_ = std::min(chunk_substeps_, count);
  }
  offset_.clear();
  int offset = 0;
  for (int s = 0; s < chunk_substeps_; ++s)
    for (std::size_t q = 0; q < stages_.size(); ++q) {
      if (s + q > 0) offset += stages_[q]->reach;
      offset_.push_back(offset);
    }
  tiles_ = (rows_ + offset + height_ - 1) / height_;
  span_ = (offset + stages_.front()->reach + height_ - 1) / height_;
  ring_ = threads > 1 ? threads + 1 : 1;
}

void Wavefront::run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake) {
  // Tiles of one substep follow one on the other, unless no row reaches another.
  const bool apart = reach_ == 0 && substeps.count == 1;
  const int at_once = substeps.count > 1 || apart ? threads.count() : 1;
  choose_tiles(substeps.count, at_once);
  if (substeps.dt != prepared_dt_)
    for (RowStage* s : stages_) s->prepare(substeps.dt);
  prepared_dt_ = substeps.dt;
  const Run r{substeps, (substeps.count + chunk_substeps_ - 1) / chunk_substeps_, awake};
  if (const int slots = chunk_substeps_ * ring_; slots > slots_) {
    for (RowStage* s : stages_) s->reserve_slots(slots);
    slots_ = slots;
  }
  if (apart)
    return threads.share(std::size_t(tiles_),
                         at_once == 1 || row_nanoseconds_ * rows_ < kSharedNanoseconds,
                         [&](std::size_t k) { run_tile(r, int(k), 0); });
  if (at_once > 1 && tiles_ > 1) return run_parallel(r, threads);
  for (int c = 0; c < r.chunks; ++c)
    for (int k = 0; k < tiles_; ++k) run_tile(r, k, c);
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

void Wavefront::run_tile(const Run& r, int tile, int chunk) const {
  const int first = chunk * chunk_substeps_;
  const int last = std::min(first + chunk_substeps_, r.substeps.count);
  std::size_t level = 0;
  for (int s = first; s < last; ++s) {
    const Substep substep = r.substeps.at(s, chunk % ring_ * chunk_substeps_ + (s - first));
    for (std::size_t q = 0; q < stages_.size(); ++q, ++level) {
      const int begin = std::max(0, tile * height_ - offset_[level]);
      const int end = std::min(rows_, (tile + 1) * height_ - offset_[level]);
      if (begin >= end) continue;
      RowStage& stage = *stages_[q];
      if (profile_.empty()) {
        run_rows(r, stage, {begin, end}, substep);
        continue;
      }
      const auto before = std::chrono::steady_clock::now();
      run_rows(r, stage, {begin, end}, substep);
      const auto spent = std::chrono::steady_clock::now() - before;
      profile_[q] += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
    }
  }
}

// Every tile counts the tiles it still waits for. Whoever finishes the last of them goes on with it,
// and puts others that have become ready into a queue, for whoever comes next.
void Wavefront::run_parallel(const Run& r, Threads& threads) {
  const int all = tiles_ * r.chunks;
  if (all > room_) {
    waits_ = std::make_unique<std::atomic<int>[]>(all);
    queue_ = std::make_unique<std::atomic<int>[]>(all);
    room_ = all;
  }
  for (int c = 0; c < r.chunks; ++c)
    for (int k = 0; k < tiles_; ++k) {
      const bool left = k > 0;
      const bool before = c > 0 && k + span_ < tiles_;
      const bool before_all = c > 0 && k == std::max(0, tiles_ - 1 - span_) && !before;
      const bool slot = c >= ring_ && k == 0;
      waits_[c * tiles_ + k].store(left + before + before_all + slot, std::memory_order_relaxed);
      queue_[c * tiles_ + k].store(kNone, std::memory_order_relaxed);
    }
  left_.store(all, std::memory_order_relaxed);
  taken_.store(0, std::memory_order_relaxed);
  queue_[0].store(0, std::memory_order_relaxed);
  queued_.store(1, std::memory_order_relaxed);
  threads.share(std::size_t(threads.count()), false, [&](std::size_t) { work(r); });
}

// One thread's part: tiles from the queue, in the order in which they became ready.
void Wavefront::work(const Run& r) {
  const int all = tiles_ * r.chunks;
  for (int place; (place = taken_.fetch_add(1, std::memory_order_relaxed)) < all;) {
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
  const int k = tile % tiles_, c = tile / tiles_;
  run_tile(r, k, c);
  int next = kNone;
  const auto release = [&](int kk, int cc) {
    const int waiting = cc * tiles_ + kk;
    if (waits_[waiting].fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    if (next == kNone)
      next = waiting;
    else
      queue_[queued_.fetch_add(1, std::memory_order_relaxed)].store(waiting,
                                                                    std::memory_order_release);
  };
  if (k + 1 < tiles_) release(k + 1, c);
  if (c + 1 < r.chunks) {
    if (k == tiles_ - 1)
      release(std::max(0, tiles_ - 1 - span_), c + 1);
    else if (k >= span_)
      release(k - span_, c + 1);
  }
  if (k == tiles_ - 1 && c + ring_ < r.chunks) release(0, c + ring_);
  left_.fetch_sub(1, std::memory_order_acq_rel);
  return next;
}

}  // namespace weft::physics

// The blocks of self-collision (blocks.h).
#include "physics/contact/self/blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft::physics {
namespace {

constexpr float kFlatter = 0.04f;  // of ρ: what is let go must be so much flatter than it must stay
constexpr double kNearPatches = 4;      // thicknesses: beyond what may touch, and a skin
constexpr std::size_t kPadding = 16;    // that kernels may read and write
constexpr std::size_t kFewBlocks = 24;  // that one thread measures faster

// Small sheets in small blocks, so that they have some; large ones in large, so that there are few.
int block_columns(const Sheet& sheet) {
  const int longest = std::max(sheet.columns, sheet.points->rows);
  return longest <= 160 ? 16 : longest <= 640 ? 32 : 64;
}

Spread both(const Spread& a, const Spread& b) {
  Spread s;
  for (int k = 0; k < 3; ++k) {
    s.low[k] = std::min(a.low[k], b.low[k]);
    s.high[k] = std::max(a.high[k], b.high[k]);
  }
  return s;
}

void widen(Spread& s, int k, float value) {
  s.low[k] = std::min(s.low[k], value);
  s.high[k] = std::max(s.high[k], value);
}

// The greatest difference of two values: no two differ by more than the box's diagonal.
float square_diagonal(const Spread& s) {
  float square = 0;
  for (int k = 0; k < 3; ++k) square += (s.high[k] - s.low[k]) * (s.high[k] - s.low[k]);
  return square;
}
float diagonal(const Spread& s) {
  return std::sqrt(square_diagonal(s));
}

struct Middle {
  float at[3], within;
};

Middle middle(const Spread& s) {
  Middle m{{}, 0.5f * diagonal(s)};
  for (int k = 0; k < 3; ++k) m.at[k] = 0.5f * (s.low[k] + s.high[k]);
  return m;
}

float dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

std::size_t count_particles(const std::vector<Sheet>& sheets) {
  std::size_t n = 0;
  for (const Sheet& s : sheets) n += std::size_t(s.points->count());
  return n;
}

void copy_meshes(const std::vector<Sheet>& sheets, Threads& threads) {
  for (const Sheet& s : sheets)
    if (s.mesh) s.mesh->copy(threads);
}

Blocks::Blocks(const std::vector<Sheet>& sheets, float least_ratio, const KernelTable& kernels)
    : sheets_(sheets), least_ratio_(least_ratio), kernels_(kernels) {
  cut(sheets);
  before_.resize(blocks_.size(), nothing());
  bounds_.resize(blocks_.size());
  flat_.resize(blocks_.size());
  edges_.resize(blocks_.size());
  near_.resize(blocks_.size() + kPadding);
  near_squared_.resize(blocks_.size() + kPadding);
  for (int k = 0; k < 3; ++k) {
    low_[k] = AlignedArray<float>(blocks_.size() + kPadding);
    high_[k] = AlignedArray<float>(blocks_.size() + kPadding);
  }
}

void Blocks::cut(const std::vector<Sheet>& sheets) {
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const Particles& p = *sheets[s].points;
    const bool mesh = sheets[s].mesh != nullptr;
    // Boxes of grids among surfaces go one particle farther, and are whole groups of lanes all the same.
    const int beyond = surfaces() && !mesh ? 1 : 0;
    const int wide = mesh ? sheets[s].columns : block_columns(sheets[s]) - beyond,
              tall = mesh ? 1 : (wide + beyond) / 2;
    const Extent e{int(blocks_.size()), (sheets[s].columns + wide - 1) / wide,
                   (p.rows + tall - 1) / tall};
    extents_.push_back(e);
    then_.emplace_back(p.rows, p.stride);
    patches_.push_back(mesh ? std::make_unique<FlatPatches>(
                                  *sheets[s].mesh, kNearPatches * double(sheets[s].thickness))
                            : nullptr);
    flat_patches_.emplace_back(mesh ? patches_.back()->pairs().size() : 0);
    for (int j = 0; j < e.down; ++j)
      for (int i = 0; i < e.across; ++i) {
        const int row = j * tall, column = i * wide, below = p.rows - row,
                  right = p.count(row) - column;
        blocks_.push_back({int(s), row, column, std::min(tall, below), std::min(wide, right), i, j,
                           std::min(tall + beyond, below), std::min(wide + beyond, right), false});
      }
  }
  borders_.resize(blocks_.size());
  for (std::size_t s = 0; s < sheets.size(); ++s)
    if (surfaces() && sheets[s].mesh)
      std::ranges::move(sheets[s].mesh->borders(), borders_.begin() + extents_[s].first);
}

// visit(block) for a block, and those beyond it along the row, the column and both.
template <class Visit>
void Blocks::for_each_of_square(std::size_t b, const Visit& visit) const {
  const Block& block = blocks_[b];
  const Extent& e = extents_[std::size_t(block.sheet)];
  const auto across = std::size_t(e.across);
  const bool along = block.across + 1 < e.across, below = block.down + 1 < e.down;
  visit(b);
  if (along) visit(b + 1);
  if (below) visit(b + across);
  if (along && below) visit(b + across + 1);
}

void Blocks::begin(Threads& threads) {
  std::fill(before_.begin(), before_.end(), nothing());
  measure(threads);
}

void Blocks::measure(Threads& threads) {
  threads.share(blocks_.size(), blocks_.size() < kFewBlocks, [&](std::size_t b) {
    measure_block(b);
    if (edges_[b]) measure_edges(b);
  });
  measure_flat(false);
}

void Blocks::measure_edges(Threads& threads) {
  threads.share(blocks_.size(), blocks_.size() < kFewBlocks,
                [&](std::size_t b) { measure_edges(b); });
  measure_flat(true);
}

void Blocks::measure_edges(std::size_t b) {
  const Block& block = blocks_[b];
  if (const auto& patches = patches_[std::size_t(block.sheet)])
    patches->measure(block.row, bounds_[b]);
  else
    kernels_.sheets.block_edges(rows_of(b));
}

// Of all squares, or of those that were nearly flat before.
void Blocks::measure_flat(bool all) {
  std::fill(edges_.begin(), edges_.end(), std::uint8_t(0));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Flat& f = flat_[b];
    if (!all && f.ratio <= f.needed) continue;
    f = flat(b);
    if (f.ratio > f.needed) for_each_of_square(b, [&](std::size_t of) { edges_[of] = 1; });
  }
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    if (patches_[s]) measure_flat_patches(s, all);
}

void Blocks::measure_flat_patches(std::size_t sheet, bool all) {
  const std::vector<FlatPatches::Pair>& pairs = patches_[sheet]->pairs();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Flat& f = flat_patches_[sheet][k];
    if (!all && f.ratio <= f.needed) continue;
    f = flat(sheet, pairs[k]);
    if (!(f.ratio > f.needed)) continue;
    for (const int patch : pairs[k].crossed) edges_[std::size_t(extents_[sheet].first + patch)] = 1;
  }
}

BlockRows Blocks::rows_of(std::size_t b) {
  const Block& block = blocks_[b];
  const Sheet& sheet = sheets_[std::size_t(block.sheet)];
  Particles& l = *sheet.points;
  BlockRows rows{};
  rows.columns = block.box_columns;
  rows.rows = block.box_rows;
  rows.edges_along = std::min(block.columns, sheet.columns - 1 - block.column);
  rows.edges_across = std::min(block.rows, l.rows - 1 - block.row);
  rows.stride = l.stride;
  rows.x = first_of(block, l.x);
  rows.v = first_of(block, l.v);
  rows.then = block.active ? ConstRow3(first_of(block, then_[std::size_t(block.sheet)]))
                           : ConstRow3(nullptr, nullptr, nullptr);
  rows.bounds = &bounds_[b];
  return rows;
}

void Blocks::measure_block(std::size_t b) {
  kernels_.sheets.block_bounds(rows_of(b));
  if (!borders_[b].empty()) measure_border(b);
  const Spread now = bounds_[b].x;
  bounds_[b].x = both(before_[b], now);
  before_[b] = now;
  for (int k = 0; k < 3; ++k) {
    low_[k][b] = bounds_[b].x.low[k];
    high_[k][b] = bounds_[b].x.high[k];
  }
}

void Blocks::measure_border(std::size_t b) {
  const auto sheet = std::size_t(blocks_[b].sheet);
  const Particles& p = *sheets_[sheet].points;
  BlockBounds& bounds = bounds_[b];
  for (const auto& [j, i] : borders_[b])
    for (int k = 0; k < 3; ++k) {
      widen(bounds.x, k, p.x.at(k, j, i));
      widen(bounds.v, k, p.v.at(k, j, i));
      if (blocks_[b].active) widen(bounds.moved, k, p.x.at(k, j, i) - then_[sheet].at(k, j, i));
    }
}

// ρ and its rate over a block and those beyond it, whose edges lead from any particle of the four to
// any other.
Blocks::Flat Blocks::flat(std::size_t b) const {
  const Block& block = blocks_[b];
  const Sheet& sheet = sheets_[std::size_t(block.sheet)];
  if (sheet.mesh) return {};
  if (std::abs(sheet.uv) > 1e-3f * std::sqrt(sheet.uu * sheet.vv)) return {};
  BlockBounds all = bounds_[b];
  for_each_of_square(b, [&](std::size_t other) { add_edges(other, all); });
  return flat(sheet, all);
}

// The same of a mesh over all patches between two.
Blocks::Flat Blocks::flat(std::size_t sheet, const FlatPatches::Pair& pair) const {
  const auto first = std::size_t(extents_[sheet].first);
  BlockBounds all = bounds_[first + std::size_t(pair.a)];
  for (const int patch : pair.crossed) add_edges(first + std::size_t(patch), all);
  return flat(sheets_[sheet], all);
}

void Blocks::add_edges(std::size_t other, BlockBounds& all) const {
  const BlockBounds& o = bounds_[other];
  all.along = both(all.along, o.along);
  all.across = both(all.across, o.across);
  all.change_along = std::max(all.change_along, o.change_along);
  all.change_across = std::max(all.change_across, o.change_across);
}

// With the bounds of all its edges, or gradients.
Blocks::Flat Blocks::flat(const Sheet& sheet, const BlockBounds& all) const {
  const Middle u = middle(all.along), v = middle(all.across);
  const float lu = std::sqrt(dot(u.at, u.at)), lv = std::sqrt(dot(v.at, v.at));
  const float ru = sheet.mesh ? 1 : std::sqrt(sheet.uu), rv = sheet.mesh ? 1 : std::sqrt(sheet.vv);
  const float askew = std::abs(dot(u.at, v.at)) / std::max(lu * lv, 1e-30f);
  const float root2 = std::sqrt(2.0f);
  Flat f;
  f.ratio = std::sqrt(std::max(0.0f, 1 - askew)) * std::min(lu / ru, lv / rv) -
            root2 * std::max(u.within / ru, v.within / rv);
  f.needed = least_ratio_ > 0 ? least_ratio_
                              : sheet.thickness / std::max(sheet.neighbour() * sheet.thickness,
                                                           sheet.mesh ? 0 : std::min(ru, rv));
  f.rate = root2 * std::max(std::sqrt(all.change_along) / ru, std::sqrt(all.change_across) / rv);
  return f;
}

auto Blocks::flat_about(std::size_t a, std::size_t b) const -> const Flat* {
  const Block &p = blocks_[a], &q = blocks_[b];
  if (p.sheet != q.sheet) return nullptr;
  if (const auto& patches = patches_[std::size_t(p.sheet)]) {
    const int pair = patches->pair(p.row, q.row);
    return pair < 0 ? nullptr : &flat_patches_[std::size_t(p.sheet)][std::size_t(pair)];
  }
  if (q.down - p.down > 1 || std::abs(q.across - p.across) > 1) return nullptr;
  const Extent& e = extents_[std::size_t(p.sheet)];
  const int i = std::max(0, std::min({p.across, q.across, e.across - 2}));
  const int j = std::max(0, std::min(p.down, e.down - 2));
  return &flat_[std::size_t(e.first + j * e.across + i)];
}

// Calls visit(a, b, gap²) for every pair a <= b of blocks whose boxes are nearer than a distance.
template <class Visit>
void Blocks::for_each_near(float distance, Visit&& visit) {
  NearBoxes boxes{};
  for (int k = 0; k < 3; ++k) {
    boxes.low[k] = low_[k].data();
    boxes.high[k] = high_[k].data();
  }
  boxes.end = int(blocks_.size());
  boxes.distance_squared = distance * distance;
  boxes.near = near_.data();
  boxes.square = near_squared_.data();
  for (std::size_t a = 0; a < blocks_.size(); ++a) {
    boxes.begin = int(a);
    boxes.box = bounds_[a].x;
    const int count = kernels_.sheets.near_boxes(boxes);
    for (int n = 0; n < count; ++n) visit(a, std::size_t(near_[n]), near_squared_[n]);
  }
}

Blocks::Outlook Blocks::look(float reach, float skin, float motion, double longest) {
  Spread velocities = nothing(), moves = nothing();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    velocities = both(velocities, bounds_[b].v);
    if (blocks_[b].active) moves = both(moves, bounds_[b].moved);
  }
  const float speed = diagonal(velocities);
  // No two that are listed have moved too far, or will.
  const bool settled = speed * longest <= motion && square_diagonal(moves) <= skin * skin;
  Outlook out{true, longest, false};
  const auto sooner = [&](double seconds) { out.seconds = std::min(out.seconds, seconds); };
  const auto visit = [&](std::size_t a, std::size_t b, float square) {
    if (settled && out.touching && blocks_[a].active && blocks_[b].active) return;
    const bool apart = square > reach * reach;
    const float way = motion + (apart ? std::sqrt(square) - reach : 0);
    // Until they have moved so far against each other.
    const double moved = way / std::sqrt(square_diagonal(both(bounds_[a].v, bounds_[b].v)));
    const Flat* const flat = flat_about(a, b);
    const float above = flat ? flat->ratio - flat->needed : 0;
    if (apart && above <= 0) return sooner(moved);
    const bool listed = blocks_[a].active && blocks_[b].active &&
                        square_diagonal(both(bounds_[a].moved, bounds_[b].moved)) <= skin * skin;
    if (above > 0) {
      // What is nearly not flat is listed, so that there is no need to come again before it is not.
      const double folded = above / flat->rate;
      const bool lists = above <= kFlatter && folded < std::min(moved, out.seconds);
      if (lists && !listed && !apart) out.covered = false;
      return sooner(apart || listed || lists ? std::max(folded, moved) : folded);
    }
    out.touching = true;
    if (!listed) out.covered = false;
    sooner(moved);
  };
  for_each_near(reach + speed * float(longest), visit);
  return out;
}

void Blocks::choose(float reach) {
  for (Block& b : blocks_) b.active = false;
  for_each_near(reach, [&](std::size_t a, std::size_t b, float) {
    const Flat* const flat = flat_about(a, b);
    if (flat && flat->ratio > flat->needed + kFlatter) return;
    blocks_[a].active = blocks_[b].active = true;
  });
  remember();
}

void Blocks::choose_all() {
  for (Block& b : blocks_) b.active = true;
  remember();
}

void Blocks::remember() {
  active_ = 0;
  for (const Block& b : blocks_) {
    if (!b.active) continue;
    active_ += std::size_t(b.rows) * std::size_t(b.columns);
    const auto sheet = std::size_t(b.sheet);
    Particles& l = *sheets_[sheet].points;
    for (int j = b.row; j < b.row + b.box_rows; ++j) {
      const Row3 from = l.x.row(j), to = then_[sheet].row(j);
      std::copy_n(from.x + b.column, b.box_columns, to.x + b.column);
      std::copy_n(from.y + b.column, b.box_columns, to.y + b.column);
      std::copy_n(from.z + b.column, b.box_columns, to.z + b.column);
    }
    for (const auto& [j, i] : borders_[std::size_t(&b - blocks_.data())])
      for (int k = 0; k < 3; ++k) then_[sheet].at(k, j, i) = l.x.at(k, j, i);
  }
}

Spread Blocks::box() const {
  Spread all = nothing();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (blocks_[b].active) all = both(all, bounds_[b].x);
  return all;
}

std::size_t Blocks::bytes() const {
  std::size_t bytes = blocks_.size() * (sizeof(Block) + sizeof(BlockBounds) + sizeof(Flat) + 32);
  for (const Rows& r : then_) bytes += r.bytes();
  for (const auto& patches : patches_)
    if (patches) bytes += patches->bytes();
  return bytes;
}

}  // namespace weft::physics

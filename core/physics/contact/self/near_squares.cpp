// The list of near squares (near_squares.h).
#include "physics/contact/self/near_squares.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "physics/contact/self/held.h"

namespace weft::physics {
namespace {

constexpr float kSkin = 0.8f;  // spacings that listed pairs may be farther apart than is held
// Of the distance at which pairs are kept apart: the most that an allowance is for several intervals.
constexpr float kMostAllowed = 0.3f;
constexpr float kOverstretched = 3;  // half-diagonals at rest: larger squares are torn and left out

void widen(Spread& spread, int k, float value) {
  spread.low[k] = std::min(spread.low[k], value);
  spread.high[k] = std::max(spread.high[k], value);
}

// At most.
std::size_t count_squares(const std::vector<Sheet>& sheets) {
  std::size_t count = count_particles(sheets);
  for (const Sheet& s : sheets)
    if (s.mesh) count += s.model->surface().all().size();
  return count;
}

float half_diagonal(const Sheet& s) {
  return 0.5f * std::sqrt(s.uu + s.vv + 2 * std::abs(s.uv));
}

}  // namespace

NearSquares::NearSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                         const Blocks& blocks, const std::vector<RestPlace>& rest,
                         const KernelTable& kernels)
    : sheets_(sheets),
      named_(named),
      kernels_(kernels),
      squares_(rest.size()),
      seams_(sheets, named, rest.size()),
      ways_(squares_, kernels),
      allowances_(blocks, named, rest.size(), kernels),
      beside_(sheets, named, squares_, kernels),
      search_(count_squares(sheets_), {}, kernels) {
  const std::size_t bodies = rest.size();
  float spacing = 0;
  for (const Sheet& s : sheets_) {
    spacing = std::max({spacing, std::sqrt(s.uu), std::sqrt(s.vv)});
    most_ = std::max(most_, kReach * held(s));
  }
  skin_ = kSkin * spacing;
  allowances_.limit(kMostAllowed * most_);
  stride_.resize(bodies);
  make_squares();
  make_parts(rest);
  ways_.forget();
  asked_.resize(squares_.size());
  boxes_.resize(squares_.size());
  allowance_.resize(squares_.size());
  way_.resize(squares_.size());
  for_each_square([&](std::size_t) { ++all_squares_; });
  sorted_.resize(all_squares_);
  left_out_.reserve(all_squares_);
}

// visit(number, sheet, row, column).
template <class Visit>
void NearSquares::for_each_body(const Visit& visit) const {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    for (int j = 0; j < sheets_[s].points->rows; ++j)
      for (int i = 0, columns = sheets_[s].points->count(j); i < columns; ++i)
        visit(std::size_t(named_[s].name(j, i)), s, j, i);
}

// visit(number).
template <class Visit>
void NearSquares::for_each_square(const Visit& visit) const {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    for (int j = 0; j < sheets_[s].points->rows && !sheets_[s].mesh; ++j)
      for (int i = 0; i < sheets_[s].columns; ++i) visit(std::size_t(named_[s].name(j, i)));
  for (std::size_t n = stride_.size(); n < squares_.size(); ++n) visit(n);
}

// Those of grids.
void NearSquares::make_squares() {
  most_squared_.resize(squares_.size());
  for_each_body([&](std::size_t n, std::size_t sheet, int j, int i) {
    const int columns = sheets_[sheet].columns, rows = sheets_[sheet].points->rows;
    const float most = kOverstretched * half_diagonal(sheets_[sheet]);
    stride_[n] = named_[sheet].stride;
    most_squared_[n] = most * most;
    for (int c = 0; c < 4; ++c)
      squares_[n].corner[c] =
          named_[sheet].name(std::min(j + (c >> 1), rows - 1), std::min(i + (c & 1), columns - 1));
  });
}

// Those of meshes, and what they have apart.
void NearSquares::make_parts(const std::vector<RestPlace>& rest) {
  struct Made {
    std::size_t first, triangles;
  };
  std::vector<Made> made;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (!sheets_[s].mesh) continue;
    const auto body = [&](int vertex) {
      const auto [row, column] = sheets_[s].points->place(vertex);
      return named_[s].name(row, column);
    };
    std::vector<std::array<std::int32_t, 3>> triangles;
    for (const auto& [a, b, c] : sheets_[s].model->surface().all())
      triangles.push_back({body(a), body(b), body(c)});
    const MeshSquares mesh = squares_of(std::move(triangles));
    owned_.resize(squares_.size(), kOwnsAll);
    made.push_back({squares_.size(), mesh.triangles});
    squares_.insert(squares_.end(), mesh.squares.begin(), mesh.squares.end());
    owned_.insert(owned_.end(), mesh.owned.begin(), mesh.owned.end());
  }
  for (std::size_t n = most_squared_.size(); n < squares_.size(); ++n) {
    float most = 0;
    for (const std::int32_t a : squares_[n].corner)
      for (const std::int32_t b : squares_[n].corner) {
        const RestPlace &p = rest[std::size_t(a)], &q = rest[std::size_t(b)];
        most = std::max(most, (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) +
                                  (p.z - q.z) * (p.z - q.z));
      }
    most_squared_.push_back(kOverstretched * kOverstretched * most);
  }
  for (std::size_t k = 0; k < made.size(); ++k) {
    const auto [first, triangles] = made[k];
    const std::size_t end = k + 1 < made.size() ? made[k + 1].first : squares_.size();
    parts_.push_back(std::make_unique<Part>(
        Part{first, end,
             BesideTriangles({squares_.data() + first, triangles}, std::int32_t(first), rest)}));
  }
}

void NearSquares::leave_out(const std::vector<std::uint8_t>& marked) {
  std::size_t first = 0;
  passing_.assign(stride_.size(), 0);
  bool any = false;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Particles& p = *sheets_[s].points;
    p.for_each([&](int j, int i) {
      const std::uint8_t mark = marked[first + std::size_t(p.number(j, i))];
      passing_[std::size_t(named_[s].name(j, i))] = mark;
      any |= mark != 0;
    });
    first += std::size_t(p.count());
  }
  if (!any) passing_.clear();
}

bool NearSquares::any_joined(const Place* now) const {
  return std::ranges::any_of(left_out_, [&](const LeftOut& square) {
    float middle[3];
    return middle_of(std::size_t(square.number), now, middle) <= square.most_squared;
  });
}

void NearSquares::list(const Place* now, Threads& threads) {
  list(now, skin_, nullptr, threads);
}

// Bodies may have moved by the skin against each other since, and may by as much before they are where the list
// that was kept ends.
void NearSquares::list_again(const Place* now, Threads& threads) {
  const std::vector<LeftOut> left_out = left_out_;
  list(now, 2 * skin_, &left_out, threads);
}

void NearSquares::list(const Place* now, float skin, const std::vector<LeftOut>* left_out,
                       Threads& threads) {
  Spread box;
  std::size_t whole = 0;
  const float range = most_ + skin + 2 * list_whole(now, left_out, box, whole);
  search_.sort(whole, box, range, threads);
  threads.share(search_.chunks(), search_.few(), [&](std::size_t k) {
    for (std::size_t p = search_.begin(k); p < search_.begin(k + 1); ++p) fill_box(p, now);
  });
  search_.find(range, threads);
  if (found_.size() < search_.chunks()) found_.resize(search_.chunks());
  threads.share(search_.chunks(), search_.few(), [&](std::size_t k) { find_in(k, skin); });
  listed_.count = 0;
  listed_.add(found_, search_.chunks());
  wake_listed();
}

// They begin without ways.
void NearSquares::wake_listed() {
  allowances_.forget();
  until_.assign(listed_.count + SquarePairs::kPadding, CornerWays::kAtOnce);
  std::fill(allowance_.begin(), allowance_.end(), 0.0f);
  std::fill(way_.begin(), way_.end(), 0.0f);
}

// The middle of a square's corners, and how far from it they are at most, squared.
float NearSquares::middle_of(std::size_t square, const Place* now, float (&middle)[3]) const {
  float off[4] = {};
  for (int k = 0; k < 3; ++k) {
    float x[4];
    for (int c = 0; c < 4; ++c) x[c] = now[squares_[square].corner[c]].x[k];
    middle[k] = 0.25f * (x[0] + x[1] + x[2] + x[3]);
    for (int c = 0; c < 4; ++c) off[c] += (x[c] - middle[k]) * (x[c] - middle[k]);
  }
  return *std::max_element(off, off + 4);
}

// The middles of all squares that are whole, for the search; returns the greatest distance of a corner
// from the middle.
float NearSquares::list_whole(const Place* now, const std::vector<LeftOut>* left_out, Spread& box,
                              std::size_t& count) {
  const auto is_out = [&](std::size_t n, float radius_squared) {
    if (!left_out) return !(radius_squared <= most_squared_[n]);
    return std::ranges::binary_search(*left_out, std::int32_t(n), {}, &LeftOut::number);
  };
  box = nothing();
  left_out_.clear();
  float widest_squared = 0;
  const Row3 to = search_.points();
  for_each_square([&](std::size_t n) {
    if (has_corner_in(squares_[n], passing_)) return;
    float middle[3];
    const float radius_squared = middle_of(n, now, middle);
    if (is_out(n, radius_squared)) {
      left_out_.push_back({std::int32_t(n), most_squared_[n]});
      return;
    }
    widest_squared = std::max(widest_squared, radius_squared);
    to.x[count] = middle[0];
    to.y[count] = middle[1];
    to.z[count] = middle[2];
    for (int k = 0; k < 3; ++k) widen(box, k, middle[k]);
    search_.names()[count++] = std::int32_t(n);
  });
  return std::sqrt(widest_squared);
}

// The box about one square.
void NearSquares::fill_box(std::size_t sorted, const Place* now) {
  const auto n = std::size_t(search_.name(sorted));
  sorted_[sorted] = std::int32_t(n);
  SquareBox& box = boxes_[sorted];
  for (int c = 0; c < 4; ++c) {
    const float* const x = now[squares_[n].corner[c]].x;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = c == 0 ? x[k] : std::min(box.low[k], x[k]);
      box.high[k] = c == 0 ? x[k] : std::max(box.high[k], x[k]);
    }
  }
}

// Whether two squares share a corner, p < q: names of a grid's squares differ as their places do.
bool NearSquares::beside(std::int32_t p, std::int32_t q) const {
  if (std::size_t(q) >= stride_.size()) {
    const auto &a = squares_[std::size_t(p)].corner, &b = squares_[std::size_t(q)].corner;
    return std::find_first_of(a, a + 4, b, b + 4) != a + 4;
  }
  const std::int32_t stride = stride_[std::size_t(p)], apart = q - p;
  return apart <= 1 || (apart >= stride - 1 && apart <= stride + 1);
}

// The pairs of a chunk of the search that are within reach, but for those that share a corner.
void NearSquares::find_in(std::size_t chunk, float skin) {
  const PairSearch::Pairs near = search_.pairs(chunk);
  SquarePairs& found = found_[chunk];
  found.reserve(near.count);
  found.count = std::size_t(
      kernels_.sheets.squares_within({boxes_.data(), int(near.count), near.owner, near.neighbour,
                                      most_ + skin, found.owner.data(), found.neighbour.data()}));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const auto [p, q] =
        std::minmax(sorted_[std::size_t(found.owner[i])], sorted_[std::size_t(found.neighbour[i])]);
    if (beside(p, q) || seams_.join(squares_[std::size_t(p)], squares_[std::size_t(q)])) continue;
    found.owner[kept] = p;
    found.neighbour[kept++] = q;
  }
  found.count = kept;
}

void NearSquares::wake() {
  if (awake_) return;
  awake_ = true;
  wake_listed();
  ways_.forget();
  beside_.wake();
}

// Of a grid, the squares that a particle is a corner of are those that begin with it, or before it along the row, the
// column or both. (Another one may be shifted in vain.)
void NearSquares::shift(std::int32_t body, float way) {
  const std::int32_t stride = stride_[std::size_t(body)];
  for (const std::int32_t square : {body, body - 1, body - stride, body - stride - 1})
    if (square >= 0) ways_.shift(std::size_t(square), way);
}

std::size_t NearSquares::bytes() const {
  std::size_t bytes = search_.bytes();
  bytes += squares_.size() * (sizeof(Square) + sizeof(SquareBox) + 17) + 4 * stride_.size();
  for (const auto& part : parts_) bytes += part->beside.bytes();
  bytes += all_squares_ * (sizeof(LeftOut) + 4);
  for (const SquarePairs* of : {&listed_, &pruned_, &within_, &still_, &corner_pairs_})
    bytes += of->bytes();
  bytes += 4 * until_.capacity() + ways_.bytes();
  for (const SquarePairs& p : found_) bytes += p.bytes();
  return bytes + beside_.bytes() + seams_.bytes() + allowances_.bytes();
}

}  // namespace weft::physics

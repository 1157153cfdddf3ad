// The plane through the eye against triangles, in the picture; pieces chained over the edges they share.
#include "hands/cut_stroke.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace weft::viewer {

namespace {

constexpr double kOverstretched = 2.5;  // times its rest length: a square that a tear has opened
constexpr double kTidy = 0.02;          // of a square: how far a line may be from what was drawn
constexpr double kBeyond = 0.5;         // of a square: how far a cut goes on beside the sheet

// Where a piece ends: on the edge between two particles, or inside of a triangle where the step begins or
// ends.
struct End {
  int low = -1, high = -1;  // -1: inside
  bool first = false;       // inside, where the step begins
  GridPoint at{};
  bool inside() const { return low < 0; }
};
struct Piece {
  End ends[2];
};

struct Corner {
  int particle;
  GridPoint at;
  ScreenPoint seen;
};

// The part of the way that lies in the triangle, as seen; depth makes places on it true to perspective.
std::optional<Piece> piece_of(const Corner (&c)[3], const std::array<ScreenPoint, 2>& way) {
  const auto twice_area = [](const ScreenPoint& a, const ScreenPoint& b, float x, float y) {
    return double(b.x - a.x) * (y - a.y) - double(b.y - a.y) * (x - a.x);
  };
  const double area = twice_area(c[0].seen, c[1].seen, c[2].seen.x, c[2].seen.y);
  if (area == 0) return std::nullopt;
  double from = 0, to = 1;
  int edge_from = -1, edge_to = -1;
  double begin[3], end[3];  // barycentric, of the corner opposite to edge k -> k+1
  for (int k = 0; k < 3; ++k) {
    const ScreenPoint &a = c[k].seen, &b = c[(k + 1) % 3].seen;
    const double first = twice_area(a, b, way[0].x, way[0].y) / area,
                 last = twice_area(a, b, way[1].x, way[1].y) / area;
    begin[(k + 2) % 3] = first, end[(k + 2) % 3] = last;
    if (first < 0 && last < 0) return std::nullopt;
    if (first < 0 && first / (first - last) > from) from = first / (first - last), edge_from = k;
    if (last < 0 && first / (first - last) < to) to = first / (first - last), edge_to = k;
  }
  if (from >= to) return std::nullopt;
  const auto end_at = [&](double t, int edge, bool is_first) {
    End e;
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double weight = (begin[k] + t * (end[k] - begin[k])) / c[k].seen.depth;
      sum += weight;
      for (std::size_t axis = 0; axis < 2; ++axis) e.at[axis] += weight * c[k].at[axis];
    }
    for (double& axis : e.at) axis /= sum;
    e.first = is_first;
    if (edge < 0) return e;
    std::tie(e.low, e.high) = std::minmax(c[edge].particle, c[(edge + 1) % 3].particle);
    return e;
  };
  return Piece{{end_at(from, edge_from, true), end_at(to, edge_to, false)}};
}

// Pieces end to end.
struct Chain {
  End first, last;
  CutLine line;
};

class Chains {
 public:
  explicit Chains(std::vector<Piece> pieces) : pieces_(std::move(pieces)), used_(pieces_.size()) {
    for (std::size_t n = 0; n < pieces_.size(); ++n)
      for (const End& e : pieces_[n].ends)
        if (!e.inside()) at_[{e.low, e.high}].push_back(n);
  }

  std::vector<Chain> all() {
    std::vector<Chain> chains;
    for (const bool open : {true, false})  // then rings
      for (std::size_t n = 0; n < pieces_.size(); ++n)
        for (int side = 0; side < 2 && !used_[n]; ++side)
          if (!open || is_end(n, pieces_[n].ends[side])) chains.push_back(walk(n, side));
    return chains;
  }

 private:
  std::optional<std::size_t> other(std::size_t piece, const End& end) const {
    if (end.inside()) return std::nullopt;
    for (const std::size_t n : at_.at({end.low, end.high}))
      if (n != piece) return n;
    return std::nullopt;
  }
  bool is_end(std::size_t piece, const End& end) const { return !other(piece, end); }

  Chain walk(std::size_t n, int side) {
    Chain chain{pieces_[n].ends[side], {}, {pieces_[n].ends[side].at}};
    for (;;) {
      used_[n] = true;
      chain.last = pieces_[n].ends[1 - side];
      chain.line.push_back(chain.last.at);
      const auto next = other(n, chain.last);
      if (!next || used_[*next]) return chain;
      const End& meets = pieces_[*next].ends[0];
      side = meets.low == chain.last.low && meets.high == chain.last.high ? 0 : 1;
      n = *next;
    }
  }

  std::vector<Piece> pieces_;
  std::vector<bool> used_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> at_;
};

double distance(const GridPoint& a, const GridPoint& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

double distance_to_line(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  const double along = distance(a, b);
  if (along == 0) return distance(p, a);
  return std::abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / along;
}

// Leaves out what lies on a straight way (Douglas and Peucker 1973); whole thousandths of a square.
void simplify(const CutLine& line, std::size_t first, std::size_t last, CutLine& to) {
  std::size_t farthest = first;
  double most = kTidy;
  for (std::size_t k = first + 1; k < last; ++k)
    if (const double d = distance_to_line(line[k], line[first], line[last]); d > most)
      most = d, farthest = k;
  if (farthest == first) {
    to.push_back({std::round(1e3 * line[last][0]) / 1e3, std::round(1e3 * line[last][1]) / 1e3});
    return;
  }
  simplify(line, first, farthest, to);
  simplify(line, farthest, last, to);
}
CutLine simplified(const CutLine& line) {
  CutLine to{{std::round(1e3 * line[0][0]) / 1e3, std::round(1e3 * line[0][1]) / 1e3}};
  simplify(line, 0, line.size() - 1, to);
  return to;
}

// The nearest point beside the sheet.
GridPoint beside(const Grid& grid, const GridPoint& p) {
  const double right = grid.nx - 1 - p[0], down = grid.ny - 1 - p[1];
  const double least = std::min({p[0], p[1], right, down});
  if (least == p[0]) return {-kBeyond, p[1]};
  if (least == p[1]) return {p[0], -kBeyond};
  if (least == right) return {grid.nx - 1 + kBeyond, p[1]};
  return {p[0], grid.ny - 1 + kBeyond};
}

// How far the sheet may have gone on under the pointer between two steps, in squares.
double reach(const Grid& grid) {
  return std::max(4.0, 0.12 * std::max(grid.nx, grid.ny));
}

}  // namespace

void CutStroke::begin(float x, float y) {
  end();
  points_ = {{x, y}};
}

void CutStroke::end() {
  points_.clear();
  lines_.clear();
  open_.clear();
}

const std::vector<CutLine>& CutStroke::lines(std::size_t cloth) const {
  static const std::vector<CutLine> none;
  const auto found = lines_.find(cloth);
  return found == lines_.end() ? none : found->second;
}

bool CutStroke::go_on(const FrameData& frame_data, const Camera& camera, const Area& area, float x,
                      float y) {
  const Projector project(camera, area);
  const auto [from_x, from_y] = points_.back();
  points_.push_back({x, y});
  bool cut = false;
  for (std::size_t c = 0; c < frame_data.cloths.size(); ++c)
    cut = step(frame_data.cloths[c], frame_data.scene->cloths[c].grid, c, project,
               {ScreenPoint{from_x, from_y, 1, true}, ScreenPoint{x, y, 1, true}}) ||
          cut;
  return cut;
}

namespace {

// Where the sheet as it lies now meets the plane of the step.
std::vector<Piece> pieces_of(const ClothCopy& cloth, const Grid& grid, const Projector& project,
                             const std::array<ScreenPoint, 2>& way) {
  const auto count = static_cast<std::size_t>(cloth.columns) * static_cast<std::size_t>(cloth.rows);
  std::vector<ScreenPoint> seen(count);
  for (std::size_t n = 0; n < count; ++n) seen[n] = project(cloth.position(static_cast<int>(n)));
  const double longest = kOverstretched * std::hypot(spacing_u(grid), spacing_v(grid));
  std::vector<Piece> pieces;
  const auto triangle = [&](std::array<int, 3> p) {
    Corner corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const int n = p[k];
      corners[k] = {n,
                    {double(n % cloth.columns), double(n / cloth.columns)},
                    seen[static_cast<std::size_t>(n)]};
      if (!corners[k].seen.seen ||
          length(cloth.position(n) - cloth.position(p[(k + 1) % 3])) > longest)
        return;
    }
    if (const auto piece = piece_of(corners, way)) pieces.push_back(*piece);
  };
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      const int a = j * cloth.columns + i, below = a + cloth.columns;
      triangle({a, a + 1, below});
      triangle({a + 1, below + 1, below});
    }
  return pieces;
}

// Goes on beside the sheet where it ends at its border.
void extend(const Grid& grid, const End& end, CutLine& line, bool front) {
  if (!end.inside()) {
    const GridPoint outside = beside(grid, end.at);
    if (distance(outside, end.at) < 2 * kBeyond)
      line.insert(front ? line.begin() : line.end(), outside);
  }
}

}  // namespace

bool CutStroke::step(const ClothCopy& cloth, const Grid& grid, std::size_t number,
                     const Projector& project, const std::array<ScreenPoint, 2>& way) {
  std::vector<Open> before, after;
  for (const Open& open : open_) (open.cloth == number ? before : after).push_back(open);
  std::vector<Chain> chains = Chains(pieces_of(cloth, grid, project, way)).all();
  std::vector<CutLine>& lines = lines_[number];
  const bool begins = points_.size() == 2;
  for (Chain& chain : chains) {
    const auto is = [](const End& end, bool first) { return end.inside() && end.first == first; };
    if (is(chain.last, true) || is(chain.first, false)) {  // along the stroke
      std::reverse(chain.line.begin(), chain.line.end());
      std::swap(chain.first, chain.last);
    }
    extend(grid, chain.first, chain.line, true);
    extend(grid, chain.last, chain.line, false);
    const bool starts_inside = is(chain.first, true), goes_on = is(chain.last, false);
    CutLine line = simplified(chain.line);
    const auto nearest =
        std::min_element(before.begin(), before.end(), [&](const Open& a, const Open& b) {
          return distance(lines[a.line].back(), line[0]) < distance(lines[b.line].back(), line[0]);
        });
    if (starts_inside && nearest != before.end()) {
      const std::size_t at = nearest->line;
      lines[at].insert(lines[at].end(), line.begin(), line.end());
      before.erase(nearest);
      if (goes_on) after.push_back({number, at});
      continue;
    }
    // The border has come by under the pointer.
    if (starts_inside && !begins && distance(beside(grid, line[0]), line[0]) < reach(grid))
      line.insert(line.begin(), beside(grid, line[0]));
    lines.push_back(std::move(line));
    if (goes_on) after.push_back({number, lines.size() - 1});
  }
  bool cut = !chains.empty();
  for (const Open& left : before) {
    CutLine& line = lines[left.line];
    if (distance(beside(grid, line.back()), line.back()) >= reach(grid)) continue;
    line.push_back(beside(grid, line.back()));
    cut = true;
  }
  open_ = std::move(after);
  return cut;
}

}  // namespace weft::viewer

// Sleeping row-blocks (sleeping.h).
#include "physics/frame/sleeping.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/body_surface.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/model/placement.h"
#include "physics/step/keeper.h"
#include "weft/shape.h"

namespace weft::physics {
namespace {

constexpr int kBlockRows = 16;
constexpr double kQuietSeconds = 0.5;

// Whether blocks of the cloth may sleep apart from each other: every stage works on rows and leaves
// held particles where they are, and none remembers an earlier substep.
bool sleeps_in_blocks(const Scene& scene, ClothStep& step) {
  return step.schedule().rows_only() && scene.solver.order == 1 && !scene.solver.tethers;
}

double distance_of(const Spread& a, const Spread& b) {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0f, a.low[k] - b.high[k], b.low[k] - a.high[k]});
    square += gap * gap;
  }
  return std::sqrt(square);
}

}  // namespace

std::unique_ptr<Sleeping> Sleeping::make(const Scene& scene, const Cloths& cloths,
                                         const KernelTable& kernels) {
  const bool gusts = (scene.wind.turbulence > 0 || !scene.wind.velocity_keys.empty()) &&
                     (scene.wind.drag > 0 || scene.wind.lift > 0);
  const bool loads = std::any_of(cloths.begin(), cloths.end(), [](const auto& step) {
    const Load* load = step->model().load();
    return load && load->changes();
  });
  if (scene.solver.sleep == 0 || gusts || loads || !scene.gravity_keys.empty()) return nullptr;
  return std::unique_ptr<Sleeping>(new Sleeping(scene, cloths, kernels));
}

Sleeping::Sleeping(const Scene& scene, const Cloths& cloths, const KernelTable& kernels)
    : scene_(scene),
      kernels_(kernels),
      frames_to_sleep_(std::max(2, int(std::ceil(kQuietSeconds / scene.time.frame)))) {
  for (const Cloth& c : scene.cloths)
    if (c.self_collision.mode != SelfCollisionMode::off)
      contact_ = std::max(contact_, 2 * c.self_collision.thickness);
  for (const auto& step : cloths) {
    Resting& r = cloths_.emplace_back();
    const Particles& l = step->particles();
    r.step = step.get();
    r.masses = AlignedArray<float>(l.inverse_mass.size());
    std::copy_n(l.inverse_mass.data(), l.inverse_mass.size(), r.masses.data());
    r.reach = std::max(step->reach(), 2);
    for (const Pin& pin : step->cloth().pins)
      if (pin.moves()) r.moving.push_back({&pin, l.place(particle_number(step->cloth(), pin))});
    const int height = sleeps_in_blocks(scene, *step) ? kBlockRows : l.rows;
    for (int j = 0; j < l.rows; j += height)
      r.blocks.push_back({{j, std::min(j + height, l.rows)}, 0, false, false, {}});
    r.awake.reserve(r.blocks.size() + 1);
    list_awake(r);
  }
}

bool Sleeping::is_quiet(const Resting& cloth, const Block& block, const Rows& before) const {
  const Particles& l = cloth.step->particles();
  const double way = scene_.solver.sleep * scene_.time.frame;
  const auto limit = float(way * way);
  const auto square = [&](int axis, std::size_t p) {
    const float d = l.x.component(axis)[p] - before.component(axis)[p];
    return d * d;
  };
  for (int j = block.rows.begin; j < block.rows.end; ++j) {
    bool quiet = true;
    const std::size_t first = std::size_t(j) * l.stride, last = first + l.count(j);
    for (std::size_t p = first; p < last; ++p)
      quiet &= square(0, p) + square(1, p) + square(2, p) < limit;
    if (!quiet) return false;
  }
  // A pin on a path that was let go is held anew by its path as long as it sleeps.
  return std::none_of(cloth.moving.begin(), cloth.moving.end(), [&](const Moving& pin) {
    return block.rows.has(pin.at.j) &&
           cloth.masses[std::size_t(pin.at.j) * l.stride + pin.at.i] > 0;
  });
}

// Where the block is, and how it fares.
void Sleeping::look(Resting& cloth, Block& block, const Rows& before) const {
  block.quiet = is_quiet(cloth, block, before);
  block.quiet_frames = block.quiet ? std::min(block.quiet_frames + 1, frames_to_sleep_) : 0;
  if (contact_ == 0 && !(block.quiet_frames == frames_to_sleep_)) return;
  Particles& l = cloth.step->particles();
  BlockBounds bounds{};
  BlockRows rows{};
  // Padding of shorter rows lies at zero: it makes a box larger, never smaller.
  for (int j = block.rows.begin; j < block.rows.end; ++j)
    rows.columns = std::max(rows.columns, l.count(j));
  rows.rows = block.rows.end - block.rows.begin;
  rows.stride = l.stride;
  rows.x = l.x.row(block.rows.begin);
  rows.v = l.v.row(block.rows.begin);
  rows.then = {nullptr, nullptr, nullptr};
  rows.bounds = &bounds;
  kernels_.sheets.block_bounds(rows);
  const auto frame = float(scene_.time.frame);
  for (int k = 0; k < 3; ++k) {
    block.box.low[k] = bounds.x.low[k] + std::min(0.0f, bounds.v.low[k] * frame);
    block.box.high[k] = bounds.x.high[k] + std::max(0.0f, bounds.v.high[k] * frame);
  }
}

bool Sleeping::beside_restless(const Resting& cloth, std::size_t b) const {
  const auto restless = [](const Block& other) { return !other.asleep && !other.quiet; };
  return (b > 0 && restless(cloth.blocks[b - 1])) ||
         (b + 1 < cloth.blocks.size() && restless(cloth.blocks[b + 1]));
}

bool Sleeping::met_by_restless(const Block& block) const {
  if (contact_ == 0) return false;
  for (const Resting& cloth : cloths_)
    for (const Block& other : cloth.blocks)
      if (&other != &block && !other.asleep && !other.quiet &&
          distance_of(other.box, block.box) < contact_)
        return true;
  return false;
}

// How far a sphere comes at most, seen from a collider that turns [m].
double turn_past(const Collider& c, double time, double later, const Vec3& middle, double radius) {
  const double turn = fastest_turn(c.rotate, time, later) * (later - time);
  if (turn == 0) return 0;
  const Vec3 about = plus(c.rotate.about, along_keys(c, later));
  const Vec3 axis = times(c.rotate.axis, 1 / length(c.rotate.axis));
  return turn * (length(cross(axis, minus(middle, about))) + radius);
}

// A sphere about the block's box against where the collider gets to during the frame.
bool Sleeping::met_by_collider(const Block& block, double time) const {
  Vec3 middle;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    middle[k] = 0.5 * (double(block.box.low[k]) + block.box.high[k]);
    square += (block.box.high[k] - middle[k]) * (block.box.high[k] - middle[k]);
  }
  for (const Collider& c : scene_.colliders) {
    const BodySurface* body = surface_of(c);
    if (!moves_rigidly(c) && !(body && body->moves())) continue;
    const double later = time + scene_.time.frame;
    const Vec3 way = minus(along_keys(c, later), along_keys(c, time));
    const double path = length(way) + turn_past(c, time, later, middle, std::sqrt(square)) +
                        (body ? body->travel(time, later) : 0);
    if (path == 0) continue;
    const double reach = c.offset + (c.friction.damps() ? c.friction.bias : 0);
    if (signed_distance(c, later, middle) < std::sqrt(square) + reach + path) return true;
  }
  return false;
}

// Whether a pin of the block is about to move along its path.
bool Sleeping::pulled(const Resting& cloth, const Block& block, double time) const {
  const ClothModel& model = cloth.step->model();
  return std::any_of(cloth.moving.begin(), cloth.moving.end(), [&](const Moving& pin) {
    return block.rows.has(pin.at.j) && model.pin_position(*pin.pin, time) !=
                                           model.pin_position(*pin.pin, time + scene_.time.frame);
  });
}

void Sleeping::set_asleep(Resting& cloth, Block& block, bool asleep) {
  Particles& l = cloth.step->particles();
  block.asleep = asleep;
  block.quiet_frames = 0;
  for (int j = block.rows.begin; j < block.rows.end; ++j) {
    const float* mass = cloth.masses.data() + std::size_t(j) * l.stride;
    for (int i = 0; i < l.count(j); ++i) l.w(j)[i] = asleep ? 0 : mass[i];
    l.weigh_row(j);
    if (asleep) zero(l.v.row(j), l.count(j));
  }
  // What stages remember of the substep before is long past.
  if (!asleep && cloth.blocks.size() == 1) cloth.step->restart();
}

// Awake rows, and those before them whose stages reach into them.
void Sleeping::list_awake(Resting& cloth) {
  cloth.awake.clear();
  for (const Block& b : cloth.blocks) {
    if (b.asleep) continue;
    const int begin = std::max(0, b.rows.begin - cloth.reach);
    if (!cloth.awake.empty() && begin <= cloth.awake.back().end)
      cloth.awake.back().end = b.rows.end;
    else
      cloth.awake.push_back({begin, b.rows.end});
  }
}

void Sleeping::begin_frame(double time) {
  for (Resting& cloth : cloths_) {
    for (Block& b : cloth.blocks)
      if (b.asleep && (met_by_collider(b, time) || pulled(cloth, b, time)))
        set_asleep(cloth, b, false);
    list_awake(cloth);
    for (const Block& b : cloth.blocks) {
      rows_slept_ += b.asleep ? b.rows.end - b.rows.begin : 0;
      rows_seen_ += b.rows.end - b.rows.begin;
    }
  }
}

void Sleeping::decide() {
  // Restless blocks are awake ones, which waking others does not change: any order will do.
  for (Resting& cloth : cloths_)
    for (std::size_t k = 0; k < cloth.blocks.size(); ++k) {
      Block& b = cloth.blocks[k];
      if (!b.asleep && b.quiet_frames < frames_to_sleep_) continue;
      const bool restless = beside_restless(cloth, k) || met_by_restless(b);
      if (b.asleep != restless) continue;
      set_asleep(cloth, b, !restless);
      b.quiet = true;
    }
  for (Resting& cloth : cloths_) list_awake(cloth);
}

void Sleeping::wake(int index) {
  Resting& cloth = cloths_[std::size_t(index)];
  for (Block& b : cloth.blocks) {
    if (b.asleep) set_asleep(cloth, b, false);
    b.quiet_frames = 0;
  }
  list_awake(cloth);
}

void Sleeping::keep_masses(int index) {
  Resting& cloth = cloths_[std::size_t(index)];
  const AlignedArray<float>& now = cloth.step->particles().inverse_mass;
  std::copy_n(now.data(), now.size(), cloth.masses.data());
}

void Sleeping::keep(Keeper& keeper) {
  keeper(rows_slept_);
  keeper(rows_seen_);
  for (Resting& cloth : cloths_) {
    keeper(cloth.blocks);
    if (!keeper.puts_back()) continue;
    for (Block& b : cloth.blocks)
      if (b.asleep) set_asleep(cloth, b, true);
    list_awake(cloth);
  }
}

bool Sleeping::all_asleep() const {
  return std::all_of(cloths_.begin(), cloths_.end(),
                     [](const Resting& c) { return c.awake.empty(); });
}

std::int64_t Sleeping::asleep() const {
  std::int64_t particles = 0;
  for (const Resting& cloth : cloths_)
    for (const Block& b : cloth.blocks)
      if (b.asleep)
        particles += cloth.step->particles().first[std::size_t(b.rows.end)] -
                     cloth.step->particles().first[std::size_t(b.rows.begin)];
  return particles;
}

double Sleeping::share() const {
  return rows_seen_ > 0 ? double(rows_slept_) / double(rows_seen_) : 0;
}

std::size_t Sleeping::bytes() const {
  std::size_t bytes = 0;
  for (const Resting& c : cloths_)
    bytes += c.masses.size() * sizeof(float) + c.blocks.capacity() * sizeof(Block);
  return bytes;
}

}  // namespace weft::physics

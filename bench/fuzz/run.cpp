#include "run.h"

#include <algorithm>
#include <bit>

#include "random_scene.h"

namespace fuzz {

using namespace weft;

namespace {

constexpr std::size_t kMostFrames = 60;
constexpr std::uint64_t kStartStream = 5'000'000;  // of random numbers

class Hash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 64; byte += 8) sum_ = (sum_ ^ (word >> byte & 0xff)) * 0x100000001b3u;
  }
  void add(float f) { add(std::uint64_t(std::bit_cast<std::uint32_t>(f))); }
  void add(const std::string& text) {
    for (const char c : text) add(std::uint64_t(static_cast<unsigned char>(c)));
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

void add_cloth(const ClothView& c, Hash& hash) {
  for (const std::size_t lane : lanes_of(c))
    for (const auto* component : {&c.x, &c.y, &c.z, &c.vx, &c.vy, &c.vz, &c.inverse_mass})
      hash.add((*component)[lane]);
  for (const auto& t : c.triangles)
    for (const std::uint32_t corner : t) hash.add(std::uint64_t{corner});
  for (const auto& t : c.tear_triangles)
    for (const std::uint32_t corner : t) hash.add(std::uint64_t{corner});
  for (const auto& p : c.tear_points)
    for (const float component : p) hash.add(component);
}

}  // namespace

std::vector<std::size_t> lanes_of(const ClothView& c) {
  std::vector<std::size_t> lanes(c.lanes.begin(), c.lanes.end());
  for (int j = 0; c.lanes.empty() && j < c.rows; ++j)
    for (int i = 0; i < c.columns; ++i)
      lanes.push_back(std::size_t(j) * std::size_t(c.stride) + std::size_t(i));
  return lanes;
}

std::uint64_t hash_of(const Simulation& simulation) {
  Hash hash;
  hash.add(simulation.hash());
  hash.add(std::uint64_t(simulation.frame()));
  hash.add(std::uint64_t(simulation.substeps()));
  hash.add(simulation.status().text);
  for (const ClothView& c : simulation.view().cloths) add_cloth(c, hash);
  return hash.sum();
}

void begin(const Case& c, Simulation& simulation) {
  if (c.speed > 0) throw_cloth(simulation, c.speed, 0, Draw(c.seed, kStartStream));
}

Trace run(const Case& c, Simulation& simulation, Recorder* recorder, const Watch& watch) {
  Trace trace;
  trace.hashes.push_back(hash_of(simulation));
  Hand hand(c.seed, c.inputs);
  for (double work = 0; work < c.work && trace.hashes.size() < kMostFrames;) {
    const bool touched = hand.act(simulation, recorder);
    simulation.advance_frame();
    if (recorder) recorder->frame(simulation);
    trace.hashes.push_back(hash_of(simulation));
    watch(simulation, touched);
    if (!simulation.status().ok) break;
    work += simulation.substeps() * work_of_substep(simulation.scene());
  }
  trace.status = simulation.status().text;
  return trace;
}

std::string difference(const Trace& a, const Trace& b) {
  const std::size_t frames = std::min(a.hashes.size(), b.hashes.size());
  for (std::size_t n = 0; n < frames; ++n)
    if (a.hashes[n] != b.hashes[n]) return "frame " + std::to_string(n) + " differs";
  if (a.hashes.size() != b.hashes.size())
    return std::to_string(a.hashes.size()) + " and " + std::to_string(b.hashes.size()) + " frames";
  return a.status == b.status ? "" : a.status + ", but " + b.status;
}

}  // namespace fuzz

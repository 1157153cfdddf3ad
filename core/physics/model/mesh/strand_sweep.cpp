// Stage "line" of a mesh: every strand is solved as a whole, by the kernel of a grid's lines
// (kernels/line.cpp), colour after colour. 32 strands of one colour and about one length are the lanes of a
// batch; what they share with no other is gathered before and put back after. The strands of a colour share
// no vertex, so batches go to the threads in any order with the same result.
#include "physics/model/mesh/strand_sweep.h"

#include <algorithm>

#include "physics/kernels/line.h"
#include "physics/model/push.h"
#include "physics/step/threads.h"

namespace weft::physics {
namespace {

constexpr double kConstraintNs = 2;           // for sizing tasks only
constexpr double kSharedNanoseconds = 40000;  // the least work worth sharing out

// As of a grid's lines (line_sweep.cpp).
constexpr double kLeastCompliance = 1e-5;

// Lanes of strands side by side: [place in the strand][kBatchLines].
struct StrandBatch {
  int particles = 0;  // of the longest
  std::vector<int>
      lanes;  // where each vertex lies in the component arrays; -1: the strand has ended
  AlignedArray<float> rest;          // m
  AlignedArray<float> give;          // m/N; one over the stiffness
  AlignedArray<float> compliance;    // 1/kg
  AlignedArray<float> lambda;        // none: a single sweep
  AlignedArray<std::int32_t> alive;  // -1 where there is a constraint
};

class StrandSweep final : public WholeStage, private TornParts {
 public:
  StrandSweep(const ClothParts& parts, const MeshEdges& edges, double stiffness,
              const std::vector<Strand>& strands, const std::vector<std::vector<int>>& colours,
              MeshTearing* tearing)
      : WholeStage("line",
                   std::to_string(strands.size()) + " strands in " +
                       std::to_string(colours.size()) + " colours, each solved as a whole",
                   std::int64_t(edges.ends.size()) * parts.scene.solver.iterations, "constraints"),
        parts_(parts),
        iterations_(parts.scene.solver.iterations) {
    if (tearing) place_.resize(edges.ends.size());
    first_.push_back(0);
    for (const std::vector<int>& colour : colours) {
      for (std::size_t n = 0; n < colour.size(); n += kBatchLines)
        add_batch(edges, stiffness, strands,
                  {colour.data() + n, std::min(colour.size() - n, std::size_t(kBatchLines))});
      first_.push_back(batches_.size());
    }
    for (const float w : parts.particles.inverse_mass.span())
      least_ = std::max(least_, kLeastCompliance * double(w));
    for (const StrandBatch& b : batches_) longest_ = std::max(longest_, b.particles);
    if (tearing) tearing->tell(*this);
  }

  std::size_t bytes() const override {
    std::size_t bytes = place_.size() * sizeof(Place);
    for (const StrandBatch& b : batches_)
      bytes +=
          b.lanes.size() * sizeof(int) * 2 + sizeof(float) * (3 * b.rest.size() + b.lambda.size());
    for (const Memory& m : memory_)
      bytes += m.x.bytes() + m.moved.bytes() + (m.w.size() + m.scratch.size()) * sizeof(float);
    return bytes;
  }
  Velocities velocities(double dt) const override {
    return gain(dt) == 0 ? Velocities::left_alone : Velocities::used;
  }
  void prepare(double dt) override {
    const double h = dt * implicit_share(parts_.scene.solver);
    for (StrandBatch& b : batches_)
      for (std::size_t n = 0; n < b.give.size(); ++n)
        b.compliance[n] = float(std::max(double(b.give[n]) / (h * h), least_));
  }

  void run(const Substep& s, Threads& threads) override {
    while (int(memory_.size()) < threads.count()) memory_.emplace_back(longest_);
    for (int n = 0; n < iterations_; ++n)
      for (std::size_t c = 0; c + 1 < first_.size(); ++c)
        share_out(c, threads, [&](StrandBatch& b, Memory& m) { solve(b, m, s.dt, n == 0); });
  }

 private:
  struct Place {
    std::size_t batch = 0, at = 0;
  };
  void set_edge(int edge, bool holds) override {
    const auto [batch, at] = place_[std::size_t(edge)];
    batches_[batch].alive[at] = holds ? -1 : 0;
  }

  // Of one thread.
  struct Memory {
    explicit Memory(int particles)
        : x(particles, kBatchLines),
          moved(particles, kBatchLines),
          w(std::size_t(particles) * kBatchLines),
          scratch(std::size_t(particles) * kBatchScratch) {}
    Rows x, moved;
    AlignedArray<float> w, scratch;
  };

  void add_batch(const MeshEdges& edges, double stiffness, const std::vector<Strand>& strands,
                 std::span<const int> chosen) {
    StrandBatch& b = batches_.emplace_back();
    b.particles = int(strands[std::size_t(chosen[0])].vertices.size());
    const std::size_t places = std::size_t(b.particles) * kBatchLines;
    b.lanes.assign(places, -1);
    b.rest = AlignedArray<float>(places);
    b.give = AlignedArray<float>(places);
    b.compliance = AlignedArray<float>(places);
    b.alive = AlignedArray<std::int32_t>(places);
    if (iterations_ > 1) b.lambda = AlignedArray<float>(places);
    for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
      const Strand& s = strands[std::size_t(chosen[lane])];
      for (std::size_t m = 0; m < s.vertices.size(); ++m)
        b.lanes[m * kBatchLines + lane] = int(parts_.particles.lane(s.vertices[m]));
      for (std::size_t m = 0; m < s.edges.size(); ++m) {
        const auto e = std::size_t(s.edges[m]);
        b.rest[m * kBatchLines + lane] = float(edges.rest[e]);
        b.give[m * kBatchLines + lane] = float(1 / std::max(stiffness * edges.triangles[e], 1e-12));
        b.alive[m * kBatchLines + lane] = -1;
        if (!place_.empty()) place_[e] = {batches_.size() - 1, m * kBatchLines + lane};
      }
    }
  }

  // Calls solve(batch, memory) for all batches of a colour, in any order.
  template <class Solve>
  void share_out(std::size_t colour, Threads& threads, const Solve& solve) {
    const std::size_t begin = first_[colour], count = first_[colour + 1] - begin;
    double work = 0;
    for (std::size_t n = 0; n < count; ++n)
      work += kConstraintNs * kBatchLines * batches_[begin + n].particles;
    if (threads.count() == 1 || work < kSharedNanoseconds) {
      for (std::size_t n = 0; n < count; ++n) solve(batches_[begin + n], memory_[0]);
      return;
    }
    threads.share(count, false, [&](std::size_t n) {
      solve(batches_[begin + n], memory_[std::size_t(Threads::index())]);
    });
  }

  float gain(double dt) const { return velocity_gain(parts_.scene.solver, true, dt); }

  void solve(StrandBatch& b, Memory& m, double dt, bool fresh) {
    gather(b, m);
    const float velocity = gain(dt);
    LineBatch p{};
    p.x = m.x.row(0);
    p.w = m.w.data();
    p.step = kBatchLines;
    p.particles = b.particles;
    p.columns = kBatchLines;
    p.rests = b.rest.data();
    p.share = 1;
    p.v = m.moved.row(0);
    p.inverse_dt = velocity > 0 ? 1.0f : 0.0f;
    p.compliance = b.compliance.data();
    p.compliance_step = kBatchLines;
    p.alive = b.alive.data();
    if (b.lambda.size() > 0) p.lambda = b.lambda.data();
    p.fresh = fresh;
    p.scratch = m.scratch.data();
    parts_.kernels.line_batch(p);
    put_back(b, m, velocity);
  }

  // Beyond a strand's end lies nothing, without mass.
  void gather(const StrandBatch& b, Memory& m) const {
    const Particles& p = parts_.particles;
    const ConstRow3 from = p.x.row(0);
    const Row3 x = m.x.row(0), moved = m.moved.row(0);
    for (std::size_t n = 0; n < b.lanes.size(); ++n) {
      const bool there = b.lanes[n] >= 0;
      const int at = there ? b.lanes[n] : 0;
      x.x[n] = from.x[at], x.y[n] = from.y[at], x.z[n] = from.z[at];
      m.w[n] = there ? p.inverse_mass[std::size_t(at)] : 0;
      moved.x[n] = moved.y[n] = moved.z[n] = 0;
    }
  }

  void put_back(const StrandBatch& b, Memory& m, float velocity) {
    const Row3 to = parts_.particles.x.row(0), v = parts_.particles.v.row(0);
    const Row3 x = m.x.row(0), moved = m.moved.row(0);
    for (std::size_t n = 0; n < b.lanes.size(); ++n) {
      const int at = b.lanes[n];
      if (at < 0) continue;
      to.x[at] = x.x[n], to.y[at] = x.y[n], to.z[at] = x.z[n];
      if (velocity == 0) continue;
      v.x[at] += velocity * moved.x[n];
      v.y[at] += velocity * moved.y[n];
      v.z[at] += velocity * moved.z[n];
    }
  }

  ClothParts parts_;
  const int iterations_;
  std::vector<StrandBatch> batches_;
  std::vector<std::size_t> first_;  // batch of each colour, and how many there are
  std::vector<Place> place_;        // of every edge, where they can tear
  double least_ = 0;                // 1/kg
  int longest_ = 0;
  std::vector<Memory> memory_;  // of every thread
};

}  // namespace

std::unique_ptr<Stage> make_strands(const ClothParts& parts, const MeshEdges& edges,
                                    double stiffness, const std::vector<Vec3>& x,
                                    MeshTearing* tearing) {
  const std::vector<Strand> strands = strands_of(edges, x);
  return std::make_unique<StrandSweep>(parts, edges, stiffness, strands,
                                       coloured_strands(strands, int(x.size())), tearing);
}

}  // namespace weft::physics

// Stage "line" of a mesh: every strand is solved as a whole, by the kernel of a grid's lines
// (kernels/line.cpp), colour after colour. 32 strands of one colour and about one length are the lanes of a
// batch; what they share with no other is gathered before and put back after. The strands of a colour share
// no vertex, so batches go to the threads in any order with the same result.
#include "physics/model/mesh/strand_sweep.h"

#include <algorithm>

#include "physics/kernels/line.h"
#include "physics/model/projected_motion.h"
#include "physics/step/threads.h"

namespace weft::physics {
namespace {

constexpr double kConstraintNs = 2;           // for sizing tasks only
constexpr double kSharedNanoseconds = 40000;  // the least work worth sharing out

// As of a grid's lines (line_sweep.cpp).
constexpr double kLeastCompliance = 1e-5;
constexpr int kSteps = 2;  // of Newton's, of a membrane

// Lanes of strands side by side: [place in the strand][kBatchLines].
struct StrandBatch {
  int particles = 0;  // of the longest
  std::vector<int>
      lanes;  // where each vertex lies in the component arrays; -1: the strand has ended
  std::vector<int> edges;            // of a membrane; -1: none
  AlignedArray<float> rest;          // m; of a membrane the square that is wanted [m²]
  AlignedArray<float> give;          // one over the stiffness [m/N; of squares m³/N]
  AlignedArray<float> compliance;    // 1/kg; of squares m²/kg
  AlignedArray<float> lambda;        // none: a single sweep
  AlignedArray<std::int32_t> alive;  // -1 where there is a constraint
  AlignedArray<float> midst;  // m²; squared lengths as solved; none: nothing tears by strain
};

}  // namespace

class StrandSweeps::Solver : private TornParts {
 public:
  Solver(const ClothParts& parts, const MeshEdges& edges, double stiffness,
         std::unique_ptr<StrandMembrane> membrane, const std::vector<Strand>& strands,
         MeshTearing* tearing, History* history)
      : parts_(parts),
        membrane_(std::move(membrane)),
        history_(history),
        remembers_(membrane_ || parts.scene.solver.iterations > 1) {
    const std::vector<std::vector<int>> colours =
        coloured_strands(strands, parts.particles.count());
    words_ = std::to_string(strands.size()) + " strands in " + std::to_string(colours.size()) +
             " colours, each solved as a whole";
    count_ = std::int64_t(edges.ends.size());
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
    if (membrane_)
      for (const double rest : edges.rest) squares_.push_back(rest * rest);
  }

  std::vector<const float*> midst() const {
    std::vector<const float*> midst;
    for (const auto& [batch, at] : place_)
      if (batches_[batch].midst.size() > 0) midst.push_back(batches_[batch].midst.data() + at);
    return midst;
  }
  const std::string& words() const { return words_; }
  std::int64_t count() const { return count_; }
  const ClothParts& parts() const { return parts_; }
  std::size_t bytes() const {
    std::size_t bytes = place_.size() * sizeof(Place) + (membrane_ ? membrane_->bytes() : 0);
    for (const StrandBatch& b : batches_)
      bytes += (b.lanes.size() * 2 + b.edges.size()) * sizeof(int) +
               sizeof(float) * (3 * b.rest.size() + b.lambda.size() + b.midst.size());
    for (const Memory& m : memory_)
      bytes +=
          m.x.bytes() + m.corrections.bytes() + (m.w.size() + m.scratch.size()) * sizeof(float);
    return bytes;
  }
  void prepare(double dt) {
    const double h = dt * implicit_share(parts_.scene.solver);
    const double rate = membrane_ ? 1 + membrane_->rate(dt) : 1;
    for (StrandBatch& b : batches_)
      for (std::size_t n = 0; n < b.give.size(); ++n) {
        const double least =
            membrane_ && b.edges[n] >= 0 ? least_ * squares_[std::size_t(b.edges[n])] : least_;
        b.compliance[n] = float(std::max(double(b.give[n]) / (rate * h * h), least));
      }
  }

  void sweep(double dt, bool fresh, bool last, Threads& threads) {
    while (int(memory_.size()) < threads.count()) memory_.emplace_back(longest_);
    if (membrane_ && fresh) membrane_->begin();
    for (std::size_t c = 0; c + 1 < first_.size(); ++c)
      share_out(c, threads, [&](StrandBatch& b, Memory& m) {
        solve(b, m, dt, fresh);
        if (last && b.midst.size() > 0) measure(b, m);
      });
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
          corrections(particles, kBatchLines),
          w(std::size_t(particles) * kBatchLines),
          scratch(std::size_t(particles) * kBatchScratch) {}
    Rows x, corrections;
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
    if (remembers_) b.lambda = AlignedArray<float>(places);
    if (membrane_) b.edges.assign(places, -1);
    if (!place_.empty() && parts_.cloth.tear_strain > 0) b.midst = AlignedArray<float>(places);
    for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
      const Strand& s = strands[std::size_t(chosen[lane])];
      for (std::size_t m = 0; m < s.vertices.size(); ++m)
        b.lanes[m * kBatchLines + lane] = int(parts_.particles.lane(s.vertices[m]));
      for (std::size_t m = 0; m < s.edges.size(); ++m) {
        const auto e = std::size_t(s.edges[m]);
        const std::size_t at = m * kBatchLines + lane;
        const double k = membrane_ ? 1 / membrane_->give(int(e)) : stiffness * edges.triangles[e];
        b.rest[at] = float(edges.rest[e]);
        b.give[at] = float(1 / std::max(k, 1e-12));
        b.alive[at] = -1;
        if (membrane_) b.edges[at] = int(e);
        if (!place_.empty()) place_[e] = {batches_.size() - 1, at};
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

  void solve(StrandBatch& b, Memory& m, double dt, bool fresh) {
    gather(b, m);
    LineBatch p{};
    p.x = m.x.row(0);
    p.w = m.w.data();
    p.step = kBatchLines;
    p.particles = b.particles;
    p.columns = kBatchLines;
    p.share = 1;
    p.u = m.corrections.row(0);
    p.compliance = b.compliance.data();
    p.compliance_step = kBatchLines;
    p.alive = b.alive.data();
    if (b.lambda.size() > 0) p.lambda = b.lambda.data();
    p.fresh = fresh;
    p.scratch = m.scratch.data();
    membrane_ ? solve_membrane(b, p, dt) : solve_springs(b, p);
    put_back(b, m, dt);
  }

  void solve_springs(const StrandBatch& b, LineBatch& p) const {
    p.rests = b.rest.data();
    parts_.kernels.lines.line_batch(p);
  }

  // Every sweep goes on from what the triangles hold, with multipliers of its own.
  void solve_membrane(StrandBatch& b, LineBatch& p, double dt) {
    const double h = dt * implicit_share(parts_.scene.solver);
    const auto rate = float(membrane_->rate(dt));
    for (std::size_t n = 0; n < b.edges.size(); ++n)
      if (b.edges[n] >= 0) b.rest[n] = membrane_->square(b.edges[n], rate);
    p.squares = b.rest.data();
    p.steps = kSteps;
    p.fresh = true;
    parts_.kernels.lines.membrane_line_batch(p);
    for (std::size_t n = 0; n < b.edges.size(); ++n)
      if (b.edges[n] >= 0) membrane_->add(b.edges[n], b.lambda[n], float(1 / (h * h)));
  }

  // Beyond a strand's end lies nothing, without mass.
  void gather(const StrandBatch& b, Memory& m) const {
    const Particles& p = parts_.particles;
    const ConstRow3 from = p.x.row(0);
    const Row3 x = m.x.row(0), u = m.corrections.row(0);
    for (std::size_t n = 0; n < b.lanes.size(); ++n) {
      const bool there = b.lanes[n] >= 0;
      const int at = there ? b.lanes[n] : 0;
      x.x[n] = from.x[at], x.y[n] = from.y[at], x.z[n] = from.z[at];
      m.w[n] = there ? p.inverse_mass[std::size_t(at)] : 0;
      u.x[n] = u.y[n] = u.z[n] = 0;
    }
  }

  // As long as its own strand's solution leaves an edge: as its force, which is in balance along the strand,
  // stretches it. Others move it again.
  void measure(StrandBatch& b, Memory& m) const {
    const Row3 x = m.x.row(0), u = m.corrections.row(0);
    const auto along = [](const float* at, const float* by, std::size_t near) {
      const std::size_t far = near + kBatchLines;
      return at[far] - at[near] + (by[far] - by[near]);
    };
    for (std::size_t n = 0; n + kBatchLines < b.midst.size(); ++n) {
      const float ex = along(x.x, u.x, n), ey = along(x.y, u.y, n), ez = along(x.z, u.z, n);
      b.midst[n] = ex * ex + ey * ey + ez * ez;
    }
  }

  void put_back(const StrandBatch& b, Memory& m, double dt) {
    const float gain = velocity_gain(parts_.scene.solver, dt);
    if (history_ && history_->left.kept) return put_back_keeping(b, m, gain);
    const Row3 x = parts_.particles.x.row(0), v = parts_.particles.v.row(0);
    const Row3 u = m.corrections.row(0);
    for (std::size_t n = 0; n < b.lanes.size(); ++n) {
      const int at = b.lanes[n];
      if (at < 0) continue;
      x.x[at] += u.x[n], x.y[at] += u.y[n], x.z[at] += u.z[n];
      v.x[at] += gain * u.x[n], v.y[at] += gain * u.y[n], v.z[at] += gain * u.z[n];
    }
  }

  void put_back_keeping(const StrandBatch& b, Memory& m, float gain) {
    const auto put = [&](const float* u, float* x, float* left, float* v, float* v_left) {
      for (std::size_t n = 0; n < b.lanes.size(); ++n) {
        const int at = b.lanes[n];
        if (at < 0) continue;
        move_keeping(x[at], left[at], double(u[n]));
        move_keeping(v[at], v_left[at], double(gain) * double(u[n]));
      }
    };
    const Row3 u = m.corrections.row(0), x = parts_.particles.x.row(0);
    const Row3 v = parts_.particles.v.row(0);
    const Row3 left = history_->left.x.row(0), v_left = history_->left.v.row(0);
    put(u.x, x.x, left.x, v.x, v_left.x);
    put(u.y, x.y, left.y, v.y, v_left.y);
    put(u.z, x.z, left.z, v.z, v_left.z);
  }

  const ClothParts& parts_;
  std::unique_ptr<StrandMembrane> membrane_;  // null: springs
  History* const history_;                    // or null
  const bool remembers_;                      // multipliers
  std::string words_;
  std::int64_t count_ = 0;
  std::vector<StrandBatch> batches_;
  std::vector<std::size_t> first_;  // batch of each colour, and how many there are
  std::vector<double> squares_;     // m²; of the membrane's edges at rest
  std::vector<Place> place_;        // of every edge, where they can tear
  double least_ = 0;                // 1/kg
  int longest_ = 0;
  std::vector<Memory> memory_;  // of every thread
};

StrandSweeps::StrandSweeps(const ClothParts& parts, const MeshEdges& edges, double stiffness,
                           const std::vector<Strand>& strands, MeshTearing* tearing,
                           History* history)
    : solver_(
          std::make_shared<Solver>(parts, edges, stiffness, nullptr, strands, tearing, history)) {}

StrandSweeps::StrandSweeps(const ClothParts& parts, const MeshEdges& edges,
                           std::unique_ptr<StrandMembrane> membrane,
                           const std::vector<Strand>& strands, History* history)
    : solver_(std::make_shared<Solver>(parts, edges, 0, std::move(membrane), strands, nullptr,
                                       history)) {}

// The first of a substep's tells the memory of all.
class StrandSweeps::Sweep final : public WholeStage {
 public:
  Sweep(std::shared_ptr<Solver> solver, int iterations, bool fresh)
      : WholeStage("line", solver->words(), solver->count() * iterations, "constraints"),
        solver_(std::move(solver)),
        iterations_(iterations),
        fresh_(fresh) {}
  std::size_t bytes() const override { return fresh_ ? solver_->bytes() : 0; }
  void prepare(double dt) override {
    if (fresh_) solver_->prepare(dt);
  }
  void run(const Substep& s, Threads& threads) override {
    for (int n = 0; n < iterations_; ++n)
      solver_->sweep(s.dt, fresh_ && n == 0, n + 1 == iterations_, threads);
  }

 private:
  std::shared_ptr<Solver> solver_;
  int iterations_;
  bool fresh_;
};

std::vector<const float*> StrandSweeps::midst() const {
  return solver_->midst();
}

std::unique_ptr<Stage> StrandSweeps::stage(int iterations, bool fresh) {
  return std::make_unique<Sweep>(solver_, iterations, fresh);
}

}  // namespace weft::physics

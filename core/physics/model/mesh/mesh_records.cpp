#include "physics/model/mesh/mesh_records.h"

#include <algorithm>

#include "physics/model/projected_motion.h"

namespace weft::physics {
namespace {

RecordRow record_row_of(const ClothParts& parts, AlignedArray<float>& records, int j,
                        float inverse_dt) {
  Particles& p = parts.particles;
  const std::size_t at = std::size_t(kRecord) * std::size_t(j) * std::size_t(p.stride);
  return {p.count(j), p.x.row(j), p.v.row(j), p.w(j), records.data() + at, inverse_dt, {}, {}};
}

class LoadRecords final : public RowStage {
 public:
  LoadRecords(const ClothParts& parts, AlignedArray<float>& records, int reach)
      : RowStage("load", "vertices into records", reach, parts.particles.count(), "particles"),
        parts_(parts),
        records_(records) {}
  Velocities velocities() const override { return Velocities::left_alone; }
  void start(const Substep& s) override { loaded_[std::size_t(s.slot)] = 0; }
  void run(int j, const Substep& s) override {
    int& loaded = loaded_[std::size_t(s.slot)];
    if (j == 0) loaded = 0;
    const int end = std::min(j + reach + 1, parts_.particles.rows);
    for (loaded = std::max(loaded, j); loaded < end; ++loaded)
      parts_.kernels.mesh.load_records(record_row_of(parts_, records_, loaded, 0));
  }

 protected:
  void reserve_slots(int slots) override { loaded_.assign(std::size_t(slots), 0); }

 private:
  ClothParts parts_;
  AlignedArray<float>& records_;
  std::vector<int> loaded_;  // the next row to come into the records, of each slot
};

class StoreRecords final : public RowStage {
 public:
  StoreRecords(const ClothParts& parts, AlignedArray<float>& records, bool limit, History* history)
      : RowStage("store", "positions and velocities gain the corrections", 0,
                 parts.particles.count(), "particles"),
        parts_(parts),
        records_(records),
        history_(history),
        limit_(limit) {}
  void run(int j, const Substep& s) override {
    RecordRow row = record_row_of(parts_, records_, j, gain(s.dt));
    if (history_ && history_->left.kept) {
      row.left = history_->left.x.row(j);
      row.v_left = history_->left.v.row(j);
    }
    parts_.kernels.mesh.store_records(row);
  }

 private:
  float gain(double dt) const {
    return limit_ ? float(1 / dt) : velocity_gain(parts_.scene.solver, dt);
  }
  ClothParts parts_;
  AlignedArray<float>& records_;
  History* history_;  // or null
  bool limit_;
};

}  // namespace

AlignedArray<float> records_of(const Particles& p) {
  return AlignedArray<float>(std::size_t(kRecord) * std::size_t(p.rows) * std::size_t(p.stride));
}

std::int32_t offset_of(const Particles& p, int vertex) {
  return std::int32_t(kRecord * p.lane(vertex));
}

std::int32_t offset_of_nobody(const Particles& p, int row, int n) {
  return kRecord * (row * p.stride + p.count(row) + n);
}

std::unique_ptr<RowStage> make_load_records(const ClothParts& parts, AlignedArray<float>& records,
                                            int reach) {
  return std::make_unique<LoadRecords>(parts, records, reach);
}

std::unique_ptr<RowStage> make_store_records(const ClothParts& parts, AlignedArray<float>& records,
                                             bool limit, History* history) {
  return std::make_unique<StoreRecords>(parts, records, limit, history);
}

}  // namespace weft::physics

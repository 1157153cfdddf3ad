// A cloth whose particles are the vertices of a triangle mesh. Particles keep the numbers that they have in
// the mesh; in memory they lie in rows of breadth-first levels (mesh_order.h).
#pragma once

#include "physics/model/followed.h"
#include "physics/model/mesh/gas_load.h"
#include "physics/model/mesh/mesh_sweeps.h"
#include "physics/model/mesh/seams.h"
#include "physics/model/mesh/strands.h"
#include "physics/model/mesh/triangle_stage.h"
#include "physics/model/projected_motion.h"
#include "physics/model/tethers.h"

namespace weft::physics {

class MeshModel final : public ClothModel {
 public:
  // The cloth's mesh is read (Cloth::mesh.shape).
  MeshModel(const Scene& scene, int index, Method method, std::uint64_t seed,
            const KernelTable& kernels);

  const ClothParts& parts() const override { return parts_; }
  History* history() override { return history_.get(); }
  void append_motion(Method method, StageList& list) override;
  void append_limits(StageList& list) override;
  bool take_substep(double dt) override;
  double mass(int particle) const override { return masses_[std::size_t(particle)]; }
  const SurfaceMesh& surface() const override { return surface_; }
  const DrawnMesh* drawn_mesh() const override { return &drawn_; }
  ConstraintCounts constraints() const override;
  Pull pull() const override;
  void accelerations(const Vec3& gravity, std::vector<Vec3>& a) const override;
  ElasticEnergy elastic_energy() const override;
  Strain strain() const override;
  double strain_in_line(const Rows& x, double spread) const override;
  double limited_strain() const override { return strain().max; }
  Vec3 pin_position(const Pin& pin, double time) const override;
  double held_energy(const Rows& x, double dt, Threads& threads) const override;
  float greatest_stretch(const Rows& x) const override;
  double attachment_energy(const Rows& x, double dt) const override;
  double rounding_gain() const override;
  const Load* load() const override { return gas_.get(); }
  Spectrum find_spectrum(std::span<const float> inverse_masses) const override;
  double stiffening(double stretch) const override;
  bool folds_freely() const override;
  std::vector<std::string> notes() const override;
  MeshTearing* mesh_tearing() override { return tearing_.get(); }
  Tearing* tearing() override { return tearing_.get(); }
  const Tearing* tearing() const override { return tearing_.get(); }
  void allow_tearing() override;
  OpenSeams open_seams() const override { return seams_.open(particles_); }
  void mark_open_seams(double beyond, std::span<std::uint8_t> marks) const override {
    seams_.mark_open(particles_, beyond, marks);
  }
  std::vector<Joined> constraints_near(const Vec3& a, const Vec3& way,
                                       double distance) const override;
  std::size_t bytes() const override;

 private:
  void weigh();
  void place();
  void append_forces(StageList& list);
  void append_projections(StageList& list);
  void append_gas(StageList& list);
  void append_membrane(StageList& list);
  void append_strands(StageList& list);
  bool sweeps_by_colours() const;
  ColourSweeps sweeps_due() const;
  MeshSweeps& sweeps();  // of bending, where there is any
  MeshSweeps& edge_sweeps();
  StrainSweeps& strain_sweeps();
  const std::vector<Strand>& strands();
  std::vector<std::vector<Tether>> attachments() const;
  double projected_energy(const Rows& x, double dt) const;
  double start_strain() const;  // the greatest of all edges
  bool holds(std::size_t edge) const { return !tearing_ || tearing_->holds(edge); }

  const TriangleMesh& mesh_;
  Method method_;
  std::uint64_t seed_;
  SurfaceMesh surface_;
  std::vector<Vec3> start_;  // of every particle [m]
  RestPlaces rest_;
  std::vector<RestTriangle> triangles_;
  MeshMaterial material_;
  MeshOrder order_;
  Particles particles_;
  Seams seams_;
  ClothParts parts_;
  std::vector<double> masses_;  // kg, of every particle
  Followed followed_;
  MeshEdges edges_;               // each once
  std::unique_ptr<GasLoad> gas_;  // null: the cloth has no pressure
  std::unique_ptr<MeshSweeps> sweeps_;
  double dt_ = 0;  // s, of substeps; 0: not known yet
  ColourSweeps colour_sweeps_{};
  std::vector<Strand> strands_;  // none until sweeps solve them
  std::unique_ptr<History> history_;
  std::unique_ptr<Rows> corrections_;         // of tethers
  std::vector<std::vector<Tether>> tethers_;  // none: the scene has them off
  DrawnMesh drawn_;
  std::unique_ptr<MeshTearing> tearing_;  // null while it cannot
  MidstLengths midst_;
};

}  // namespace weft::physics

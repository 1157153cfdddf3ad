// Bullet's classical soft body set to the problem (peer.h).
//
// Its position solver moves the ends of a link by the share kLST of its error, per pass. One pass a
// substep with kLST = w/(w + 1/(k dt²)), w the sum of both inverse masses, is the compliant
// projection of a spring of k N/m, so the run converges to the same motion as dt goes to zero.
#include "peer.h"

#ifdef WEFT_BULLET
#include <BulletSoftBody/btSoftBody.h>

#include <map>

#include "held.h"
#endif

namespace bench {

#ifdef WEFT_BULLET
namespace {

class BulletCloth final : public Peer {
 public:
  BulletCloth(const weft::Scene& scene, int substeps)
      : scene_(scene), substeps_(substeps), dt_(btScalar(scene.time.frame / substeps)) {
    const weft::Cloth& cloth = scene_.cloths[0];
    const weft::Grid& g = cloth.grid;
    info_.m_gravity = vector(scene_.gravity);
    info_.air_density = 0;
    info_.water_density = 0;
    info_.m_sparsesdf.Initialize();
    btAlignedObjectArray<btVector3> x;
    btAlignedObjectArray<btScalar> m;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const btScalar s = btScalar(i) / btScalar(g.nx - 1), t = btScalar(j) / btScalar(g.ny - 1);
        x.push_back(vector(g.origin) + s * vector(g.u) + t * vector(g.v));
        m.push_back(btScalar(weft::particle_mass(cloth, i, j)));
      }
    body_ = std::make_unique<btSoftBody>(&info_, x.size(), &x[0], &m[0]);
    for (const weft::Pin& pin : cloth.pins) body_->setMass(pin.j * g.nx + pin.i, 0);
    moved_ = moving_pins(cloth);
    body_->m_cfg.piterations = 1;
    body_->m_cfg.collisions = 0;
    body_->m_cfg.kDP = btScalar(cloth.drag * dt_);
    link_all(cloth);
  }

  // What a world does for a body without contacts in every substep.
  void advance_frame() override {
    for (int s = 0; s < substeps_; ++s) {
      body_->predictMotion(dt_);
      ++done_;
      for (const Held& held : moved_)
        body_->m_nodes[int(held.particle)].m_x = vector(place_of(held, done_ * double(dt_)));
      body_->solveConstraints();
      body_->integrateMotion();
    }
  }

  std::vector<double> positions() const override {
    std::vector<double> all;
    for (int n = 0; n < body_->m_nodes.size(); ++n) {
      const btVector3& x = body_->m_nodes[n].m_x;
      all.insert(all.end(), {double(x.x()), double(x.y()), double(x.z())});
    }
    return all;
  }

 private:
  static btVector3 vector(const weft::Vec3& v) {
    return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])};
  }

  void link_all(const weft::Cloth& cloth) {
    const int nx = cloth.grid.nx, ny = cloth.grid.ny;
    const auto link = [&](int i, int j, int oi, int oj, double k) {
      if (oi >= 0 && oi < nx && oj < ny) link_nodes(j * nx + i, oj * nx + oi, k);
    };
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        link(i, j, i + 1, j, cloth.stiffness.structural);
        link(i, j, i, j + 1, cloth.stiffness.structural);
        link(i, j, i + 1, j + 1, cloth.stiffness.shear);
        link(i, j, i - 1, j + 1, cloth.stiffness.shear);
        link(i, j, i + 2, j, cloth.stiffness.bend);
        link(i, j, i, j + 2, cloth.stiffness.bend);
      }
  }

  void link_nodes(int a, int b, double k) {
    const double w = double(body_->m_nodes[a].m_im) + double(body_->m_nodes[b].m_im);
    if (w == 0) return;
    const double share = w / (w + 1 / (k * double(dt_) * double(dt_)));
    btSoftBody::Material*& material = materials_[share];
    if (!material) {
      material = body_->appendMaterial();
      material->m_kLST = btScalar(share);
    }
    body_->appendLink(a, b, material);
  }

  weft::Scene scene_;
  int substeps_, done_ = 0;
  btScalar dt_;
  std::vector<Held> moved_;
  btSoftBodyWorldInfo info_;
  std::unique_ptr<btSoftBody> body_;
  std::map<double, btSoftBody::Material*> materials_;
};

}  // namespace

std::unique_ptr<Peer> make_bullet_peer(const weft::Scene& scene, int substeps) {
  return std::make_unique<BulletCloth>(scene, substeps);
}
#else
std::unique_ptr<Peer> make_bullet_peer(const weft::Scene&, int) {
  return nullptr;
}
#endif

}  // namespace bench

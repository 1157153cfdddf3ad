// What is measured of a mesh's model in double precision (mesh_model.h).
#include <algorithm>
#include <cmath>

#include "physics/model/largest_eigenvalue.h"
#include "physics/model/mesh/mesh_model.h"
#include "physics/model/strain_in_line.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr double kRounding = 4e-7;  // of positions in single precision, of the scene's size

}  // namespace

ConstraintCounts MeshModel::constraints() const {
  return {std::int64_t(edges_.ends.size()), 0, 0};
}

Pull MeshModel::pull() const {
  const double stiffness = material_.membrane
                               ? std::max({material_.c11, material_.c22, material_.c66})
                               : 2 * material_.stiffness;
  const double longest = *std::max_element(edges_.rest.begin(), edges_.rest.end());
  const double force = 2 * stiffness * longest;
  return {stiffness, force, 3 * force / *std::min_element(masses_.begin(), masses_.end())};
}

void MeshModel::accelerations(const Vec3& gravity, std::vector<Vec3>& a) const {
  a.assign(start_.size(), Vec3{});
  const std::vector<Vec3> x = particles_.gather(particles_.x);
  if (material_.damped()) {
    const std::vector<Vec3> v = particles_.gather(particles_.v);
    add_mesh_forces(triangles_, material_, x, &v, a);
  } else {
    add_mesh_forces(triangles_, material_, x, nullptr, a);
  }
  particles_.for_each([&](int j, int i) {
    Vec3& own = a[std::size_t(particles_.number(j, i))];
    own = particles_.w(j, i) > 0 ? plus(times(own, particles_.w(j, i)), gravity) : Vec3{};
  });
  seams_.share(particles_, a);
}

ElasticEnergy MeshModel::elastic_energy() const {
  const std::vector<Vec3> x = particles_.gather(particles_.x);
  MeshMaterial stretches = material_;
  stretches.bends = false;
  ElasticEnergy energy;
  (material_.membrane ? energy.membrane : energy.springs) = mesh_energy(triangles_, stretches, x);
  if (material_.bends) energy.bending = mesh_energy(triangles_, bending_alone(material_), x);
  return energy;
}

Strain MeshModel::strain() const {
  const std::vector<Vec3> x = particles_.gather(particles_.x);
  const std::int64_t torn = tearing_ ? tearing_->torn() : 0;
  Strain strain{-1, 0, std::int64_t(edges_.ends.size()) - torn};
  for (std::size_t n = 0; n < edges_.ends.size(); ++n) {
    if (!holds(n)) continue;
    const auto& [a, b] = edges_.ends[n];
    const double e = distance(x[std::size_t(a)], x[std::size_t(b)]) / edges_.rest[n] - 1;
    strain.max = std::max(strain.max, e);
    strain.mean += e / double(strain.constraints);
  }
  return strain;
}

double MeshModel::start_strain() const {
  double most = 0;
  for (std::size_t n = 0; n < edges_.ends.size(); ++n) {
    const auto& [a, b] = edges_.ends[n];
    most = std::max(
        most,
        std::abs(distance(start_[std::size_t(a)], start_[std::size_t(b)]) / edges_.rest[n] - 1));
  }
  return most;
}

// What is farther from a pin than the mesh is long is taken back at once.
double MeshModel::attachment_energy(const Rows& at, double dt) const {
  const std::vector<Vec3> x = particles_.gather(at);
  double sum = 0;
  for (const std::vector<Tether>& slot : tethers_)
    for (std::size_t p = 0; p < slot.size(); ++p) {
      const double w = particles_.inverse_mass[particles_.lane(int(p))];
      if (slot[p].pin < 0 || w == 0) continue;
      const double over =
          std::max(0.0, distance(x[p], x[std::size_t(slot[p].pin)]) - slot[p].reach);
      sum += 0.5 / w * over * over / (dt * dt);
    }
  return sum;
}

double MeshModel::held_energy(const Rows& x, double dt, Threads&) const {
  const double load = gas_ ? gas_->greatest_energy(particles_.gather(x)) : 0;
  if (!is_explicit(method_)) return projected_energy(x, dt) + load;
  return mesh_energy(triangles_, material_, particles_.gather(x)) + rounding_gain() + load;
}

// A projected edge counts as a spring of at most the inertia of its ends over dt², all that a sweep makes
// of it; the membrane as it is.
double MeshModel::projected_energy(const Rows& at, double dt) const {
  const std::vector<Vec3> x = particles_.gather(at);
  const double slack = kRounding * std::max(1.0, double(at.greatest(parts_.kernels)));
  if (material_.membrane)
    return mesh_energy(triangles_, material_, x) +
           pull().stiffness * double(edges_.ends.size()) * slack * slack;
  double sum = 0;
  for (std::size_t n = 0; n < edges_.ends.size(); ++n) {
    if (!holds(n)) continue;
    const auto& [a, b] = edges_.ends[n];
    const double w = double(particles_.inverse_mass[particles_.lane(a)]) +
                     double(particles_.inverse_mass[particles_.lane(b)]);
    if (w == 0) continue;
    const double k = std::min(material_.stiffness * edges_.triangles[n], 1 / (w * dt * dt));
    const double over =
        std::abs(distance(x[std::size_t(a)], x[std::size_t(b)]) - edges_.rest[n]) + slack;
    sum += 0.5 * k * over * over;
  }
  return sum + (material_.bends ? mesh_energy(triangles_, bending_alone(material_), x) : 0);
}

// Every fourth edge is looked at.
double MeshModel::strain_in_line(const Rows& x, double spread) const {
  StrainInLine lines(spread);
  const auto at = [&](int p) {
    const auto [j, i] = particles_.place(p);
    return Vec3{x.at(0, j, i), x.at(1, j, i), x.at(2, j, i)};
  };
  for (const Strand& strand : strands_)
    lines.look(int(strand.edges.size()), [&](int n) -> std::optional<double> {
      const auto edge = std::size_t(strand.edges[std::size_t(n)]);
      if (!holds(edge)) return {};
      return distance(at(edges_.ends[edge][0]), at(edges_.ends[edge][1])) / edges_.rest[edge] - 1;
    });
  return lines.greatest();
}

float MeshModel::greatest_stretch(const Rows& x) const {
  double most = 0;
  for (std::size_t n = 0; n < edges_.ends.size(); n += 4) {
    if (!holds(n)) continue;
    const auto at = [&](int p) {
      const auto [j, i] = particles_.place(p);
      return Vec3{x.at(0, j, i), x.at(1, j, i), x.at(2, j, i)};
    };
    most = std::max(most, distance(at(edges_.ends[n][0]), at(edges_.ends[n][1])) / edges_.rest[n]);
  }
  return float(most * most);
}

double MeshModel::rounding_gain() const {
  constexpr double kHalfUnit = 6e-8;  // of a position's last place, of the scene's size
  const double size = std::max(1.0, double(particles_.x.greatest(parts_.kernels)));
  return pull().stiffness * double(edges_.ends.size()) * std::pow(kHalfUnit * size, 2);
}

// Of M^-1/2 K M^-1/2, K as the difference of forces, which are as good as linear so near to rest; the
// damping's is that of forces by velocities.
Spectrum MeshModel::find_spectrum(std::span<const float> inverse_masses) const {
  const std::size_t count = start_.size();
  std::vector<double> root(count);
  for (std::size_t p = 0; p < count; ++p)
    root[p] = std::sqrt(double(inverse_masses[particles_.lane(int(p))]));
  using Field = std::vector<double>;
  const auto weighted = [&](const Field& u, double by) {
    std::vector<Vec3> field(count);
    for (std::size_t n = 0; n < u.size(); ++n) field[n / 3][n % 3] = by * root[n / 3] * u[n];
    return field;
  };
  const auto forces = [&](const std::vector<Vec3>& off, const std::vector<Vec3>* v) {
    std::vector<Vec3> x = start_, f(count);
    for (std::size_t p = 0; p < count; ++p) x[p] = plus(x[p], off[p]);
    add_mesh_forces(triangles_, material_, x, v, f);
    return f;
  };
  const double step = 1e-4 * *std::min_element(edges_.rest.begin(), edges_.rest.end());
  const auto stiffness = [&](const Field& u, Field& y) {
    double greatest = 1e-300;
    for (std::size_t n = 0; n < u.size(); ++n)
      greatest = std::max(greatest, std::abs(u[n]) * root[n / 3]);
    const double scale = step / greatest;
    const auto ahead = forces(weighted(u, scale), nullptr);
    const auto back = forces(weighted(u, -scale), nullptr);
    for (std::size_t n = 0; n < u.size(); ++n)
      y[n] = root[n / 3] * (back[n / 3][n % 3] - ahead[n / 3][n % 3]) / (2 * scale);
  };
  const std::vector<Vec3> still(count);
  const auto at_rest = forces(still, nullptr);
  const auto damping = [&](const Field& u, Field& y) {
    const std::vector<Vec3> v = weighted(u, 1);
    const auto f = forces(still, &v);
    for (std::size_t n = 0; n < u.size(); ++n)
      y[n] = root[n / 3] * (at_rest[n / 3][n % 3] - f[n / 3][n % 3]);
  };
  Spectrum spectrum;
  spectrum.omega_squared = largest_eigenvalue(3 * count, stiffness);
  if (material_.damped()) spectrum.damping = largest_eigenvalue(3 * count, damping);
  if (gas_) spectrum.load = gas_->omega_squared();
  return spectrum;
}

}  // namespace weft::physics

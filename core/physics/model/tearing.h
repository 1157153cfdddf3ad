// What holds together of a cloth that can tear, as the frame, views and snapshots see it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace weft::physics {

// A constraint by the particles that it joins.
using Joined = std::array<int, 2>;

// What is drawn of a torn cloth; corners and owners as lanes of the component arrays, corners of the
// boundary's triangles as numbers of its points.
struct TornSurface {
  using Triangles = std::span<const std::array<std::uint32_t, 3>>;
  Triangles whole;                               // triangles that no tear passes through
  std::span<const std::array<float, 3>> points;  // m; of the tear boundary
  std::span<const std::uint32_t> owners;         // the particle that each point goes with
  Triangles boundary;
  // Of a mesh with texture coordinates, those of the whole triangles' corners.
  std::span<const std::array<std::array<double, 2>, 3>> uv{};
};

class Tearing {
 public:
  virtual ~Tearing() = default;

  // Follows what died since the last call; returns whether anything did.
  virtual bool update() = 0;
  // Remembers which constraints there are; go_back() undoes what died since.
  virtual void remember() = 0;
  virtual void go_back() = 0;

  virtual std::int64_t torn() const = 0;      // constraints that are gone
  virtual std::uint64_t version() const = 0;  // rises when triangles change
  virtual std::vector<Joined> torn_list() const = 0;
  // Exactly these are gone, and what spans them; what no constraint joins is passed over.
  virtual void set_torn(const std::vector<Joined>& torn) = 0;
  // Ends these constraints and what spans them, and returns how many that were.
  virtual std::int64_t end_all(const std::vector<Joined>& constraints) = 0;
  // As the cloth lies now; valid until it moves or tears.
  virtual TornSurface surface() = 0;
};

}  // namespace weft::physics

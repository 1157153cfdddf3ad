// Where the vertices of a mesh are over time, as point caches hold it (.pc2, .mdd).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "weft/scene.h"

namespace weft {

struct PointCache {
  using Place = std::array<float, 3>;  // in the file's coordinates

  int points = 0;             // of each sample
  bool in_frames = false;     // times count frames of the scene, not seconds
  std::vector<float> times;   // of the samples, increasing
  std::vector<Place> places;  // sample after sample

  int samples() const { return int(times.size()); }
  const Place* sample(int n) const { return places.data() + std::size_t(n) * std::size_t(points); }
};

struct PointCacheFile {
  std::shared_ptr<const PointCache> cache;  // null where there are faults
  std::vector<Fault> faults;                // place: the file
};

// Of a mesh that is not known yet.
inline constexpr int kAnyPoints = -1;

// Reads a .pc2 file, whose times count frames, or an .mdd file, whose times are seconds. Refused: another
// number of points than `points`, no sample, times that do not increase, sizes that the header does not tell,
// what is no finite number, more than 1 GiB. Never throws on bad input.
PointCacheFile read_point_cache(const std::string& path, int points);

// The same from the bytes of a file; `name`, which ends with the format, is what messages call it.
PointCacheFile parse_point_cache(std::string_view bytes, const std::string& name, int points);

// Where the vertices of a mesh, which is read, are at a sample of their motion, from 0 on [m].
std::vector<Vec3> placed_vertices(const MeshSource& mesh, const PointCache& motion, int sample);

// Bytes of an .mdd file with the same samples, the same bits in the same order.
std::string mdd_bytes(const PointCache& cache);

}  // namespace weft

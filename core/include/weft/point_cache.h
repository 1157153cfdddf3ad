// Where the vertices of a mesh are over time, as point caches hold it (.pc2, .mdd), or as glTF files animate it.
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
  std::vector<Fault> faults;                // place: the file, or "file:place"
  std::vector<std::string> notes;           // of glTF, a sentence each that begins with the file
};

// Of a mesh that is not known yet.
inline constexpr int kAnyPoints = -1;

// Reads a .pc2 file, whose times count frames, an .mdd file, whose times are seconds, or the animation of a .glb or
// .gltf (read_gltf_motion()). Refused: another number of points than `points`, no sample, times that do not increase,
// sizes that the header does not tell, what is no finite number, more than 1 GiB. Never throws on bad input.
PointCacheFile read_point_cache(const std::string& path, int points);

// The same from the bytes of a .pc2 or .mdd file; `name`, which ends with the format, is what messages call it.
PointCacheFile parse_point_cache(std::string_view bytes, const std::string& name, int points);

// The first animation of a glTF 2.0 file, as .gltf or .glb: where its channels (STEP, LINEAR, CUBICSPLINE) put the
// vertices that read_gltf() reads, by nodes, skins and morph targets, in the file's seconds. Samples are at the keys,
// and so close between them that vertices, which go straight from one to the next, stay within 1e-4 of the mesh's
// size, or a note says how far they come off. What jumps from key to key does so in 1/60 s before the key, or in half
// of the time between them. Refused besides what breaks the format: no animation, a channel of more than 65536 keys,
// keys alone at more than 131072 times or 1 GiB. Buffers as for read_gltf(). Never throws on bad input.
PointCacheFile read_gltf_motion(std::string_view bytes, const std::string& name,
                                const std::string& folder, int points);

// Where the vertices of a mesh, which is read, are at a sample of their motion, from 0 on [m].
std::vector<Vec3> placed_vertices(const MeshSource& mesh, const PointCache& motion, int sample);

// Bytes of an .mdd file with the same samples, the same bits in the same order.
std::string mdd_bytes(const PointCache& cache);

}  // namespace weft

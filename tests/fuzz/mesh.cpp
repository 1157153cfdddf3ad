// Meshes of all formats: any bytes are a mesh whose triangles are of its vertices, or faults with reasons; and so are
// animations of glTF, whose samples are of the same vertices.
#include "weft/mesh.h"

#include <cmath>

#include "target.h"
#include "weft/point_cache.h"

namespace {

void look_at_motion(std::string_view text, const weft::MeshFile& mesh) {
  const weft::PointCacheFile file =
      weft::read_gltf_motion(text, "mesh.obj", "/nowhere", weft::kAnyPoints);
  for (const weft::Fault& fault : file.faults)
    fuzz::require(!fault.what.empty() && fault.place.starts_with("mesh.obj"));
  fuzz::require(file.faults.empty() == (file.cache != nullptr));
  if (!file.cache) return;
  fuzz::require(mesh.faults.empty() &&
                std::size_t(file.cache->points) == mesh.mesh.vertices.size());
  fuzz::require(file.cache->places.size() ==
                std::size_t(file.cache->points) * file.cache->times.size());
  for (std::size_t n = 1; n < file.cache->times.size(); ++n)
    fuzz::require(file.cache->times[n] > file.cache->times[n - 1]);
  for (const auto& place : file.cache->places)
    for (const float value : place) fuzz::require(std::abs(value) <= 1e9F);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = fuzz::text_of(data, size);
  const bool gltf = text.starts_with("glTF") || text.starts_with("{");
  const weft::MeshFile file = text.starts_with("ply") ? weft::read_ply(text, "mesh.obj")
                              : gltf ? weft::read_gltf(text, "mesh.obj", "/nowhere")
                                     : weft::read_obj(text, "mesh.obj");
  for (const weft::Fault& fault : file.faults)
    fuzz::require(!fault.what.empty() && fault.place.starts_with("mesh.obj"));
  if (gltf) look_at_motion(text, file);
  if (!file.faults.empty()) return 0;
  fuzz::require(!file.mesh.triangles.empty());
  fuzz::require(file.mesh.uv.empty() || file.mesh.uv.size() == file.mesh.triangles.size());
  for (const auto& triangle : file.mesh.triangles)
    for (const int corner : triangle)
      fuzz::require(corner >= 0 && std::size_t(corner) < file.mesh.vertices.size());
  return 0;
}

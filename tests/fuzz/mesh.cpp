// Meshes of all formats: any bytes are a mesh whose triangles are of its vertices, or faults with reasons.
#include "weft/mesh.h"

#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = fuzz::text_of(data, size);
  const bool gltf = text.starts_with("glTF") || text.starts_with("{");
  const weft::MeshFile file = text.starts_with("ply") ? weft::read_ply(text, "mesh.obj")
                              : gltf ? weft::read_gltf(text, "mesh.obj", "/nowhere")
                                     : weft::read_obj(text, "mesh.obj");
  for (const weft::Fault& fault : file.faults)
    fuzz::require(!fault.what.empty() && fault.place.starts_with("mesh.obj"));
  if (!file.faults.empty()) return 0;
  fuzz::require(!file.mesh.triangles.empty());
  fuzz::require(file.mesh.uv.empty() || file.mesh.uv.size() == file.mesh.triangles.size());
  for (const auto& triangle : file.mesh.triangles)
    for (const int corner : triangle)
      fuzz::require(corner >= 0 && std::size_t(corner) < file.mesh.vertices.size());
  return 0;
}

// Triangle meshes as they come from files: what cloth and bodies of any shape are made of.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "weft/scene.h"

namespace weft {

// Vertices keep the numbers and the order that they have in the file.
struct TriangleMesh {
  // The vertices of one object or group of the file.
  struct Group {
    std::string name;
    std::vector<int> vertices;  // ascending, each once
  };
  using Uv = std::array<double, 2>;

  std::vector<Vec3> vertices;                 // m
  std::vector<std::array<int, 3>> triangles;  // corners, counter-clockwise seen from outside
  std::vector<std::array<Uv, 3>> uv;      // of every triangle's corners; empty: the file has none
  std::vector<std::array<int, 2>> edges;  // loose ones, of no face
  std::vector<Group> groups;
};

struct MeshFile {
  TriangleMesh mesh;               // complete only when `faults` is empty
  std::vector<Fault> faults;       // place: "file:line", or the file alone
  std::vector<std::string> notes;  // what was repaired, a sentence each that begins with the file
};

// Whether a file's name ends as those of meshes do, in letters of any size.
bool is_mesh_file(std::string_view path);

// Reads a mesh file by the end of its name, .obj, .ply, .glb or .gltf: faces of three corners or more are cut
// into triangles. Repaired, with a note: corners that repeat a vertex, faces given twice, faces turned over.
// Refused: what is not a finite number, faces without area, edges of more than two faces, more than 2^22
// triangles or 2^22 vertices. Never throws on bad input.
MeshFile read_mesh(const std::string& path);

// The same from bytes in memory; `name` is what messages call it.
MeshFile read_obj(std::string_view text, const std::string& name);
// Stanford .ply, in text or binary. Vertices in one place are one where they carry texture coordinates or
// normals; edges of the file are loose ones.
MeshFile read_ply(std::string_view bytes, const std::string& name);
// glTF 2.0, as .gltf or .glb: all nodes of its scene as one mesh [m], each a group of its name, as the file shows
// them where nothing is animated: by the nodes' transforms, skins, and morph targets with their weights. Vertices of
// one node in one place are one, if they move alike. Buffers lie in the file, or beside it in `folder`. Refused
// besides: compression. Left out, with a note: points.
MeshFile read_gltf(std::string_view bytes, const std::string& name, const std::string& folder);

// Text that read_obj() reads to the same mesh, groups left out: the same bits in the same order.
std::string write_obj(const TriangleMesh& mesh);

// The mean length of the edges of a mesh, which is read, as the scene places it [m]; inner edges count twice.
double mean_edge(const MeshSource& mesh);

// What seams make one: groups of two vertices or more of a cloth's mesh, which is read. Its pairs join them,
// and with `sewing` its loose edges; vertices of no face pass a seam on, but are in no group. Groups come in
// the order of their least vertices, each ascending.
std::vector<std::vector<int>> sewn_vertices(const Cloth& cloth);

// A mesh, which is read, with what its seams join as one: points that are vertices, or groups of them, and
// triangles of points.
struct EnclosingSurface {
  std::vector<std::vector<int>> members;      // vertices of each point
  std::vector<std::array<int, 3>> triangles;  // as those of the mesh
};
EnclosingSurface enclosing_surface(const Cloth& cloth);

// What a closed mesh, which is read, encloses as it starts [m³]; points lie in the middle of their vertices.
// Below 0 where its triangles look inwards.
double enclosed_volume(const Cloth& cloth);

// Calls visit(mesh, place in the scene) for every mesh of a scene, of cloths, of their shapes at rest, and of
// bodies.
template <class AnyScene, class Visit>
void for_each_mesh(AnyScene& scene, Visit&& visit) {
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    auto& mesh = scene.cloths[c].mesh;
    if (!mesh.given()) continue;
    const std::string place = "/cloths/" + std::to_string(c) + "/mesh";
    visit(mesh, place);
    if (mesh.rest == MeshRest::file) visit(mesh.at_rest, place + "/rest");
  }
  for (std::size_t c = 0; c < scene.colliders.size(); ++c)
    if (auto* body = std::get_if<MeshBody>(&scene.colliders[c].shape))
      visit(*body, "/colliders/" + std::to_string(c) + "/mesh");
}

// Calls visit(name) for the name of every file of meshes and animations.
template <class Visit>
void for_each_mesh_file(Scene& scene, Visit&& visit) {
  for_each_mesh(scene, [&](MeshSource& mesh, const std::string&) { visit(mesh.file); });
  for (Collider& collider : scene.colliders)
    if (!collider.animation.empty()) visit(collider.animation);
}

// Where the scene names the file of the mesh at such a place.
inline std::string place_of_file(const std::string& place) {
  return place.ends_with("/rest") ? place : place + "/file";
}

// What is asked of the surface of a body, whose mesh and motion are read, scaled and turned, about its place.
// `frame` [s]: of the scene, which is the unit of time of some motions.
std::shared_ptr<const BodySurface> surface_of(const MeshBody& body, double frame = 1.0 / 60);

// The edges that one triangle alone has, by the numbers of their vertices in the file from 0 on; none: the
// body is closed.
std::span<const std::array<int, 2>> open_edges(const BodySurface& surface);

// Meshes and motions by the names of their files, for scenes that come from the same files.
struct MeshStore {
  std::map<std::string, std::shared_ptr<const TriangleMesh>> shapes;
  std::map<std::string, std::shared_ptr<const PointCache>> motions;
  // What a scene has.
  void take(const Scene& scene);
  // To the meshes of a scene that have nothing yet.
  void give(Scene& scene) const;
};

// Names the files of meshes and animations by their whole paths, where they lie beside `folder`.
void use_full_paths(Scene& scene, const std::string& folder);

// Reads the meshes of a scene that have no shape yet, and the animations of bodies, files beside `folder`
// where they are not absolute, and makes the surfaces of bodies. Faults have the place in the scene, and
// where in the file.
void load_meshes(Scene& scene, const std::string& folder, std::vector<Fault>& faults,
                 std::vector<std::string>& notes);

}  // namespace weft

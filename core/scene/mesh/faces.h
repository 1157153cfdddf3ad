// A mesh while it is read: faces with the lines that they come from.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "weft/mesh.h"

namespace weft::text {

inline constexpr std::size_t kMaxVertices = std::size_t{1} << 22, kMaxTriangles = kMaxVertices;
inline constexpr std::size_t kMaxLooseEdges = 4 * kMaxVertices;
inline constexpr std::size_t kMaxMeshFaults = 20;
inline constexpr std::size_t kMaxMeshBytes = std::size_t{1} << 30;  // of a file
inline constexpr std::size_t kMaxCorners = 256;  // of one face, which is cut in the square of them
inline constexpr double kFarthestPlace = 1e9;    // in the file's own units

// A mesh, and the line of the file that each of its triangles comes from; in files without lines another
// number above 0, which `words` tells of ("face 12").
struct RawMesh {
  MeshFile& file;
  const std::string& name;
  std::vector<int> lines{};
  std::function<std::string(int)> words{};
  int first_vertex = 1;  // its number in messages, as the format counts

  // `line`: 0 where the whole file is meant.
  void fault(int line, std::string what, std::string allowed) const;
  std::string where(int line) const { return words ? words(line) : "line " + std::to_string(line); }
  void note(const std::string& what) const { file.notes.push_back(name + ": " + what); }
  bool full() const { return file.faults.size() >= kMaxMeshFaults; }
};

// What keeps a mesh, which is read or made by a program, from being simulated where the scene puts it. Faces
// without area and edges of more than two are told of as files are read.
std::optional<Fault> fault_of(const MeshSource& mesh, const std::string& place);
// The same of a mesh with corners, which messages call so, whose vertices lie so [m].
std::optional<Fault> fault_of_places(const TriangleMesh& mesh, const std::vector<Vec3>& x,
                                     const std::string& called, const std::string& place);
// Where the scene has points that a file has.
void put(const MeshSource& mesh, std::vector<Vec3>& points);

// The mean length of the edges of a mesh whose vertices lie so; inner edges count twice.
double mean_edge_at(const TriangleMesh& mesh, const std::vector<Vec3>& x);

// What keeps a mesh from being cloth with its shape at rest.
std::optional<Fault> fault_of_rest(const ClothMesh& mesh, const std::string& place);

// Cuts a polygon into triangles of its corners' numbers, by ears, seen along its mean normal; the shorter
// diagonal of a quadrilateral where both lie inside.
// `crosses`: set where the polygon is seen to cross itself.
std::vector<std::array<int, 3>> triangles_of(const std::vector<Vec3>& corners,
                                             bool* crosses = nullptr);

// Drops what is given twice, turns faces so that neighbours agree, and tells of what cannot be cloth.
void repair(RawMesh& mesh);

}  // namespace weft::text

// Odd meshes, animations and pins in scene files: what is meant is read, what is not meant is told.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "folder.h"
#include "made_up_bodies.h"
#include "output/bytes.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n";

std::string told(const SceneFile& file) {
  std::string text;
  for (const Fault& f : file.faults) text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
  for (const std::string& note : file.notes) text += note + "\n";
  return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

SceneFile read_cloth(const Folder& folder, const std::string& cloth) {
  return read_scene(folder.write("scene.json", R"({"weft": 1, "cloths": [{)" + cloth + "}]}"));
}

SceneFile read_body(const Folder& folder, const std::string& body) {
  return read_scene(folder.write("scene.json", R"({"weft": 1,
      "cloths": [{"grid": {"points": [4, 4], "origin": [0, 9, 0]}}], "colliders": [{)" +
                                                   body + "}]}"));
}

// A point cache of one sample.
std::string cache_of(const std::vector<Vec3>& places) {
  std::string bytes("POINTCACHE2\0", 12);
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(1), put(int(places.size())), put(0.0F), put(1.0F), put(1);
  for (const Vec3& p : places)
    for (const double value : p) put(float(value));
  return bytes;
}

TEST(MeshInput, AMeshWithoutAFileIsNoGrid) {
  const std::string missing = "file: file is missing (a mesh file (.obj, .ply, .glb, .gltf))\n";
  for (const std::string mesh :
       {R"({})", R"({"file": ""})", R"({"scale": 2, "rest": "uv"})", R"({"translate": [0, 1, 0]})"})
    for (const std::string more : {"", R"(, "pins": [40])", R"(, "grid": {"points": [8, 8]})"}) {
      const std::string cloth = R"("mesh": )" + mesh + more;
      EXPECT_EQ(told(read_scene_text(R"({"weft": 1, "cloths": [{)" + cloth + "}]}")),
                "/cloths/0/mesh/" + missing)
          << cloth;
    }
  EXPECT_EQ(told(read_scene_text(R"({"weft": 1, "cloths": [{}], "colliders": [{"mesh": {}}]})")),
            "/colliders/0/mesh/" + missing);
  // One fault for one mistake.
  EXPECT_EQ(
      told(read_scene_text(R"({"weft": 1, "cloths": [{"mesh": {"fil": "a.obj"}, "pins": [40]}]})")),
      "/cloths/0/mesh/fil: unknown key \"fil\" (the nearest known key is \"file\")\n");
  // Made by a program, and by an override of a scene of grids.
  Scene scene;
  scene.cloths.emplace_back().mesh.scale = 2;
  const std::vector<Fault> faults = validate(scene);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].place + ": " + faults[0].what, "/cloths/0/mesh/file: file is missing");
  for (const char* of : {R"({"weft": 1, "cloths": [{}]})", R"({"cloth": {}})"}) {
    EXPECT_EQ(told(read_scene_text(of, {{"/cloths/0/mesh/scale", "2"}})),
              "/cloths/0/mesh/" + missing);
    EXPECT_EQ(told(read_scene_text(of, {{"/cloths/0/density", "2"}})), "");
  }
}

// However its lines end and go on, and whatever mark it begins with.
TEST(MeshInput, AnObjFileIsReadWhateverItsLinesAre) {
  const std::string plain = kSquare + "o a#1\nf 1 2 3 # \\\no a#2\nf 1 3 4\n";
  const MeshFile expected = read_obj(plain, "a.obj");
  ASSERT_TRUE(expected.faults.empty());
  ASSERT_EQ(expected.mesh.groups.size(), 2u);
  EXPECT_EQ(expected.mesh.groups[0].name, "a#1");
  const std::string wide =
      replaced(replaced(plain, "f 1 3", "f \\\n1 3\\\n"), "v 1 0", "v 1\\\n\\\n 0");
  for (const std::string& text : {plain, wide})
    for (const std::string end : {"\n", "\r\n"})
      for (const std::string mark : {"", "\xEF\xBB\xBF"})
        for (const bool last : {true, false}) {
          std::string bytes = mark + replaced(text, "\n", end);
          if (!last) bytes.resize(bytes.size() - end.size());
          const MeshFile file = read_obj(bytes, "a.obj");
          ASSERT_TRUE(file.faults.empty()) << bytes << file.faults[0].what;
          EXPECT_EQ(file.mesh.vertices, expected.mesh.vertices);
          EXPECT_EQ(file.mesh.triangles, expected.mesh.triangles);
          EXPECT_EQ(file.mesh.groups.size(), 2u);
        }
  const MeshFile old = read_obj(replaced(plain, "\n", "\r"), "a.obj");
  ASSERT_TRUE(old.faults.empty()) << old.faults[0].what;
  EXPECT_EQ(old.mesh.triangles, expected.mesh.triangles);
  // Faults have the line on which the statement begins.
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const MeshFile bad = read_obj(replaced(wide + "v 1 \\\n x 0\n", "\n", end), "a.obj");
    ASSERT_EQ(bad.faults.size(), 1u);
    EXPECT_EQ(bad.faults[0].place, "a.obj:15");
  }
  EXPECT_TRUE(read_obj(plain + "f 1 2 3 \\", "a.obj").faults.empty());
}

TEST(MeshInput, OtherTextsMayBeginWithTheMarkOfUtf8) {
  const Folder folder;
  const std::string mark = "\xEF\xBB\xBF";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 "
      "1\n3 0 1 2\n";
  EXPECT_TRUE(read_ply(mark + ply, "a.ply").faults.empty());
  const std::string gltf = R"({"asset": {"version": "2.0"}})";
  EXPECT_EQ(read_gltf(mark + gltf, "a.gltf", "").faults[0].what,
            read_gltf(gltf, "a.gltf", "").faults[0].what);
  EXPECT_EQ(told(read_scene_text(mark + R"({"weft": 1, "cloths": [{}]})")), "");
  folder.write("a.obj", std::string("\xFF\xFEv\0 \0", 6));
  EXPECT_EQ(read_mesh(folder / "a.obj").faults[0].what, "the file is text in UTF-16");
}

TEST(MeshInput, VerticesThatLieOnOthersAreToldOf) {
  const Folder folder;
  const std::string apart =
      "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 4 5 6\n";
  const auto notes = [&](const std::string& obj, const std::string& more = "") {
    folder.write("a.obj", obj);
    const SceneFile file = read_cloth(folder, R"("mesh": {"file": "a.obj"})" + more);
    EXPECT_TRUE(file.faults.empty()) << told(file);
    return told(file);
  };
  EXPECT_EQ(notes(apart),
            "/cloths/0/mesh: 2 vertices lie exactly on others without being joined to them, first "
            "3 on 1 (counted from 0): the cloth is in pieces there. If it is to be one, merge them "
            "in the file, or join them by pairs: \"seams\": [[1, 3], …]\n");
  EXPECT_NE(notes(apart, R"(, "seams": [[1, 3]])").find(": 1 vertex lies exactly on others"),
            std::string::npos);
  // -0 is 0, and three in one place are two too many.
  EXPECT_NE(notes(apart + "v 0 0 1\nv 1 0 2\nv -0 0 2\nf 7 8 9\n").find(": 3 vertices lie"),
            std::string::npos);
  // No alarm: joined by pairs or by loose edges; of no face; beside each other; one vertex with several texture
  // coordinates.
  EXPECT_EQ(notes(apart, R"(, "seams": [[1, 3], [5, 2]])"), "");
  EXPECT_EQ(notes(apart + "l 2 4\nl 3 6\n", R"(, "sewing": true)"), "");
  EXPECT_EQ(notes(kSquare + "v 0 0 0\nf 1 2 3\nf 1 3 4\n").find("lie"), std::string::npos);
  EXPECT_EQ(notes(replaced(apart, "v 1 0 0\nv 1 0 1\nv 0 0 1", "v 1 1e-5 0\nv 1 0 1\nv 0 1e-5 1")),
            "");
  EXPECT_EQ(notes(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 5 0\nvt 6 0\nvt 5 1\nf 1/1 2/2 3/3\nf 1/4 "
                            "3/5 4/6\n"),
            "");
}

TEST(MeshInput, APinOfAMeshIsANumber) {
  const Folder folder;
  folder.write("a.obj", kSquare + "f 1 2 3 4\n");
  const auto pins = [&](const std::string& list) {
    return read_cloth(folder, R"("mesh": {"file": "a.obj"}, "pins": )" + list);
  };
  const std::string why =
      " is a column and a row, and the cloth is a mesh (the number of a vertex, from 0 on)\n";
  EXPECT_EQ(told(pins("[[3, 0]]")), "/cloths/0/pins/0: the pin [3, 0]" + why);
  EXPECT_EQ(told(pins("[1, [3, 2]]")), "/cloths/0/pins/1: the pin [3, 2]" + why);
  EXPECT_EQ(told(pins(R"([{"at": [3, 0]}])")), "/cloths/0/pins/0/at: the pin [3, 0]" + why);
  // What is written comes back.
  const SceneFile file = pins(R"([3, {"at": 1, "follow": 0}, {"vertices": [0, 2]}])");
  EXPECT_EQ(file.faults.size(), 1u);  // no collider
  const SceneFile still = pins(R"([3, {"at": 1, "keys": [[0, 0, 1, 0]]}, {"vertices": [0, 2]}])");
  ASSERT_EQ(told(still), "");
  const SceneFile again = read_scene(folder.write("again.json", write_scene_text(still.scene)));
  EXPECT_EQ(told(again), "");
  EXPECT_EQ(again.scene, still.scene);
}

TEST(MeshInput, FaultsOfPlacesHaveVertexValueAndRange) {
  const Folder folder;
  folder.write("a.obj", kSquare + "f 1 2 3 4\n");
  EXPECT_EQ(told(read_cloth(folder, R"("mesh": {"file": "a.obj", "scale": 2e4})")),
            "/cloths/0/mesh/scale: the mesh reaches 20000 m away, at vertex 1 (counted from 0) "
            "(-10000 to 10000 m along each axis)\n");
  folder.write("a.obj", "v 0 0 0\nv 1e-3 0 0\nv 0 0 5e-7\nf 1 2 3\n");
  EXPECT_EQ(told(read_cloth(folder, R"("mesh": {"file": "a.obj"})")),
            "/cloths/0/mesh/scale: the mesh has an edge of 5e-7 m, between vertices 2 and 0 "
            "(counted from 0) (edges of at least 1e-6 m)\n");
}

TEST(MeshInput, AShapeAtRestThatIsNoneIsToldOf) {
  const Folder folder;
  folder.write("a.obj", kSquare + "f 1 2 3 4\n");
  const auto rest = [&](const std::string& word) {
    return told(read_cloth(folder, R"("mesh": {"file": "a.obj", "rest": ")" + word + R"("})"));
  };
  for (const char* word : {"shape", "flat", "a.obj"}) EXPECT_EQ(rest(word), "") << word;
  EXPECT_EQ(rest(""),
            "/cloths/0/mesh/rest: rest is empty (shape, flat or uv, or a second mesh file)\n");
  EXPECT_EQ(rest("Flat"), "/cloths/0/mesh/rest: " + (folder / "Flat") +
                              ": the file is of no known kind (shape, flat, uv, or a file: .obj, "
                              ".ply, .glb, .gltf)\n");
}

TEST(MeshInput, AFaceThatCrossesItselfIsToldOf) {
  const std::string note =
      "a.obj: 1 face crosses itself, seen along the normal, first in line 5; "
      "triangles of it lie on each other";
  for (const char* face : {"f 1 3 2 4", "f 1 2 4 3"}) {
    const MeshFile file = read_obj(kSquare + face + "\n", "a.obj");
    ASSERT_GE(file.notes.size(), 1u) << face;
    EXPECT_EQ(file.notes[0], note);
  }
  // Neither a dent, nor corners in line, nor what is not plane.
  for (const std::string& places :
       {kSquare, std::string("v 0 0 0\nv 1 0 0\nv 0.1 0 0.1\nv 0 0 1\n"),
        std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 0 3\n"),
        std::string("v 0 0 0\nv 1 0.4 0\nv 1 0 1\nv 0 0.4 1\n")}) {
    EXPECT_TRUE(read_obj(places + "f 1 2 3 4\n", "a.obj").notes.empty()) << places;
    EXPECT_TRUE(read_obj(places + "f 4 3 2 1\n", "a.obj").notes.empty()) << places;
  }
}

TEST(MeshInput, AFaultyAnimationIsOneFault) {
  const Folder folder;
  const auto ball = tests::ball(8, 6, 0.5);
  folder.write("body.obj", write_obj(*ball));
  std::vector<Vec3> places = ball->vertices;
  places[ball->triangles[0][1]] = places[ball->triangles[0][0]];
  folder.write("bad.pc2", cache_of(places));
  const std::string text =
      told(read_body(folder, R"("mesh": {"file": "body.obj"}, "animation": "bad.pc2")"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_EQ(text.find("/colliders/0/animation: sample 1 of the animation has an edge of 0 m"), 0u);
  EXPECT_EQ(text.find("()"), std::string::npos) << text;
}

// Of balls of all sizes, numbered at random; no alarm for what bends, grows, or is drawn out.
TEST(MeshInput, AnAnimationInAnotherOrderIsToldOf) {
  const Folder folder;
  std::mt19937 random(7);
  for (const auto& [around, along] : {std::pair(8, 6), {12, 8}, {24, 16}, {60, 40}}) {
    const auto ball = tests::ball(around, along, 0.5);
    folder.write("body.obj", write_obj(*ball));
    const auto notes = [&](const std::vector<Vec3>& places) {
      folder.write("a.pc2", cache_of(places));
      const SceneFile file =
          read_body(folder, R"("mesh": {"file": "body.obj"}, "animation": "a.pc2")");
      EXPECT_TRUE(file.faults.empty()) << told(file);
      return told(file);
    };
    for (int n = 0; n < 5; ++n) {
      std::vector<Vec3> mixed = ball->vertices;
      std::shuffle(mixed.begin(), mixed.end(), random);
      EXPECT_NE(notes(mixed).find("its vertices may be in another order"), std::string::npos)
          << around;
    }
    const double turns = std::min(8.0, 0.1 * around);
    const Vec3 pole = ball->vertices[0];
    const auto moved = [&](const auto& to) {
      std::vector<Vec3> places;
      for (const Vec3& p : ball->vertices) places.push_back(to(p));
      return notes(places);
    };
    EXPECT_EQ(moved([](Vec3 p) { return p; }), "");
    EXPECT_EQ(moved([](Vec3 p) { return Vec3{p[2] + 3, -p[0], p[1]}; }), "");
    EXPECT_EQ(moved([](Vec3 p) { return Vec3{2 * p[0], 0.1 * p[1], p[2]}; }), "");
    EXPECT_EQ(
        moved([&](Vec3 p) {  // rolled up, as far as its edges allow
          const double a = turns * p[0];
          return Vec3{(0.3 + 0.1 * p[1]) * std::cos(a), (0.3 + 0.1 * p[1]) * std::sin(a), p[2]};
        }),
        "");
    EXPECT_EQ(moved([&](Vec3 p) { return p == pole ? Vec3{0, 5, 0} : p; }), "");  // a spike
    EXPECT_NE(moved([](Vec3 p) {
                return Vec3{100 * p[0], 100 * p[1], 100 * p[2]};
              }).find("its unit may be another"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace weft

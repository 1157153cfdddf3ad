// Bodies that are mesh files, as scenes name them.
#include "body_scenes.h"
#include "contact_scenes.h"
#include "folder.h"
#include "made_up_bodies.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {
namespace {

TEST(MeshBodyFile, IsBesideTheScene) {
  const Folder folder;
  folder.write("body.obj", write_obj(*tests::box({1, 2, 3})));
  folder.write("scene.json", scene_with(R"({"mesh": {"file": "body.obj", "scale": 0.1,
      "rotate": [0, 0, 90], "translate": [0, 0.1, 0]}, "friction": 0.5, "offset": 0.01})"));
  const SceneFile file = read_scene(folder / "scene.json");
  ASSERT_TRUE(file.faults.empty()) << first_fault(file);
  const Collider& body = file.scene.colliders[0];
  EXPECT_NEAR(signed_distance(body, 0, {0.5, 0.1, 0}), 0.3, 1e-12);  // turned: 0.2 wide
  EXPECT_NEAR(signed_distance(body, 0, {0, 0.15, 0}), -0.05, 1e-12);
  const SceneFile again = read_scene(folder.write("again.json", write_scene_text(file.scene)));
  EXPECT_EQ(again.scene.colliders, file.scene.colliders);
  EXPECT_TRUE(again.faults.empty());
  const SceneFile smaller =
      read_scene(folder / "scene.json", {{"/colliders/0/mesh/scale", "0.05"}});
  EXPECT_NEAR(signed_distance(smaller.scene.colliders[0], 0, {0.5, 0.1, 0}), 0.4, 1e-12);
}

TEST(MeshBodyFile, FaultsNameTheFileAndTheLine) {
  const Folder folder;
  const auto fault_of = [&](const std::string& obj, const std::string& more = "") {
    folder.write("body.obj", obj);
    folder.write("scene.json", scene_with(R"({"mesh": {"file": "body.obj")" + more + "}}"));
    return first_fault(read_scene(folder / "scene.json"));
  };
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string place = "/colliders/0/mesh/file: " + (folder / "body.obj");
  EXPECT_EQ(fault_of("v 0 0 nan\n"), place + ":1: \"nan\" is no coordinate");
  EXPECT_EQ(fault_of(corners + "f 1 2 5\n"), place + ":5: there is no vertex \"5\"");
  EXPECT_EQ(fault_of(corners), place + ": the mesh has no faces");
  EXPECT_EQ(fault_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
            place + ":4: the triangle of vertices 1, 2 and 3 has no area");
  const std::string open = fault_of(corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  EXPECT_NE(open.find("/colliders/0/offset: offset is 0, and the mesh is open: 3 edges"),
            std::string::npos)
      << open;
  EXPECT_EQ(fault_of(corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"), "");
  EXPECT_NE(fault_of(corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", R"(, "scale": 1e5)")
                .find("/colliders/0/mesh/scale: the mesh reaches"),
            std::string::npos);
  folder.write("scene.json", scene_with(R"({"mesh": {"file": "none.obj"}})"));
  EXPECT_NE(first_fault(read_scene(folder / "scene.json")).find("there is no such mesh file"),
            std::string::npos);
  EXPECT_EQ(first_fault(read_scene_text(scene_with(R"({"mesh": {}})"))),
            "/colliders/0/mesh/file: file is missing");
}

TEST(MeshBodyFile, ARecordingCarriesIt) {
  const Folder folder;
  folder.write("body.obj", write_obj(*tests::ball(16, 8, 0.4)));
  folder.write("scene.json", scene_with(R"({"mesh": {"file": "body.obj"}, "friction": 0.5})"));
  const SceneFile file = read_scene(folder / "scene.json");
  ASSERT_TRUE(file.faults.empty()) << first_fault(file);
  Simulation simulation(file.scene);
  {
    Recorder recorder(folder / "run.jsonl", simulation);
    for (int n = 0; n < 3; ++n) {
      simulation.advance_frame();
      recorder.frame(simulation);
    }
    recorder.finish();
  }
  std::filesystem::remove(folder / "body.obj");
  const Recording recording = read_recording(folder / "run.jsonl");
  Simulation replayed(recording.scene);
  for (int n = 0; n < 3; ++n) replayed.advance_frame();
  EXPECT_EQ(replayed.hash(), simulation.hash());
}

}  // namespace
}  // namespace weft

// What a window leaves when it is ended from outside, and files that its command line names twice.
#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <vector>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

class WindowEnds : public Window {
 protected:
  // Begins a film and waits for some frames of it.
  static void film(const Screen& screen) {
    screen.key("F11");
    screen.wait("the film", [](const Json& now) {
      return now["news"].dump().find("pinned2.mp4") != std::string::npos;
    });
    const int start = screen.now()["frame"];
    screen.wait("frames", [&](const Json& now) { return now["frame"] > start + 8; });
  }
  // The recording is whole and replays, and nothing else is left in the folder.
  void expect_recording() const {
    ASSERT_TRUE(folder.has("session"));
    EXPECT_EQ(weft("run --replay session"), 0) << folder.read("weft.out");
    std::ifstream lines(folder / "session");
    const auto count = std::count(std::istreambuf_iterator<char>(lines), {}, '\n');
    EXPECT_GT(count, 20);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      EXPECT_FALSE(entry.path().string().ends_with(".tmp")) << entry.path();
  }
};

TEST_F(WindowEnds, ASignalEndsItInOrder) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Screen screen(folder);
    screen.open("pinned2 --record session");
    screen.wait("frames", [](const Json& now) { return now["frame"] > 25; });
    screen.send(signal);
    EXPECT_EQ(screen.finish(), 128 + signal) << screen.said();
    expect_recording();
    std::filesystem::remove(folder / "session");
  }
}

// Alone, and where the session goes on with a mesh after a grid, whose recording ends there.
TEST_F(WindowEnds, MeshesAreRecordedWithTheSession) {
  Screen screen(folder);
  screen.open("flag_round --record session");
  screen.wait("frames", [](const Json& now) { return now["frame"] > 10; });
  screen.click("add sphere");
  const Json added = screen.wait_for("edited", true);
  screen.wait("more",
              [&](const Json& now) { return now["frame"] > added["frame"].get<int>() + 15; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_NE(folder.read("session").find("\"set_scene\""), std::string::npos);
  EXPECT_EQ(weft("run flag_round --replay session"), 0) << folder.read("weft.out");
  expect_recording();

  Screen second(folder);
  second.open("flag --record session");
  second.wait("frames", [](const Json& now) { return now["frame"] > 25; });
  second.key("Next");
  second.wait("the mesh",
              [](const Json& now) { return now["scene"] == "flag_round" && now["frame"] > 5; });
  EXPECT_EQ(second.quit(), 0) << second.said();
  expect_recording();
}

// The frame in which it comes would take many minutes.
TEST_F(WindowEnds, NothingWaitsForALongFrame) {
  const auto scene = [](int substeps, int stiffness) {
    return R"({"weft": 1, "time": {"substeps": )" + std::to_string(substeps) +
           R"(}, "cloths": [{"grid": {"points": [300, 300]}, "stiffness": {"structural": )" +
           std::to_string(stiffness) + "}}]}";
  };
  for (const int signal : {0, SIGINT, SIGTERM}) {
    folder.write("long.json", scene(2, 50));
    Screen screen(folder);
    screen.open("long.json --record session --threads 1");
    screen.click("Export");
    screen.click("Start export");
    screen.wait("frames", [](const Json& now) { return now["frame"] > 25; });
    folder.write("long.json", scene(100000, 51));
    screen.wait("the long frame", [](const Json& now) { return now["stiffness"] == 51; });
    const auto begun = std::chrono::steady_clock::now();
    if (signal != 0) screen.send(signal);
    EXPECT_EQ(signal != 0 ? screen.finish() : screen.quit(), signal == 0 ? 0 : 128 + signal)
        << screen.said();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(30));
    expect_recording();
    EXPECT_TRUE(folder.read("long.pc2").starts_with("POINTCACHE2"));
    for (const char* file : {"session", "long.pc2"}) std::filesystem::remove(folder / file);
  }
}

// Ctrl-C goes to all processes of the terminal's group.
TEST_F(WindowEnds, CtrlCKeepsTheFilm) {
  Screen screen(folder);
  screen.open("pinned2");
  film(screen);
  const std::string viewer = std::to_string(screen.viewer());
  std::ifstream children("/proc/" + viewer + "/task/" + viewer + "/children");
  for (pid_t child = 0; children >> child;)
    if (::getpgid(child) == ::getpgid(screen.viewer())) ::kill(child, SIGINT);
  screen.send(SIGINT);
  EXPECT_EQ(screen.finish(), 128 + SIGINT) << screen.said();
  EXPECT_EQ(run("ffprobe -v error pinned2.mp4"), 0);
}

TEST_F(WindowEnds, ALostDisplayLosesNeitherRecordingNorFilm) {
  Screen screen(folder);
  screen.open("pinned2 --record session");
  film(screen);
  screen.end_server();
  EXPECT_EQ(screen.finish(), 6) << screen.said();
  EXPECT_NE(screen.said().find("the display is gone"), std::string::npos) << screen.said();
  expect_recording();
  EXPECT_EQ(run("ffprobe -v error pinned2.mp4"), 0);
}

// A film that fails when the window has closed is told where there is no window to tell it.
TEST_F(WindowEnds, AFilmThatFailsAtTheEndIsAnError) {
  std::filesystem::create_directory(folder / "bin");
  folder.write("bin/ffmpeg", "#!/bin/sh\n/bin/cat >/dev/null\nexit 1\n");
  std::filesystem::permissions(folder / "bin/ffmpeg", std::filesystem::perms::owner_all);
  Screen screen(folder);
  screen.open("pinned2", "PATH='" + (folder / "bin") + "'");
  film(screen);
  EXPECT_EQ(screen.quit(), 5);
  EXPECT_NE(screen.said().find("pinned2.mp4: the film could not be written"), std::string::npos)
      << screen.said();
}

TEST_F(WindowEnds, QuitLeavesNothing) {
  Screen screen(folder);
  screen.open("pinned2 --record session");
  screen.wait("frames", [](const Json& now) { return now["frame"] > 25; });
  screen.send(SIGQUIT);
  EXPECT_EQ(screen.finish(), 128 + SIGQUIT);
  EXPECT_FALSE(folder.has("session"));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().string().ends_with(".tmp")) << entry.path();
}

TEST_F(WindowEnds, ARecordingThatCannotBeWrittenIsAnError) {
  // At the end, or while it is written.
  for (const int frames : {5, 200}) {
    Screen screen(folder);
    screen.open("pinned2 --record /dev/full");
    screen.wait("frames", [&](const Json& now) { return now["frame"] > frames; });
    EXPECT_EQ(screen.quit(), 5);
    EXPECT_NE(screen.said().find("/dev/full: writing failed"), std::string::npos) << screen.said();
  }
}

TEST_F(WindowEnds, NoOutputOverwritesAnotherOrAnInput) {
  folder.write("small.json", R"({"weft": 1, "cloths": [{"grid": {"points": [4, 4]}}]})");
  const Screen screen(folder);
  for (const auto& [arguments, one, other] :
       std::vector<std::array<std::string, 3>>{{"--record a --log ./a", "--record", "--log"},
                                               {"--record small.json", "--record", "SCENE"},
                                               {"--headless --out small.json", "--out", "SCENE"}}) {
    EXPECT_EQ(run("DISPLAY=" + screen.display() + " '" WEFT_VIEWER_PROGRAM "' small.json " +
                  arguments + " 2>err"),
              2)
        << arguments;
    const std::string said = folder.read("err");
    EXPECT_NE(said.find(one), std::string::npos) << said;
    EXPECT_NE(said.find(other), std::string::npos) << said;
  }
  EXPECT_TRUE(folder.read("small.json").starts_with("{\"weft\""));
}

TEST_F(WindowEnds, AnExportDoesNotTakeTheNameOfTheRecording) {
  Screen screen(folder);
  screen.open("pinned2 --paused --record pinned2.pc2");
  screen.click("Export");
  screen.click("Start export");
  screen.wait("the export to begin", [](const Json& now) {
    return now["news"].dump().find("pinned2-2.pc2") != std::string::npos;
  });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_TRUE(folder.read("pinned2.pc2").starts_with("{"));
  EXPECT_TRUE(folder.read("pinned2-2.pc2").starts_with("POINTCACHE2"));
}

}  // namespace
}  // namespace weft

// Files that come into the window and go out of it: scenes and pictures dropped onto it, pictures,
// and films saved from it, and what it says where nothing can be written. (viewer_export_test.cpp has exports.)
#include <stb_image.h>
#include <stb_image_write.h>

#include <vector>

#include "screen.h"

namespace weft {
namespace {

using Json = nlohmann::json;

constexpr const char* kScene = R"({"weft": 1, "name": "NAME", "cloths": [{
    "grid": {"points": [9, 9], "u": [1, 0, 0], "v": [0, 0, 1]}, "pins": [[0, 0], [8, 0]]}]})";

std::string scene_named(const std::string& name) {
  std::string scene = kScene;
  return scene.replace(scene.find("NAME"), 4, name);
}

struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;

  // The share of pixels of a colour.
  template <class Is>
  double share(Is is) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < rgb.size(); k += 3) count += is(rgb[k], rgb[k + 1], rgb[k + 2]);
    return 3.0 * static_cast<double>(count) / static_cast<double>(rgb.size());
  }
};

Image decoded(const std::string& path) {
  Image image;
  int channels = 0;
  unsigned char* const data = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
  if (data != nullptr) image.rgb.assign(data, data + 3 * image.width * image.height);
  stbi_image_free(data);
  return image;
}

bool is_red(int r, int g, int b) {
  return 4 * r > 5 * g && 4 * r > 5 * b;
}
bool is_green(int r, int g, int b) {
  return 4 * g > 5 * r && 4 * g > 5 * b;
}

// The standard colour's cloth before the grey room.
void expect_cloth(const Image& image) {
  ASSERT_FALSE(image.rgb.empty());
  EXPECT_GT(image.share(is_red), 0.01);
  EXPECT_LT(image.share(is_red), 0.6);
}

class WindowFiles : public Window {
 protected:
  void write_green(const std::string& name) const {
    std::vector<unsigned char> rgb;
    for (int k = 0; k < 64 * 64; ++k) rgb.insert(rgb.end(), {20, 200, 40});
    ASSERT_NE(stbi_write_png((folder / name).c_str(), 64, 64, 3, rgb.data(), 0), 0);
  }
  // Names in the test's folder that end so.
  std::size_t count(const std::string& end) const {
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      found += entry.path().string().ends_with(end);
    return found;
  }
};

#ifdef WEFT_DROP_PROGRAM

TEST_F(WindowFiles, DroppedScenesAreOpenedAndPicturesWorn) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  folder.write("a scene, 100%41 new.json", scene_named("spaces"));
  screen.drop("'a scene, 100%41 new.json'");
  screen.wait_for("scene", "spaces");
  folder.write("größe.json", scene_named("umlauts"));
  screen.drop("größe.json");
  screen.wait_for("scene", "umlauts");

  const auto green = [](const std::string& rgb) {
    return Image{Screen::kWidth, Screen::kHeight, {rgb.begin(), rgb.end()}}.share(is_green);
  };
  EXPECT_LT(green(screen.picture()), 0.001);
  write_green("green cloth 50%.PNG");
  screen.drop("'green cloth 50%.PNG'");
  EXPECT_EQ(screen.wait_for("look", "texture")["scene"], "umlauts");
  screen.wait_picture("a green cloth", [&](const std::string& rgb) { return green(rgb) > 0.01; });
  folder.write("no picture.png", "not at all");
  screen.drop("'no picture.png'");
  const Json refused =
      screen.wait("a fault", [](const Json& now) { return !now["faults"].empty(); });
  EXPECT_NE(refused["faults"].dump().find("no picture.png"), std::string::npos);

  // Several at once: the last scene is shown.
  write_green("again.png");
  screen.drop("again.png 'a scene, 100%41 new.json'");
  screen.wait_for("scene", "spaces");
  screen.wait("no fault", [](const Json& now) { return now["faults"].empty(); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(WindowFiles, ADroppedBrokenSceneIsToldAndTheOldOneGoesOn) {
  Screen screen(folder);
  screen.open("pinned2");
  folder.write("broken.json", R"({"weft": 1, "cloths": [{"dragg": 1}]})");
  screen.drop("broken.json");
  const Json broken =
      screen.wait("a fault", [](const Json& now) { return !now["faults"].empty(); });
  EXPECT_NE(broken["faults"].dump().find("broken.json:/cloths/0"), std::string::npos)
      << broken["faults"];
  EXPECT_EQ(broken["scene"], "pinned2");
  screen.wait("frames go on",
              [&](const Json& now) { return now["frame"] > broken["frame"].get<int>() + 3; });
  screen.click("message");
  screen.wait("the fault dismissed", [](const Json& now) { return now["faults"].empty(); });
  screen.drop(".");  // a folder
  screen.wait("another fault", [](const Json& now) { return !now["faults"].empty(); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

#endif

TEST_F(WindowFiles, PicturesShowWhatTheViewShows) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  screen.key("F12");
  screen.wait("a picture", [](const Json& now) { return tells(now, "pinned2.png"); });
  const Image beside = decoded(folder / "pinned2.png");
  EXPECT_LT(beside.width, Screen::kWidth);
  EXPECT_EQ(beside.height, Screen::kHeight);
  expect_cloth(beside);
  screen.key("Tab");
  screen.wait("the panel to go",
              [](const Json& now) { return !now["controls"].contains("filter"); });
  screen.key("F12");
  screen.wait("another picture", [](const Json& now) { return tells(now, "pinned2-2.png"); });
  const Image alone = decoded(folder / "pinned2-2.png");
  EXPECT_EQ(alone.width, Screen::kWidth);
  EXPECT_EQ(alone.height, Screen::kHeight);
  expect_cloth(alone);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(WindowFiles, FilmsHaveThirtyPicturesForASecondOfTheScene) {
  Screen screen(folder);
  screen.open("pinned2 --paused --set /time/frame=0.02");
  screen.key("F11");
  screen.wait("the film to begin", [](const Json& now) { return tells(now, "pinned2.mp4"); });
  screen.step_to(12);
  EXPECT_FALSE(folder.has("pinned2.mp4"));
  screen.key("F11");
  screen.wait("the film saved", [](const Json& now) { return tells(now, "Film saved"); });
  ASSERT_EQ(run("ffprobe -v error -count_frames -select_streams v:0 -of csv=p=0 -show_entries "
                "stream=codec_name,width,height,r_frame_rate,nb_read_frames pinned2.mp4 >probe"),
            0);
  // 0.24 s, and the picture at its start.
  EXPECT_EQ(folder.read("probe"), "h264,944,800,30/1,8\n");
  ASSERT_EQ(run("ffmpeg -loglevel error -i pinned2.mp4 -vf select=eq'(n\\,7)' -frames:v 1 "
                "last.png </dev/null"),
            0);
  expect_cloth(decoded(folder / "last.png"));

  // One that is going on when the window closes is whole, too.
  screen.key("F11");
  screen.wait("another film", [](const Json& now) { return tells(now, "pinned2-2.mp4"); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  EXPECT_EQ(run("ffprobe -v error pinned2-2.mp4"), 0);
  EXPECT_EQ(count(".tmp"), 0u);
}

// Of its own size, from frame 3 to 8: 0.06 s … 0.16 s. The scene has gone past them and starts anew.
TEST_F(WindowFiles, FilmsHaveTheSizeAndTheFramesAskedFor) {
  Screen screen(folder);
  screen.open("pinned2 --set /time/frame=0.02");
  screen.wait("some frames", [](const Json& now) { return now["frame"] > 10; });
  screen.click("Film");
  screen.click("film as view");
  screen.wait("the size", [](const Json& now) {  // above what is clicked next
    return now["controls"].contains("picture width");
  });
  screen.click("film endless");
  screen.type_number("picture width", "640");
  screen.type_number("picture height", "360");
  screen.type_number("first frame", "3");
  screen.type_number("last frame", "8");
  screen.click("Start film");
  screen.wait("the film saved", [](const Json& now) { return tells(now, "Film saved"); });
  ASSERT_EQ(run("ffprobe -v error -count_frames -select_streams v:0 -of csv=p=0 -show_entries "
                "stream=width,height,nb_read_frames pinned2.mp4 >probe"),
            0);
  EXPECT_EQ(folder.read("probe"), "640,360,4\n");
  const Json now = screen.now();
  screen.wait("frames go on", [&](const Json& later) { return later["frame"] > now["frame"]; });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(WindowFiles, FilmsAreNumberedPicturesWithoutFfmpeg) {
  Screen screen(folder);
  screen.open("pinned2 --paused --set /time/frame=0.02", "PATH=/nowhere");
  for (const std::string name : {"pinned2", "pinned2-2"}) {
    const int start = screen.now()["frame"];
    screen.key("F11");
    screen.wait("the film to begin",
                [&](const Json& now) { return tells(now, name + "_00000.png"); });
    screen.step_to(start + 4);
    screen.key("F11");
    screen.wait("the film saved", [](const Json& now) { return tells(now, "Film saved"); });
    EXPECT_EQ(count(".png"), name == "pinned2" ? 3u : 6u);
    expect_cloth(decoded(folder / (name + "_00002.png")));
  }
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

// The scene plays on, and waits for pictures that take longer than a 30th of a second.
TEST_F(WindowFiles, FilmsOfAScenePlayingShowNoMomentTwice) {
  Screen screen(folder);
  screen.open("pinned2", "PATH=/nowhere");
  screen.key("F11");
  screen.wait("twenty pictures", [&](const Json&) { return count(".png") > 20; });
  screen.key("F11");
  screen.wait("the film saved", [](const Json& now) { return tells(now, "Film saved"); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const std::size_t pictures = count(".png");
  std::string before;
  for (std::size_t n = 0; n < pictures; ++n) {
    char name[32];
    std::snprintf(name, sizeof name, "pinned2_%05d.png", static_cast<int>(n));
    const std::string now = folder.read(name);
    EXPECT_NE(now, before) << name;
    before = now;
  }
}

TEST_F(WindowFiles, AFilmThatFfmpegGivesUpLeavesNothing) {
  std::filesystem::create_directory(folder / "bin");
  folder.write("bin/ffmpeg", "#!/bin/sh\nexit 1\n");
  std::filesystem::permissions(folder / "bin/ffmpeg", std::filesystem::perms::owner_all);
  Screen screen(folder);
  screen.open("pinned2 --paused", "PATH='" + (folder / "bin") + "'");
  screen.key("F11");
  screen.wait("the film's end", [](const Json& now) { return tells(now, "The film ends"); });
  EXPECT_EQ(count(".mp4") + count(".tmp"), 0u);
  screen.key("n");
  screen.wait_for("frame", 1);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

TEST_F(WindowFiles, PicturesHaveTheSizeAskedFor) {
  Screen screen(folder);
  screen.open("pinned2 --paused");
  screen.click("Picture");
  screen.click("Save picture");
  screen.wait("a picture", [](const Json& now) { return tells(now, "pinned2.png"); });
  EXPECT_EQ(screen.quit(), 0) << screen.said();
  const Image image = decoded(folder / "pinned2.png");
  EXPECT_EQ(image.width, 1920);
  EXPECT_EQ(image.height, 1080);
  expect_cloth(image);
}

// A folder that is gone takes no file from anyone.
TEST_F(WindowFiles, WhatCannotBeWrittenIsTold) {
  std::filesystem::create_directory(folder / "gone");
  Screen screen(folder);
  screen.open("pinned2 --paused", "", "gone");
  std::filesystem::remove(folder / "gone");
  const auto expect_refusal = [&](const char* file) {
    const Json now = screen.wait(std::string("refusal of ") + file, [&](const Json& state) {
      return tells(state, std::string(file) + ": cannot write: No such file");
    });
    EXPECT_EQ(now["scene"], "pinned2");
  };
  screen.key("F12");
  expect_refusal("pinned2.png");
  screen.key("F11");
  expect_refusal("pinned2.mp4");
  screen.click("Export");
  screen.click("Start export");
  expect_refusal("pinned2.pc2");
  screen.key("ctrl+s");
  expect_refusal("pinned2-edited.json");
  screen.key("n");
  screen.wait_for("frame", 1);
  EXPECT_EQ(screen.quit(), 0) << screen.said();
}

}  // namespace
}  // namespace weft

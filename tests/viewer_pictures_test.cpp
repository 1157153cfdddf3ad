// weft-viewer as a user runs it: every look renders a scene without any display, and differs from the
// others; wrong words on the command line are refused before anything is opened.
#include <gtest/gtest.h>
#include <stb_image.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

int run(const std::string& words) {
  const std::string command = std::string(WEFT_VIEWER_PROGRAM) + " " + words + " >/dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Pictures, EveryLookRendersItsOwn) {
  const fs::path folder = fs::temp_directory_path() / "weft_viewer_pictures";
  fs::create_directories(folder);
  std::set<std::string> pictures;
  int looks = 0;
  for (const char* look :
       {"colour", "phong_force", "ggx_force", "blinn_phong", "diffuse", "normals", "texture",
        "bump", "displacement", "mirror", "pbr", "fabric", "strain", "wireframe", "points"}) {
    const fs::path out = folder / (std::string(look) + ".png");
    ASSERT_EQ(run("sphere --headless --frames 20 --size 160x120 --shader " + std::string(look) +
                  " --out " + out.string()),
              0)
        << look;
    const std::string bytes = bytes_of(out);
    EXPECT_EQ(bytes.substr(1, 3), "PNG") << look;
    EXPECT_GT(bytes.size(), 1500u) << look;  // more than one flat colour
    pictures.insert(bytes);
    ++looks;
  }
  EXPECT_EQ(int(pictures.size()), looks);
  fs::remove_all(folder);
}

struct Decoded {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

Decoded decode(const fs::path& path) {
  Decoded picture;
  int channels = 0;
  unsigned char* data = stbi_load(path.c_str(), &picture.width, &picture.height, &channels, 3);
  if (data != nullptr) picture.rgb.assign(data, data + 3 * picture.width * picture.height);
  stbi_image_free(data);
  return picture;
}

// The last of a strip is further on than the first; both have the cloth.
TEST(Pictures, AStripShowsTheRunFromItsStart) {
  const fs::path out = fs::temp_directory_path() / "weft_viewer_strip.png";
  ASSERT_EQ(run("sphere --headless --frames 40 --strip 3 --size 80x60 --out " + out.string()), 0);
  const Decoded strip = decode(out);
  fs::remove(out);
  ASSERT_EQ(strip.width, 240);
  ASSERT_EQ(strip.height, 60);
  const auto at = [&](int picture, int x, int y) {
    return &strip.rgb[static_cast<std::size_t>(3 * (y * 240 + 80 * picture + x))];
  };
  std::array<int, 3> red{}, other{};
  for (std::size_t k = 0; k < 3; ++k)
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) {
        const unsigned char* now = at(static_cast<int>(k), x, y);
        red[k] += now[0] > 1.3 * now[2];
        other[k] += std::abs(now[0] - at(0, x, y)[0]) > 8;
      }
  for (const int count : red) EXPECT_GT(count, 100);
  EXPECT_GT(other[1], 50);
  EXPECT_GT(other[2], other[1]);
}

// Kept pictures may be of another driver: what an eye would see counts, that is, the mean and the
// share of pixels that are plainly different.
TEST(Pictures, EveryLookIsAsKept) {
  const fs::path out = fs::temp_directory_path() / "weft_viewer_kept.png";
  int looks = 0;
  const fs::path folder = WEFT_SOURCE_DIR "/tests/pictures";
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".png") continue;
    const std::string look = entry.path().stem().string();
    ASSERT_EQ(
        run((folder / "scene.json").string() + " --headless --frames 25 --size 160x120 --shader " +
            look + " --out " + out.string()),
        0)
        << look;
    const Decoded kept = decode(entry.path()), now = decode(out);
    ASSERT_EQ(kept.rgb.size(), 3u * 160 * 120) << look;
    ASSERT_EQ(now.rgb.size(), kept.rgb.size()) << look;
    double sum = 0, plain = 0;
    for (std::size_t k = 0; k < kept.rgb.size(); ++k) {
      const int apart = std::abs(int(kept.rgb[k]) - int(now.rgb[k]));
      sum += apart;
      plain += apart > 40;
    }
    EXPECT_LT(sum / double(kept.rgb.size()), 2) << look;
    EXPECT_LT(plain / double(kept.rgb.size()), 0.01) << look;
    ++looks;
  }
  EXPECT_EQ(looks, 15);
  fs::remove(out);
}

// Wherever the plain cloth hides the ball, the raised one does, too.
TEST(Pictures, RaisedClothHidesWhatLiesBeneath) {
  const fs::path out = fs::temp_directory_path() / "weft_viewer_raised.png";
  const auto draw = [&](const char* look) {
    EXPECT_EQ(run("sphere --headless --frames 75 --size 320x240 --shader " + std::string(look) +
                  " --out " + out.string()),
              0);
    return decode(out);
  };
  const Decoded plain = draw("diffuse"), raised = draw("displacement");
  ASSERT_EQ(plain.rgb.size(), 3u * 320 * 240);
  ASSERT_EQ(raised.rgb.size(), plain.rgb.size());
  const auto is_cloth = [](const Decoded& picture, std::size_t k) {
    return 10 * picture.rgb[k] > 11 * picture.rgb[k + 2];  // warm, in a grey room
  };
  double cloth = 0, lost = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); k += 3) {
    cloth += is_cloth(plain, k);
    lost += is_cloth(plain, k) && !is_cloth(raised, k);
  }
  EXPECT_GT(cloth, 5000);
  EXPECT_LT(lost, 0.01 * cloth);
  fs::remove(out);
}

// Ambient occlusion darkens folds and what rests on the floor, brightens nothing, and leaves open ground alone.
TEST(Pictures, FinePicturesHaveAmbientOcclusion) {
  const fs::path out = fs::temp_directory_path() / "weft_viewer_fine.png";
  const auto draw = [&](const char* quality) {
    EXPECT_EQ(
        run("selfCollision --set /cloths/0/self_collision/response=stiff --headless --frames 110 "
            "--size 320x240 --shader diffuse --quality " +
            std::string(quality) + " --out " + out.string()),
        0);
    return decode(out);
  };
  const Decoded plain = draw("standard"), fine = draw("fine");
  fs::remove(out);
  ASSERT_EQ(plain.rgb.size(), 3u * 320 * 240);
  ASSERT_EQ(fine.rgb.size(), plain.rgb.size());
  double darker = 0, brighter = 0, below = 0, ground = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); k += 3) {
    const int less = int(plain.rgb[k]) - int(fine.rgb[k]);
    darker += less > 12;
    brighter += less < -12;
    const bool lowest = k > 3u * 320 * 220;  // open floor before the cloth
    ground += lowest;
    below += lowest && less > 3;
  }
  EXPECT_GT(darker, 400);
  EXPECT_LT(brighter, 0.1 * darker);
  EXPECT_LT(below, 0.02 * ground);
}

TEST(Pictures, EveryShippedSceneIsShown) {
  const fs::path docs = WEFT_SOURCE_DIR "/docs";
  const std::string page = bytes_of(docs / "viewer.md");
  for (const auto& entry : fs::directory_iterator(WEFT_SOURCE_DIR "/scenes")) {
    if (!entry.is_regular_file()) continue;
    const std::string picture = "pictures/scene-" + entry.path().stem().string() + ".png";
    EXPECT_NE(page.find("](" + picture + ")"), std::string::npos) << picture;
    EXPECT_TRUE(fs::exists(docs / picture)) << picture;
  }
}

TEST(Pictures, FramesAreDecimal) {
  const fs::path out = fs::temp_directory_path() / "weft_viewer_decimal.png";
  const auto draw = [&](const char* frames) {
    EXPECT_EQ(run("sphere --headless --size 64x64 --frames " + std::string(frames) + " --out " +
                  out.string()),
              0)
        << frames;
    return bytes_of(out);
  };
  EXPECT_EQ(draw("090"), draw("90"));
  EXPECT_EQ(draw("000"), draw("0"));
  fs::remove(out);
}

TEST(Pictures, WrongWordsAreRefused) {
  EXPECT_EQ(run("sphere --headless"), 2);
  EXPECT_EQ(run("sphere --headless --out a.png --shader plaid"), 2);
  EXPECT_EQ(run("sphere --headless --out a.png --size 3x3"), 2);
  EXPECT_EQ(run("sphere --headless --out a.png --quality best"), 2);
  EXPECT_EQ(run("no_such_scene --headless --out a.png"), 3);
  EXPECT_EQ(run("sphere --headless --frames 1 --size 64x64 --out /no/such/folder/a.png"), 5);
}

}  // namespace

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

// Warm, in a grey room; `k`: where the pixel's bytes begin.
bool is_cloth(const Decoded& picture, std::size_t k) {
  return 10 * picture.rgb[k] > 11 * picture.rgb[k + 2];
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
  double cloth = 0, lost = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); k += 3) {
    cloth += is_cloth(plain, k);
    lost += is_cloth(plain, k) && !is_cloth(raised, k);
  }
  EXPECT_GT(cloth, 5000);
  EXPECT_LT(lost, 0.01 * cloth);
  fs::remove(out);
}

// Ambient occlusion darkens folds and the floor beneath, brightens nothing of the floor, and leaves open ground alone.
// The cloth itself is thick in fine pictures, and so not the same pixel by pixel.
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
  double folds = 0, darker = 0, brighter = 0, below = 0, ground = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); k += 3) {
    const int less = int(plain.rgb[k]) - int(fine.rgb[k]);
    const bool cloth = is_cloth(plain, k) || is_cloth(fine, k);
    folds += cloth && less > 12;
    darker += !cloth && less > 12;
    brighter += !cloth && less < -12;
    const bool lowest = k > 3u * 320 * 220;  // open floor before the cloth
    ground += lowest;
    below += lowest && less > 3;
  }
  EXPECT_GT(folds, 400);
  EXPECT_GT(darker, 400);
  EXPECT_LT(brighter, 0.02 * darker);
  EXPECT_LT(below, 0.02 * ground);
}

// Two pieces of a sheet that show the eye an edge of a metre each, one above the other: the back one was severed from
// the front one, by a cut of the scene or a tear, and lifted. `mesh`: in the place of the grid.
std::string severed_sheet(double thickness, const std::string& how, const std::string& mesh) {
  const std::string shape = mesh.empty()
                                ? R"("grid": {"points": [21, 21], "u": [1, 0, 0], "v": [0, 0, 1]})"
                                : R"("mesh": {"file": ")" + mesh + "\"}";
  return R"({"weft": 1, "gravity": [0, 0, 0], "camera": {"azimuth": 0, "elevation": 0}, "cloths": [{)" +
         shape + R"(, "stiffness": {"structural": 100}, )" + how + R"(
      "self_collision": {"mode": "particles", "thickness": )" +
         std::to_string(thickness) + R"(},
      "pins": [{"box": [[-1, -1, 0.54], [2, 1, 2]], "keys": [[0, 0, 0, 0]]},
               {"box": [[-1, -1, -1], [2, 1, 0.52]], "keys": [[0, 0, 0, 0], [0.2, 0, 0.3, 0]]}]}]})";
}

// The sheet of severed_sheet(), as a file.
void write_mesh(const fs::path& path) {
  std::ofstream file(path);
  constexpr int kSide = 21;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) file << "v " << 0.05 * i << " 0 " << 0.05 * j << "\n";
  for (int j = 0; j + 1 < kSide; ++j)
    for (int i = 0; i + 1 < kSide; ++i) {
      const int a = 1 + j * kSide + i, b = a + kSide;
      file << "f " << a << ' ' << a + 1 << ' ' << b << "\nf " << a + 1 << ' ' << b + 1 << ' ' << b
           << "\n";
    }
}

// Seen along the sheet, a border is as high as the cloth is thick, in the measure of its width, a metre: the front's
// own border and the one along the cut or tear. By the look of normals, which point to the eye there and nowhere else.
TEST(Pictures, FinePicturesShowTheThicknessOfBorders) {
  const fs::path folder = fs::temp_directory_path() / "weft_viewer_rim";
  fs::create_directories(folder);
  write_mesh(folder / "sheet.obj");
  const auto bands = [&](const std::string& scene, const char* quality) {
    std::ofstream(folder / "scene.json") << scene;
    EXPECT_EQ(run((folder / "scene.json").string() +
                  " --headless --frames 20 --size 400x300 --shader normals --quality " + quality +
                  " --out " + (folder / "a.png").string()),
              0);
    const Decoded picture = decode(folder / "a.png");
    EXPECT_EQ(picture.rgb.size(), 3u * 400 * 300);
    std::vector<std::array<double, 2>> found;  // pixels, columns: of each half of the picture
    for (const int from : {0, 150}) {
      double pixels = 0;
      std::set<int> columns;
      for (int y = from; y < from + 150; ++y)
        for (int x = 0; x < 400; ++x) {
          const auto* c = &picture.rgb[static_cast<std::size_t>(3 * (400 * y + x))];
          const bool to_eye = c[2] > 190 && std::abs(c[0] - 128) < 35 && std::abs(c[1] - 128) < 35;
          pixels += to_eye;
          if (to_eye) columns.insert(x);
        }
      found.push_back({pixels, static_cast<double>(columns.size())});
    }
    return found;
  };
  const std::string cut = R"("cuts": [[[-1, 10.5], [21, 10.5]]],)", torn = R"("tear_strain": 0.3,)";
  const std::tuple<const char*, std::string, std::string> kinds[] = {
      {"cut", cut, ""}, {"torn", torn, ""}, {"torn mesh", torn, "sheet.obj"}};
  for (const auto& [name, how, mesh] : kinds)
    for (const double thickness : {0.02, 0.04}) {
      for (const auto& [pixels, columns] : bands(severed_sheet(thickness, how, mesh), "fine")) {
        ASSERT_GT(columns, 100) << name << thickness;
        EXPECT_NEAR(pixels / columns, thickness * columns, 1) << name << thickness;
      }
      for (const auto& [pixels, columns] : bands(severed_sheet(thickness, how, mesh), "standard"))
        EXPECT_EQ(pixels, 0) << name << thickness;
    }
  fs::remove_all(folder);
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

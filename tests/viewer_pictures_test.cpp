// weft-viewer as a user runs it: every look renders a scene without any display, and differs from the
// others; wrong words on the command line are refused before anything is opened.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

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
       {"colour", "phong_force", "ggx_force", "blinn_phong", "diffuse", "normals", "texture", "bump",
        "displacement", "mirror", "pbr", "strain", "wireframe", "points"}) {
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

TEST(Pictures, WrongWordsAreRefused) {
  EXPECT_EQ(run("sphere"), 2);
  EXPECT_EQ(run("sphere --headless"), 2);
  EXPECT_EQ(run("sphere --headless --out a.png --shader plaid"), 2);
  EXPECT_EQ(run("sphere --headless --out a.png --size 3x3"), 2);
  EXPECT_EQ(run("no_such_scene --headless --out a.png"), 3);
  EXPECT_EQ(run("sphere --headless --frames 1 --size 64x64 --out /no/such/folder/a.png"), 5);
}

}  // namespace

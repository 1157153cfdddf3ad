// Files that hold too much are refused before memory is spent on them, and what may be long costs
// little.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "scene/json_survey.h"
#include "scene/json_text.h"
#include "scene/schema.h"
#include "weft/read_scene.h"

namespace {

using namespace weft::text;

std::string told(const std::string& text) {
  std::string all;
  for (const auto& fault : weft::read_scene_text(text).faults)
    all += fault.place + ": " + fault.what + " (" + fault.allowed + ")\n";
  return all;
}

std::string list_of(const std::string& item, std::size_t count) {
  std::string text = "[" + item;
  for (std::size_t k = 1; k < count; ++k) text += "," + item;
  return text + "]";
}

std::string scene_with(const std::string& key, const std::string& value) {
  return R"({"weft": 1, "cloths": [{"grid": {"points": [2, 2]}, ")" + key + "\": " + value + "}]}";
}

double kilobytes(const std::string& field) {
  std::ifstream lines("/proc/self/status");
  double value = 0;
  for (std::string word; lines >> word;)
    if (word == field + ":" && lines >> value) break;
  return value;
}

// The most bytes of memory that `work` took beyond what there was; 0 where the system does not tell.
template <class Work>
double peak_bytes(Work&& work) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the peak begins anew
  const double before = kilobytes("VmRSS");
  const bool told = kilobytes("VmHWM") < before + 1024;
  work();
  return told ? 1024 * (kilobytes("VmHWM") - before) : 0;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kKeepsWhatIsFreed = true;
#else
constexpr bool kKeepsWhatIsFreed = false;
#endif

TEST(Survey, CountsOutsideOfStrings) {
  const Survey found = survey(R"({"a": [1, 2, [3, "x,y]\",["]], "b": {}, "c": []})");
  EXPECT_EQ(found.lists, 5u);
  EXPECT_EQ(found.longest.items, 3u);
  EXPECT_EQ(found.longest.position, 6u);
  EXPECT_TRUE(found.long_lists.empty());
}

TEST(Survey, FindsLongListsInTheOrderInWhichTheyOpen) {
  const std::string text = "[" + list_of("[]", 1500) + "," + list_of("0", 2000) + "]";
  const Survey found = survey(text);
  ASSERT_EQ(found.long_lists.size(), 2u);
  EXPECT_EQ(found.long_lists[0].nth, 1u);
  EXPECT_EQ(found.long_lists[0].items, 1500u);
  EXPECT_EQ(found.long_lists[1].nth, 1502u);
  EXPECT_EQ(found.long_lists[1].items, 2000u);
}

TEST(Survey, TakesAnyText) {
  for (const char* text : {"", "]", "}{", "\"", "\"\\", "[,,", "{\"", "[[[", ",,,", "[}", "\\"})
    EXPECT_LE(survey(text).lists, 3u) << text;
  EXPECT_LE(survey(std::string(1 << 20, '[')).lists, 100u);
}

TEST(Limits, AreThoseOfTheSchema) {
  const Json limits = Json::parse(weft::scene_schema()).at("x-limits");
  EXPECT_EQ(limits.at("bytes"), kMaxTextBytes);
  EXPECT_EQ(limits.at("depth"), kMaxDepth);
  EXPECT_EQ(limits.at("keys"), kMaxKeys);
  EXPECT_EQ(limits.at("key bytes"), kMaxKeyBytes);
  EXPECT_EQ(limits.at("lists"), kMaxLists);
  EXPECT_EQ(limits.at("values"), kMaxValues);
}

TEST(Limits, TooManyListsAreToldWithTheLongest) {
  EXPECT_EQ(told(scene_with("pins", list_of("[0,0]", 3'000'000))),
            ": the text holds 3000006 lists and objects; the longest list, at line 1, column 61, "
            "has 3000000 items (at most 2000000 in all)\n");
}

TEST(Limits, TooManyValuesAreToldWithTheLongest) {
  EXPECT_EQ(told(scene_with("masses", list_of("1", 25'000'000))),
            ": the text holds 25000009 values; the longest list, at line 1, column 63, has "
            "25000000 items (at most 20000000 in all)\n");
}

TEST(Limits, LongListsAreToldByTheirPlace) {
  EXPECT_EQ(told(scene_with("pins", list_of("[0,0]", 1'000'001))),
            "/cloths/0/pins: pins has 1000001 items (a list of at most 1000000 items)\n");
  EXPECT_EQ(told(R"({"weft": 1, "cloths": )" + list_of("{}", 1001) + "}"),
            "/cloths: cloths has 1001 items (a list of 1 to 1000 items)\n");
  EXPECT_EQ(told(R"({"weft": 1, "cloths": [{}], "colliders": )" + list_of("{}", 1001) + "}"),
            "/colliders: colliders has 1001 items (a list of at most 1000 items)\n");
  EXPECT_EQ(told(scene_with(
                "pins", "[{\"at\": [0, 0], \"keys\": " + list_of("[0, 0, 0, 0]", 100'001) + "}]")),
            "/cloths/0/pins/0/keys: keys has 100001 items (a list of at most 100000 items)\n");
}

TEST(Limits, LongKeysAreTold) {
  EXPECT_EQ(told("{\"weft\": 1, \"" + std::string(201, 'k') + "\": 1}"),
            ": a key has 201 bytes (at most 200)\n");
}

// What refuses a long list takes no more memory than the list would where it is right.
TEST(Limits, RefusingTakesBoundedMemory) {
  if (kKeepsWhatIsFreed) GTEST_SKIP() << "the address sanitizer keeps what is freed";
  for (const std::string& text :
       {scene_with("pins", list_of("[0,0]", 6'000'000)), scene_with("x", list_of("1", 8'000'000)),
        R"({"weft": 1, "cloths": )" + list_of("{}", 1'900'000) + "}",
        scene_with("stiffness", list_of("[]", 1'900'000))}) {
    const double bytes = peak_bytes([&] { EXPECT_NE(told(text), ""); });
    EXPECT_LT(bytes, 400e6) << text.substr(0, 80);
  }
}

// Forty bytes a number, from the text to the scene and through its check.
TEST(Limits, MassesTakeFewBytesANumber) {
  if (kKeepsWhatIsFreed) GTEST_SKIP() << "the address sanitizer keeps what is freed";
  constexpr int kSide = 2048;
  std::string text =
      R"({"weft": 1, "cloths": [{"grid": {"points": [2048, 2048], "u": [9, 0, 0],
      "v": [0, 0, 9]}, "masses": )" +
      list_of("1", kSide * kSide);
  text += R"(, "density": 1, "drag": 0, "pins": [], "level": 0, "bending": 0}], "name": "a"})";
  weft::SceneFile file;
  const double reading = peak_bytes([&] { file = weft::read_scene_text(text); });
  ASSERT_TRUE(file.faults.empty());
  EXPECT_EQ(file.scene.cloths[0].masses.size(), std::size_t(kSide) * kSide);
  EXPECT_LT(reading / (kSide * kSide), 40);
  const double checking = peak_bytes([&] { EXPECT_TRUE(weft::validate(file.scene).empty()); });
  EXPECT_LT(checking / (kSide * kSide), 40);
}

// Numbers at the edges of double: too large is told, all others are read or told by their range.
TEST(Numbers, HugeTinyAndSignedZero) {
  const auto with = [](const std::string& number) {
    return told(R"({"weft": 1, "gravity": [0, )" + number + R"(, 0], "cloths": [{}]})");
  };
  EXPECT_EQ(with("1e400"), ": line 1, column 32: the number is too large (plain JSON)\n");
  EXPECT_EQ(with("-1e400"), ": line 1, column 33: the number is too large (plain JSON)\n");
  EXPECT_EQ(with("1e308"), "/gravity/1: gravity[1] is 1e308 (-10000 to 10000 m/s²)\n");
  EXPECT_EQ(with("18446744073709551615"),
            "/gravity/1: gravity[1] is 18446744073709551615 (-10000 to 10000 m/s²)\n");
  for (const char* number : {"5e-324", "-5e-324", "1e-400", "-0", "-0.0"})
    EXPECT_EQ(with(number), "") << number;
  for (const char* word : {"NaN", "nan", "Infinity", "-Infinity", "inf"})
    EXPECT_NE(with(word).find("plain JSON"), std::string::npos) << word;
  EXPECT_NE(with("\"NaN\"").find("(a number, -10000 to 10000 m/s²)"), std::string::npos);
}

TEST(Numbers, WholeNumbersOutOfTheirRange) {
  for (const char* number : {"1e308", "-1e308", "2147483648", "-2147483649", "1e19",
                             "-9223372036854775808", "18446744073709551615", "2.5", "-0.5"}) {
    const std::string points =
        told(R"({"weft": 1, "cloths": [{"grid": {"points": [)" + std::string(number) + ", 2]}}]}");
    EXPECT_NE(points.find("/cloths/0/grid/points/0: "), std::string::npos) << number << points;
    EXPECT_NE(points.find("2 to 4096"), std::string::npos) << points;
    const std::string course =
        told(R"({"cloth": {"num_width_points": )" + std::string(number) + "}}");
    EXPECT_NE(course.find("/cloth/num_width_points: "), std::string::npos) << number << course;
  }
  EXPECT_EQ(told(R"({"weft": 1, "cloths": [{"grid": {"points": [2e0, 4.0]}}]})"), "");
}

TEST(Numbers, OverridesAreCheckedTheSameWay) {
  for (const char* value : {"1e400", "NaN", "inf", "-1e308", "1e19", ""}) {
    const auto faults = weft::read_scene("pinned2", {{"/solver/iterations", value}}).faults;
    ASSERT_FALSE(faults.empty()) << value;
    EXPECT_EQ(faults[0].place, "/solver/iterations") << value;
  }
}

// A program may put anything into the struct: each value is told, and nothing is computed from it.
TEST(Numbers, StructsOfAnything) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(), 1e308, -1e308};
  for (const double value : bad)
    for (const int points :
         {std::numeric_limits<int>::min(), -1, 0, 1, std::numeric_limits<int>::max()}) {
      weft::Scene scene;
      scene.time = {value, points, value};
      scene.solver.iterations = points;
      weft::Cloth& cloth = scene.cloths.emplace_back();
      cloth.grid = {points, points, {value, 0, 0}, {value, value, 0}, {0, 0, value}, value};
      cloth.density = cloth.particle_mass = cloth.drag = value;
      cloth.masses = {value};
      cloth.pins = {{points, points, {{value, {value, 0, 0}}}}};
      weft::Collider& cutter = scene.colliders.emplace_back();
      cutter.shape = weft::Sphere{{value, 0, 0}, value};
      cutter.offset = value;
      cutter.cuts = true;
      EXPECT_FALSE(weft::validate(scene).empty());
    }
}

// A cutter is measured against the grids only where these are right.
TEST(Numbers, ACutterAmongWrongGrids) {
  weft::Scene scene;
  scene.cloths.emplace_back().grid.nx = std::numeric_limits<int>::min();
  scene.colliders.push_back({weft::Sphere{}, {}, 0, {}, true});
  const auto faults = weft::validate(scene);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].place, "/cloths/0/grid/points/0");
}

TEST(Words, AreTextOfOneLine) {
  const auto faults_of = [](const std::string& name) {
    weft::Scene scene;
    scene.cloths.emplace_back();
    scene.name = name;
    const auto faults = weft::validate(scene);
    return faults.empty() ? "" : faults[0].place + ": " + faults[0].what;
  };
  EXPECT_EQ(faults_of("Tüll"), "");
  EXPECT_EQ(faults_of("a\nb"), "/name: name has control characters");
  EXPECT_EQ(faults_of("a\x7f"), "/name: name has control characters");
  EXPECT_EQ(faults_of("a\xff"), "/name: name has bytes that are not UTF-8");
}

}  // namespace

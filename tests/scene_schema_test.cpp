// Schema, reader, writer, Scene and validate() say the same: names, defaults and ranges. And the
// table of docs/scenes.md is the schema's.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "scene/assets.h"
#include "scene/document.h"
#include "scene/schema.h"
#include "weft/read_scene.h"

namespace {

using namespace weft::text;

// One of everything: every key of the schema is in the document of this scene.
weft::Scene full_scene() {
  weft::Scene scene;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.masses = {1, 1, 1, 1};
  cloth.pins = {{0, 0, {}}, {1, 1, {{0, {0, 0, 0}}}}};
  cloth.pins.push_back({.keys = {{0, {0, 0, 0}}}, .vertices = {1}});
  cloth.pins.push_back({.keys = {}, .group = "hem"});
  cloth.pins.push_back({.keys = {}, .box = weft::BoxCorners{}});
  for (const weft::Shape& shape :
       {weft::Shape(weft::Sphere{}), weft::Shape(weft::Plane{}), weft::Shape(weft::Capsule{}),
        weft::Shape(weft::Box{}), weft::Shape(weft::Cylinder{}),
        weft::Shape(weft::TaperedCapsule{}), weft::Shape(weft::MeshBody{})})
    scene.colliders.push_back({shape, {}, 0, {{0, {0, 0, 0}}}, false});
  scene.colliders[1].friction = {weft::FrictionModel::coulomb, 0.5, 0.4};
  scene.colliders[2].friction = {weft::FrictionModel::course, 0.5, 0.5};
  return scene;
}

using Visit = std::function<void(const Json& schema, const std::string& place)>;

// Calls `visit` for each value of the document that is neither list nor object.
void for_each_leaf(const Json& schema, const Json& value, const std::string& place,
                   const Visit& visit) {
  const Json* chosen = alternative(schema, value);
  ASSERT_TRUE(chosen) << place;
  if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); ++k) {
      const Json* below = descend(*chosen, &value, std::to_string(k));
      ASSERT_TRUE(below) << place;
      for_each_leaf(*below, value[k], place + "/" + std::to_string(k), visit);
    }
  } else if (value.is_object()) {
    for (auto it = value.begin(); it != value.end(); ++it) {
      const Json* below = descend(*chosen, &value, it.key());
      ASSERT_TRUE(below) << place << "/" << it.key();
      for_each_leaf(*below, *it, place + "/" + it.key(), visit);
    }
  } else {
    visit(schema, place);
  }
}

Json with(const Json& document, const std::string& place, const Json& value) {
  Json changed = document;
  changed[Json::json_pointer(place)] = value;
  return changed;
}

bool names(const std::vector<weft::Fault>& faults, const std::string& place) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const weft::Fault& fault) { return fault.place == place; });
}

// Both ways in: a file, and a struct that a program filled in.
void expect_rejected(const Json& document, const std::string& place, const Json& value) {
  const Json changed = with(document, place, value);
  EXPECT_TRUE(names(weft::read_scene_text(changed.dump()).faults, place)) << place << value;
  if (value.is_number()) {
    const std::string whole = place.find("/friction/") != std::string::npos
                                  ? place.substr(0, place.rfind('/'))
                                  : place;  // a struct may write its friction as one number
    const auto faults = weft::validate(scene_of(changed));
    EXPECT_TRUE(names(faults, place) || names(faults, whole)) << place << value;
  }
}

void expect_accepted(const Json& document, const std::string& place, const Json& value) {
  Check result;
  check(scene_schema_json(), with(document, place, value), result);
  EXPECT_TRUE(result.faults.empty()) << place << value;
  const Json again = document_of(scene_of(with(document, place, value)));
  if (place.find("/friction/") == std::string::npos) {
    EXPECT_EQ(again[Json::json_pointer(place)], value) << place;
  }
}

TEST(Schema, DefaultsAreThoseOfTheStructs) {
  const Json written = document_of(full_scene());
  std::set<std::string> checked;
  std::function<void(const Json&, const Json&, const std::string&)> walk =
      [&](const Json& schema, const Json& value, const std::string& place) {
        const Json* chosen = alternative(schema, value);
        if (!chosen || !chosen->contains("properties")) return;
        for (const auto& [key, property] : chosen->at("properties").items()) {
          const std::string here = place + "/" + key;
          const Json* found = member(value, key);
          if (key == "fabric") continue;  // stands for other keys (scene_fabric_test.cpp)
          if (chosen->contains("oneOf") && !found) continue;  // another shape
          ASSERT_TRUE(found) << here << " is in the schema but not in Scene";
          if (found->is_object()) walk(property, *found, here);
        }
      };
  walk(scene_schema_json(), written, "");

  // What a minimal document reads as is what each default says.
  const Json minimal =
      document_of(weft::read_scene_text(R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}},
        {"plane": {}}, {"capsule": {}}, {"box": {}}, {"cylinder": {}}, {"mesh": {}}]})")
                      .scene);
  std::function<void(const Json&, const Json&, const std::string&)> compare =
      [&](const Json& schema, const Json& value, const std::string& place) {
        const Json* standard = member(schema, "default");
        if (standard && !standard->is_object() && place != "/colliders") {
          EXPECT_EQ(*standard, value) << place;
          checked.insert(place);
        } else if (value.is_object()) {
          for (const auto& [key, item] : value.items())
            compare(schema.at("properties").at(key), item, place + "/" + key);
        } else if (value.is_array()) {
          for (std::size_t k = 0; k < value.size(); ++k)
            compare(schema.at("items"), value[k], place + "/" + std::to_string(k));
        }
      };
  compare(scene_schema_json(), minimal, "");
  EXPECT_GT(checked.size(), 60u);
}

TEST(Schema, RangesHoldInFilesAndInStructs) {
  const Json document = document_of(full_scene());
  int bounds = 0;
  for_each_leaf(
      scene_schema_json(), document, "", [&](const Json& schema, const std::string& place) {
        const Json* chosen = alternative(schema, document[Json::json_pointer(place)]);
        // "auto" stands for substeps; its range is the other alternative's.
        if (place == "/time/substeps") chosen = &schema.at("oneOf").at(0);
        const Json* low = member(*chosen, "minimum");
        const Json* high = member(*chosen, "maximum");
        if (!low || !high) return;
        const double least = low->get<double>(), most = high->get<double>();
        const bool whole = chosen->at("type") == "integer";
        const bool reserved = place == "/time/substeps";  // 0 is kAutoSubsteps in the struct
        expect_rejected(document, place,
                        whole ? Json(static_cast<int>(least) - (reserved ? 2 : 1))
                              : Json(std::nextafter(least, -INFINITY)));
        expect_rejected(
            document, place,
            whole ? Json(static_cast<int>(most) + 1) : Json(std::nextafter(most, INFINITY)));
        expect_accepted(document, place, whole ? Json(static_cast<int>(least)) : Json(least));
        expect_accepted(document, place, whole ? Json(static_cast<int>(most)) : Json(most));
        expect_rejected(document, place, "word");
        bounds += 2;
      });
  EXPECT_GT(bounds, 150);
}

TEST(Schema, WordsAreThoseOfTheEnums) {
  const Json document = document_of(full_scene());
  for_each_leaf(scene_schema_json(), document, "",
                [&](const Json& schema, const std::string& place) {
                  const Json* words = member(schema, "enum");
                  if (!words) return;
                  std::set<std::string> distinct;
                  for (const Json& word : *words) {
                    expect_accepted(document, place, word);
                    distinct.insert(word.get<std::string>());
                  }
                  EXPECT_EQ(distinct.size(), words->size());
                  expect_rejected(document, place, "nonsense");
                });
}

TEST(Schema, IsTheFileOfTheDocs) {
  std::ifstream file(std::string(WEFT_SOURCE_DIR) + "/docs/scene.schema.json");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(weft::scene_schema(), text.str());
}

TEST(Schema, DescribesEveryValue) {
  const std::function<void(const Json&, const std::string&)> walk = [&](const Json& schema,
                                                                        const std::string& place) {
    if (const Json* properties = member(schema, "properties"))
      for (const auto& [key, property] : properties->items()) {
        EXPECT_TRUE(property.contains("description")) << place << "/" << key;
        walk(property, place + "/" + key);
      }
    if (const Json* items = member(schema, "items")) walk(*items, place + "/0");
    if (const Json* options = member(schema, "oneOf"))
      for (const Json& option : *options) walk(option, place);
  };
  walk(scene_schema_json(), "");
  walk(course_schema_json(), "");
}

// Rows of the table of docs/scenes.md.
void add_rows(const Json& schema, const std::string& place, std::string& rows) {
  const Json* properties = member(schema, "properties");
  if (const Json* items = member(schema, "items"))
    if (items->contains("properties")) return add_rows(*items, place + "/0", rows);
  if (!properties) return;
  for (const auto& [key, property] : properties->items()) {
    const std::string here = place + "/" + key;
    const Json* standard = member(property, "default");
    const bool section = property.contains("properties");
    const Json* items = member(property, "items");
    std::string kind = section ? "" : kind_words(property);
    std::string meaning = property.at("description").get<std::string>();
    for (auto bar = meaning.find('|'); bar != std::string::npos; bar = meaning.find('|', bar + 2))
      meaning.insert(bar, "\\");
    if (items && items->contains("minimum")) kind += ", " + range_words(*items);
    rows += "| `" + here + "` | " + kind + " | " +
            (standard && !section ? "`" + standard->dump() + "`" : "") + " | " + meaning + " |\n";
    add_rows(property, here, rows);
  }
}

// Run with WEFT_UPDATE_DOCS=1 to write the tables anew.
TEST(Docs, TablesAreTheSchemas) {
  const std::string path = std::string(WEFT_SOURCE_DIR) + "/docs/scenes.md";
  std::ifstream file(path);
  std::stringstream read;
  read << file.rdbuf();
  std::string text = read.str();
  for (const auto& [name, schema] :
       {std::pair("weft", &scene_schema_json()), std::pair("course", &course_schema_json())}) {
    std::string rows = "| key | value | default | meaning |\n|---|---|---|---|\n";
    add_rows(*schema, "", rows);
    const std::string begin = std::string("<!-- keys: ") + name + " -->\n";
    const auto from = text.find(begin);
    const auto to = text.find("<!-- end -->", from);
    ASSERT_NE(from, std::string::npos);
    ASSERT_NE(to, std::string::npos);
    const std::string table = text.substr(from + begin.size(), to - from - begin.size());
    if (std::getenv("WEFT_UPDATE_DOCS"))
      text.replace(from + begin.size(), table.size(), rows);
    else
      EXPECT_EQ(table, rows);
  }
  if (std::getenv("WEFT_UPDATE_DOCS")) std::ofstream(path) << text;
}

}  // namespace

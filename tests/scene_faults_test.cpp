// Broken scenes and what is said about them, word for word: `place: what is wrong (what is
// allowed)`.
#include <gtest/gtest.h>

#include <cmath>

#include "weft/read_scene.h"

namespace {

std::string told(const std::vector<weft::Fault>& faults) {
  std::string text;
  for (const auto& fault : faults)
    text +=
        (text.empty() ? "" : "\n") + fault.place + ": " + fault.what + " (" + fault.allowed + ")";
  return text;
}

struct Broken {
  const char* text;
  const char* told;
};

// clang-format off
constexpr Broken kBroken[] = {
    {"",
     ": line 1, column 1: syntax error while parsing value - unexpected end of input; expected '[', '{', or a literal (plain JSON)"},
    {R"({"weft": 1, "cloths": [{}])",
     ": line 1, column 27: syntax error while parsing object - unexpected end of input; expected '}' (plain JSON)"},
    {R"({"weft": 1,
 "cloths": [{}],})",
     ": line 2, column 17: syntax error while parsing object key - unexpected '}'; expected string literal (plain JSON)"},
    {R"(// a comment
{})",
     ": line 1, column 1: syntax error while parsing value - invalid literal (plain JSON)"},
    {R"({"weft": 1, "gravity": [0, NaN, 0]})",
     ": line 1, column 28: syntax error while parsing value - invalid literal (plain JSON)"},
    {R"({"weft": 1, "gravity": [0, 1e999, 0]})",
     ": line 1, column 32: the number is too large (plain JSON)"},
    {R"({"weft": 1, "cloths": [{}], "weft": 1})",
     "/weft: the key is given twice (each key once)"},
    {R"({"weft": 1, "cloths": [{"level": 1, "level": 2}]})",
     "/cloths/0/level: the key is given twice (each key once)"},
    {"[1, 2]",
     R"(: the scene is [1, 2] (an object with "weft": 1 and cloths, or with cloth, sphere and plane))"},
    {R"("swing")",
     R"(: the scene is "swing" (an object with "weft": 1 and cloths, or with cloth, sphere and plane))"},
    {"{}",
     R"(: this is neither a Weft scene nor a course scene (an object with "weft": 1 and cloths, or with cloth, sphere and plane))"},
    {R"({"weft": 1})",
     ": cloths is missing (a list of 1 to 1000 items)"},
    {R"({"weft": 2, "cloths": [{}]})",
     "/weft: weft is 2 (1)"},
    {R"({"weft": 1, "cloths": []})",
     "/cloths: cloths has no items (a list of 1 to 1000 items)"},
    {R"({"weft": 1, "cloths": {}})",
     "/cloths: cloths is an object (a list of 1 to 1000 items)"},
    {R"({"cloths": [{}]})",
     ": weft is missing (1)"},
    {R"({"weft": 1, "gravty": [0,0,0], "cloths": [{}]})",
     R"(/gravty: unknown key "gravty" (the nearest known key is "gravity"))"},
    {R"({"weft": 1, "gravity": -9.81, "cloths": [{}]})",
     "/gravity: gravity is -9.81 (a list of 3 numbers or an object with keys)"},
    {R"({"weft": 1, "gravity": [0, -9.81], "cloths": [{}]})",
     "/gravity: gravity has 2 items (a list of 3 numbers)"},
    {R"({"weft": 1, "gravity": [0, 1e5, 0], "cloths": [{}]})",
     "/gravity/1: gravity[1] is 100000 (-10000 to 10000 m/s²)"},
    {R"({"weft": 1, "name": 3, "cloths": [{}]})",
     "/name: name is 3 (text)"},
    {R"({"weft": 1, "about": "two\nlines", "cloths": [{}]})",
     "/about: about has control characters (one line of text)"},
    {R"({"weft": 1, "time": {"frame": 0}, "cloths": [{}]})",
     "/time/frame: frame is 0 (1e-5 to 1 s)"},
    {R"({"weft": 1, "time": {"substeps": 0}, "cloths": [{}]})",
     "/time/substeps: substeps is 0 (1 to 100000)"},
    {R"({"weft": 1, "time": {"substeps": "many"}, "cloths": [{}]})",
     R"(/time/substeps: substeps is "many" (an integer, 1 to 100000 or "auto"))"},
    {R"({"weft": 1, "time": {"substeps": 2.5}, "cloths": [{}]})",
     R"(/time/substeps: substeps is 2.5 (an integer, 1 to 100000 or "auto"))"},
    {R"({"weft": 1, "time": {"seconds": -1}, "cloths": [{}]})",
     "/time/seconds: seconds is -1 (1e-5 to 1e6 s)"},
    {R"({"weft": 1, "time": 5, "cloths": [{}]})",
     "/time: time is 5 (an object with frame, substeps, seconds)"},
    {R"({"weft": 1, "solver": {"method": "implicit"}, "cloths": [{}]})",
     R"(/solver/method: method is "implicit" (positional, spring, spring_friction or compliant))"},
    {R"({"weft": 1, "solver": {"itertions": 3}, "cloths": [{}]})",
     R"(/solver/itertions: unknown key "itertions" (the nearest known key is "iterations"))"},
    {R"({"weft": 1, "solver": {"iterations": 0}, "cloths": [{}]})",
     "/solver/iterations: iterations is 0 (1 to 1000)"},
    {R"({"weft": 1, "solver": {"tethers": 1}, "cloths": [{}]})",
     "/solver/tethers: tethers is 1 (true or false)"},
    {R"({"weft": 1, "solver": {"sweep": "line"}, "cloths": [{}]})",
     "/solver/sweep: sweep is line (only with method positional or compliant; the method is spring)"},
    {R"({"weft": 1, "solver": {"tethers": true}, "cloths": [{}]})",
     "/solver/tethers: tethers are on (only with method positional or compliant; the method is spring)"},
    {R"({"weft": 1, "solver": {"order": 2}, "cloths": [{}]})",
     "/solver/order: order is 2 (only with method compliant; the method is spring)"},
    {R"({"weft": 1, "solver": {"order": 2, "method": "compliant", "sweep": "jacobi"}, "cloths": [{}]})",
     "/solver/order: order is 2 (only with sweep gauss_seidel or line; the sweep is jacobi)"},
    {R"({"weft": 1, "solver": {"order": 3, "method": "compliant"}, "cloths": [{}]})",
     "/solver/order: order is 3 (1 or 2)"},
    {R"({"weft": 1, "cloths": [{"grid": {"points": [1, 5]}}]})",
     "/cloths/0/grid/points/0: points[0] is 1 (2 to 4096)"},
    {R"({"weft": 1, "cloths": [{"grid": {"points": [5]}}]})",
     "/cloths/0/grid/points: points has 1 item (a list of 2 integers)"},
    {R"({"weft": 1, "cloths": [{"grid": {"u": [0,0,0]}}]})",
     "/cloths/0/grid/u: u is zero (a side with a length)"},
    {R"({"weft": 1, "cloths": [{"grid": {"u": [0,0,2]}}]})",
     "/cloths/0/grid: u and v are parallel (two directions)"},
    {R"({"weft": 1, "cloths": [{"grid": {"u": [1e-6,0,0], "points": [9,9]}}]})",
     "/cloths/0/grid/u: the particles are 1.25e-7 m apart along u (at least 1e-6 m)"},
    {R"({"weft": 1, "cloths": [{"grid": {"jitter": true}}]})",
     "/cloths/0/grid/jitter: jitter is true (a number, 0 to 1 m)"},
    {R"({"weft": 1, "cloths": [{"stiffness": {"structural": -3}}]})",
     "/cloths/0/stiffness/structural: structural is -3 (0 to 1e9 N/m)"},
    {R"({"weft": 1, "cloths": [{"stiffness": 1000}]})",
     "/cloths/0/stiffness: stiffness is 1000 (an object with structural, shear, bend)"},
    {R"({"weft": 1, "cloths": [{"stiffness": {"sheer": 1}}]})",
     R"(/cloths/0/stiffness/sheer: unknown key "sheer" (the nearest known key is "shear"))"},
    {R"({"weft": 1, "cloths": [{"density": 0}]})",
     "/cloths/0/density: density is 0 (1e-6 to 1e6 kg/m²)"},
    {R"({"weft": 1, "cloths": [{"density": 1e-6, "grid": {"points": [4096, 4096]}}]})",
     "/cloths/0/density: a particle in a corner weighs 1.4908439816864726e-14 kg (1e-9 to 1e6 kg)"},
    {R"({"weft": 1, "cloths": [{"particle_mass": 1e-12}]})",
     "/cloths/0/particle_mass: each particle weighs 1e-12 kg (1e-9 to 1e6 kg)"},
    {R"({"weft": 1, "cloths": [{"masses": [1, 2, 3]}]})",
     "/cloths/0/masses: masses has 3 values (4, one for each particle, or none)"},
    {R"({"weft": 1, "cloths": [{"masses": [1, 2, 3, 0]}]})",
     "/cloths/0/masses/3: masses[3] is 0 (1e-9 to 1e6 kg)"},
    {R"({"weft": 1, "cloths": [{"positional_k": 0.7}]})",
     "/cloths/0/positional_k: positional_k is 0.7 (0 to 0.5)"},
    {R"({"weft": 1, "cloths": [{"level": 3}]})",
     "/cloths/0/level: level is 3 (0 to 1 on this grid)"},
    {R"({"weft": 1, "cloths": [{"level": null}]})",
     "/cloths/0/level: level is null (an integer, 0 to 8)"},
    {R"({"weft": 1, "cloths": [{"tear_strain": "never"}]})",
     R"(/cloths/0/tear_strain: tear_strain is "never" (a number, 0 to 100))"},
    {R"({"weft": 1, "cloths": [{"self_collision": {"mode": "particles", "thickness": 0.9}, "grid": {"points": [9, 9]}}]})",
     "/cloths/0/self_collision/thickness: thickness is 0.9 (1e-5 to 0.5 m, 4 times the spacing of the grid)"},
    {R"({"weft": 1, "cloths": [{"self_collision": {"mode": "on"}}]})",
     R"(/cloths/0/self_collision/mode: mode is "on" (off, particles or surface))"},
    {R"({"weft": 1, "cloths": [{"pins": [[0, 2]]}]})",
     "/cloths/0/pins/0: the pin [0, 2] is outside of the grid ([0, 0] to [1, 1])"},
    {R"({"weft": 1, "cloths": [{"pins": [[0, 0], [0, 0]]}]})",
     "/cloths/0/pins/1: the particle [0, 0] is pinned twice (once; it is held by /cloths/0/pins/0)"},
    {R"({"weft": 1, "cloths": [{"pins": [3]}]})",
     "/cloths/0/pins/0: the pin [3, 0] is outside of the grid ([0, 0] to [1, 1])"},
    {R"({"weft": 1, "cloths": [{"pins": [[0, 0, 0]]}]})",
     "/cloths/0/pins/0: pins[0] has 3 items (a list of 2 integers)"},
    {R"({"weft": 1, "cloths": [{"pins": [{"keys": []}]}]})",
     "/cloths/0/pins/0: at is missing (a list of 2 integers or an integer, 0 to 4194303)"},
    {R"({"weft": 1, "cloths": [{"pins": [{"at": [0, 0], "keys": [[1, 0,0,0], [1, 0,0,1]]}]}]})",
     "/cloths/0/pins/0/keys/1: time 1 comes after 1 (times that increase)"},
    {R"({"weft": 1, "cloths": [{"pins": [{"at": [0, 0], "keys": [[0, 0, 0]]}]}]})",
     "/cloths/0/pins/0/keys/0: keys[0] has 3 items (a list of 4 numbers)"},
    {R"({"weft": 1, "cloths": [{"pins": [[-1, 0], [0, 1.5], [7, 7]]}]})",
     R"(/cloths/0/pins/0/0: pins[0][0] is -1 (0 to 4194303)
/cloths/0/pins/1/1: pins[1][1] is 1.5 (an integer, 0 to 4194303)
/cloths/0/pins/2: the pin [7, 7] is outside of the grid ([0, 0] to [1, 1]))"},
    {R"({"weft": 1, "time": {"frame": 1, "substeps": 2}, "cloths": [{"drag": 3}]})",
     "/cloths/0/drag: drag takes 1.5 of the velocity in one substep (0 to 1: less drag or more substeps)"},
    {R"({"weft": 1, "cloths": [{"grid": {"points": [4096, 4096]}}, {}]})",
     "/cloths: the cloths have 16777220 particles (4 to 16777216 in all)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"friction": 0.1}]})",
     "/colliders/0: colliders[0] has no shape (exactly one of sphere, plane, capsule, box, cylinder, tapered_capsule, mesh)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "box": {}}]})",
     "/colliders/0: colliders[0] has sphere and box (exactly one of sphere, plane, capsule, box, cylinder, tapered_capsule, mesh)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {"radius": 0}}]})",
     "/colliders/0/sphere/radius: radius is 0 (1e-6 to 10000 m)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"spehre": {"radius": 1}}]})",
     R"(/colliders/0/spehre: unknown key "spehre" (the nearest known key is "sphere"))"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {"centre": [0,0,0]}}]})",
     R"(/colliders/0/sphere/centre: unknown key "centre" (the nearest known key is "center"))"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"plane": {"normal": [0,0,0]}}]})",
     "/colliders/0/plane/normal: normal is zero (a direction at least 1e-6 long)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"capsule": {"a": [0,1,0]}}]})",
     "/colliders/0/capsule/b: b is where a is (at least 1e-6 m from a)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"tapered_capsule": {"a": [0,1,0]}}]})",
     "/colliders/0/tapered_capsule/b: b is where a is (at least 1e-6 m from a)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"cylinder": {"rounding": 0.2}}]})",
     "/colliders/0/cylinder/rounding: rounding is 0.2 (0 to 0.1 m, half of the least thickness)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"box": {"rounding": 0.2}}]})",
     "/colliders/0/box/rounding: rounding is 0.2 (0 to 0.1 m, half of the least thickness)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"box": {"half": [0.1, -0.1, 0.1]}}]})",
     "/colliders/0/box/half/1: half[1] is -0.1 (1e-6 to 10000 m)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": -0.1}]})",
     "/colliders/0/friction: friction is -0.1 (0 to 10)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": {"static": 0.2, "dynamic": 0.4}}]})",
     "/colliders/0/friction: dynamic friction 0.4 is above static friction 0.2 (0 to 0.2, at most static)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": {"damping": 0.5}}]})",
     "/colliders/0/friction: damping is 0.5 and bias 0 (both above 0, or neither)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": {"damping": 1, "bias": -1}}]})",
     "/colliders/0/friction/bias: bias is -1 (0 to 10 m)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": {"course": 2}}]})",
     "/colliders/0/friction/course: course is 2 (0 to 1)"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": {"course": 0.5, "static": 1}}]})",
     R"(/colliders/0/friction/static: unknown key "static" (the nearest known key is "course"))"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": "ice"}]})",
     R"(/colliders/0/friction: friction is "ice" (a number, 0 to 10 or an object with course or an object with static, dynamic, damping, bias))"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "offset": 5, "cuts": "yes"}]})",
     R"(/colliders/0/offset: offset is 5 (0 to 1 m)
/colliders/0/cuts: cuts is "yes" (true or false))"},
    {R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "keys": [[2, 0,0,0], [1, 0,0,0]]}]})",
     "/colliders/0/keys/1: time 1 comes after 2 (times that increase)"},
    {R"({"weft": 1, "cloths": [{}], "wind": {"turbulence": 2, "velocity": [0, 0, "fast"]}})",
     R"(/wind/turbulence: turbulence is 2 (0 to 1)
/wind/velocity/2: velocity[2] is "fast" (a number, -1000 to 1000 m/s))"},
    {R"({"weft": 1, "cloths": [{"grid": {"poins": [9, 9]}, "pins": [[8, 8]]}], "a/b~c": 1})",
     R"(/cloths/0/grid/poins: unknown key "poins" (the nearest known key is "points")
/a~1b~0c: unknown key "a/b~c" (the nearest known key is "about"))"},
    {R"({"cloth": {"kss": 5}})",
     R"(/cloth/kss: unknown key "kss" (the nearest known key is "ks"))"},
    {R"({"cloth": {"pinned": [[50, 0], [0, 49]]}})",
     "/cloth/pinned/0: the pin [50, 0] is outside of the grid ([0, 0] to [49, 49])"},
    {R"({"sphere": {"origin": [0,0,0]}})",
     ": cloth is missing (an object with width, height, num_width_points, num_height_points, thickness, orientation, damping, density, ks, enable_structural, enable_shearing, enable_bending, pinned)"},
    {R"({"cloth": {"orientation": 2, "damping": 101}, "plane": {"normal": [0,0,0], "friction": 1.5}})",
     R"(/cloth/orientation: orientation is 2 (0 or 1)
/cloth/damping: damping is 101 (0 to 100 %)
/plane/friction: friction is 1.5 (0 to 1)
/plane/normal: normal is zero (a direction at least 1e-6 long))"},
    {R"({"cloth": {}, "sphere": {"centre": [0,0,0]}})",
     R"(/sphere/centre: unknown key "centre" (the nearest known key is "origin"))"},
    {R"({"cloth": {}, "weft": 1})",
     R"(/cloth: unknown key "cloth" (the nearest known key is "cloths")
: cloths is missing (a list of 1 to 1000 items))"},
    {R"({"cloth": {"num_width_points": 1}, "ball": {}})",
     R"(/cloth/num_width_points: num_width_points is 1 (2 to 4096)
/ball: unknown key "ball" (the nearest known key is "name"))"},
};

struct BrokenOverride {
  const char* pointer;
  const char* value;
  const char* told;
};

// Of the scene {"weft": 1, "cloths": [{}]}.
constexpr BrokenOverride kBrokenOverrides[] = {
    {"solver/iterations", "3",
     R"(solver/iterations: the override "solver/iterations" is no JSON pointer to a value (such as /solver/iterations))"},
    {"/solver/itertions", "3",
     R"(/solver/itertions: there is no "itertions" to override (the nearest known key is "iterations"))"},
    {"/solvr/iterations", "3",
     R"(/solvr/iterations: there is no "solvr" to override (the nearest known key is "solver"))"},
    {"/solver/iterations", "0",
     "/solver/iterations: iterations is 0 (1 to 1000)"},
    {"/solver/iterations", "[1",
     "/solver/iterations: the value is line 1, column 3: syntax error while parsing array - unexpected end of input; expected ']' (JSON, or a bare word)"},
    {"/cloths/1/level", "1",
     R"(/cloths/1/level: the list has no element "1" (0 to 0))"},
    {"/cloths/7", "{}",
     R"(/cloths/7: the list has no element "7" (0 to 1))"},
    {"", "{}",
     R"(: the override "" is no JSON pointer to a value (such as /solver/iterations))"},
    {"/a~2", "1",
     R"(/a~2: the override "/a~2" is no JSON pointer to a value (such as /solver/iterations))"},
    {"/time/frame/x", "1",
     R"(/time/frame/x: there is no "x" to override (a value of the scene))"},
    {"/gravity/3", "1",
     R"(/gravity/3: the list has no element "3" (0 to 2))"},
    {"/gravity/x", "1",
     R"(/gravity/x: the list has no element "x" (0 to 2))"},
    {"/solver/iterations", "1e999",
     "/solver/iterations: the value is line 1, column 5: the number is too large (JSON, or a bare word)"},
    {"/solver/iterations", "nan",
     R"(/solver/iterations: iterations is "nan" (an integer, 1 to 1000))"},
    {"/solver/iterations", "",
     "/solver/iterations: the value is empty (JSON, or a bare word)"},
    {"/cloths/99999999999999999999/level", "1",
     R"(/cloths/99999999999999999999/level: the list has no element "99999999999999999999" (0 to 0))"},
};
// clang-format on

TEST(BrokenScene, EveryFaultIsNamed) {
  for (const Broken& broken : kBroken)
    EXPECT_EQ(told(weft::read_scene_text(broken.text).faults), broken.told) << broken.text;
}

TEST(BrokenScene, OverridesAreNamedByTheirPointer) {
  for (const auto& [pointer, value, expected] : kBrokenOverrides) {
    const auto file = weft::read_scene_text(R"({"weft": 1, "cloths": [{}]})", {{pointer, value}});
    EXPECT_EQ(told(file.faults), expected) << pointer << "=" << value;
  }
}

TEST(BrokenScene, OverridesOfACourseSceneAreCheckedInBothForms) {
  const auto file = weft::read_scene(
      "pinned2", {{"/cloth/ks", "-1"}, {"/solver/iterations", "0"}, {"/solver/itertions", "5"}});
  EXPECT_EQ(told(file.faults),
            "/cloth/ks: ks is -1 (0 to 1e9 N/m)\n"
            "/solver/itertions: there is no \"itertions\" to override "
            "(the nearest known key is \"iterations\")");
  EXPECT_EQ(told(weft::read_scene("pinned2", {{"/solver/iterations", "0"}}).faults),
            "/solver/iterations: iterations is 0 (1 to 1000)");
}

TEST(BrokenScene, TellsTheFirstHundredFaults) {
  std::string text = R"({"weft": 1, "cloths": [{"masses": [0)";
  for (int k = 0; k < 1000; ++k) text += ", -1";
  EXPECT_EQ(weft::read_scene_text(text + "]}]}").faults.size(), 100u);
}

TEST(BrokenScene, LimitsBoundHostileText) {
  const auto told_of = [](const std::string& text) {
    return told(weft::read_scene_text(text).faults);
  };
  EXPECT_EQ(told_of(std::string(1 << 20, '[')),
            ": lists and objects are nested deeper than 32 (at most 32)");
  EXPECT_EQ(told_of(std::string((64u << 20) + 1, ' ')),
            ": the text is longer than 64 MiB (at most 64 MiB)");
  std::string keys = "{";
  for (int k = 0; k < 2000; ++k) keys += "\"" + std::to_string(k) + "\": 0, ";
  EXPECT_EQ(told_of(keys + "\"weft\": 1}"), ": the object has more than 1000 keys (at most 1000)");
  EXPECT_EQ(told_of(std::string("{\"we\0ft\": 1}", 12)),
            ": line 1, column 5: syntax error while parsing object key - invalid string: control "
            "character U+0000 (NUL) must be escaped to \\u0000; expected string literal "
            "(plain JSON)");
  EXPECT_NE(told_of("{\"\xff\": 1}"), "");
  const std::string long_key(1 << 20, 'k');
  EXPECT_LT(weft::read_scene_text("{\"weft\": 1, \"cloths\": [{}], \"" + long_key + "\": 1}")
                .faults.at(0)
                .what.size(),
            200u);
}

TEST(BrokenFile, IsNamed) {
  const auto missing = weft::read_scene("pined2");
  EXPECT_FALSE(missing.found);
  EXPECT_EQ(told(missing.faults),
            ": there is no such scene (a path, or a shipped scene; the nearest is \"pinned2\")");
  EXPECT_FALSE(weft::read_scene("no/such/file.json").found);
  EXPECT_FALSE(weft::read_scene("").found);
  EXPECT_EQ(told(weft::read_scene("/").faults), ": this is a folder (a scene file)");
  const auto endless = weft::read_scene("/dev/zero");
  EXPECT_EQ(told(endless.faults), ": the text is longer than 64 MiB (at most 64 MiB)");
}

// What only a program that fills in the struct can do wrong.
TEST(Validate, NamesWhatIsNotFinite) {
  weft::Scene scene;
  scene.cloths.emplace_back();
  scene.gravity[1] = NAN;
  scene.cloths[0].grid.u[0] = INFINITY;
  scene.cloths[0].masses = {1, 1, NAN, 1};
  EXPECT_EQ(told(weft::validate(scene)),
            "/gravity/1: gravity[1] is not a number (NaN) (-10000 to 10000 m/s²)\n"
            "/cloths/0/grid/u/0: u[0] is infinite (-10000 to 10000 m)\n"
            "/cloths/0/masses/2: masses[2] is not a number (NaN) (1e-9 to 1e6 kg)");
}

TEST(Validate, NamesWhatAMembraneDoesNotFit) {
  weft::Scene scene;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.membrane = {4, 9, 6, 4, 0};
  cloth.stiffness.bend = 0;
  cloth.level = 1;
  cloth.grid.v = {0.1, 0, 1};
  cloth.bending.twist = 1e-5;
  scene.solver.method = weft::Method::positional;
  EXPECT_EQ(
      told(weft::validate(scene)),
      "/cloths/0/membrane/coupling: coupling is 6 (between -6 and 6 N/m, the root of warp times "
      "weft)\n"
      "/cloths/0/membrane/shear: shear is 4 (below 4 N/m, warp or weft)\n"
      "/cloths/0/membrane: u and v of the grid are not at right angles (a membrane's warp and weft "
      "are)\n"
      "/cloths/0/membrane: both membrane and stiffness or spring_damping are given (one of the "
      "two)\n"
      "/cloths/0/membrane: a membrane is given (not with method positional)\n"
      "/cloths/0/membrane: a membrane is given beside a level (level 0)");
  scene.cloths[0] = {};
  scene.cloths[0].membrane = {4, 9, 0, 0, 0};
  scene.solver.method = weft::Method::spring;
  EXPECT_EQ(told(weft::validate(scene)), "/cloths/0/membrane/shear: shear is 0 (above 0)");
}

TEST(Validate, NamesWhatIsOutsideOfAnEnum) {
  weft::Scene scene;
  scene.cloths.emplace_back();
  scene.solver.method = static_cast<weft::Method>(9);
  scene.solver.sweep = static_cast<weft::Sweep>(-1);
  EXPECT_EQ(told(weft::validate(scene)),
            "/solver/method: method is 9 (positional, spring, spring_friction or compliant)\n"
            "/solver/sweep: sweep is -1 (gauss_seidel, jacobi or line)");
}

TEST(Validate, NamesAnEmptySceneAndAnEmptyGrid) {
  EXPECT_EQ(told(weft::validate({})), "/cloths: cloths has no items (a list of 1 to 1000 items)");
  weft::Scene scene;
  scene.cloths.emplace_back().grid.nx = 1;
  scene.cloths[0].pins.push_back({5, -1, {}});
  EXPECT_EQ(told(weft::validate(scene)),
            "/cloths/0/grid/points/0: points[0] is 1 (2 to 4096)\n"
            "/cloths/0/pins/0/1: pins[0][1] is -1 (0 to 4194303)");
}

}  // namespace

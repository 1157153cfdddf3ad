// Options, checked before anything is opened.
#include "command_line.h"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <iostream>

#include "failure.h"

namespace weft::viewer {

namespace {

std::string look_names() {
  std::string names;
  for (const Look& look : kLooks) names += (names.empty() ? "" : ", ") + std::string(look.name);
  return names;
}

std::string fault_of_look(const std::string& name) {
  return find_look(name) ? "" : "'" + name + "' is no look (" + look_names() + ")";
}

bool read_size(const std::string& text, int& width, int& height) {
  const std::size_t x = text.find('x');
  if (x == std::string::npos) return false;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), text.data() + x, width);
  const auto [stop2, error2] = std::from_chars(text.data() + x + 1, end, height);
  return error == std::errc() && error2 == std::errc() && stop == text.data() + x && stop2 == end &&
         width >= 16 && width <= 8192 && height >= 16 && height <= 8192;
}

std::string fault_of_size(const std::string& text) {
  int width = 0, height = 0;
  return read_size(text, width, height) ? "" : "'" + text + "' is no size (16x16 to 8192x8192)";
}

std::string fault_of_set(const std::string& text) {
  const bool good = text.starts_with('/') && text.find('=') != std::string::npos;
  return good ? "" : "'" + text + "' is not POINTER=VALUE (such as /solver/iterations=20)";
}

// Leading zeros would make a number octal.
std::string decimal(std::string& text) {
  text.erase(0, std::min(text.find_first_not_of('0'), text.size() - 1));
  return "";
}

void add_options(CLI::App& program, Arguments& a, std::string& size,
                 std::vector<std::string>& sets) {
  program.add_option("SCENE", a.scene, "A scene file, or the name of a shipped scene")
      ->type_name("");
  program.add_option("--set", sets, "Override one value of the scene; repeatable")
      ->type_name("POINTER=VALUE")
      ->allow_extra_args(false)
      ->check(CLI::Validator(fault_of_set, ""));
  program.add_option("--shader", a.look, "The look: " + look_names())
      ->type_name("NAME")
      ->check(CLI::Validator(fault_of_look, ""));
  program.add_flag("--headless", a.headless, "Render one picture without any display");
  program.add_option("--frames", a.frames, "Frames to simulate before the picture")
      ->type_name("N")
      ->transform(CLI::Validator(decimal, ""))
      ->check(CLI::Range(0, 1'000'000));
  program
      .add_option("--strip", a.strip, "So many pictures side by side, from the start to that frame")
      ->type_name("N")
      ->check(CLI::Range(1, 64));
  program.add_option("--size", size, "Size of the picture in pixels (1280x720)")
      ->type_name("WxH")
      ->check(CLI::Validator(fault_of_size, ""));
  program
      .add_option("--quality", a.settings.quality, "Of pictures: automatic, quick, standard, fine")
      ->type_name("NAME")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, Quality>{{"automatic", Quality::automatic},
                                                                 {"quick", Quality::quick},
                                                                 {"standard", Quality::standard},
                                                                 {"fine", Quality::fine}}));
  program.add_option("--out", a.out, "The picture to write")->type_name("FILE.png");
  program.add_option("--threads", a.threads, "Worker threads; never changes the result")
      ->type_name("P")
      ->check(CLI::Range(1, 256));
  program.add_option("--seed", a.seed, "Seeds every random choice")->type_name("N");
  program.add_option("--azimuth", a.azimuth, "Direction of the camera [degrees]")->type_name("A");
  program.add_option("--elevation", a.elevation, "Height of the camera [degrees]")->type_name("A");
  program.add_option("--zoom", a.zoom, "Nearer (> 1) or farther")
      ->type_name("F")
      ->check(CLI::Range(0.01, 100.0));
  program.add_flag("--paused", a.paused, "Open the window with the scene at rest");
  program.add_option("--keys", a.keys, "Which keys do what (docs/viewer.md)")->type_name("FILE");
  program
      .add_option("--record", a.record, "Record the session from its start, for weft run --replay")
      ->type_name("FILE");
  program.add_option("--measure", a.measure, "Measure how quick the window is, print it and close")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 3600.0));
  program.add_option("--log", a.log, "Tell what the window shows, a line for every change")
      ->type_name("FILE");
  program.add_option("--texture", a.pictures.texture, "A picture for the look texture")
      ->type_name("FILE");
  program
      .add_option("--height-map", a.pictures.height_map, "A height map for bump and displacement")
      ->type_name("FILE");
  constexpr std::array<std::pair<const char*, const char*>, 4> kMaps{
      {{"--base-color-map", "The look pbr's base colour"},
       {"--metallic-map", "Its share of metal, 0 … 1 in red"},
       {"--roughness-map", "Its roughness, 0 … 1 in red"},
       {"--normal-map", "Its normals (y along v)"}}};
  for (std::size_t map = 0; map < kMaps.size(); ++map)
    program.add_option(kMaps[map].first, a.pictures.material[map], kMaps[map].second)
        ->type_name("FILE");
  program.add_option("--sky", a.pictures.sky, "A folder of posx, negx, … negz (.png or .jpg)")
      ->type_name("FOLDER");
}

}  // namespace

std::optional<int> parse_arguments(int count, char** words, Arguments& arguments) {
  CLI::App program{"Play with cloth simulated by Weft in a window, or render pictures of it",
                   "weft-viewer"};
  std::string size;
  std::vector<std::string> sets;
  add_options(program, arguments, size, sets);
  program.footer(
      "\nSIGINT, SIGTERM and SIGHUP close the window after the present frame; recording, film and\n"
      "export are written, and where the display is lost, too. A second signal ends it at once.");
  try {
    program.parse(count, words);
    if (arguments.strip > 1 && !arguments.headless)
      throw CLI::ValidationError("--strip", "is for --headless");
    if (arguments.headless && arguments.out.empty())
      throw CLI::RequiredError("--headless needs --out FILE.png: it");
  } catch (const CLI::Success& asked) {
    return program.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::cerr << "weft-viewer: error: command line: " << error.what()
              << " (`weft-viewer --help` tells more)\n";
    return kBadCommandLine;
  }
  if (!size.empty()) read_size(size, arguments.width, arguments.height);
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    arguments.overrides.push_back({set.substr(0, equals), set.substr(equals + 1)});
  }
  return std::nullopt;
}

}  // namespace weft::viewer

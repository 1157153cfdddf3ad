// Pictures and textures: what the program weaves and paints itself, the user's files in their
// place, and PNG files written.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picture/gl.h"
#include "picture/linear.h"

namespace weft::viewer {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
};

// Throws Failure when it cannot be written.
void write_png(const std::string& path, const Picture& picture);

// What cannot be read, or has more pixels along a side than kMostPixels or the graphics card takes, gives an empty
// object and the reason in `error`.
constexpr int kMostPixels = 8192;

// A file as it is, for the panel.
Texture load_picture(const std::string& path, std::string& error);

// A file, or "" for the program's own.
Texture load_texture(const std::string& path, std::string& error);     // woven check; sRGB
Texture load_height_map(const std::string& path, std::string& error);  // its threads; red = height

// The four maps of the look pbr: base colour (sRGB), metallic and roughness (red, linear), normals in the
// surface's axes (x along u, y along v, 0 … 1 for -1 … 1). The program's own are a brocade.
enum class MaterialMap { base_color, metallic, roughness, normal };
Texture load_material_map(MaterialMap map, const std::string& path, std::string& error);

// The sky as a cube map with all levels. `path`: a folder of posx, negx, posy, negy, posz, negz
// (.png or .jpg).
Texture load_sky(const std::string& path, Vec3f light, std::string& error);

}  // namespace weft::viewer

// A plain weave of coloured threads, its heights, and a sky with a sun and clouds.
#include "picture/images.h"

#include <stb_image.h>
#include <stb_image_write.h>

#include <filesystem>
#include <memory>

#include "failure.h"
#include "weft/output.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace {

constexpr int kWeaveSize = 512;  // texels
constexpr int kThreads = 32;     // across the tile

struct Thread {
  float height;  // 0 … 1
  bool warp;     // which of the two threads is on top
  int index;     // which of its kind
};

// Plain weave: threads over and under in turn, round across, arched along.
Thread weave(float u, float v, int threads) {
  const float a = u * static_cast<float>(threads), b = v * static_cast<float>(threads);
  const int i = static_cast<int>(a) % threads, j = static_cast<int>(b) % threads;
  const float s = a - std::floor(a) - 0.5f, t = b - std::floor(b) - 0.5f;
  const bool warp = (i + j) % 2 == 0;
  const float across = warp ? s : t, along = warp ? t : s;
  const float round = std::sqrt(std::max(0.0f, 1 - 3.6f * across * across));
  const float arch = std::cos(along * 2.4f);
  return {0.1f + 0.9f * round * arch, warp, warp ? i : j};
}

// A check: bands of coloured threads, the same in both directions.
Vec3f thread_color(int index) {
  const int band = index % kThreads;
  if (band < 10) return {0.62f, 0.56f, 0.44f};
  if (band < 14) return {0.10f, 0.16f, 0.32f};
  if (band < 16) return {0.62f, 0.56f, 0.44f};
  if (band < 26) return {0.10f, 0.16f, 0.32f};
  if (band < 28) return {0.55f, 0.08f, 0.06f};
  return {0.10f, 0.16f, 0.32f};
}

// A brocade: matt blue warp, and weft of metal wire that shows in diamonds.
struct Material {
  Vec3f color;
  float metallic, roughness;
};
Material brocade(const Thread& thread, float u, float v) {
  constexpr float kDiamonds = 4;  // across the tile
  const float a = std::abs(2 * (u * kDiamonds - std::floor(u * kDiamonds)) - 1),
              b = std::abs(2 * (v * kDiamonds - std::floor(v * kDiamonds)) - 1);
  const float shade = 0.6f + 0.4f * thread.height;
  if (!thread.warp && a + b < 1) return {Vec3f{1.0f, 0.71f, 0.29f} * shade, 1, 0.28f};
  return {(thread.warp ? Vec3f{0.05f, 0.10f, 0.30f} : Vec3f{0.30f, 0.05f, 0.09f}) * shade, 0,
          0.85f};
}

std::uint8_t to_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float srgb = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(srgb * 255));
}

void repeat_and_filter() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateMipmap(GL_TEXTURE_2D);
}

Texture upload(const std::uint8_t* rgb, int width, int height, GLint format) {
  Texture texture = make_texture();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb);
  repeat_and_filter();
  return texture;
}

struct Freed {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

struct Pixels {
  int width = 0, height = 0;
  std::unique_ptr<stbi_uc, Freed> rgb;  // none, and the reason in `error`, when it cannot be read
};

// The size is looked at before memory is asked for: a file of some kilobytes can claim gigabytes.
Pixels read_pixels(const std::string& path, std::string& error) {
  Pixels pixels;
  std::error_code ignored;
  int channels = 0;
  GLint most = kMostPixels;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  most = std::min(most, kMostPixels);
  const auto refuse = [&](const std::string& what) {
    const std::string side = std::to_string(most);
    error = printable(path) + ": " + what + " (a PNG or JPEG file of at most " + side + " × " +
            side + " pixels is needed)";
  };
  if (!std::filesystem::is_regular_file(path, ignored))  // a pipe would be waited for
    refuse("no such file");
  else if (stbi_info(path.c_str(), &pixels.width, &pixels.height, &channels) == 0)
    refuse(stbi_failure_reason());
  else if (std::max(pixels.width, pixels.height) > most)
    refuse(std::to_string(pixels.width) + " × " + std::to_string(pixels.height) + " pixels");
  else if (pixels.rgb.reset(stbi_load(path.c_str(), &pixels.width, &pixels.height, &channels, 3));
           pixels.rgb == nullptr)
    refuse(stbi_failure_reason());
  return pixels;
}

Texture load_file(const std::string& path, GLint format, std::string& error) {
  const Pixels pixels = read_pixels(path, error);
  if (pixels.rgb == nullptr) return {};
  return upload(pixels.rgb.get(), pixels.width, pixels.height, format);
}

float lattice_noise(int x, int y, int z) {
  auto h = static_cast<std::uint32_t>(x) * 73856093u ^ static_cast<std::uint32_t>(y) * 19349663u ^
           static_cast<std::uint32_t>(z) * 83492791u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<float>((h ^ (h >> 16)) & 0xffffu) / 65535.0f;
}

float smooth_noise(Vec3f p) {
  const Vec3f f{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const Vec3f d = p - f;
  const auto curve = [](float t) { return t * t * (3 - 2 * t); };
  const Vec3f t{curve(d.x), curve(d.y), curve(d.z)};
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const float w = (i != 0 ? t.x : 1 - t.x) * (j != 0 ? t.y : 1 - t.y) * (k != 0 ? t.z : 1 - t.z);
    sum += w * lattice_noise(static_cast<int>(f.x) + i, static_cast<int>(f.y) + j,
                             static_cast<int>(f.z) + k);
  }
  return sum;
}

float clouds(Vec3f direction) {
  if (direction.y < 0.02f) return 0;
  Vec3f p = direction * (2.2f / (direction.y + 0.25f));  // a layer overhead
  p.y = 1;
  float sum = 0, share = 0.5f;
  for (int octave = 0; octave < 5; ++octave, share *= 0.5f, p = p * 2.03f)
    sum += share * smooth_noise(p);
  const float t = std::clamp((sum - 0.48f) / 0.22f, 0.0f, 1.0f);
  return t * t * (3 - 2 * t) * std::clamp(direction.y * 6, 0.0f, 1.0f);
}

Vec3f sky_color(Vec3f d, Vec3f light) {
  const Vec3f horizon{0.80f, 0.86f, 0.92f}, zenith{0.10f, 0.24f, 0.60f},
      ground{0.20f, 0.19f, 0.17f};
  if (d.y < 0) return mix(horizon, ground, std::min(1.0f, std::sqrt(-d.y * 6)));
  const Vec3f blue = mix(horizon, zenith, std::pow(d.y, 0.55f));
  const Vec3f air = mix(blue, {1.05f, 1.05f, 1.08f}, 0.85f * clouds(d));
  const float sun = std::max(0.0f, dot(d, light));
  return air +
         Vec3f{1.0f, 0.92f, 0.75f} * (0.35f * std::pow(sun, 24.0f) + 12 * std::pow(sun, 1500.0f));
}

// The direction of a texel, by the layout of cube maps.
Vec3f cube_direction(int face, float s, float t) {
  switch (face) {
    case 0:
      return {1, -t, -s};
    case 1:
      return {-1, -t, s};
    case 2:
      return {s, 1, t};
    case 3:
      return {s, -1, -t};
    case 4:
      return {s, -t, 1};
    default:
      return {-s, -t, -1};
  }
}

void paint_face(int face, Vec3f light) {
  constexpr int size = 256;
  std::vector<float> rgb;
  rgb.reserve(3 * size * size);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const float s = (2 * static_cast<float>(i) + 1) / size - 1;
      const float t = (2 * static_cast<float>(j) + 1) / size - 1;
      const Vec3f c = sky_color(normalized(cube_direction(face, s, t)), light);
      rgb.insert(rgb.end(), {c.x, c.y, c.z});
    }
  glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), 0, GL_RGB16F, size, size,
               0, GL_RGB, GL_FLOAT, rgb.data());
}

bool load_face(const std::string& folder, int face, int& size, std::string& error) {
  static constexpr const char* names[] = {"posx", "negx", "posy", "negy", "posz", "negz"};
  for (const char* extension : {".png", ".jpg"}) {
    const std::string path = folder + "/" + names[face] + extension;
    if (!std::filesystem::exists(path)) continue;
    const Pixels pixels = read_pixels(path, error);
    const int width = pixels.width;
    if (pixels.rgb == nullptr) return false;
    const bool good = width == pixels.height && (size == 0 || size == width);
    if (good) {
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), 0, GL_SRGB8, width,
                   width, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels.rgb.get());
      size = width;
    } else {
      error = printable(path) + ": not a square picture of the same size as the other faces";
    }
    return good;
  }
  error = printable(folder) + ": no " + names[face] + ".png or .jpg";
  return false;
}

}  // namespace

void write_png(const std::string& path, const Picture& picture) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  stbi_write_png_compression_level = 9;
  stbi_write_png_to_func(append, &bytes, picture.width, picture.height, 3, picture.rgb.data(),
                         picture.width * 3);
  try {
    OutputFile file(path);
    file.write(bytes);
    file.commit();
  } catch (const WriteError& error) {
    throw Failure(kCannotWrite, printable(error.path) + ": " + error.what());
  }
}

Texture load_picture(const std::string& path, std::string& error) {
  return load_file(path, GL_RGB8, error);
}

Texture load_texture(const std::string& path, std::string& error) {
  if (!path.empty()) return load_file(path, GL_SRGB8, error);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * kWeaveSize * kWeaveSize);
  for (int j = 0; j < kWeaveSize; ++j)
    for (int i = 0; i < kWeaveSize; ++i) {
      const Thread thread = weave((static_cast<float>(i) + 0.5f) / kWeaveSize,
                                  (static_cast<float>(j) + 0.5f) / kWeaveSize, kThreads);
      const Vec3f c = thread_color(thread.index) * (0.55f + 0.6f * thread.height);
      rgb.insert(rgb.end(), {to_byte(c.x), to_byte(c.y), to_byte(c.z)});
    }
  return upload(rgb.data(), kWeaveSize, kWeaveSize, GL_SRGB8);
}

Texture load_height_map(const std::string& path, std::string& error) {
  if (!path.empty()) return load_file(path, GL_RGB8, error);
  std::vector<std::uint8_t> rgb;
  for (int j = 0; j < kWeaveSize; ++j)
    for (int i = 0; i < kWeaveSize; ++i) {
      const Thread thread = weave((static_cast<float>(i) + 0.5f) / kWeaveSize,
                                  (static_cast<float>(j) + 0.5f) / kWeaveSize, kThreads / 2);
      rgb.insert(rgb.end(), 3, static_cast<std::uint8_t>(std::lround(thread.height * 255)));
    }
  return upload(rgb.data(), kWeaveSize, kWeaveSize, GL_RGB8);
}

Texture load_material_map(MaterialMap map, const std::string& path, std::string& error) {
  const GLint format = map == MaterialMap::base_color ? GL_SRGB8 : GL_RGB8;
  if (!path.empty()) return load_file(path, format, error);
  constexpr float kRelief = 3;  // steepness of the threads' sides
  const auto place = [](int texel) { return (static_cast<float>(texel) + 0.5f) / kWeaveSize; };
  const auto height = [&](int i, int j) { return weave(place(i), place(j), kThreads).height; };
  const auto level = [](float share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
  };
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * kWeaveSize * kWeaveSize);
  for (int j = 0; j < kWeaveSize; ++j)
    for (int i = 0; i < kWeaveSize; ++i) {
      const Material m = brocade(weave(place(i), place(j), kThreads), place(i), place(j));
      if (map == MaterialMap::base_color) {
        rgb.insert(rgb.end(), {to_byte(m.color.x), to_byte(m.color.y), to_byte(m.color.z)});
      } else if (map == MaterialMap::normal) {
        const float h = height(i, j);
        const Vec3f n = normalized({-kRelief * (height((i + 1) % kWeaveSize, j) - h),
                                    -kRelief * (height(i, (j + 1) % kWeaveSize) - h), 1});
        rgb.insert(rgb.end(),
                   {level(0.5f * n.x + 0.5f), level(0.5f * n.y + 0.5f), level(0.5f * n.z + 0.5f)});
      } else {
        rgb.insert(rgb.end(), 3, level(map == MaterialMap::metallic ? m.metallic : m.roughness));
      }
    }
  return upload(rgb.data(), kWeaveSize, kWeaveSize, format);
}

Texture load_sky(const std::string& path, Vec3f light, std::string& error) {
  Texture texture = make_texture();
  glBindTexture(GL_TEXTURE_CUBE_MAP, texture.id());
  int size = 0;
  for (int face = 0; face < 6; ++face) {
    if (path.empty())
      paint_face(face, light);
    else if (!load_face(path, face, size, error))
      return {};
  }
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateMipmap(GL_TEXTURE_CUBE_MAP);
  return texture;
}

}  // namespace weft::viewer

// Pictures as the viewer reads its textures: any bytes are read or refused, and every byte of what is
// read is there.
#include <stb_image.h>

#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  int width = 0, height = 0, channels = 0;
  if (stbi_info(file.path().c_str(), &width, &height, &channels) == 0) return 0;
  if (std::int64_t{width} * height > 1 << 20) return 0;  // large ones are slow, not wrong
  stbi_uc* const pixels = stbi_load(file.path().c_str(), &width, &height, &channels, 3);
  if (pixels == nullptr) {
    fuzz::require(stbi_failure_reason() != nullptr);
    return 0;
  }
  std::size_t sum = 0;
  for (std::size_t n = 0; n < 3 * std::size_t(width) * std::size_t(height); ++n) sum += pixels[n];
  fuzz::require(sum <= 255 * 3 * std::size_t(width) * std::size_t(height));
  stbi_image_free(pixels);
  return 0;
}
